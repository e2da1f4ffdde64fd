"""Modes of an azimuth set: frequencies with the uncertainty of the printed digits, damping, whirl and names."""

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eig

from .multiblade import BLADES, fixed_frame, states_of_components
from .sets import AzimuthSet
from .states import STRUCTURAL

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

COVERAGE = 3.29
"""Standard deviations that cover 99.9 % of normally distributed errors."""

MIN_OSCILLATION = 1e-6
"""Imaginary part relative to the largest eigenvalue, and in rad/s, below which an eigenvalue does not oscillate."""

DOMINANT = 0.5
"""Participation above which a motion alone names a mode."""


@dataclass(frozen=True)
class Mode:
    """A mode in the fixed frame.

    Attributes:
        name: dominant motion, as ``tower fore-aft 1`` or ``flapwise 1 backward``.
        confidence: participation of that motion, 0 to 1.
        participation: participation of the largest motions.
        eigenvalue: rad/s.
        uncertainty: of the eigenvalue due to printed digits, rad/s (99.9 %); infinite if the digits do not determine it.
        structural: share of structural states in the participation.
        shape: eigenvector in the fixed frame, by state.
        adjoint: left eigenvector; adjointᵀ shape = 1.
    """

    name: str
    confidence: float
    participation: tuple[tuple[str, float], ...]
    eigenvalue: complex
    uncertainty: float
    structural: float
    shape: Complex
    adjoint: Complex

    @property
    def frequency(self) -> float:
        """Undamped frequency |λ| / 2π, Hz."""
        return abs(self.eigenvalue) / (2 * np.pi)

    @property
    def damping(self) -> float:
        """Damping ratio."""
        return -self.eigenvalue.real / abs(self.eigenvalue)

    @property
    def relative_uncertainty(self) -> float:
        """Uncertainty of the frequency relative to it."""
        return self.uncertainty / abs(self.eigenvalue)


@dataclass(frozen=True)
class Spectrum:
    """Eigenvalues of the mean state matrix in the fixed frame.

    Attributes:
        matrices: state matrices in the fixed frame (azimuth, row, column).
        modes: oscillating modes, by frequency.
        real: eigenvalues that do not oscillate, rad/s.
    """

    matrices: Array
    modes: tuple[Mode, ...]
    real: Complex

    @property
    def vectors(self) -> tuple[Complex, Complex, Complex]:
        """Eigenvalues, left eigenvectors by row and right ones by column of all modes."""
        return (
            np.array([mode.eigenvalue for mode in self.modes]),
            np.array([mode.adjoint for mode in self.modes]),
            np.array([mode.shape for mode in self.modes]).T,
        )


def spectrum(azimuth_set: AzimuthSet, A: Array) -> Spectrum:
    """The modes of state matrices ``A``, which may differ from those of the files by a correction."""
    matrices = fixed_frame(azimuth_set, A)
    values, left, right = cast("tuple[Complex, Complex, Complex]", eig(matrices.mean(axis=0), left=True, right=True))
    norms = np.einsum("ij,ij->j", left.conj(), right)
    size = float(np.abs(values).max(initial=0.0))
    oscillates = values.imag > max(MIN_OSCILLATION, 1e-12 * size)
    indices = [k for k in sorted(np.flatnonzero(oscillates), key=lambda k: abs(values[k])) if abs(norms[k]) > 1e-300]
    shapes, adjoints = right[:, indices], (left[:, indices].conj() / norms[indices]).T
    uncertainties = _rounding(azimuth_set, header_sensitivity(azimuth_set, A), adjoints, shapes)
    modes = [
        _named(azimuth_set, complex(values[k]), float(u), shape, adjoint)
        for k, u, shape, adjoint in zip(indices, uncertainties, shapes.T, adjoints, strict=True)
    ]
    return Spectrum(matrices, _numbered(_distinct(modes)), values[~oscillates & (values.imag >= 0)])


def header_sensitivity(azimuth_set: AzimuthSet, A: Array) -> tuple[Array, Array]:
    """Change of the matrices in the fixed frame by half a unit in the last digit of azimuths and of rotor speeds."""
    units = np.array([file.unit for file in azimuth_set.files])
    base = fixed_frame(azimuth_set, A)
    faster = np.array([file.rotor_speed for file in azimuth_set.files]) + units
    return fixed_frame(azimuth_set, A, azimuth_set.azimuths + units) - base, fixed_frame(
        azimuth_set, A, speeds=faster
    ) - base


