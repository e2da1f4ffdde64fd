"""A judgement of linearisations for the terminal and as plain data: verdict, findings, named modes."""

from collections.abc import Iterator, Sequence

import numpy as np
from rich.table import Table

from ...cases.linearisation.findings import DEFECT, LIMIT, NOTE, Finding, count
from ...cases.linearisation.judged import NO, OPEN, YES, JudgedSet, Judgement, TrackedMode
from ...cases.linearisation.machine.split import (
    AERODYNAMICS,
    DEFLECTION,
    GRAVITY,
    NODES,
    REST,
    SHAPES,
    Comparison,
    ModeComparison,
)
from ...cases.linearisation.mode_tables import ModeTable
from ...cases.linearisation.modes import Mode
from ..shared.table_columns import tables

MARKS = {DEFECT: "✘", LIMIT: "○", NOTE: "–"}

MEANING = {
    YES: "no defect was found",
    NO: "these linearisations have a defect",
    OPEN: "no defect was found, but the files do not show everything",
}

MOST = 20
"""Largest number of modes listed without ``--all``."""


def verdict(judgement: Judgement) -> str:
    """The first line: the verdict, what was read, and the number of findings."""
    files = sum(len(judged_set.azimuth_set.files) for judged_set in judgement.sets)
    parts = [count(files, "linearisation"), count(len(judgement.sets), "operating point")] if files else []
    parts += [count(len(judgement.tables), "table of modes", "tables of modes")] if judgement.tables else []
    defects = sum(finding.level == DEFECT for finding in judgement.findings)
    tally = f"; {count(defects, 'defect')}" if defects else ""
    return f"{judgement.verdict}: {MEANING[judgement.verdict]} ({', '.join(parts)}{tally})"


def findings(judgement: Judgement) -> Iterator[str]:
    """One line for each finding, with its set if there are several."""
    several = len(judgement.sets) + len(judgement.tables) > 1
    for finding in judgement.findings:
        where = f"{finding.where}: " if several else ""
        yield f"{MARKS[finding.level]} {where}{finding}"


def modes(judgement: Judgement, width: int, all_modes: bool = False) -> Iterator[Table]:
    """Tables of the named modes: of one operating point in full, of several as a Campbell diagram."""
    if len(judgement.sets) == 1:
        yield from _one(judgement.sets[0], width, all_modes)
    elif judgement.sets:
        yield from _several(judgement, width, all_modes)
    for table in judgement.tables:
        yield from _listed(table, width, all_modes)


def _one(judged_set: JudgedSet, width: int, all_modes: bool) -> Iterator[Table]:
    selection = _shown(judged_set.modes, all_modes)
    rows = [
        (
            mode.name,
            f"{mode.frequency:.5g}",
            _uncertainty(mode),
            f"{100 * mode.damping:.3g}",
            f"{100 * mode.confidence:.0f}",
        )
        for mode in selection
    ]
    method = f", {judged_set.method}" if len(judged_set.azimuth_set.files) > 1 else ""
    title = f"{judged_set.azimuth_set.name}: {_rpm(judged_set)}{method}"
    head = ("mode", "Hz", "± %", "damping %", "participation %")
    yield from tables(head, rows, width, title)


def _several(judgement: Judgement, width: int, all_modes: bool) -> Iterator[Table]:
    head = ["mode", *(f"{judged_set.azimuth_set.omega * 30 / np.pi:.4g} rpm" for judged_set in judgement.sets)]
    rows = [track for track in judgement.tracked if all_modes or _structural(track)]
    rows = rows if all_modes else rows[:MOST]
    yield from tables(
        head,
        [(t.name, *("" if m is None else f"{m.frequency:.5g}" for m in t.at)) for t in rows],
        width,
        "Frequency in Hz",
    )
    yield from tables(
        head,
        [(t.name, *("" if m is None else f"{100 * m.damping:.3g}" for m in t.at)) for t in rows],
        width,
        "Damping in %",
    )


def _listed(table: ModeTable, width: int, all_modes: bool) -> Iterator[Table]:
    """Frequencies, and damping where it is given, of a table of modes; the share of the motion that names a mode."""
    factor, unit = (60.0, "rpm") if table.unit == "Hz" else (1.0, table.unit)
    head = ["mode", *(f"{factor * point:.4g} {unit}" for point in table.points)]
    shares = [(f"{100 * share:.0f}",) for share in table.shares] or [()] * len(table.names)
    rows = [
        (name, *share, *("" if np.isnan(f) else f"{f:.5g}" for f in values))
        for name, share, values in zip(table.names, shares, table.frequencies, strict=True)
    ]
    limit = len(rows) if all_modes else MOST
    share_column = ["participation %"] if table.shares else []
    yield from tables([head[0], *share_column, *head[1:]], rows[:limit], width, f"{table.name}: frequency in Hz")
    damped = [
        (name, *("" if np.isnan(value) else f"{100 * value:.3g}" for value in values))
        for name, values in zip(table.names, table.damping, strict=True)
        if not np.isnan(values).all()
    ]
    if damped:
        yield from tables(head, damped[:limit], width, f"{table.name}: damping in %")


PARTS = (SHAPES, NODES, GRAVITY, DEFLECTION, AERODYNAMICS, REST)

MIN_ORIGIN = 1e-3
"""Relative difference beyond the structure from which on its origin is listed."""


