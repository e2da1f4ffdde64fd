"""Checks of the equations themselves: columns, generator, units, symmetry, damping."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..findings import DEFECT, LIMIT, NOTE, Finding, count, listed
from ..modes import Mode, Spectrum
from ..sets import AzimuthSet
from ..states import STRUCTURAL

Array = NDArray[np.float64]

MAY_BE_FREE = ("generator", "platform surge", "platform sway", "platform yaw", "yaw")
"""Motions that may cost no force."""

MAX_GENERATOR_STIFFNESS = 0.1
"""Square of the angular frequency, rad²/s², that aerodynamics or a control may give the generator's azimuth."""

MIN_DRIFT = 0.01
"""Growth rate of the free rotation, relative to the rotor speed, that is noted."""

MASS_RATIOS = (1e-4, 1e2)
"""Limits of the mass of a blade's motion relative to the tower's."""

MAX_ASYMMETRY = 0.02
"""Imaginary part, relative to its size, of an eigenvalue of M⁻¹K with symmetric matrices: rounding only."""


def columns(azimuth_set: AzimuthSet) -> Iterator[Finding]:
    """Displacements that move nothing, and motions whose accelerations are zero."""
    ineffective, stuck, idle = [], [], 0
    for q, v in azimuth_set.pairs:
        state = azimuth_set.states[q]
        if state.module not in STRUCTURAL:
            continue
        if not azimuth_set.A[:, v].any():
            stuck.append(state.label)
        elif not azimuth_set.A[:, :, q].any() and state.family not in MAY_BE_FREE:
            ineffective.append(state.label)
    for i, state in enumerate(azimuth_set.states):
        others = np.delete(azimuth_set.A[:, :, i], i, axis=1)
        idle += state.module not in STRUCTURAL and not state.rate and not others.any()
    if ineffective:
        yield Finding(
            "zero column",
            DEFECT,
            f"{count(len(ineffective), 'displacement')} of structures without effect on any equation ({listed(ineffective)})",
            "their columns of A are zero although a spring must hold them: report it to the authors of the program",
            float(len(ineffective)),
        )
    if "generator" in stuck:
        yield Finding(
            "generator locked",
            DEFECT,
            "the generator is listed as a degree of freedom, but its acceleration row is zero",
            "linearise with GenDOF as the turbine operates: a locked generator raises the drivetrain's and edgewise modes",
            0.0,
        )
    if others_stuck := [label for label in stuck if label != "generator"]:
        yield Finding(
            "zero row",
            DEFECT,
            f"{count(len(others_stuck), 'motion')} without acceleration ({listed(others_stuck)})",
            "their rows of A are zero: report it to the authors of the program",
            float(len(others_stuck)),
        )
    if idle:
        yield Finding(
            "idle states",
            NOTE,
            f"{count(idle, 'state')} of first order without effect on any other state",
            "harmless; they add eigenvalues that move nothing",
            float(idle),
        )


def generator(azimuth_set: AzimuthSet, spectrum: Spectrum) -> Iterator[Finding]:
    """A free generator has no stiffness: turning the rotor costs nothing."""
    for q, v in azimuth_set.pairs:
        if azimuth_set.states[q].family != "generator" or not azimuth_set.A[:, v].any():
            continue
        stiffness = -float(spectrum.matrices.mean(axis=0)[v, q])
        if stiffness > MAX_GENERATOR_STIFFNESS:
            yield Finding(
                "generator locked",
                DEFECT,
                f"the generator is listed as free, but a spring of ({np.sqrt(stiffness) / (2 * np.pi):.3g} Hz)² holds it",
                "linearise with a free generator, or without its degree of freedom",
                stiffness,
            )
        drift = float(spectrum.real.real.max(initial=0.0))
        if drift > MIN_DRIFT * abs(azimuth_set.omega) and stiffness <= MAX_GENERATOR_STIFFNESS:
            yield Finding(
                "generator not at zero",
                NOTE,
                f"the rotor's free rotation grows with {drift:.2g} rad/s in place of 0",
                "forces that depend on the azimuth, or rounding, act on the free rotor; slow modes are less certain",
                drift,
            )


def units(azimuth_set: AzimuthSet, spectrum: Spectrum) -> Iterator[Finding]:
    """Masses of tower and blades, from the ratio of the two couplings between them.

    With A = −M⁻¹K and a nearly diagonal K, the ratio of masses is (A_tt / A_bb) (A_tb / A_bt); a unit of the tower's
    states that is larger by a factor s multiplies it by 1/s².
    """
    mean = spectrum.matrices.mean(axis=0)
    index = {(s.family, s.rate): i for i, s in enumerate(azimuth_set.states) if s.blade is None and s.module == "ED"}
    groups = {azimuth_set.states[g.members[0]].family: g for g in azimuth_set.groups if not g.rate and g.derivative}
    for tower, blade, components in (
        ("tower fore-aft 1", "flapwise 1", (0,)),
        ("tower side-side 1", "edgewise 1", (1, 2)),
    ):
        if (tower, False) not in index or (tower, True) not in index or blade not in groups or azimuth_set.blades != 3:
            continue
        group = groups[blade]
        t, vt = index[tower, False], index[tower, True]
        ratios = []
        for k in components:
            b, vb = group.members[k], (group.derivative or ())[k]
            with np.errstate(divide="ignore", invalid="ignore"):
                ratios.append(abs(mean[vt, t] / mean[vb, b] * mean[vt, b] / mean[vb, t]))
        finite = [r for r in ratios if np.isfinite(r) and r > 0]
        ratio = float(np.median(finite)) if finite else 0.01
        if not MASS_RATIOS[0] < ratio < MASS_RATIOS[1]:
            factor = 10.0 ** round(np.log10(ratio / 0.02) / 2)
            yield Finding(
                "units of the tower",
                DEFECT,
                f"the couplings of {tower} and {blade} imply a ratio of masses of {ratio:.1g}: the tower's states are "
                f"{'larger' if factor > 1 else 'smaller'} by {max(factor, 1 / factor):g}",
                f"their unit is not {azimuth_set.states[t].unit}{' but mm' if factor == 1000 else ''}: divide rows and "
                "multiply columns by the factor",
                float(factor),
            )
            return


