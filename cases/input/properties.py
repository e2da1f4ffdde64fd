"""Properties of a blade: its mass and moments, and the centres and principal axes of its sections.

They follow from the 6×6 matrices, about any reference axis. With the compliance ``S`` of a section (strains (axial, y,
z, torsion, about y, about z) from forces in that order):

* an axial force at the tension centre causes no bending;
* a transverse force at the shear centre causes no torsion: ``y = −S(τ, z) / S(τ, τ)``, ``z = S(τ, y) / S(τ, τ)``;
* the principal axes are those of the bending part of ``S``, which is independent of the position of the axis.

(Hodges, *Nonlinear Composite Beam Theory*, 2006, ch. 4; D. H. Hodges' generalised shear centre.) The mass centre comes
from the first moments ``M(x, ψ) = −m y``, ``M(x, θ) = m z``. A rigid strain has no compliance: a centre that depends on
it is taken on the reference axis, as are all centres of a section without couplings.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.blade import AXIAL, BEND_Y, BEND_Z, SHEAR_Y, SHEAR_Z, TORSION, Blade
from ...core.element.sections import frames, root
from ...core.sampling import mass_at
from ...core.space import gauss
from ...core.space import spatial as sp
from ...core.space.inertia import about_centre, transformed

Array = NDArray[np.float64]

ROUND = 1e-3
"""Relative difference of the bending stiffnesses below which principal axes are undefined."""

_GAUSS = 6


@dataclass(frozen=True)
class Mass:
    """A rigid body's mass properties about a point, from its 6×6 inertia there.

    Attributes:
        mass: kg.
        centre: (3,) m, mass centre, from the point.
        moments: (3, 3) kg m², second moments (moment of inertia) about the point.
    """

    mass: float
    centre: Array
    moments: Array

    @property
    def first(self) -> Array:
        """(3,) kg m, first moments about the point."""
        return self.mass * self.centre

    @property
    def own(self) -> Array:
        """(3, 3) kg m², second moments about the centre of mass."""
        cross = sp.skew(self.centre)
        return self.moments + self.mass * cross @ cross


@dataclass(frozen=True)
class SectionProperties:
    """Properties at each station, in section axes, m and rad; (n,) each, centres (n, 2) along y and z.

    Attributes:
        mass_centre, tension_centre, shear_centre: from the reference axis.
        principal: angle from the section's y and z to the nearest principal bending axes, about x, within ±π/4; NaN for
            a section with equal bending stiffness in all directions.
        mass_axes: the same for the axes of the sectional inertia about the mass centre; NaN without inertia.
        EA, GJ: N, N m²; about the tension and shear centre.
        EI_flap, EI_edge: N m², in the principal axes, against motion along z and y.
    """

    mass_centre: Array
    tension_centre: Array
    shear_centre: Array
    principal: Array
    mass_axes: Array
    EA: Array
    GJ: Array
    EI_flap: Array
    EI_edge: Array


def about_hub(blade: Blade) -> Mass:
    """Mass about the hub's centre in the hub's axes (z along the rotor's), with precone, pitch and tip mass."""
    return _properties(_inertia(blade))


def about_root(blade: Blade) -> Mass:
    """Mass about the root in the blade's axes (x along the blade, coned and pitched with it), with the tip mass."""
    return _properties(transformed(_inertia(blade), sp.inverse(root(blade))))


def tip(blade: Blade) -> Mass | None:
    """The body at the tip, about the tip in the tip section's axes; None if there is none."""
    return _properties(blade.tip_mass) if blade.tip_mass[0, 0] > 0 else None


def farthest(values: Array) -> float:
    """The value (n,) of the largest magnitude, with its sign, to a nanometre."""
    return round(float(values[np.abs(values).argmax()]), 9) + 0.0


def _inertia(blade: Blade) -> Array:
    """Inertia (6, 6) about the hub's centre by Gauss quadrature between stations; mass is linear between them."""
    s, weight = (part.ravel() for part in gauss.between(blade.stations, _GAUSS))
    parts = np.concatenate([mass_at(blade, s) * weight[:, None, None], blade.tip_mass[None]])
    return transformed(parts, frames(blade, np.append(s, blade.stations[-1]))).sum(0)


def _properties(inertia: Array) -> Mass:
    mass, centre, _ = about_centre(inertia)
    return Mass(float(mass), centre, inertia[3:, 3:])


def sections(blade: Blade) -> SectionProperties:
    """Centres, principal axes and engineering stiffnesses of the sections at the stations."""
    m = blade.mass
    mass = m[:, 0, 0]
    mass_centre = np.stack([-m[:, AXIAL, BEND_Z], m[:, AXIAL, BEND_Y]], axis=1) / mass[:, None]
    s = _compliance(blade)
    bend = s[:, BEND_Y:, BEND_Y:]
    flexural: Array = np.linalg.inv(bend).astype(float)
    compensation = -(flexural @ s[:, BEND_Y:, AXIAL][..., None])[
        ..., 0
    ]  # moments that undo the bending of a unit axial force
    tension = np.stack([-compensation[:, 1], compensation[:, 0]], axis=1)
    torsion = s[:, TORSION, TORSION]
    couplings = np.stack([-s[:, TORSION, SHEAR_Z], s[:, TORSION, SHEAR_Y]], axis=1)
    shear = np.divide(couplings, torsion[:, None], out=np.zeros_like(couplings), where=torsion[:, None] > 0)
    axial = s[:, AXIAL, AXIAL] + (s[:, AXIAL, BEND_Y:] * compensation).sum(1)
    principal, flap, edge = _axes(flexural)
    own = m[:, 4:, 4:] - mass[:, None, None] * _spread(mass_centre)
    return SectionProperties(
        mass_centre=mass_centre,
        tension_centre=tension,
        shear_centre=shear,
        principal=principal,
        mass_axes=_axes(own)[0],
        EA=_inverse(axial),
        GJ=_inverse(torsion),
        EI_flap=flap,
        EI_edge=edge,
    )


def _compliance(blade: Blade) -> Array:
    """Compliance (n, 6, 6), zero for rigid strains."""
    soft = np.flatnonzero(np.isfinite(blade.stiffness).all(axis=(0, 2)))
    out = np.zeros_like(blade.stiffness)
    out[:, soft[:, None], soft] = np.linalg.inv(blade.stiffness[:, soft[:, None], soft])
    return out


def _axes(stiffness: Array) -> tuple[Array, Array, Array]:
    """Angle to the nearest principal axes of symmetric (n, 2, 2) about y and z, and the values there."""
    a, b, c = stiffness[:, 0, 0], stiffness[:, 0, 1], stiffness[:, 1, 1]
    middle, radius = (a + c) / 2, np.hypot((a - c) / 2, b)
    angle = 0.5 * np.arctan2(2 * b, a - c)
    angle = angle - np.pi / 2 * np.round(angle / (np.pi / 2))
    first = np.where(a >= c, middle + radius, middle - radius)
    return np.where(2 * radius > ROUND * np.abs(middle), angle, np.nan), first, 2 * middle - first


def _spread(centre: Array) -> Array:
    """(n, 2, 2) second moments about y and z of unit masses at ``centre`` (n, 2)."""
    y, z = centre.T
    return np.stack([np.stack([z * z, -y * z], axis=1), np.stack([-y * z, y * y], axis=1)], axis=1)


def _inverse(compliance: Array) -> Array:
    return np.divide(1.0, compliance, out=np.full_like(compliance, np.inf), where=compliance > 0)
