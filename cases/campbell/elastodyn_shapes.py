"""Mode shapes as ElastoDyn wants them: ``φ(x) = Σ c_k x^k``, k = 2 … 6, ``φ(1) = 1``, for flap 1, flap 2 and edge 1.

ElastoDyn bends a blade in its sections' own flap and edge directions and turns the curvatures by the structural twist itself,
and knows no torsion, shear, stretch, offsets or sectional inertia. Its shapes are therefore those of the blade without these,
and without pitch, at the hub radius, precone and rotor speed of interest (J. Jonkman's advice to users of ElastoDyn): of that
blade flap and edge do not couple, and each shape is one function. Shapes of the twisted blade itself are another thing; where
they are fitted too, it is to show by how much the two differ.

x is the fraction of the flexible blade from root to tip. A shape has no sign beyond ``φ(1) = 1``: positive flap is ElastoDyn's,
downwind, and positive edge is ElastoDyn's, as the tip's displacement.
"""

import warnings
from dataclasses import dataclass, replace

import numpy as np

from ...core.blade import BEND_Y, BEND_Z, Blade, section_mass, section_stiffness
from ...core.chain.refinement import AccuracyWarning
from ...core.element.sections import compliance
from ...core.modes import STATIONS, Modes
from ...core.participation import families, numbered, participation
from ...core.solve import modes
from ..input.errors import CaseError
from ..judge.pairing import Array

POWERS = (2, 3, 4, 5, 6)

WANTED = {"flap 1": "BldFl1Sh", "flap 2": "BldFl2Sh", "edge 1": "BldEdgSh"}
"""Modes, and ElastoDyn's names of their coefficients."""

DIGITS = 6
"""Decimals to which coefficients are given; they add up to 1 as given."""


@dataclass(frozen=True)
class Polynomial:
    """One shape.

    Attributes:
        mode: ``flap 1``.
        frequency: rad/s, of the blade it is the shape of.
        coefficients: (5,) of x² … x⁶, as given: rounded, and adding up to 1.
        shape: (21,) what was fitted, at the common stations, 1 at the tip.
        largest: largest deviation of the polynomial from the shape, of the tip's displacement.
        rms: root mean square of the same.
        condition: of the least-squares problem (2-norm): how many times an error of the shape can be larger in a coefficient.
        uncertainty: relative, of the frequency; infinite where it is not known.
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


def fit(mode: str, frequency: float, shape: Array, x: Array = STATIONS) -> Polynomial:
    """Least squares over ``x``, ``φ(1) = 1`` held exactly: ``φ − x⁶ = Σ c_k (x^k − x⁶)``, k = 2 … 5.

    Raises:
        CaseError: if the tip does not move.
    """
    if abs(shape[-1]) < 1e-6 * np.abs(shape).max(initial=0.0) or not shape[-1]:
        raise CaseError(f"{mode}: its tip does not move: a polynomial that is 1 at the tip cannot describe it")
    wanted = shape / shape[-1]
    basis = np.stack([x**k - x**6 for k in POWERS[:-1]], axis=1)
    some, *_ = np.linalg.lstsq(basis, wanted - x**6, rcond=None)
    some = np.round(some, DIGITS)
    coefficients = np.append(some, round(1.0 - some.sum(), DIGITS))
    deviation = np.power.outer(x, POWERS) @ coefficients - wanted
    return Polynomial(
        mode=mode,
        frequency=frequency,
        coefficients=coefficients,
        shape=wanted,
        largest=float(np.abs(deviation).max()),
        rms=float(np.sqrt(np.mean(deviation**2))),
        condition=float(np.linalg.cond(basis)),
    )


def principal(blade: Blade) -> Blade:
    """The blade as ElastoDyn knows it: straight, its sections' principal bending stiffnesses untwisted, mass without inertia.

    The bending stiffness is what a pure moment meets, whatever the reference axis: the inverse of the bending block of the
    compliance. Of its two principal values, edge is the one whose axis is nearer to the section's z.
    """
    block = compliance(blade, blade.stations)[:, BEND_Y : BEND_Z + 1, BEND_Y : BEND_Z + 1]
    values, vectors = np.linalg.eigh(np.linalg.inv(block))
    flap = np.abs(vectors[:, 0, :]).argmax(1)  # the principal axis nearer to y, which flap bends about
    n = np.arange(len(values))
    tip = blade.tip_mass[0, 0]
    return replace(
        blade,
        name=f"{blade.name}, as ElastoDyn knows it",
        stiffness=section_stiffness(np.inf, np.inf, values[n, flap], values[n, 1 - flap]),
        mass=section_mass(blade.mass[:, 0, 0]),
        twist=np.zeros(len(blade.stations)),
        curve=np.zeros((0, 3)),
        pitch=0.0,
        tip_mass=np.diag([tip, tip, tip, 0.0, 0.0, 0.0]),
    )


def polynomials(blade: Blade, omega: float, elements: int | None = None) -> tuple[Polynomial, ...]:
    """Flap 1, flap 2 and edge 1 of the principal blade at rotor speed ``omega``, rad/s; see ``core.solve.modes``.

    Raises:
        CaseError: if one of them is not among the lowest modes.
    """
    plain = principal(blade)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # uncertainties are in the answer
        solved = modes(plain, omega, elements, 8)
    return tuple(_of(solved, plain, name) for name in WANTED)


def as_it_is(blade: Blade, solved: Modes) -> tuple[Polynomial, ...]:
    """The same of the blade itself: the out-of-plane or in-plane part of the modes so named, as many as there are."""
    named = numbered(families(participation(solved, blade)))
    return tuple(_of(solved, blade, name) for name in WANTED if name in named)


def _of(solved: Modes, blade: Blade, name: str) -> Polynomial:
    named = numbered(families(participation(solved, blade)))
    if name not in named:
        raise CaseError(f"{blade.name}: no {name} among the lowest modes, {', '.join(named)}: ElastoDyn needs it")
    k = named.index(name)
    sure = float(solved.uncertainty[k]) if len(solved.uncertainty) else np.inf
    return replace(fit(name, float(solved.frequencies[k]), component(solved, k, name.split()[0])), uncertainty=sure)


def component(solved: Modes, k: int, family: str) -> Array:
    """Displacement (21,) of mode ``k`` out of the plane of rotation (flap) or in it (edge), at the phase of its tip."""
    part = solved.shapes[k, :, 2 if family == "flap" else 1]
    return np.real(part * np.exp(-1j * np.angle(part[-1])))