def _rounding(azimuth_set: AzimuthSet, header: tuple[Array, Array], adjoints: Complex, shapes: Complex) -> Array:
    """Uncertainties of eigenvalues by the rounding of all printed numbers, whose errors are independent and uniform.

    δλ = Σ l_i δA_ij r_j has the standard deviation √(Σ h² |Σ l_i r_j|² / 3) with half a unit in the last digit h. Entries of
    equal size have one error, with their signs: those of equal blades, and of one blade at azimuths that others pass, too.
    """
    files = len(azimuth_set.files)
    inexact = azimuth_set.half_unit > 0
    _, first, group = np.unique(np.abs(azimuth_set.A[inexact]), return_index=True, return_inverse=True)
    half_unit = azimuth_set.half_unit[inexact][first]
    ends = np.cumsum(np.count_nonzero(inexact, axis=(1, 2)))[:-1]
    signs, groups = np.split(np.sign(azimuth_set.A[inexact]), ends), np.split(group, ends)
    transforms = [
        states_of_components(azimuth_set, float(psi), file.rotor_speed)
        for psi, file in zip(azimuth_set.azimuths, azimuth_set.files, strict=True)
    ]
    out = np.empty(len(adjoints))
    for m, (adjoint, shape) in enumerate(zip(adjoints, shapes.T, strict=True)):
        sums = np.zeros(len(half_unit), complex)
        for (P, inverse), where, sign, index in zip(transforms, inexact, signs, groups, strict=True):
            change = np.asarray(np.outer(adjoint @ inverse, P @ shape)[where] * sign, dtype=np.complex128)
            sums += np.bincount(index, change.real, len(half_unit)) + 1j * np.bincount(
                index, change.imag, len(half_unit)
            )
        variance = float(np.sum((half_unit * np.abs(sums)) ** 2))
        by_azimuth, by_speed = (np.einsum("j,kj->k", shape, adjoint @ sensitivity) for sensitivity in header)
        variance += float(np.sum(np.abs(by_azimuth) ** 2) + np.abs(np.sum(by_speed)) ** 2)
        out[m] = COVERAGE * np.sqrt(variance / 3) / files
    return out


def _named(azimuth_set: AzimuthSet, value: complex, uncertainty: float, shape: Complex, adjoint: Complex) -> Mode:
    factor = np.abs(adjoint * shape)
    factor = factor / factor.sum()
    share: dict[str, float] = defaultdict(float)
    whirling: dict[str, tuple[float, float]] = {}
    component = components(azimuth_set)
    for i, state in enumerate(azimuth_set.states):
        if i in component:
            family, part = state.family, component[i]
            share[f"{family} {'collective' if part == 0 else 'whirl'}"] += float(factor[i])
        else:
            # an oscillation of the generator is torsion of the drivetrain; alone it turns freely
            family = "drivetrain" if state.family == "generator" else state.family
            share[family + (f" of blade {state.blade}" if state.blade else "")] += float(factor[i])
    for group in azimuth_set.groups if azimuth_set.blades == BLADES else ():
        if not group.rate:
            _, c, s = (shape[k] for k in group.members)
            weight = sum(float(factor[k]) for k in group.members[1:])
            family = azimuth_set.states[group.members[0]].family
            before = whirling.get(family, (0.0, 0.0))
            size = max(abs(c) ** 2 + abs(s) ** 2, 1e-300)
            whirling[family] = (
                before[0] + weight * abs(c + 1j * s) ** 2 / size,
                before[1] + weight * abs(c - 1j * s) ** 2 / size,
            )
    ordered = sorted(share.items(), key=lambda item: -item[1])
    name, confidence = ordered[0]
    if name.endswith(" whirl"):
        family = name.removesuffix(" whirl")
        forward, backward = whirling.get(family, (0.0, 0.0))
        name = f"{family} {'forward' if forward > backward else 'backward'}"
    structural = float(sum(factor[i] for i, state in enumerate(azimuth_set.states) if state.module in STRUCTURAL))
    return Mode(name, confidence, tuple(ordered[:4]), value, uncertainty, structural, shape, adjoint)


def components(azimuth_set: AzimuthSet) -> dict[int, int]:
    """Index of a state in the fixed frame → 0 collective, 1 cosine, 2 sine; only states of three blades are in it."""
    if azimuth_set.blades != BLADES:
        return {}
    return {index: k for group in azimuth_set.groups for k, index in enumerate(group.members)}


def _distinct(modes: Sequence[Mode]) -> list[Mode]:
    """Modes whose neighbour in the complex plane is nearer than their uncertainty get an infinite one."""
    values = np.array([mode.eigenvalue for mode in modes])
    out = []
    for k, mode in enumerate(modes):
        gaps = np.abs(np.delete(values, k) - values[k])
        mixed = mode.uncertainty > abs(mode.eigenvalue) or (len(gaps) and mode.uncertainty > gaps.min() * 10)
        out.append(replace(mode, uncertainty=float("inf")) if mixed else mode)
    return out


def _numbered(modes: Sequence[Mode]) -> tuple[Mode, ...]:
    """Number the families that the file does not number, as BeamDyn's, and modes of equal names, by frequency."""
    count: Counter[str] = Counter()
    total = Counter(mode.name for mode in modes)
    out = []
    for mode in modes:
        count[mode.name] += 1
        family, _, last = mode.name.rpartition(" ")
        whirl = last in ("collective", "forward", "backward")
        name = mode.name
        if whirl and not family[-1].isdigit():
            name = f"{family} {count[mode.name]} {last}"
        elif total[mode.name] > 1:
            name = f"{mode.name} ({count[mode.name]})"
        out.append(replace(mode, name=name))
    return tuple(out)