def decks(judgement: Judgement, compared: Sequence[Comparison], width: int) -> Iterator[Table | str]:
    """Tables of the modes of each operating point beside those of Southwell's turbine, with the parts of the differences."""
    for judged_set, comparison in zip(judgement.sets, compared, strict=False):
        parts = [name for name in PARTS if any(name in pair.parts for pair in comparison.modes)]
        head = ("mode", "Hz", "± %", "Southwell Hz", "MAC", "difference %", *(f"{name} %" for name in parts))
        rows = [_beside(pair, parts) for pair in comparison.modes]
        yield from tables(
            head, rows, width, f"{judged_set.azimuth_set.name}: {_rpm(judged_set)}, beside Southwell's turbine in vacuo"
        )
        origins = [
            (pair.mode.name, pair.origin)
            for pair in comparison.modes
            if pair.origin and _beyond(pair) > max(MIN_ORIGIN, pair.mode.relative_uncertainty)
        ]
        if origins:
            yield from tables(("mode", "largest term beyond the structure"), origins, width, "")
        if comparison.remark:
            yield f"{judged_set.azimuth_set.name}: {comparison.remark}"


def _beside(pair: ModeComparison, parts: Sequence[str]) -> tuple[str, ...]:
    return (
        pair.mode.name,
        f"{pair.mode.frequency:.5g}",
        _uncertainty(pair.mode),
        f"{pair.frequency:.5g}",
        f"{pair.mac:.2f}",
        *(_percent(value) for value in (pair.difference, *(pair.parts.get(name, 0.0) for name in parts))),
    )


def _percent(value: float) -> str:
    """A relative difference in percent, without the sign of a zero."""
    return f"{round(100 * value, 2):+.2f}".replace("-0.00", "0.00").replace("+0.00", "0.00")


def _beyond(pair: ModeComparison) -> float:
    """Size of what is no part of the structure, relative."""
    return max(abs(pair.parts.get(name, 0.0)) for name in (AERODYNAMICS, REST))


def _structural(track: TrackedMode) -> bool:
    return any(mode is not None and mode.structural > 0.5 for mode in track.at)


def _shown(modes: tuple[Mode, ...], all_modes: bool) -> list[Mode]:
    return list(modes) if all_modes else [mode for mode in modes if mode.structural > 0.5][:MOST]


def _uncertainty(mode: Mode) -> str:
    percent = 100 * mode.relative_uncertainty
    return "?" if not np.isfinite(percent) or percent >= 100 else f"{percent:.2g}"


def _rpm(judged_set: JudgedSet) -> str:
    wind = judged_set.azimuth_set.files[0].wind_speed
    at = f" at {wind:g} m/s" if np.isfinite(wind) and wind > 0 else ""
    return f"{judged_set.azimuth_set.omega * 30 / np.pi:.4g} rpm{at}, {count(len(judged_set.azimuth_set.files), 'azimuth')}"


def plain(judgement: Judgement, compared: Sequence[Comparison] = ()) -> dict[str, object]:
    """The judgement as data for JSON; ``compared``: the modes of each operating point beside those of Southwell's turbine."""
    return {
        "verdict": judgement.verdict,
        "findings": [_plain_finding(finding) for finding in judgement.findings],
        "operating_points": [
            {
                "name": judged_set.azimuth_set.name,
                "files": [str(file.path) for file in judged_set.azimuth_set.files],
                "omega_rad_s": judged_set.azimuth_set.omega,
                "wind_speed_m_s": _finite(judged_set.azimuth_set.files[0].wind_speed),
                "method": judged_set.method,
                "modes": [_plain_mode(mode) for mode in judged_set.modes],
                **(_plain_comparison(compared[k]) if k < len(compared) else {}),
            }
            for k, judged_set in enumerate(judgement.sets)
        ],
        "tables": [_plain_table(table) for table in judgement.tables],
    }


def _plain_table(table: ModeTable) -> dict[str, object]:
    return {
        "name": table.name,
        "operating_points": table.points.tolist(),
        "unit": table.unit,
        "modes": [
            {
                "name": name,
                "frequency_hz": [_finite(value) for value in frequencies.tolist()],
                "damping_ratio": [_finite(value) for value in damping.tolist()],
                "participation": table.shares[k] if table.shares else None,
            }
            for k, (name, frequencies, damping) in enumerate(
                zip(table.names, table.frequencies, table.damping, strict=True)
            )
        ],
    }


def _plain_comparison(comparison: Comparison) -> dict[str, object]:
    return {
        "machine": [
            {
                "mode": pair.mode.name,
                "southwell_frequency_hz": pair.frequency,
                "mac": pair.mac,
                "difference": pair.difference,
                "parts": pair.parts,
                "origin": pair.origin,
            }
            for pair in comparison.modes
        ],
        "remark": comparison.remark,
        "causes": [
            {"cause": cause.name, "factor": cause.factor, "explained": cause.explained, "named": cause.named}
            for cause in comparison.causes
        ],
    }


def _plain_finding(finding: Finding) -> dict[str, object]:
    return {
        "name": finding.name,
        "level": finding.level,
        "where": finding.where,
        "what": finding.observation,
        "remedy": finding.remedy,
        "value": _finite(finding.value),
    }


def _plain_mode(mode: Mode) -> dict[str, object]:
    return {
        "name": mode.name,
        "frequency_hz": mode.frequency,
        "damping_ratio": mode.damping,
        "relative_uncertainty": _finite(mode.relative_uncertainty),
        "participation": dict(mode.participation),
        "structural": mode.structural,
    }


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None
