"""Energy fractions of a mode in flapwise, edgewise, torsional and axial motion, and the family name that follows from them.

A slice of the blade translates with its mass centre and rotates about it, so its kinetic energy is the sum of four parts
(König's theorem). None of them is negative or depends on the reference axis:

* flapwise and edgewise: motion of the mass centre along the blade's z and y, and rotation of the section in bending;
* torsion: rotation about the blade's axis through the mass centre, with the polar inertia about it;
* axial: motion of the mass centre along the blade.

The blade's axes are the hub's rotated by precone and pitch, not by twist. A blade whose sections have no moments of inertia
has no kinetic energy in torsion, however large the rotation.
"""

from collections import Counter
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from . import curve
from .blade import Blade
from .element.sections import frames, root
from .modes import STATIONS, Modes
from .sampling import mass_at
from .space import gauss
from .space.inertia import about_centre

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

FAMILIES = ("flapwise", "edgewise", "torsion", "axial")
"""Names of the four energy fractions, in their order."""

MIXED = "mixed"

DOMINANT_FRACTION = 0.6
"""Smallest energy fraction that names a mode; otherwise the mode is mixed."""

MIN_NAMED_FRACTION = 0.05
"""Energy fractions below this are not named."""

_GAUSS = 4


def participation(modes: Modes, blade: Blade) -> Array:
    """Energy fractions (m, 4) of the modes in the order of ``FAMILIES``; each row adds up to 1.

    Shapes are interpolated between the common stations by cubic splines. Mass is integrated between the blade's stations by
    Gauss quadrature, and the tip mass is added. In bending, sections rotate with the line of mass centres.
    """
    s, weight = _quadrature(blade)
    mass = np.concatenate([weight[:, None, None] * mass_at(blade, s[:-1]), blade.tip_mass[None]])
    axes = root(blade)[:3, :3]
    centre, inertia = _about_centre(mass, frames(blade, s)[:, :3, :3])
    velocity, turning = _motion(modes, blade, s, centre)
    parts = (mass[:, 0, 0, None] * np.abs(velocity @ axes) ** 2).sum(1)[:, [2, 1, 0, 0]]
    parts[:, 2] = 0.0
    turns = turning @ axes
    parts[:, :3] += (turns.conj() * np.einsum("sij,msj->msi", axes.T @ inertia @ axes, turns)).real.sum(1)[:, [1, 2, 0]]
    total = parts.sum(1, keepdims=True)
    return np.divide(parts, total, out=np.zeros_like(parts), where=total > 0)


def in_blade_axes(modes: Modes, blade: Blade) -> Complex:
    """Shapes (m, 21, 4) with displacements along the blade's axes instead of the hub's (precone, pitch)."""
    out = modes.shapes.copy()
    out[:, :, :3] = modes.shapes[:, :, :3] @ root(blade)[:3, :3]
    return out


def gyration(blade: Blade) -> float:
    """Radius of gyration of the blade in torsion, about its mass centres, m."""
    s, weight = _quadrature(blade)
    mass = np.concatenate([weight[:, None, None] * mass_at(blade, s[:-1]), blade.tip_mass[None]])
    section = frames(blade, s)[:, :3, :3]
    _, inertia = _about_centre(mass, section)
    polar = np.einsum("si,sij,sj->s", section[:, :, 0], inertia, section[:, :, 0]).sum()
    return float(np.sqrt(max(polar, 0.0) / mass[:, 0, 0].sum()))


def families(energy_fractions: Array) -> tuple[str, ...]:
    """Family of each row of energy fractions (m, 4): the one with at least ``DOMINANT_FRACTION``, else ``mixed``."""
    return tuple(FAMILIES[int(row.argmax())] if row.max() >= DOMINANT_FRACTION else MIXED for row in energy_fractions)


def numbered(names: Sequence[str]) -> tuple[str, ...]:
    """Number modes, given by family in order of frequency, within their family: ``flapwise 1``, ``edgewise 1``."""
    occurrences: Counter[str] = Counter()
    out = []
    for name in names:
        occurrences[name] += 1
        out.append(f"{name} {occurrences[name]}")
    return tuple(out)


