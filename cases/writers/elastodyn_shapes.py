"""Mode shapes for ElastoDyn: ``φ(x) = Σ c_k x^k``, k = 2 … 6, ``φ(1) = 1``, for flapwise 1, flapwise 2 and edgewise 1.

ElastoDyn bends a blade in the flap and edge directions of its sections and rotates the curvatures by the structural
twist itself; it has no torsion, shear, stretch, offsets or sectional inertia. Its shapes are therefore those of the
blade without these, and without pitch, at the hub radius, precone and rotor speed of interest (J. Jonkman's advice to
users of ElastoDyn): flap and edge of that blade do not couple, and each shape is one function. The shapes of the
twisted blade differ; they are fitted only to show the difference.

x is the fraction of the flexible blade from root to tip. The sign of a shape is fixed only by ``φ(1) = 1``: flap is
positive downwind and edge in ElastoDyn's positive direction, as is the tip's displacement.
"""

import warnings
from dataclasses import dataclass, replace

import numpy as np

from ...core.blade import BEND_Y, BEND_Z, Blade, section_mass, section_stiffness
from ...core.element.sections import compliance
from ...core.modes import STATIONS, Modes
from ...core.participation import families, numbered, participation
from ...core.solve import modes
from ...core.spectrum.refinement import AccuracyWarning
from ..input.errors import CaseError
from ..judge.pairing import Array

POWERS = (2, 3, 4, 5, 6)

ELASTODYN_NAMES = {"flapwise 1": "BldFl1Sh", "flapwise 2": "BldFl2Sh", "edgewise 1": "BldEdgSh"}
"""Modes, and the names of their coefficients in ElastoDyn."""

DIGITS = 6
"""Decimals of the coefficients; the rounded coefficients add up to 1."""


@dataclass(frozen=True)
class Polynomial:
    """One shape.

    Attributes:
        mode: ``flapwise 1``.
        frequency: frequency of the blade with this shape, rad/s.
        coefficients: (5,) of x² … x⁶, rounded and adding up to 1.
        shape: (21,) fitted shape at the common stations, 1 at the tip.
        largest: largest deviation of the polynomial from the shape, relative to the tip displacement.
        rms: root mean square of the same deviation.
        condition: condition number (2-norm) of the least-squares problem: largest amplification of an error of the
            shape in a coefficient.
        uncertainty: relative uncertainty of the frequency; infinite if unknown.
    """

    mode: str
    frequency: float
    coefficients: Array
    shape: Array
    largest: float
    rms: float
    condition: float
    uncertainty: float = np.inf

    def at(self, x: Array) -> Array:
        """Values at fractions ``x``."""
        return np.power.outer(x, POWERS) @ self.coefficients


def fit(mode: str, frequency: float, shape: Array) -> Polynomial:
    """Least-squares fit over ``STATIONS`` (x) with ``φ(1) = 1`` exactly: ``φ − x⁶ = Σ c_k (x^k − x⁶)``, k = 2 … 5.

    Raises:
        CaseError: if the tip does not move.
    """
    if abs(shape[-1]) < 1e-6 * np.abs(shape).max(initial=0.0) or not shape[-1]:
        raise CaseError(f"{mode}: its tip does not move, so no polynomial that is 1 at the tip describes it")
    scaled = shape / shape[-1]
    basis = np.stack([STATIONS**k - STATIONS**6 for k in POWERS[:-1]], axis=1)
    free, *_ = np.linalg.lstsq(basis, scaled - STATIONS**6, rcond=None)
    free = np.round(free, DIGITS)
    coefficients = np.append(free, round(1.0 - free.sum(), DIGITS))
    deviation = np.power.outer(STATIONS, POWERS) @ coefficients - scaled
    return Polynomial(
        mode=mode,
        frequency=frequency,
        coefficients=coefficients,
        shape=scaled,
        largest=float(np.abs(deviation).max()),
        rms=float(np.sqrt(np.mean(deviation**2))),
        condition=float(np.linalg.cond(basis)),
    )


def principal(blade: Blade) -> Blade:
    """The blade as ElastoDyn models it: straight, untwisted principal bending stiffnesses, mass without inertia.

    The bending stiffness is that under a pure moment, independent of the reference axis: the inverse of the bending
    block of the compliance. Edge is the principal value whose axis is nearer to the section's z.
    """
    block = compliance(blade, blade.stations)[:, BEND_Y : BEND_Z + 1, BEND_Y : BEND_Z + 1]
    values, vectors = np.linalg.eigh(np.linalg.inv(block))
    flap = np.abs(vectors[:, 0, :]).argmax(1)  # the principal axis nearer to y, which flap bends about
    n = np.arange(len(values))
    tip = blade.tip_mass[0, 0]
    return replace(
        blade,
        name=f"{blade.name}, in ElastoDyn's terms",
        stiffness=section_stiffness(np.inf, np.inf, values[n, flap], values[n, 1 - flap]),
        mass=section_mass(blade.mass[:, 0, 0]),
        twist=np.zeros(len(blade.stations)),
        curve=np.zeros((0, 3)),
        pitch=0.0,
        tip_mass=np.diag([tip, tip, tip, 0.0, 0.0, 0.0]),
    )


def polynomials(blade: Blade, omega: float, elements: int | None = None) -> tuple[Polynomial, ...]:
    """Flapwise 1, flapwise 2 and edgewise 1 of the principal blade at rotor speed ``omega``, rad/s; see ``core.solve.modes``.

    Raises:
        CaseError: if one of them is not among the lowest modes.
    """
    plain = principal(blade)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # uncertainties are in the answer
        solved = modes(plain, omega, elements, 8)
    return tuple(_of(solved, plain, name) for name in ELASTODYN_NAMES)


def as_it_is(blade: Blade, solved: Modes) -> tuple[Polynomial, ...]:
    """The same fits for the full blade: the out-of-plane or in-plane part of the modes with these names, if present."""
    names = numbered(families(participation(solved, blade)))
    return tuple(_of(solved, blade, name) for name in ELASTODYN_NAMES if name in names)


def _of(solved: Modes, blade: Blade, name: str) -> Polynomial:
    names = numbered(families(participation(solved, blade)))
    if name not in names:
        raise CaseError(f"{blade.name}: no {name} among the lowest modes, {', '.join(names)}: ElastoDyn needs it")
    k = names.index(name)
    uncertainty = float(solved.uncertainty[k]) if len(solved.uncertainty) else np.inf
    return replace(
        fit(name, float(solved.frequencies[k]), component(solved, k, name.split()[0])), uncertainty=uncertainty
    )


def component(solved: Modes, k: int, family: str) -> Array:
    """Displacement (21,) of mode ``k`` out of the plane of rotation (flap) or in it (edge), at the phase of its tip."""
    part = solved.shapes[k, :, 2 if family == "flapwise" else 1]
    return np.real(part * np.exp(-1j * np.angle(part[-1])))
