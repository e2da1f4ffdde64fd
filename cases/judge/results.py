"""The results of a run: one row per cell, all of it written to ``results.jsonl``.

That file has one JSON object a line, told apart by ``kind``. The first line is the plan: every case and code of the run. The
last one is the completion record: how many lines of each kind precede it. A file without either, or without the cells that
its plan asks for, is *unfinished*, and no command takes it for a result. Between them are the settings of the cases, cells,
refinements' answers, negative controls, error budgets, origins, and one line about the run itself.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

import msgspec

from ...core.regular_files import LARGEST_DATA, read_bytes
from ..input import atomic
from . import checks

Verdict = Literal[
    "pass", "fail", "inconclusive", "known difference", "estimate", "measured", "not applicable", "not run"
]
Unit = Literal["rad_s", "rpm", "gamma"]


@dataclass(frozen=True)
class Cell:
    """One code's answer for one mode at one speed, against the reference.

    A cell without an answer (not run, not applicable) has ``mode`` 0 and no numbers. ``difference`` is
    ``frequency/reference − 1``; ``uncertainty`` is relative, of that difference: discretisation of both sides, and
    half a unit of the last digit for a printed table. Frequencies are in rad/s.

    Attributes:
        case: the case's name; of a case with several blades, the blade's after a slash.
        omega: rotor speed, rad/s.
        mode: 1, 2, 3 … within the reference's modes at this speed.
        family: chordwise, flapwise, torsion, axial, mixed; ``flapwise 1`` is family plus ordinal within it.
        code: the code's short name.
        version: of the code.
        role: ``code`` (refined until converged), ``discretisation`` (the paper's own discretisation, its own column),
            ``same discretisation`` (held to 1e-8), ``table`` (printed numbers), ``measured`` (no code: see ``measured``).
        frequency: the code's best answer (extrapolated where refinement allows), rad/s.
        reference: core's converged answer with the same physical effects, rad/s.
        difference: relative.
        uncertainty: relative.
        target: relative; |difference| + uncertainty must not exceed it.
        verdict: see ``cases.verdict``.
        reason: why, where the verdict is not a plain pass; names and quantifies the cause of a known difference.
        full: core's converged answer with all effects, rad/s (equals ``reference`` unless the code lacks some).
        shares: what the code shares with core: ``nothing``, ``mechanical model``, ``discretisation``, ``everything`` (core
            by its other method); empty for core itself.
        elements: the finest refinement used.
        order: observed order of convergence, where there is one.
        mac: mass-weighted MAC of the pairing.
        seconds: wall time of the finest solution.
        ordinal: of the mode within its family, where the run has no rows for the others at this speed.
    """

    case: str
    omega: float
    mode: int
    family: str
    code: str
    version: str
    role: str
    frequency: float | None
    reference: float | None
    difference: float | None
    uncertainty: float | None
    target: float
    verdict: Verdict
    reason: str = ""
    full: float | None = None
    elements: int | None = None
    order: float | None = None
    mac: float | None = None
    seconds: float | None = None
    shares: str = ""
    ordinal: int | None = None


@dataclass(frozen=True)
class Level:
    """One frequency at one refinement, for convergence figures: paired to ``mode`` of the reference."""

    case: str
    omega: float
    mode: int
    code: str
    elements: int
    frequency: float


@dataclass(frozen=True)
class Control:
    """What became of one seeded fault, run through the whole pipeline; see ``cases.faults``.

    Attributes:
        control: the fault's name.
        area: what is faulty: core, an adapter, pairing, …
        what: what such a program does.
        size: of its effect, in words.
        case: the trial's blade, as in ``Cell``; empty for faults in history and gate.
        omega: the trial's highest rotor speed, rad/s.
        caught: the cells (or lines of the gate) that are bad with the fault and not without it; none: nobody notices.
        change: the largest difference among those cells, relative.
        needs: codes that the trial needs and that are not installed; it was not run then.
    """

    control: str
    area: str
    what: str
    size: str
    case: str
    omega: float
    caught: tuple[str, ...]
    change: float | None = None
    needs: str = ""

    @property
    def missed(self) -> bool:
        """Whether it was run and nobody noticed."""
        return not self.caught and not self.needs


@dataclass(frozen=True)
class Share:
    """What one cause does to one of core's frequencies: a part of the differences that a reader sees.

    Attributes:
        case: as in ``Cell``.
        omega: rotor speed, rad/s.
        mode: by name: ``flapwise 2``.
        cause: discretisation, model form, or rounding.
        part: which: ``lumped mass, 50 elements``.
        change: relative; None where no mode is like it.
        bound: whether ``change`` is the most that it can be, of either sign.
    """

    case: str
    omega: float
    mode: str
    cause: str
    part: str
    change: float | None
    bound: bool = False


@dataclass(frozen=True)
class Origin:
    """Where the answers of one column for one blade come from; see ``references.interface.Independence``."""

    case: str
    code: str
    engine: str
    theory: str
    rotation: str
    sections: str
    eigensolver: str


@dataclass(frozen=True)
class Setting:
    """What a report says of a case's blade, so that old results can be shown without the case's file.

    Attributes:
        case: as in ``Cell``.
        title: one line.
        description: what the case shows, and what in it is assumed.
        source: where its data come from.
        unit: what its speeds are given in: ``rad_s``, ``rpm`` or ``gamma``.
        facts: name → value with unit, in words.
        groups: how many independent groups must agree with core; 0 where the run does not ask for any.
        lacking: why the case asks for none.
        target: the case's, relative; None where there is not one.
    """

    case: str
    title: str
    description: str
    source: str
    unit: Unit
    facts: dict[str, str] = field(default_factory=dict)
    groups: int = 0
    lacking: str = ""
    target: float | None = None


@dataclass(frozen=True)
class Planned:
    """A column of one case that a run was to have.

    Attributes:
        case: as in ``Cell``.
        code: likewise.
        speeds: number of speeds at which cells are due.
        modes: number of cells due at each of them; a code without an answer there has one cell, of mode 0, that says why.
            Zero where only some modes are known, as in a printed table.
    """

    case: str
    code: str
    speeds: int
    modes: int


@dataclass(frozen=True)
class Run:
    """Everything a report needs.

    Attributes:
        cells: all rows.
        levels: every refinement's answer.
        versions: package or code → version.
        command: what was typed, to reproduce.
        settings: of each case's blade.
        controls: results of the seeded faults.
        shares: where differences come from.
        origins: where the answers of each column come from.
        plan: every column that the run was to have.
        unfinished: what is missing, in a sentence; empty if the run is complete.
    """

    cells: tuple[Cell, ...]
    levels: tuple[Level, ...] = ()
    versions: dict[str, str] = field(default_factory=dict)
    command: str = ""
    settings: tuple[Setting, ...] = ()
    controls: tuple[Control, ...] = ()
    shares: tuple[Share, ...] = ()
    origins: tuple[Origin, ...] = ()
    plan: tuple[Planned, ...] = ()
    unfinished: str = ""


KINDS: dict[str, type] = {
    "setting": Setting,
    "cell": Cell,
    "level": Level,
    "control": Control,
    "share": Share,
    "origin": Origin,
}
"""What a line of each kind is, in the order of the file."""

ROWS: dict[str, str] = {kind: f"{kind}s" for kind in KINDS}
"""The field of ``Run`` that holds the lines of each kind."""


def write(path: Path, run: Run) -> None:
    """Write a complete run, in place of what is there.

    Raises:
        OSError: if it cannot be written; what was there before is unchanged.
        ValueError: if the run is unfinished.
    """
    if what := run.unfinished or gaps(run):
        raise ValueError(f"{path}: not written: {what}")
    atomic.write(path, (msgspec.json.encode(line) + b"\n" for line in _lines(run)))


def _lines(run: Run) -> Iterator[dict[str, Any]]:
    yield {"kind": "plan", "columns": run.plan}
    for kind, name in ROWS.items():
        yield from ({"kind": kind, **msgspec.to_builtins(row)} for row in getattr(run, name))
    yield {"kind": "run", "versions": run.versions, "command": run.command}
    yield {"kind": "end", "lines": {kind: len(getattr(run, name)) for kind, name in ROWS.items()}}


def gaps(run: Run) -> str:
    """What the plan asks for and the cells do not have, in a sentence; empty if nothing."""
    there: dict[tuple[str, str], dict[float, list[int]]] = {}
    for cell in run.cells:
        there.setdefault((cell.case, cell.code), {}).setdefault(cell.omega, []).append(cell.mode)
    missing = [p for p in run.plan if not _done(p, there.get((p.case, p.code), {}))]
    if not missing:
        return ""
    first = f"{missing[0].case} × {missing[0].code}"
    more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
    return f"cells of {first}{more} are missing, of {len(run.plan)} planned"


def _done(planned: Planned, modes: dict[float, list[int]]) -> bool:
    answered = (0 in found or len(found) >= planned.modes for found in modes.values())
    return len(modes) >= planned.speeds and all(answered)


def read(path: Path) -> Run:
    """The run in a results file, rows in the file's order. It is unfinished unless the file says that it is complete.

    Raises:
        OSError: if the file cannot be read.
        ValueError: naming file and line, if a whole line is not what this version writes.
    """
    rows: dict[str, list[Any]] = {kind: [] for kind in KINDS}
    about: dict[str, Any] = {}
    *lines, torn = read_bytes(path, LARGEST_DATA).split(b"\n")
    kinds = []
    for number, line in enumerate(lines, 1):
        try:
            data = msgspec.json.decode(line)
            kinds.append(kind := data.pop("kind"))
            if kind == "run":
                about |= {
                    "versions": msgspec.convert(data["versions"], dict[str, str]),
                    "command": msgspec.convert(data["command"], str),
                }
            elif kind == "plan":
                about["plan"] = msgspec.convert(data["columns"], tuple[Planned, ...])
            elif kind == "end":
                about["end"] = data["lines"]
            else:
                row = msgspec.convert(data, KINDS[kind])
                checks.check(row)
                rows[kind].append(row)
        except (ValueError, AttributeError, KeyError, TypeError, RecursionError) as error:
            raise ValueError(
                f"{path}: line {number}: not a result ({error}): was it written by another version?"
            ) from error
    end = about.pop("end", None)
    run = Run(**{ROWS[kind]: tuple(found) for kind, found in rows.items()}, **about)
    return replace(run, unfinished=_unfinished(kinds, torn, end) or gaps(run))


def _unfinished(kinds: list[str], torn: bytes, end: Any) -> str:
    """Why the lines of a file, by kind, are not a whole run; empty if they are."""
    count = Counter(kinds)
    if kinds[:1] != ["plan"] or count["plan"] > 1:
        return "the file does not begin with the plan of its run"
    if torn or kinds[-1] != "end" or count["end"] > 1:
        return "the file does not end with the completion record of its run"
    if end != {kind: count[kind] for kind in KINDS} or count["run"] != 1:
        return "the file has not the lines that its completion record counts"
    return ""