def symmetry(azimuth_set: AzimuthSet) -> Iterator[Finding]:
    """Eigenvalues of M⁻¹K of each blade alone, which are real and positive without aerodynamics and damping.

    If they are not, a block that is stored some states further on makes them so again.
    """
    if any(name.startswith("AeroDyn") for file in azimuth_set.files for name in file.modules):
        return
    rate_of = dict(azimuth_set.pairs)
    for blade in range(1, azimuth_set.blades + 1):
        q = [
            i
            for i, s in enumerate(azimuth_set.states)
            if s.blade == blade and not s.rate and i in rate_of and s.module in STRUCTURAL
        ]
        if len(q) < 2:
            continue
        v = [rate_of[i] for i in q]
        block = -azimuth_set.A[0][np.ix_(v, q)]
        worst = _asymmetry(block)
        if worst < MAX_ASYMMETRY:
            continue
        shifts = (6, 3, 1) if azimuth_set.states[q[0]].module == "BD" else (1,)
        better = [
            (s * sign, axis)
            for s in shifts
            for sign in (1, -1)
            for axis in (0, 1)
            if _asymmetry(np.roll(block, s * sign, axis)) < min(MAX_ASYMMETRY, worst / 10)
        ]
        if better:
            shift, _ = better[0]
            yield Finding(
                "index shift",
                DEFECT,
                f"the stiffness block of blade {blade} is stored {abs(shift)} states off its place",
                "a block of A is stored at the wrong index: report it to the authors of the program",
                float(abs(shift)),
            )
        else:
            yield Finding(
                "asymmetric stiffness",
                DEFECT,
                f"blade {blade} alone has no symmetric mass and stiffness: eigenvalues of M⁻¹K are complex or negative "
                f"({100 * worst:.2g} %)",
                "rows or columns are mixed up, or the units of some states differ",
                worst,
            )
        return


def _asymmetry(block: Array) -> float:
    """Largest imaginary part of the eigenvalues relative to their size; 1 if an eigenvalue is negative."""
    values = np.linalg.eigvals(block)
    size = np.abs(values)
    if (values.real < -1e-3 * size.max()).any():
        return 1.0
    return float((np.abs(values.imag) / np.maximum(size, 1e-6 * size.max())).max())


def damping(azimuth_set: AzimuthSet, modes: tuple[Mode, ...]) -> Iterator[Finding]:
    """Structural modes that grow, beyond the uncertainty of the printed digits."""
    grow = [m for m in modes if m.eigenvalue.real > m.uncertainty and m.structural > 0.5 and m.damping < -1e-4]
    if not grow:
        return
    aerodynamic = any(name.startswith("AeroDyn") for file in azimuth_set.files for name in file.modules)
    worst = min(grow, key=lambda m: m.damping)
    yield Finding(
        "negative damping",
        LIMIT if aerodynamic else DEFECT,
        f"{count(len(grow), 'mode')} with negative damping (worst: {worst.name}, {100 * worst.damping:.2g} %)",
        "an instability of the turbine, or of the linearisation: check another operating point"
        if aerodynamic
        else "without aerodynamics no structural mode gains energy: see the other findings, else report it",
        worst.damping,
    )


def digits(azimuth_set: AzimuthSet, modes: tuple[Mode, ...]) -> Iterator[Finding]:
    """Frequencies that the printed digits do not determine."""
    uncertain = [m for m in modes if m.structural > 0.5 and m.relative_uncertainty > 0.01]
    if uncertain:
        worst = max(uncertain, key=lambda m: m.relative_uncertainty)
        uncertainty = (
            "undetermined" if worst.relative_uncertainty >= 1 else f"± {100 * worst.relative_uncertainty:.2g} %"
        )
        yield Finding(
            "truncated digits",
            DEFECT,
            f"{min(f.digits for f in azimuth_set.files)} printed digits leave {len(uncertain)} of {len(modes)} frequencies "
            f"uncertain by more than 1 % (worst: {worst.name}, {worst.frequency:.4g} Hz, {uncertainty})",
            'set OutFmt of the main input file to "ES18.9E3" or finer and linearise again',
            worst.relative_uncertainty,
        )
