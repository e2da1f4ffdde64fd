"""The Campbell diagram of a turbine, and the machine that moves in a selected mode at a selected speed, in one file."""

import json
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...cases.campbell.machine import MachineDiagram, ModeLine
from ...cases.input import atomic
from ...core.turbine.motion import Motion
from ..shared.certain import certain, relative
from ..shared.style import COLOURS, MUTED
from ..shared.units import Units
from .interactive import PAGE, POLICY
from .machine import NAMED, frame

AMPLITUDE = 0.08
"""Largest drawn motion, relative to the height of the machine."""

SPARSE = 2
"""Every how many nodes of a blade are drawn."""

_DASHES = {"collective": "dash", "forward": "dashdot", "backward": "dot"}

_STYLE = """
h1 { font-size: 24px; }
body { font: 16px/1.5 system-ui, sans-serif; margin: 0 auto; max-width: 1100px; padding: 0 12px 24px; color: #222; }
.controls { display: flex; flex-wrap: wrap; gap: 8px 20px; align-items: center; margin: 12px 0; }
.controls label { display: flex; gap: 8px; align-items: center; }
select, button { font: inherit; padding: 4px 10px; max-width: 100%; }
#caption { font-weight: 600; margin: 4px 0; }
.note { color: #555; font-size: 14px; }
@media (max-width: 699px) { #diagram, div:has(> #diagram) { height: 680px !important; } }
"""

_BODY = """
<h2>The machine in one mode</h2>
<p class="note">Select a mode and a speed, or click on a point of the diagram. One period of the mode takes 2 s; the rotor
turns in proportion. Amplitudes are not to scale.</p>
<div class="controls">
<label>Mode <select id="mode"></select></label>
<label>Speed <input id="speed" type="range" min="0" step="1"><span id="speed-label"></span></label>
<label>Amplitude <input id="amplitude" type="range" min="0" max="2" step="0.05" value="1"></label>
<label><input id="turns" type="checkbox" checked> Rotor turns</label>
<button id="play" type="button">Play</button>
</div>
<p id="caption" aria-live="polite"></p>
<div id="machine"></div>
"""


def lines(diagram: MachineDiagram, units: Units) -> Any:
    """The diagram as a Plotly figure: hover for mode, frequency, ± and confidence; click on a name to hide its line."""
    import plotly.graph_objects as go

    figure = go.Figure()
    for n, line in enumerate(diagram.lines):
        texts = [
            f"{escape(name)}<br>{units.at(float(omega))}: {_frequency(line, k, units)}"
            f"<br>± {relative(line.uncertainty)} relative<br>confidence of the name {100 * line.confidence[k]:.0f} %"
            for k, (omega, name) in enumerate(zip(diagram.omega, line.names, strict=True))
        ]
        figure.add_scatter(
            x=diagram.omega * units.speeds,
            y=line.frequencies * units.frequencies,
            name=escape(line.name),
            mode="lines+markers",
            line={
                "color": COLOURS[n % len(COLOURS)],
                "dash": next((dash for word, dash in _DASHES.items() if word in line.name), "solid"),
            },
            marker={"size": 5},
            text=texts,
            hoverinfo="text",
        )
    ends = diagram.omega[[0, -1]]
    highest = 1.05 * max(float(line.frequencies.max()) for line in diagram.lines)
    for n in diagram.request.per_rev:
        dotted = {"color": MUTED, "width": 1, "dash": "dot"}
        stop = np.array([ends[0], min(float(ends[1]), highest / n)])
        x, y = stop * units.speeds, n * stop * units.frequencies
        figure.add_scatter(x=x, y=y, name=f"{n}P", mode="lines", line=dotted, hoverinfo="name", showlegend=False)
        figure.add_annotation(
            x=x[1], y=y[1], text=f"{n}P", showarrow=False, xshift=10, font={"color": MUTED, "size": 11}
        )
    if diagram.request.operating:
        low, high = (omega * units.speeds for omega in diagram.request.operating)
        figure.add_vrect(x0=low, x1=high, fillcolor=MUTED, opacity=0.12, line_width=0, annotation_text="operating")
    figure.update_layout(
        xaxis_title=units.speed_label,
        yaxis={"title": units.frequency_label, "range": [0.0, highest * units.frequencies]},
        template="plotly_white",
        hovermode="closest",
        height=560,
        margin={"l": 60, "r": 20, "t": 20},
    )
    return figure


