"""Checks of the azimuths of a set: coverage of the revolution, and steadiness of the operating point."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..findings import DEFECT, LIMIT, Finding
from ..floquet import phases
from ..sets import AzimuthSet

Array = NDArray[np.float64]

STANDSTILL = 1e-3
"""Rotor speed in rad/s below which the rotor stands."""

MAX_GAP = 1.5
"""Largest gap between azimuths relative to even spacing."""

SAME_AZIMUTH = np.radians(0.5)
"""Azimuths that differ by less are the same."""

MAX_SPEED_SPREAD = 2e-3
"""Largest spread of the rotor speed of a steady operating point, relative."""

MAX_ACCELERATION = 0.02
"""Largest change of speed within a revolution at a steady operating point, relative."""

MAX_APERIODIC = 0.05
"""Largest deviation of the blades' deflections from a periodic motion, relative to their size."""


EXCHANGE = (
    "blades 1, 2, 3 must follow each other in the direction of increasing azimuth: exchange the numbers of two blades"
)
"""Remedy for blades that are exchanged."""


def coverage(azimuth_set: AzimuthSet) -> Iterator[Finding]:
    """Gaps, repeated azimuths, and azimuths that show too few phases of blade passing."""
    if abs(azimuth_set.omega) < STANDSTILL:
        return
    n = len(azimuth_set.files)
    psi = np.sort(np.mod(azimuth_set.azimuths, 2 * np.pi))
    if n == 1:
        yield Finding(
            "one azimuth",
            LIMIT,
            "one azimuth does not show whether the equations depend on the azimuth",
            "linearise at 12 or more azimuths of a revolution (NLinTimes)",
            1.0,
        )
        return
    gaps = np.diff(np.append(psi, psi[0] + 2 * np.pi))
    if gaps.min() < SAME_AZIMUTH:
        yield Finding(
            "repeated azimuths",
            DEFECT,
            f"two files have the azimuth {np.degrees(psi[gaps.argmin()]):.2f}°",
            "give each azimuth once",
            float(np.degrees(gaps.min())),
        )
    elif gaps.max() > MAX_GAP * 2 * np.pi / n:
        yield Finding(
            "missing azimuths",
            DEFECT,
            f"{n} azimuths leave a gap of {np.degrees(gaps.max()):.0f}° (even spacing: {360 / n:.0f}°)",
            "linearise at azimuths that cover the revolution evenly, or give the missing files",
            float(np.degrees(gaps.max())),
        )
    elif (phase_count := phases(azimuth_set.azimuths)) < 3:
        yield Finding(
            "few azimuths",
            LIMIT,
            f"{n} azimuths show {phase_count} phase{'s' if phase_count > 1 else ''} of blade passing",
            "variation with three times the rotor speed is invisible: linearise at 12 or more azimuths",
            float(phase_count),
        )


def steadiness(azimuth_set: AzimuthSet) -> Iterator[Finding]:
    """Rotor speed, acceleration of the generator, azimuths of the header, and periodic deflections of the blades."""
    if abs(azimuth_set.omega) < STANDSTILL:
        return
    speeds = np.array([file.rotor_speed for file in azimuth_set.files])
    reasons: list[tuple[str, float]] = []
    spread = float(np.ptp(speeds) / abs(azimuth_set.omega))
    if spread > MAX_SPEED_SPREAD:
        reasons.append((f"the rotor speed varies by {100 * spread:.2g} % between the azimuths", spread))
    for i, state in enumerate(azimuth_set.states):
        if state.family == "generator" and state.rate and np.isfinite(azimuth_set.accelerations[:, i]).all():
            change = float(np.abs(azimuth_set.accelerations[:, i]).max() * 2 * np.pi / azimuth_set.omega**2)
            if change > MAX_ACCELERATION:
                reasons.append((f"the generator changes its speed by {100 * change:.2g} % in a revolution", change))
    aperiodic = _aperiodic(azimuth_set, (0, 1, 2))
    exchanged = _aperiodic(azimuth_set, (0, 2, 1)) if aperiodic > MAX_APERIODIC else 0.0
    if aperiodic > MAX_APERIODIC and exchanged < aperiodic / 5:
        yield Finding(
            "blades exchanged",
            DEFECT,
            f"deflections of the blades deviate by {100 * aperiodic:.2g} % from a periodic motion, with blades 2 and 3 "
            f"exchanged by {100 * exchanged:.2g} %",
            EXCHANGE,
            aperiodic,
        )
    elif aperiodic > MAX_APERIODIC:
        reasons.append(
            (f"deflections of the blades deviate by {100 * aperiodic:.2g} % from a periodic motion", aperiodic)
        )
    for text, value in reasons[:1]:
        yield Finding(
            "unsteady operating point",
            DEFECT,
            text,
            "linearise after the transients have decayed (CalcSteady, or a later LinTimes)",
            value,
        )
    for i, state in enumerate(azimuth_set.states):
        if state.family == "generator" and not state.rate and len(azimuth_set.files) > 1:
            offset = np.exp(1j * (azimuth_set.values[:, i] - azimuth_set.azimuths))
            error = float(np.abs(np.angle(offset / offset[0])).max())
            if error > np.radians(2.0):
                yield Finding(
                    "azimuth contradicts generator",
                    DEFECT,
                    f"azimuths of header and generator differ by {np.degrees(error):.1f}°",
                    "the header is not of this linearisation: linearise again",
                    error,
                )


def _periodic_fit(psi: Array, values: Array) -> tuple[Array, int]:
    """Residuals of a fit by harmonics of the azimuth, and the number of harmonics that the azimuths determine."""
    for harmonics in (2, 1, 0):
        h = np.arange(1, harmonics + 1)
        basis = np.column_stack([np.ones(len(psi)), np.cos(np.outer(psi, h)), np.sin(np.outer(psi, h))])
        if len(psi) >= basis.shape[1] + 2 and np.linalg.cond(basis) < 30:
            break
    return values - basis @ np.linalg.lstsq(basis, values, rcond=None)[0], harmonics


def _aperiodic(azimuth_set: AzimuthSet, order: tuple[int, ...]) -> float:
    """Deviation of the deflections of blades in this order from one function of their azimuth, relative to their size."""
    if azimuth_set.blades != 3 or len(azimuth_set.files) < 2:
        return 0.0
    psi = azimuth_set.blade_azimuths
    worst = 0.0
    for group in azimuth_set.groups:
        if group.rate or azimuth_set.states[group.members[0]].module != "ED":
            continue
        values = azimuth_set.values[:, [group.members[k] for k in order]].ravel()
        residual, harmonics = _periodic_fit(psi, values)
        size = float(np.abs(values).max())
        if np.isfinite(values).all() and harmonics and size > 1e-6:
            worst = max(worst, float(np.abs(residual).max()) / size)
    return worst
