"""Other descriptions of the same blade, whose frequencies must be the same: each is a convention of the description.

``INVARIANCES`` are functions from a blade to two blades with equal frequencies at rotor speeds that differ in their sign at
most. Rotations and offsets are computed without core: ``references.readers.quadrature.placed`` and the formulae here.
Where an offset or a rotation varies along the blade, properties are no longer linear between stations: stations are added
until the error is small, and once more to know its size.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import Rotation

from ...core.blade import BEND_Y, BEND_Z, Blade, clamped
from ...references.readers.quadrature import Mounted, linear, placed
from .weights import stations_of

Array = NDArray[np.float64]

OFFSET = (0.01, -0.006)
"""Distance by which the reference axis is moved along y and z, as a fraction of the length."""

ANGLE = 0.6
"""Angle by which section axes are turned, rad."""

TILT = 0.08
"""Pitch and precone that are stated otherwise, rad."""

MAX_TWIST = np.radians(1.0)
"""Largest change of the frame between stations where a transformation varies along the blade."""

MAX_STATIONS = 400
"""Largest number of stations of a transformed blade."""

STIFF = 1e4
"""Stiffness in place of a rigid strain where the transformation couples strains, relative to bending over the length."""


class NotApplicableError(Exception):
    """An invariance does not apply to a blade; the message gives the reason in one line."""


@dataclass(frozen=True)
class Invariance:
    """A second description of a blade.

    Attributes:
        name: what is changed.
        convention: what is wrong if the frequencies differ.
        alter: two blades with equal frequencies, from a blade and the number of parts into which intervals are divided.
        reversed_rotation: whether the second rotates in the opposite sense.
        exact: whether the properties of the second stay linear between the stations.
    """

    name: str
    convention: str
    alter: Callable[[Blade, int], tuple[Blade, Blade]]
    reversed_rotation: bool = False
    exact: bool = True


def split(blade: Blade, parts: int) -> Blade:
    """The blade with every interval between stations divided into equal parts; the same properties, curve and kinks."""
    s = blade.stations
    points = s[:-1, None] + np.diff(s)[:, None] * np.arange(parts) / parts
    stations = np.append(points.ravel(), s[-1])
    rigid = np.isinf(blade.stiffness).any(axis=0)
    stiffness = linear(s, np.where(np.isinf(blade.stiffness), 0.0, blade.stiffness), stations)
    stiffness[:, rigid] = np.inf
    return replace(
        blade,
        stations=stations,
        stiffness=stiffness,
        mass=linear(s, blade.mass, stations),
        twist=linear(s, blade.twist, stations),
        curve=_splines(blade, stations),
    )


def _splines(blade: Blade, stations: Array) -> Array:
    """Points (k, 3) of the curve, a cubic spline between kinks."""
    ends, s = [0.0, *blade.kinks, blade.length], blade.stations
    out = np.empty((len(stations), 3))
    for start, end in pairwise(ends):
        in_segment, new = (s >= start) & (s <= end), (stations >= start) & (stations <= end)
        out[new] = make_interp_spline(s[in_segment], blade.curve[in_segment], k=min(3, int(in_segment.sum()) - 1))(
            stations[new]
        )
    return out


def _turned(angle: float) -> Array:
    """Matrix (6, 6) from section axes turned by an angle about x to the section axes."""
    block = Rotation.from_rotvec([angle, 0.0, 0.0]).as_matrix()
    return np.block([[block, np.zeros((3, 3))], [np.zeros((3, 3)), block]])


def _congruent(matrices: Array, to: Array) -> Array:
    """``to``ᵀ M ``to`` with strains that are rigid before and after kept rigid."""
    rigid = np.isinf(matrices).any(axis=0) if matrices.ndim == 3 else np.isinf(matrices)
    out = np.swapaxes(to, -1, -2) @ np.where(np.isinf(matrices), 0.0, matrices) @ to
    out[..., rigid] = np.inf
    return out


def _section_axes(blade: Blade, _: int) -> tuple[Blade, Blade]:
    rigid = _rigid(blade)
    if rigid[1] != rigid[2] or rigid[BEND_Y] != rigid[BEND_Z]:
        blade = flexible(blade)
    to = _turned(-ANGLE)
    rotated = replace(
        blade,
        twist=blade.twist - ANGLE,
        stiffness=_congruent(blade.stiffness, to),
        mass=_congruent(blade.mass, to),
        tip_mass=_congruent(blade.tip_mass, to),
    )
    return blade, rotated


def _rigid(blade: Blade) -> NDArray[np.bool_]:
    """(6,) whether a strain is rigid."""
    return np.array([np.isinf(blade.stiffness[:, k, k]).any() for k in range(6)])


def flexible(blade: Blade) -> Blade:
    """The blade with rigid strains replaced by stiff ones; the same stiffness in each description that is compared."""
    d, rigid = np.diagonal(blade.stiffness, axis1=1, axis2=2), _rigid(blade)
    if not rigid.any():
        return blade
    if rigid[[BEND_Y, BEND_Z]].any():
        raise NotApplicableError("bending is rigid")
    bending = np.maximum(d[:, BEND_Y], d[:, BEND_Z])
    stiffness = np.where(np.isinf(blade.stiffness), 0.0, blade.stiffness)
    for strain in np.flatnonzero(rigid):
        stiffness[:, strain, strain] = STIFF * bending / (blade.length**2 if strain < 3 else 1.0)
    return replace(blade, stiffness=stiffness)


def _split(blade: Blade, _: int) -> tuple[Blade, Blade]:
    return blade, split(blade, 2)


def _axis(blade: Blade, parts: int) -> tuple[Blade, Blade]:
    """The curve moved by e, in blade axes: the strains and velocities there are [1 Rᵀe×R; 0 1] times those at the curve."""
    if not clamped(blade):
        raise NotApplicableError("the root is not clamped: its hinge would move with the axis")
    blade = flexible(blade)
    fine = split(blade, _pieces(blade, parts))
    e = blade.length * np.array([0.0, *OFFSET])
    _, axes = placed(Mounted(stations_of(fine), 0.0, 0.0, 0.0, fine.kinks), fine.stations)
    local = np.einsum("nji,j->ni", axes, e)
    to = np.tile(np.eye(6), (len(local), 1, 1))
    to[:, :3, 3:] = _cross(local)
    tip = to[-1]
    shifted = replace(
        fine,
        curve=fine.curve + e,
        stiffness=_congruent(fine.stiffness, to),
        mass=_congruent(fine.mass, to),
        tip_mass=tip.T @ fine.tip_mass @ tip,
    )
    return blade, shifted


def _cross(a: Array) -> Array:
    """Matrices (n, 3, 3) of the vector products a ×."""
    x, y, z = a.T
    zero = np.zeros_like(x)
    return np.stack([np.stack(row, axis=-1) for row in ((zero, -z, y), (z, zero, -x), (-y, x, zero))], axis=-2)


def _pieces(blade: Blade, parts: int) -> int:
    """Number of parts of an interval, so that sections turn little between stations."""
    _, axes = placed(Mounted(stations_of(blade), 0.0, 0.0, 0.0, blade.kinks), blade.stations)
    angles = (Rotation.from_matrix(axes[:-1]).inv() * Rotation.from_matrix(axes[1:])).magnitude()
    intervals = len(blade.stations) - 1
    limit = max(MAX_STATIONS // (2 * intervals), 1)
    return parts * min(int(np.ceil(angles.max() / MAX_TWIST)) or 1, limit)


def _mirror(flips: Array) -> Callable[[Blade], Blade]:
    """The mirror image: displacements along axes with −1 change their sign, and rotations about the others."""
    strains = np.concatenate([flips, np.prod(flips) * flips])
    signs = np.outer(strains, strains)

    def alter(blade: Blade) -> Blade:
        off = ~np.eye(6, dtype=bool)
        factor = np.where(off, signs, 1.0)
        return replace(
            blade,
            stiffness=np.where(np.isinf(blade.stiffness), blade.stiffness, blade.stiffness * factor),
            mass=blade.mass * factor,
            tip_mass=blade.tip_mass * factor,
            twist=-blade.twist,
            pitch=-blade.pitch,
            curve=blade.curve * flips,
            precone=blade.precone * flips[2],
        )

    return alter


def _pitch(blade: Blade, _: int) -> tuple[Blade, Blade]:
    if not clamped(blade):
        raise NotApplicableError("the root is not clamped: its hinge turns with the pitch")
    rotation = Rotation.from_rotvec([TILT, 0.0, 0.0])
    return (
        replace(blade, pitch=blade.pitch + TILT),
        replace(blade, twist=blade.twist + TILT, curve=rotation.apply(blade.curve)),
    )


def _precone(blade: Blade, parts: int) -> tuple[Blade, Blade]:
    """Hub radius, precone and pitch stated by the curve, which begins where the root was."""
    if not clamped(blade):
        raise NotApplicableError("the root is not clamped: its hinge turns with the precone")
    cone = blade.precone if blade.precone else TILT
    coned = replace(blade, precone=cone)
    if abs(blade.hub_radius * np.sin(cone)) > 0.2 * blade.length:
        raise NotApplicableError("the root is too far from the rotor's plane for a curve that begins there")
    fine = split(coned, _pieces(coned, parts))
    points, axes = placed(
        Mounted(stations_of(fine), fine.hub_radius, fine.precone, fine.pitch, fine.kinks), fine.stations
    )
    plane = fine.hub_radius * np.cos(cone)
    on_curve = replace(
        fine, hub_radius=plane, precone=0.0, pitch=0.0, curve=points - [plane, 0.0, 0.0], twist=np.zeros(len(points))
    )
    _, untwisted = placed(Mounted(stations_of(on_curve), 0.0, 0.0, 0.0, on_curve.kinks), on_curve.stations)
    twist = np.unwrap((Rotation.from_matrix(untwisted).inv() * Rotation.from_matrix(axes)).as_rotvec()[:, 0])
    return coned, replace(on_curve, twist=twist)


def _image(flips: tuple[float, float, float]) -> Callable[[Blade, int], tuple[Blade, Blade]]:
    mirrored = _mirror(np.array(flips))
    return lambda blade, _: (blade, mirrored(blade))


INVARIANCES = (
    Invariance("stations split", "properties between stations, or the curve through them", _split),
    Invariance("section axes turned", "the axes in which sections and tip mass are given, or the sense of the twist",
               _section_axes),
    Invariance("reference axis moved", "the point about which stiffness, mass and tip mass are given", _axis, exact=False),
    Invariance("mirror image with reversed rotation", "a sign of twist, pitch, sweep, coupling or offset",
               _image((1.0, -1.0, 1.0)), reversed_rotation=True),
    Invariance("mirror image in the rotor's plane", "a sign of precone, twist, pitch, prebend, coupling or offset",
               _image((1.0, 1.0, -1.0))),
    Invariance("pitch stated as twist", "the sense or the axis of the pitch", _pitch),
    Invariance("precone stated by the curve", "the sense of the precone, or the direction of the hub radius", _precone,
               exact=False),
)  # fmt: skip
"""What does not change the frequencies of a blade."""
