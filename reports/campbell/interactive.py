"""The Campbell diagram and the mode shapes as interactive figures of Plotly, in one file that needs no network."""

from collections.abc import Mapping
from html import escape
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from ...cases.campbell.diagram import Campbell
from ...cases.input import atomic
from ...core import curve
from ...core.modes import STATIONS
from ..shared.certain import certain, relative
from ..shared.style import COLOURS, MUTED
from ..shared.units import Units
from .shapes import scaled

PAGE = "campbell-interactive.html"

PHASES = 24
"""Pictures of one period of a mode."""

AMPLITUDE, HALF_CHORD = 0.12, 0.02
"""Largest drawn motion, and half the drawn chord, as fractions of the blade's length."""

MARGIN = {"l": 50, "r": 12}
"""Space beside the figures, pixels: small, for telephones."""

POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:"
"""Content security policy of the page: nothing is fetched."""


def installed() -> bool:
    """Whether Plotly is installed (the extra ``interactive``)."""
    return find_spec("plotly") is not None


def lines(diagram: Campbell, units: Units, confirmed: Mapping[int, str] | None = None) -> Any:
    """The diagram as a Plotly figure: hover for mode, frequency, ± and confirming codes; click on a name to hide its line.

    Args:
        diagram: the diagram.
        units: of the axes.
        confirmed: names of the codes that confirm a track, by its index.
    """
    import plotly.graph_objects as go

    tracks, codes = diagram.tracks, confirmed or {}
    speeds = tracks.omega * units.speeds
    figure = go.Figure()
    for t in range(tracks.count):
        frequency, doubt = tracks.frequencies[:, t], tracks.uncertainty[:, t]
        texts = [
            f"{escape(diagram.labels[t])}<br>{units.at(float(omega))}: {certain(f * units.frequencies, u)} {units.frequency}"
            f"<br>± {relative(u)} relative<br>confirmed by: {escape(codes.get(t, 'not verified'))}"
            if np.isfinite(f)
            else ""
            for omega, f, u in zip(tracks.omega, frequency, doubt, strict=True)
        ]
        figure.add_scatter(
            x=speeds,
            y=frequency * units.frequencies,
            name=escape(diagram.labels[t]),
            mode="lines+markers",
            line={"color": COLOURS[t % len(COLOURS)]},
            marker={"size": 5},
            text=texts,
            hoverinfo="text",
        )
    highest = float(np.nanmax(tracks.frequencies)) * units.frequencies * 1.05
    for n in diagram.request.per_rev:
        rays = n * tracks.omega[[0, -1]]
        line = {"color": MUTED, "width": 1, "dash": "dot"}
        x, y = tracks.omega[[0, -1]] * units.speeds, rays * units.frequencies
        figure.add_scatter(x=x, y=y, name=f"{n}P", mode="lines", line=line, hoverinfo="name", legendgroup="nP")
    if diagram.request.operating:
        low, high = (omega * units.speeds for omega in diagram.request.operating)
        figure.add_vrect(x0=low, x1=high, fillcolor=MUTED, opacity=0.12, line_width=0, annotation_text="operating")
    figure.update_layout(
        title=f"{escape(diagram.blade.name)}:<br>natural frequencies versus rotor speed",
        legend={"orientation": "h", "y": -0.15},
        margin=MARGIN,
        xaxis_title=units.speed_label,
        yaxis={"title": units.frequency_label, "range": [0.0, highest]},
        template="plotly_white",
        hovermode="closest",
        height=620,
    )
    return figure


