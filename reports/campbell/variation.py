"""Fig. 3 of Park et al. (2010) and the table of variations, for the substitutes of its unpublished blade."""

from collections.abc import Sequence
from functools import partial

import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import PchipInterpolator

from ...cases.campbell.variation import PRINTED, Variation
from ..shared.certain import certain
from ..shared.style import INK, WIDTH, beside, house, title
from ..shared.units import RPM
from .marks import DASHES, FAMILY_COLOURS
from .tables import Sheet

WHAT = {
    "windpact": "WindPACT 3.0 MW, the nearest public blade",
    "surrogate": "surrogate: WindPACT with EI × 1.30, not the paper's blade",
    "surrogate-untwisted": "the same surrogate without twist",
}
"""Descriptions of the blades of ``park-blade``."""


def label(variation: Variation) -> str:
    """The description of a blade."""
    name = variation.diagram.blade.name.partition("/")[2] or variation.diagram.blade.name
    return WHAT.get(name, name)


def figure(variations: Sequence[Variation]) -> Figure:
    """Draw one row per blade: the lowest frequencies against rotor speed, and their change; crosses: the paper."""
    with house():
        low, row = 0.62, 2.75
        height = low + 0.35 + row * len(variations)
        out = Figure((WIDTH, height))
        top = 108 * max(float(np.nanmax(v.rises)) for v in variations)
        for place, variation in enumerate(variations):
            diagram = variation.diagram
            bottom = (low + (len(variations) - 1 - place) * row) / height
            size = (row - 0.62) / height
            left, right = out.add_axes((0.065, bottom, 0.31, size)), out.add_axes((0.565, bottom, 0.3, size))
            fine = np.linspace(diagram.tracks.omega[0], diagram.tracks.omega[-1], 121)
            speeds, interpolate = fine * RPM.speeds, partial(PchipInterpolator, diagram.tracks.omega**2)
            ends: tuple[list[tuple[float, str, str]], list[tuple[float, str, str]]] = ([], [])
            for t in range(diagram.tracks.count):
                family = diagram.labels.names[t].split()[0]
                look = {"color": FAMILY_COLOURS[family], "ls": DASHES[family], "lw": 1.7}
                hertz = np.sqrt(interpolate(diagram.tracks.frequencies[:, t] ** 2)(fine**2)) * RPM.frequencies
                change = 100 * (hertz / hertz[0] - 1.0)
                left.plot(speeds, hertz, **look)
                right.plot(speeds, change, **look)
                ends[0].append(
                    (
                        float(hertz[-1]),
                        f"{diagram.labels[t]}  {certain(float(hertz[-1]), float(diagram.tracks.uncertainty[-1, t]), 4)}",
                        FAMILY_COLOURS[family],
                    )
                )
                ends[1].append((float(change[-1]), f"{diagram.labels[t]}  {change[-1]:.1f} %", FAMILY_COLOURS[family]))
            for rpm, largest in PRINTED.items():
                right.plot(rpm, 100 * largest, marker="x", ms=7, mew=1.6, color=INK, zorder=5, clip_on=False)
            for axes, labels, what in ((left, ends[0], RPM.frequency_label), (right, ends[1], "change from rest, %")):
                axes.set_xlim(speeds[0], speeds[-1])
                axes.set_ylim(0, top if axes is right else None)
                axes.set_ylabel(what)
                beside(axes, labels, 8)
                if place == len(variations) - 1:
                    axes.set_xlabel(RPM.speed_label)
            left.set_title(label(variation), size=9, pad=8)
        below = "Park et al. (2010), Fig. 3: their blade is unpublished, these are substitutes; ×: its largest stated change"
        title(out, "Natural frequencies of a rotating wind-turbine blade", below)
    return out


def sheet(variations: Sequence[Variation]) -> Sheet:
    """The table of changes at the paper's speeds: converged, and in brackets with the paper's 20 lumped elements."""
    rows = []
    for v in variations:
        names = [v.diagram.labels[t] for t in range(v.diagram.tracks.count)]
        for t, name in enumerate(names):
            changes = [f"{_percent(v.rises[k, t])} ({_percent(v.lumped[k, t])})" for k in range(len(PRINTED))]
            rows.append((label(v) if t == 0 else "", name, *changes))
    rows.append(("Park et al. (2010)", "largest", *[_percent(p) for p in PRINTED.values()]))
    head = ("blade", "mode", *[f"{rpm:g} rpm" for rpm in PRINTED])
    note = "Change of frequency from rest; in brackets with the paper's discretisation, 20 elements with lumped masses."
    return Sheet("Frequency variations", head, tuple(rows), note)


def _percent(value: float) -> str:
    return f"{100 * value:+.1f} %" if np.isfinite(value) else "–"
