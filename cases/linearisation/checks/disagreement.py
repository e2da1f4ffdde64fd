"""Checks that the azimuths agree in the fixed frame, and the reason if they do not."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..findings import DEFECT, LIMIT, Finding
from ..floquet import SAME_PHASE, interpolate, second_order
from ..modes import Spectrum
from ..multiblade import fixed_frame, states_of_components
from ..sets import AzimuthSet
from .azimuths import EXCHANGE

Array = NDArray[np.float64]

MAX_EFFECT = 2e-3
"""Largest change of an eigenvalue, relative to it, by the part of an azimuth's matrix that no harmonic explains."""

LARGE_EFFECT = 1e-2
"""Change above which the azimuths are of different machines or states."""

MIN_DRIFT = 5e-3
"""Smallest change of an equation by another inertia, relative."""

ROUNDING_FACTOR = 2.0
"""Multiple of the uncertainty by the digits of one file below which a change is not significant."""

EXPLAINS = 4.0
"""Factor by which the disagreement falls if its cause is undone."""


def unexplained(azimuths: Array, matrices: Array) -> Array:
    """Parts of the matrices that harmonics of blade passing do not explain (azimuth, row, column)."""
    fit = interpolate(azimuths, matrices)
    return matrices - np.array([fit.at(float(psi)) for psi in azimuths])


def effects(azimuth_set: AzimuthSet, spectrum: Spectrum, parts: Array) -> Array:
    """Relative changes of the eigenvalues by each azimuth's part (mode, azimuth), to first and second order.

    Changes that the rounding of one file may cause are 0.
    """
    values, adjoints, shapes = spectrum.vectors
    second = second_order(parts, azimuth_set.omega, (-2, -1, 1, 2), values, adjoints, shapes) / np.abs(values)
    weight = np.linalg.norm(parts, axis=(1, 2))
    share = weight / max(float(weight.max()), 1e-300)
    out = []
    for mode, estimate in zip(spectrum.modes, second, strict=True):
        if mode.structural > 0.5 and np.isfinite(mode.uncertainty):
            change = np.maximum(np.abs(parts @ mode.shape @ mode.adjoint) / abs(mode.eigenvalue), estimate * share)
            rounding = mode.relative_uncertainty * np.sqrt(len(parts))
            out.append(np.where(change > ROUNDING_FACTOR * rounding, change, 0.0))
    return np.array(out).reshape(-1, len(parts))


def agreement(azimuth_set: AzimuthSet, A: Array, spectrum: Spectrum) -> Iterator[Finding]:
    """Azimuths that disagree in the fixed frame: blades exchanged, one inertia changed, or the block that differs most."""
    if len(azimuth_set.files) < 2 or not spectrum.modes:
        return
    parts = unexplained(azimuth_set.azimuths, spectrum.matrices)
    parts[np.abs(parts) < ROUNDING_FACTOR * _noise(azimuth_set)] = 0.0
    effect = effects(azimuth_set, spectrum, parts)
    if not effect.size or effect.max() < MAX_EFFECT:
        return
    size = float(np.linalg.norm(unexplained(azimuth_set.azimuths, spectrum.matrices)))
    exchanged = float(np.linalg.norm(_exchanged(azimuth_set, A))) if azimuth_set.blades == 3 else np.inf
    if size > EXPLAINS * exchanged:
        yield Finding(
            "blades exchanged",
            DEFECT,
            f"azimuths differ in the fixed frame, with blades 2 and 3 exchanged {size / max(exchanged, 1e-300):.0f} times less",
            EXCHANGE,
            size / max(exchanged, 1e-300),
        )
        return
    drift = _inertia(azimuth_set, spectrum.matrices)
    if drift:
        label, ratio, names = drift
        yield Finding(
            "version drift",
            DEFECT,
            f"in {len(names)} of {len(azimuth_set.files)} files (first: {names[0]}) the equation of {label} is {ratio:.3f} "
            "times that of the others, and the other equations follow: its inertia differs",
            "linearise all azimuths with one model and one version",
            ratio,
        )
        return
    k = int(effect.max(axis=0).argmax())
    row, column = np.unravel_index(int(np.abs(parts[k]).argmax()), parts[k].shape)
    yield Finding(
        "azimuths disagree",
        DEFECT if effect.max() > LARGE_EFFECT else LIMIT,
        f"{azimuth_set.files[k].path.name} changes an eigenvalue by {100 * effect.max():.2g} %, most in the equation of "
        f"{azimuth_set.states[row].label} by {azimuth_set.states[column].label}",
        "linearise this azimuth again, at a steady operating point",
        float(effect.max()),
    )


def _exchanged(azimuth_set: AzimuthSet, A: Array) -> Array:
    """What harmonics do not explain if blades 2 and 3 are exchanged."""
    k = np.arange(len(azimuth_set.states))
    for group in azimuth_set.groups:
        _, second, third = group.members
        k[[second, third]] = third, second
    swapped = A[:, k][:, :, k]
    return unexplained(azimuth_set.azimuths, fixed_frame(azimuth_set, swapped))


def _inertia(azimuth_set: AzimuthSet, matrices: Array) -> tuple[str, float, list[str]] | None:
    """A degree of freedom whose inertia differs between azimuths: its label, the ratio of its equation, and the files.

    A change of one diagonal entry of M multiplies the acceleration row of its motion by a factor and adds multiples of that
    row to all others.
    """
    reference = _typical(azimuth_set.azimuths, matrices)
    difference = matrices - reference
    difference[np.abs(difference) < ROUNDING_FACTOR * _noise(azimuth_set)] = 0.0
    total = float(np.linalg.norm(difference))
    best: tuple[float, int, Array] | None = None
    for q, v in azimuth_set.pairs:
        row = reference[:, v]
        size = np.einsum("kj,kj->k", row, row)
        if azimuth_set.states[q].blade or not size.all():
            continue
        factor = np.einsum("kij,kj->ki", difference, row) / size[:, None]
        remaining = float(np.linalg.norm(difference - factor[:, :, None] * row[:, None, :]))
        ratio = 1 + factor[:, v]
        changed = np.abs(ratio - 1) > MIN_DRIFT
        if changed.any() and not changed.all() and remaining < total / 2 and (best is None or remaining < best[0]):
            best = remaining, q, ratio
    if best is None:
        return None
    _, q, ratio = best
    changed = np.abs(ratio - 1) > MIN_DRIFT
    worst = float(ratio[np.abs(ratio - 1).argmax()])
    return (
        azimuth_set.states[q].label,
        worst,
        [f.path.name for f, c in zip(azimuth_set.files, changed, strict=True) if c],
    )


def _typical(azimuths: Array, matrices: Array) -> Array:
    """For each azimuth the median of the matrices at its phase of blade passing, if there are three, else of all."""
    distances = np.abs(np.angle(np.exp(3j * (azimuths[:, None] - azimuths))))
    overall = np.median(matrices, axis=0)
    return np.array(
        [
            np.median(matrices[at_phase], axis=0)
            if np.count_nonzero(at_phase := distance < SAME_PHASE / 2) > 2
            else overall
            for distance in distances
        ]
    )


def _noise(azimuth_set: AzimuthSet) -> Array:
    """Largest errors of the matrices in the fixed frame by the printed digits (azimuth, row, column)."""
    out = np.empty_like(azimuth_set.half_unit)
    for k, file in enumerate(azimuth_set.files):
        P, inverse = states_of_components(azimuth_set, file.azimuth, file.rotor_speed)
        out[k] = np.abs(inverse) @ azimuth_set.half_unit[k] @ np.abs(P)
    return out