def shapes(diagram: Campbell, k: int, units: Units) -> Any:
    """The mode shapes at speed number ``k`` as an animated Plotly figure in three dimensions, not to scale."""
    import plotly.graph_objects as go

    blade = diagram.blade
    order, motion = scaled(diagram, k, arm=blade.length / 10)
    undeformed, _ = curve.at(blade.stations, blade.curve, blade.kinks, STATIONS * blade.length)
    phases = np.exp(2j * np.pi * np.arange(PHASES) / PHASES)

    def surface(mode: int, phase: complex) -> dict[str, Any]:
        displacement = AMPLITUDE * blade.length * (motion[mode] * phase).real
        half_chord, angle = HALF_CHORD * blade.length, displacement[:, 3]
        edges = [
            undeformed
            + displacement[:, :3]
            + side * half_chord * np.stack([0 * angle, np.cos(angle), np.sin(angle)], 1)
            for side in (-1, 1)
        ]
        x, y, z = np.round(np.stack(edges, 1), 4).transpose(2, 0, 1)
        return {"x": x, "y": y, "z": z}

    names = [escape(diagram.labels[t]) for t in order]
    frequencies = diagram.tracks.frequencies[k, order] * units.frequencies
    titles = [f"{name}, {f:.4g} {units.frequency}" for name, f in zip(names, frequencies, strict=True)]
    colour = [[0, COLOURS[0]], [1, COLOURS[0]]]
    figure = go.Figure(
        [
            go.Surface(
                **surface(m, 1.0), showscale=False, colorscale=colour, visible=m == 0, name=title, hoverinfo="name"
            )
            for m, title in enumerate(titles)
        ],
        frames=[
            go.Frame(data=[go.Surface(**surface(m, phase)) for m in range(len(order))], name=str(j))
            for j, phase in enumerate(phases)
        ],
    )
    play = {"frame": {"duration": 60, "redraw": True}, "fromcurrent": True, "transition": {"duration": 0}}
    loop = [*[str(j) for j in range(PHASES)]] * 10
    stop = [[None], {"frame": {"duration": 0, "redraw": False}, "mode": "immediate"}]
    pick = [
        {"label": title, "method": "update", "args": [{"visible": [m == j for j in range(len(order))]}]}
        for m, title in enumerate(titles)
    ]
    reach = (AMPLITUDE + HALF_CHORD) * blade.length + float(np.abs(undeformed[:, 1:]).max())
    side = {"range": [-reach, reach]}
    figure.update_layout(
        title=f"Mode shapes, {units.at(float(diagram.tracks.omega[k]))}, not to scale",
        scene={
            "xaxis": {"title": "x, m (along the blade)"},
            "yaxis": {"title": "y, m (edgewise)", **side},
            "zaxis": {"title": "z, m (flapwise)", **side},
            "aspectmode": "manual",
            "camera": {"eye": {"x": 1.2, "y": -2.6, "z": 1.1}},
            "aspectratio": {"x": 2.2, "y": 0.8, "z": 0.8},
        },
        updatemenus=[
            {"buttons": pick, "x": 0.0, "xanchor": "left", "y": 1.08},
            {
                "type": "buttons",
                "direction": "left",
                "x": 1.0,
                "xanchor": "right",
                "y": 1.08,
                "buttons": [
                    {"label": "play", "method": "animate", "args": [loop, play]},
                    {"label": "stop", "method": "animate", "args": stop},
                ],
            },
        ],
        template="plotly_white",
        margin=MARGIN,
        height=620,
    )
    return figure


def write(diagram: Campbell, folder: Path, units: Units, k: int, confirmed: Mapping[int, str] | None = None) -> Path:
    """Write the page with both figures; ``k`` is the number of the speed of the shapes. Return its path.

    Raises:
        OSError: if the file cannot be written.
    """
    first = lines(diagram, units, confirmed).to_html(full_html=False, include_plotlyjs=True)
    second = shapes(diagram, k, units).to_html(full_html=False, include_plotlyjs=False, auto_play=False)
    path = folder / PAGE
    atomic.write(
        path,
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>Campbell diagram of {escape(diagram.blade.name)}</title>\n</head>\n"
        f"<body>\n{first}\n{second}\n</body>\n</html>\n",
    )
    return path