def describe_fractions(energy_fractions: Array) -> str:
    """Energy fractions (4,) of one mode in words, largest first: ``54 % flapwise, 43 % edgewise``."""
    order = np.argsort(-energy_fractions, kind="stable")
    return ", ".join(
        f"{100 * energy_fractions[k]:.0f} % {FAMILIES[k]}" for k in order if energy_fractions[k] >= MIN_NAMED_FRACTION
    )


def _quadrature(blade: Blade) -> tuple[Array, Array]:
    """Points (k+1,) and weights (k,) between the blade's stations and the common ones; the last point is the tip."""
    ends = np.unique(np.concatenate([blade.stations, STATIONS * blade.length]))
    ends = ends[np.append(True, np.diff(ends) > 1e-9 * blade.length)]
    s, weight = gauss.between(ends, _GAUSS)
    return np.append(s, blade.length), weight.ravel()


def _motion(modes: Modes, blade: Blade, s: Array, centre: Array) -> tuple[Complex, Complex]:
    """Velocity of the mass centres (at ``centre`` (k, 3) from the reference curve) and rotation (m, k, 3) at ``s``, hub axes.

    Pieces between kinks are treated separately; one with fewer than three of the common stations is joined to the previous.
    """
    at = curve.on_kinks(STATIONS * blade.length, blade.kinks, curve.KINK_TOLERANCE * blade.length)
    ends = [0.0, blade.length]
    for kink in blade.kinks:
        if min(np.sum((at >= ends[-2]) & (at <= kink)), np.sum(at >= kink)) >= 3:
            ends.insert(-1, kink)
    velocity = np.empty((len(modes.frequencies), len(s), 3), complex)
    turning = np.empty_like(velocity)
    for start, end in pairwise(ends):
        piece = (at >= start) & (at <= end)
        in_piece = (s >= start) & (s <= end)
        section = np.where(
            (at[piece] == start)[:, None, None], *(frames(blade, at[piece], root_side=b) for b in (False, True))
        )
        velocity[:, in_piece], turning[:, in_piece] = _smooth_motion(
            blade, at[piece], section[:, :3, :3], modes.shapes[:, piece], s[in_piece], centre[in_piece]
        )
    return velocity, turning


def _smooth_motion(
    blade: Blade, at: Array, section: Array, shapes: Complex, s: Array, centre: Array
) -> tuple[Complex, Complex]:
    """``_motion`` on one smooth piece, from shapes (m, n, 4) and section axes (n, 3, 3) at its stations ``at`` (n,)."""
    tangent, (offset, _) = section[:, :, 0], _about_centre(mass_at(blade, at), section)
    displacement = shapes[:, :, :3]
    bending_rotation = np.cross(
        tangent, CubicSpline(at, displacement, axis=1)(at, 1)
    )  # part of the sections' rotation about x that is not torsion
    torsion = (shapes[:, :, 3] - bending_rotation[:, :, 0]) / tangent[:, 0]
    line = CubicSpline(at, displacement + torsion[:, :, None] * np.cross(tangent, offset), axis=1)
    along = frames(blade, s)[:, :3, 0]
    bending = np.cross(along, line(s, 1))
    turning = bending + CubicSpline(at, torsion, axis=1)(s)[:, :, None] * along
    from_line = centre - CubicSpline(at, offset)(s)
    return line(s) + np.cross(bending, centre - from_line) + np.cross(turning, from_line), turning


def _about_centre(mass: Array, section: Array) -> tuple[Array, Array]:
    """Mass centre (k, 3) from the reference point and inertia (k, 3, 3) about it, hub axes, from 6×6 in ``section`` axes."""
    _, centre, inertia = about_centre(mass)
    return np.einsum("sij,sj->si", section, centre), section @ inertia @ np.swapaxes(section, -1, -2)
