"""c2_def of a body in HAWC2's htc file: the half-chord line of a blade, and the axis of other bodies.

c2_def is x, y, z and twist in degrees at sections, of a blade from a root at z = 0 where the half-chord line may be offset from
the blade's axis, with Akima splines in z between them.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import Akima1DInterpolator, CubicSpline

from ...errors import CaseError
from ..text import ROUNDING, believable, number
from .bodies import Body, Command

Array = NDArray[np.float64]

FINE = 2001
"""Number of points of the polygon that measures the length of the half-chord line."""

LENGTHS = 5e-3
"""Largest distance of the last station from the end of c2_def, as a fraction of the length, for the same blade."""

MIN_SPACING = 1e-6
"""Distance, as a fraction of the length, within which a section of c2_def coincides with a station."""


class HalfChords(NamedTuple):
    """The half-chord line at the stations of both files: arc length (n,) m, curve (n, 3) m and twist (n,) rad.

    Axes are those of ``core.blade``. ``at`` (n,) are the same stations in the structural file's r. ``strays`` is the
    deviation (m, rad) of the line from c2_def between the stations, due to the different splines.
    """

    s: Array
    curve: Array
    twist: Array
    at: Array
    strays: tuple[float, float]


def sections(body: Body) -> list[Command]:
    """The commands ``sec`` of c2_def."""
    return [c for c in body if c.words[0] == "sec"]


def points(body: Body) -> Array:
    """The sections of c2_def: x, y, z in m and twist in degrees (n, 4).

    Raises:
        CaseError: naming the line of the section at fault.
    """
    lines = sections(body)
    c2 = np.array([_section(c) for c in lines])
    for count in (c for c in body if c.words[0] == "nsec"):
        word = " ".join(count.words[1:2])
        if number(word) != len(c2):
            raise CaseError(f"{count.at}: nsec: {word}: c2_def has {len(c2)} sections: make the numbers equal")
    for k, line in enumerate(lines, 1):
        if number(line.words[1]) != k:
            raise CaseError(
                f"{line.at}: sec: number {line.words[1]}, but it is section {k}: number them from 1 in order"
            )
    if len(c2) < 2:
        raise CaseError(f"{lines[0].at}: 1 section: c2_def needs at least a root and a tip")
    return c2


def blade_points(body: Body) -> Array:
    """``points`` of a blade, which rises from a root at z = 0.

    Raises:
        CaseError: naming the line of the section at fault.
    """
    c2, lines = points(body), sections(body)
    c2[0, 2] = 0.0 if abs(c2[0, 2]) <= ROUNDING * abs(c2[-1, 2]) else c2[0, 2]
    if c2[0, 2] != 0:
        raise CaseError(f"{lines[0].at}: sec: z = {c2[0, 2]:g} m: the first section is the root; begin at z = 0")
    falls = np.flatnonzero(np.diff(c2[:, 2]) <= ROUNDING * abs(c2[-1, 2])) + 1
    if len(falls):
        k = int(falls[0])
        raise CaseError(
            f"{lines[k].at}: sec: z = {c2[k, 2]:g} m: not beyond the previous one: sort them and remove duplicates"
        )
    return c2


def half_chords(body: Body, r: Array) -> HalfChords:
    """The half-chord line at the stations ``r`` m of a structural file and at the sections of c2_def.

    Raises:
        CaseError: naming the line of the section at fault.
    """
    c2 = blade_points(body)
    spline = Akima1DInterpolator(c2[:, 2], c2)
    z = np.unique(np.concatenate([np.linspace(0, c2[-1, 2], FINE), c2[:, 2]]))
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(spline(z)[:, :3], axis=0), axis=1))])
    if abs(r[-1] - arc[-1]) > LENGTHS * arc[-1]:
        raise CaseError(
            f"{sections(body)[-1].at}: c2_def is {arc[-1]:g} m long, the stations end at {r[-1]:g} m: check that both are "
            "of the same blade"
        )
    s = r * (arc[-1] / r[-1])
    own = np.interp(c2[:, 2], z, arc)
    distance = np.abs(own[:, None] - s).min(axis=1)
    s = np.union1d(s, own[distance > MIN_SPACING * arc[-1]])
    at = spline(np.interp(s, arc, z))
    curve, twist = at[:, [2, 0, 1]], np.radians(at[:, 3])
    fine = spline(z)
    deviation = np.linalg.norm(CubicSpline(s, curve)(arc) - fine[:, [2, 0, 1]], axis=1).max()
    angle = np.abs(np.interp(arc, s, twist) - np.radians(fine[:, 3])).max()
    return HalfChords(s, curve, twist, s * (r[-1] / arc[-1]), (float(deviation), float(angle)))


def _section(command: Command) -> list[float]:
    """x, y, z, m, and twist, degrees, of a ``sec`` of c2_def."""
    values = [number(w) for w in command.words[2:6]]
    if len(values) != 4 or any(v is None or not believable(v) for v in values):
        raise CaseError(f"{command.at}: sec: not x, y, z and twist: {' '.join(command.words)}: correct it")
    return [float(v) for v in values if v is not None]
