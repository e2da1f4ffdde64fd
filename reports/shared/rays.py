"""Rays of n per revolution in a diagram of frequencies against rotor speed."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .style import MUTED
from .units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

RAY = "#C9C9C9"

CLEAR = 0.035
"""Least distance of a label from the modes, as a fraction of the height."""


def rays(
    axes: "Axes",
    units: Units,
    per_rev: Sequence[int],
    omega: Array,
    frequencies: Array,
    operating: tuple[float, float] | None = None,
    labels: Sequence[tuple[float, float]] = (),
) -> None:
    """Draw rays, labelled at the top edge or, if they do not reach it, where the label is clear of the modes.

    Args:
        axes: axes with their limits, in ``units``.
        per_rev: the numbers n.
        omega: (k,) speeds of the modes, rad/s.
        frequencies: (k, m) frequencies of the modes, rad/s; nan where there is none.
        operating: range of speeds without labels, if there is room outside it, rad/s.
        labels: speeds and frequencies, rad/s, above which there are other labels.
    """
    (left, right), top = axes.get_xlim(), axes.get_ylim()[1]
    slope = units.frequencies / units.speeds
    for n in per_rev:
        end = min(right, top / (n * slope))
        if end <= left:
            continue
        axes.plot([left, end], [n * slope * left, n * slope * end], color=RAY, lw=0.7, zorder=1)
        reaches_top = end < right * (1 - 1e-9)
        places = left + (right - left) * np.arange(0.97, 0.4, -0.02)
        if operating:
            outside = places[places > operating[1] * units.speeds + 0.03 * (right - left)]
            places = outside if len(outside) else places
        distance = _distance(places / units.speeds, n, omega, frequencies) * units.frequencies / top
        for speed, frequency in labels:
            above = n * slope * places / top - frequency * units.frequencies / top
            beside = np.abs(places - speed * units.speeds) < 0.09 * (right - left)
            distance[beside & (above > 0) & (above < 0.17)] = 0.0
        clear = np.flatnonzero(distance > CLEAR)
        at = end if reaches_top else float(places[clear[0] if len(clear) else distance.argmax()])
        axes.annotate(
            f"{n}P",
            (at, n * slope * at),
            (0, 3 if reaches_top else 0),
            textcoords="offset points",
            ha="center",
            va="bottom" if reaches_top else "center",
            size=7.5,
            color=MUTED,
            bbox=None if reaches_top else {"facecolor": "white", "edgecolor": "none", "pad": 0.6},
            zorder=2,
            annotation_clip=False,
        )


def _distance(speeds: Array, n: int, omega: Array, frequencies: Array) -> Array:
    """Distance of a ray from the nearest mode at each speed, rad/s."""
    modes = np.stack([np.interp(speeds, omega, f) for f in frequencies.T])
    return np.asarray(np.nanmin(np.abs(modes - n * speeds), axis=0))
