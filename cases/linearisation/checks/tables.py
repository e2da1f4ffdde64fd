"""Checks of what a set's files state: headers, flags, tables of states, and completeness of the blades."""

from collections import Counter, defaultdict
from collections.abc import Iterator

import numpy as np

from ..findings import DEFECT, LIMIT, NOTE, Finding, count, listed
from ..sets import AzimuthSet
from ..states import RATE, STRUCTURAL

FEW_DIGITS = 4
"""Significant digits of OpenFAST's default format; fewer were cut off."""


def headers(azimuth_set: AzimuthSet) -> Iterator[Finding]:
    """Overflowed fields, and versions that differ within the set."""
    fields = Counter(field for file in azimuth_set.files for field in file.overflowed)
    if fields:
        yield Finding(
            "header overflow",
            DEFECT,
            f"{count(len(fields), 'field')} printed as asterisks ({listed(list(fields))})",
            "the program that wrote the file lacks columns for these numbers; the tables were counted instead",
            float(len(fields)),
        )
    versions = sorted({file.version for file in azimuth_set.files})
    if len(versions) > 1:
        yield Finding(
            "version drift",
            DEFECT,
            f"the azimuths were written by {len(versions)} versions ({listed(versions)})",
            "linearise all azimuths with one version",
            float(len(versions)),
        )
    digits = min(file.digits for file in azimuth_set.files)
    if digits < FEW_DIGITS:
        yield Finding(
            "truncated digits",
            DEFECT,
            f"entries of A have {digits} significant digits",
            'set OutFmt of the main input file to at least "ES18.9E3" and linearise again',
            float(digits),
        )


def order(azimuth_set: AzimuthSet) -> Iterator[Finding]:
    """Orders of the states that differ between files, and tables of states and derivatives that contradict each other."""
    if len(set(azimuth_set.order)) > 1:
        reordered = [
            file.path.name
            for file, k in zip(azimuth_set.files, azimuth_set.order, strict=True)
            if k != azimuth_set.order[0]
        ]
        yield Finding(
            "states reordered",
            NOTE,
            f"another order of the states in {len(reordered)} of {len(azimuth_set.files)} files ({listed(reordered)})",
            "sorted by their descriptions; programs that read by position mix them up",
            float(len(reordered)),
        )
    for file in azimuth_set.files:
        if not file.derivatives:
            continue
        contradictions = [
            k + 1
            for k, (state, slope) in enumerate(zip(file.states, file.derivatives, strict=False))
            if not _belongs(state.text, slope.text)
        ]
        if contradictions or len(file.derivatives) != len(file.states):
            yield Finding(
                "states reordered",
                DEFECT,
                f"{file.path.name}: {len(contradictions)} rows of the tables of states and of derivatives name different "
                f"states (first: row {contradictions[0] if contradictions else len(file.states)})",
                "the tables were edited or are of different models: linearise again",
                float(len(contradictions)),
            )
            break


def _belongs(state: str, slope: str) -> bool:
    """Whether the derivative's description is that of the state; its unit and module may be written differently."""
    return (
        slope.replace(RATE, "").split("(")[0].split(",")[0].rstrip("/s")
        == state.replace(RATE, "").split("(")[0].split(",")[0].rstrip("/s")
        and slope.count(RATE) == state.count(RATE) + 1
    )


def flags(azimuth_set: AzimuthSet) -> Iterator[Finding]:
    """Flags of the rotating frame that contradict the description."""
    misflagged = [
        s for s in azimuth_set.states if s.expected_rotating is not None and s.rotating != s.expected_rotating
    ]
    frozen_on_request = [s for s in misflagged if s.module == "BD" and not s.rotating]
    misflagged = [s for s in misflagged if s not in frozen_on_request]
    if frozen_on_request:
        yield Finding(
            "fixed blade states",
            NOTE,
            f"{len(frozen_on_request)} states of BeamDyn are flagged as fixed",
            "as with RotStates = False; they are transformed to the rotating frame",
            float(len(frozen_on_request)),
        )
    if misflagged:
        states = listed([f"{s.label} flagged {'T' if s.rotating else 'F'}" for s in misflagged])
        yield Finding(
            "frame flag",
            DEFECT,
            f"{count(len(misflagged), 'flag')} of the rotating frame against the description ({states})",
            "states of blades turn with the rotor, others do not: the frame was taken from the descriptions",
            float(len(misflagged)),
        )