def _frequency(line: ModeLine, k: int, units: Units) -> str:
    return f"{certain(float(line.frequencies[k]) * units.frequencies, line.uncertainty)} {units.frequency}"


def moving(diagram: MachineDiagram, units: Units) -> dict[str, Any]:
    """What ``machine.js`` draws: positions at each speed, and complex displacements of each mode, of which the largest is 1."""
    speeds = []
    for k, solved in enumerate(diagram.solved):
        motion = solved.parts
        modes = []
        for line in diagram.lines:
            mode = _scaled(motion, line.places[k])
            mode |= {
                "name": line.names[k],
                "omega": float(line.frequencies[k]),
                "frequency": _frequency(line, k, units),
                "confidence": f"{100 * line.confidence[k]:.0f} %",
            }
            modes.append(mode)
        speeds.append(
            {
                "omega": float(solved.omega),
                "label": units.at(float(solved.omega)),
                "tower": motion.tower.round(3).tolist(),
                "shaft": motion.shaft[:3].round(5).tolist(),
                "blade": motion.blade[_drawn(motion)].round(3).tolist(),
                "modes": modes,
            }
        )
    motion = diagram.solved[0].parts
    radius = float(np.linalg.norm(motion.blade, axis=1).max())
    top = float(motion.shaft[0, 3]) + 1.15 * radius
    return {
        "names": [line.name for line in diagram.lines],
        "blades": diagram.turbine.blades,
        "colours": COLOURS,
        "size": AMPLITUDE * top,
        "reach": 1.15 * max(radius, float(np.abs(motion.tower[:, 1:]).max())),
        "top": top,
        "speeds": speeds,
    }


def _drawn(motion: Motion) -> NDArray[np.intp]:
    """Indices of the nodes of a blade that are drawn, with the last."""
    last = len(motion.blade) - 1
    return np.append(np.arange(0, last, SPARSE), last)


def _scaled(motion: Motion, m: int) -> dict[str, Any]:
    """Mode m, scaled so that the largest displacement of tower and blades is 1 and real."""
    tower, hub, blades = motion.tower_motion[m], motion.hub[m], motion.blades[m]
    carried = hub[:3] + np.cross(hub[3:], motion.blade)  # of the first blade with the hub, at the azimuth 0
    values = np.concatenate([tower.ravel(), carried.ravel(), blades.ravel()])
    largest = values[np.abs(values).argmax()]
    pairs = (_pairs(part / largest) for part in (tower, hub, blades[:, _drawn(motion)]))
    return dict(zip(("tower", "hub", "blades"), pairs, strict=True))


def _pairs(values: NDArray[np.complex128]) -> list[Any]:
    """Nested lists of [real, imaginary]."""
    return np.stack([values.real, values.imag], axis=-1).round(5).tolist()


def write(diagram: MachineDiagram, folder: Path, units: Units) -> Path:
    """Write the page; return its path.

    Raises:
        OSError: if the file cannot be written.
    """
    options = {"responsive": True, "displaylogo": False}
    figure = lines(diagram, units).to_html(full_html=False, include_plotlyjs=True, div_id="diagram", config=options)
    data = json.dumps(moving(diagram, units), separators=(",", ":")).replace("</", "<\\/")
    script = files(__package__ or "").joinpath("machine.js").read_text(encoding="utf-8")
    path = folder / PAGE
    atomic.write(
        path,
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>Campbell diagram of {escape(diagram.turbine.name)}</title>\n<style>{_STYLE}</style>\n</head>\n"
        f"<body>\n<h1>{escape(diagram.turbine.name)}: natural frequencies versus rotor speed</h1>\n"
        f'<p class="note">{escape(frame(diagram))} {escape(NAMED)}</p>\n{figure}\n{_BODY}'
        f'<script type="application/json" id="machine-data">{data}</script>\n<script>{script}</script>\n</body>\n</html>\n',
    )
    return path
