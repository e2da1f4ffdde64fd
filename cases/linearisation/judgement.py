"""The judgement of linearisations: corrected modes, findings and the verdict."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..input.errors import CaseError
from . import floquet, hawcstab2, mode_tables, tracking
from .checks import azimuths, blades, disagreement, structure, tables
from .checks.frames import in_rotating_frame
from .findings import DEFECT, Finding
from .judged import AVERAGED, FLOQUET, JudgedSet, Judgement, by_level, located
from .lin_file import read
from .mode_tables import ModeTable
from .modes import Mode, Spectrum, spectrum
from .sets import AzimuthSet, collect

Array = NDArray[np.float64]

STRUCTURAL_DEFECTS = (
    "index shift",
    "kinematic rows",
    "states reordered",
    "missing state",
    "zero column",
    "asymmetric stiffness",
)
"""Defects after which comparisons between blades and azimuths would only repeat them."""

TABLES = (".csv", ".cmb", ".amp")
"""Suffixes of tables of modes."""

MAX_PERIODIC = 1e-4
"""Largest relative difference of Floquet's frequencies from those of the mean matrix at which the mean is kept."""


def judge(paths: Sequence[Path]) -> Judgement:
    """Judge linearisations of OpenFAST, and tables of modes.

    Args:
        paths: ``.lin`` files, of which those with the same stem are the azimuths of one operating point; tables of modes
            (``.csv``, HAWCStab2's ``.cmb``; an ``.amp`` file with the same stem names its modes).

    Raises:
        CaseError: if a file cannot be used.
    """
    listed = tuple(_tables(paths))
    linearisations = [path for path in paths if path.suffix.lower() not in TABLES]
    sets = tuple(judge_set(judged_set) for judged_set in collect([read(path) for path in linearisations]))
    tracked = tracking.track(sets)
    findings = [finding for judged_set in sets for finding in judged_set.findings]
    for table in listed:
        findings += located(mode_tables.findings(table), table.name)
    findings += located((*tracking.drift(sets), *tracking.lines(sets, tracked)), "all operating points")
    return Judgement(sets, tracked, listed, by_level(findings))


def _tables(paths: Sequence[Path]) -> Iterator[ModeTable]:
    """Tables of modes; those of HAWCStab2 with the amplitudes of the same stem."""
    amplitudes = {path.with_suffix(""): path for path in paths if path.suffix.lower() == ".amp"}
    for path in paths:
        if path.suffix.lower() == ".csv":
            yield mode_tables.read_csv(path)
        elif path.suffix.lower() == ".cmb":
            yield hawcstab2.read(path, amplitudes.pop(path.with_suffix(""), None))
    for path in amplitudes.values():
        raise CaseError(
            f"{path}: amplitudes without frequencies: give {path.with_suffix('.cmb').name} of the same analysis with it"
        )


def judge_set(azimuth_set: AzimuthSet) -> JudgedSet:
    """Judge the azimuths of one operating point."""
    findings = [
        *tables.headers(azimuth_set),
        *tables.order(azimuth_set),
        *tables.flags(azimuth_set),
        *tables.completeness(azimuth_set),
        *tables.kinematics(azimuth_set),
        *azimuths.coverage(azimuth_set),
        *azimuths.steadiness(azimuth_set),
        *structure.columns(azimuth_set),
        *structure.symmetry(azimuth_set),
    ]
    broken = any(finding.level == DEFECT and finding.name in STRUCTURAL_DEFECTS for finding in findings)
    A, frame = (azimuth_set.A, ()) if broken else in_rotating_frame(azimuth_set)
    findings += frame
    averaged = spectrum(azimuth_set, A)
    if not broken:
        findings += blades.equality(blades.differences(azimuth_set), azimuth_set)
        findings += [*structure.generator(azimuth_set, averaged), *structure.units(azimuth_set, averaged)]
    if not any(finding.level == DEFECT and finding.name != "truncated digits" for finding in findings):
        findings += disagreement.agreement(azimuth_set, A, averaged)
    findings += structure.digits(azimuth_set, averaged.modes)
    modes, method = (averaged.modes, AVERAGED) if broken else _periodic(azimuth_set, averaged)
    if not any(finding.level == DEFECT for finding in findings):
        findings += structure.damping(azimuth_set, modes)
    return JudgedSet(azimuth_set, modes, method, located(_once(by_level(findings)), azimuth_set.name))


def _once(findings: Sequence[Finding]) -> Iterator[Finding]:
    names: set[str] = set()
    for finding in findings:
        if finding.name not in names:
            yield finding
        names.add(finding.name)


def _periodic(azimuth_set: AzimuthSet, averaged: Spectrum) -> tuple[tuple[Mode, ...], str]:
    """Floquet's exponents in place of the eigenvalues of the mean matrix, where the azimuths determine them."""
    if azimuth_set.blades != 3 or not averaged.modes or abs(azimuth_set.omega) < azimuths.STANDSTILL:
        return averaged.modes, AVERAGED
    fit = floquet.interpolate(azimuth_set.azimuths, averaged.matrices)
    if not fit.harmonics:
        return averaged.modes, AVERAGED
    eigenvalues, adjoints, shapes = averaged.vectors
    structural = np.array([mode.structural > 0.5 for mode in averaged.modes])
    parts = averaged.matrices - averaged.matrices.mean(axis=0)
    estimate = floquet.second_order(parts, azimuth_set.omega, (-3, 3), eigenvalues, adjoints, shapes) / np.abs(
        eigenvalues
    )
    if not structural.any() or estimate[structural].max() < MAX_PERIODIC / 2:
        return averaged.modes, AVERAGED
    values = floquet.exponents(fit, azimuth_set.omega, eigenvalues)
    change = np.abs(values - eigenvalues) / np.abs(eigenvalues)
    if change[structural].max() < MAX_PERIODIC:
        return averaged.modes, AVERAGED
    fewer = floquet.exponents(
        floquet.interpolate(azimuth_set.azimuths, averaged.matrices, fit.harmonics - 1), azimuth_set.omega, eigenvalues
    )
    modes = tuple(
        replace(
            mode, eigenvalue=complex(value), uncertainty=float(np.hypot(mode.uncertainty, abs(value - coarse_value)))
        )
        for mode, value, coarse_value in zip(averaged.modes, values, fewer, strict=True)
    )
    return modes, FLOQUET