def completeness(azimuth_set: AzimuthSet) -> Iterator[Finding]:
    """Displacements without rates, rates without displacements, and motions that some blades lack."""
    index = azimuth_set.index
    single = [
        state.label
        for state in azimuth_set.states
        if state.module in STRUCTURAL and (state.kind, state.blade, not state.rate) not in index
    ]
    if single:
        yield Finding(
            "missing state",
            DEFECT,
            f"{count(len(single), 'state')} of second order without displacement or rate ({listed(single)})",
            "the table was edited: linearise again",
            float(len(single)),
        )
    blades: dict[str, set[int]] = defaultdict(set)
    family: dict[str, str] = {}
    for state in azimuth_set.states:
        if state.blade and not state.rate and state.module in STRUCTURAL:
            blades[state.kind].add(state.blade)
            family[state.kind] = state.family
    all_motions = set().union(*blades.values()) if blades else set()
    absent_motions = [
        f"{family[kind]} of blade {blade}"
        for kind, have in blades.items()
        for blade in sorted(all_motions - have)
        if all_motions - have
    ]
    if absent_motions:
        yield Finding(
            "missing state",
            DEFECT,
            f"{count(len(absent_motions), 'motion')} missing that other blades have ({listed(absent_motions)})",
            "enable the degree of freedom on all blades",
            float(len(absent_motions)),
        )
    numbered = {state.family for state in azimuth_set.states if state.module == "ED"}
    skipped = [
        f"{name} 1"
        for name in ("flapwise", "edgewise", "tower fore-aft", "tower side-side")
        if f"{name} 2" in numbered and f"{name} 1" not in numbered
    ]
    if skipped:
        yield Finding(
            "missing state",
            DEFECT,
            f"a second mode is enabled without the first ({listed(skipped)})",
            "enable the first mode",
            float(len(skipped)),
        )
    if azimuth_set.blades and len(all_motions) == 1 and azimuth_set.omega > 1e-3:
        yield Finding(
            "single blade",
            LIMIT,
            "only one blade moves while the rotor turns",
            "enable the degrees of freedom of all blades, or stop the rotor",
            1.0,
        )


def _switched_off(azimuth_set: AzimuthSet, pair: tuple[int, int]) -> bool:
    """Whether a motion of no structure has no equation at all, as the idle directions of a structural control."""
    at = list(pair)
    return (
        azimuth_set.states[pair[0]].module not in STRUCTURAL
        and not azimuth_set.A[:, at].any()
        and not azimuth_set.A[:, :, at].any()
    )


def kinematics(azimuth_set: AzimuthSet) -> Iterator[Finding]:
    """Rows of displacements: unit vectors of their rates."""
    shifts: dict[int, int | None] = {}
    pairs = [pair for pair in azimuth_set.pairs if not _switched_off(azimuth_set, pair)]
    for A in azimuth_set.A:
        for q, v in pairs:
            unit = np.zeros(len(A))
            unit[v] = 1.0
            if np.abs(A[q] - unit).max() > 1e-3:
                unit_columns = np.flatnonzero(np.abs(A[q] - 1) < 1e-3)
                shifts[q] = (
                    int(unit_columns[0]) - v
                    if len(unit_columns) == 1 and np.count_nonzero(np.abs(A[q]) > 1e-3) == 1
                    else None
                )
    if not shifts:
        return
    shift, times = Counter(shifts.values()).most_common(1)[0]
    states = listed([azimuth_set.states[q].label for q in shifts])
    if shift and times > 1 and times > len(shifts) / 2:
        yield Finding(
            "index shift",
            DEFECT,
            f"the rows of {count(times, 'displacement')} ({states}) are the rates {shift:+d} states further on",
            "a block of A is stored at the wrong index: report it to the authors of the program",
            float(shift),
        )
    elif None not in shifts.values():
        yield Finding(
            "states reordered",
            DEFECT,
            f"the rows of {count(len(shifts), 'displacement')} ({states}) are the rates of other states",
            "the table of states does not belong to the matrix: linearise again",
            float(len(shifts)),
        )
    else:
        yield Finding(
            "kinematic rows",
            DEFECT,
            f"the rows of {count(len(shifts), 'displacement')} ({states}) are not those of their rates",
            "A is damaged, or the states are not displacements: linearise again",
            float(len(shifts)),
        )
