"""What a run leaves behind: a row a cell, tidy, and nothing that cannot be written to ``results.jsonl``.

That file has one JSON object a line. Most are cells, by their fields; ``kind`` tells them from refinements' answers, from
the settings of the cases, which come first, the negative controls, and the line about the run itself.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import msgspec

Verdict = Literal["pass", "fail", "inconclusive", "known difference", "estimate", "not applicable", "not run"]
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
            ``same discretisation`` (held to 1e-8), ``table`` (printed numbers).
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
class Run:
    """Everything a report needs.

    Attributes:
        cells: all rows.
        levels: every refinement's answer.
        versions: package or code → version.
        command: what was typed, to reproduce.
        settings: of each case's blade.
        controls: what became of core made wrong on purpose.
        shares: where differences come from.
        origins: where the answers of each column come from.
    """

    cells: tuple[Cell, ...]
    levels: tuple[Level, ...] = ()
    versions: dict[str, str] = field(default_factory=dict)
    command: str = ""
    settings: tuple[Setting, ...] = ()
    controls: tuple[Control, ...] = ()
    shares: tuple[Share, ...] = ()
    origins: tuple[Origin, ...] = ()


def append(path: Path, cells: Iterable[Cell] = (), levels: Iterable[Level] = (), run: Run | None = None) -> None:
    """Add lines to a results file: cells and levels as they come; of ``run``, its settings, controls, shares,
    versions and command."""
    lines: list[dict[str, Any]] = [{"kind": "cell", **msgspec.to_builtins(c)} for c in cells]
    lines += [{"kind": "level", **msgspec.to_builtins(v)} for v in levels]
    if run:
        lines += [{"kind": "setting", **msgspec.to_builtins(s)} for s in run.settings]
        lines += [{"kind": "control", **msgspec.to_builtins(c)} for c in run.controls]
        lines += [{"kind": "share", **msgspec.to_builtins(s)} for s in run.shares]
        lines += [{"kind": "origin", **msgspec.to_builtins(o)} for o in run.origins]
        lines.append({"kind": "run", "versions": run.versions, "command": run.command})
    with path.open("ab") as file:
        file.writelines(msgspec.json.encode(line) + b"\n" for line in lines)


def read(path: Path) -> Run:
    """The run in a results file, rows in the file's order; a torn last line is left out.

    Raises:
        ValueError: naming file and line, if a whole line is not what this version writes.
    """
    rows: dict[type, list[Any]] = {kind: [] for kind in KINDS.values()}
    about: dict[str, Any] = {}
    for number, line in enumerate(path.read_bytes().split(b"\n")[:-1], 1):
        try:
            data = msgspec.json.decode(line)
            kind = data.pop("kind")
            if kind == "run":
                about = {"versions": data["versions"], "command": data["command"]}
            else:
                rows[KINDS[kind]].append(msgspec.convert(data, KINDS[kind]))
        except (msgspec.DecodeError, AttributeError, KeyError, TypeError) as error:
            raise ValueError(
                f"{path}: line {number}: not a result ({error}): was it written by another version?"
            ) from error
    return Run(
        tuple(rows[Cell]),
        tuple(rows[Level]),
        settings=tuple(rows[Setting]),
        controls=tuple(rows[Control]),
        shares=tuple(rows[Share]),
        origins=tuple(rows[Origin]),
        **about,
    )


KINDS: dict[str, type] = {
    "cell": Cell,
    "level": Level,
    "setting": Setting,
    "control": Control,
    "share": Share,
    "origin": Origin,
}
"""What a line of each kind is."""
