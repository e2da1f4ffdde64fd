"""The file of a complete run, ``results.jsonl``.

It has one JSON object per line; ``kind`` identifies its type. The first line is the plan: every case and code of
the run. The last line is the completion record: the number of lines of each kind before it. A file without either, or
without the cells that its plan requires, is *unfinished*, and no command accepts it as a result. Between them are the
settings of the cases, cells, answers of refinements, seeded faults, error budgets, origins, diagnoses, checks of
properties, and one line about the run itself.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec

from ...core.regular_files import LARGEST_DATA, read_bytes
from ..input import atomic
from ..judge import checks
from ..judge.results import (
    BudgetEntry,
    Cell,
    Control,
    Diagnosed,
    Level,
    Origin,
    Planned,
    PropertyCheck,
    Run,
    Setting,
)

RESULTS = "results.jsonl"
"""Name of the file in the output folder of a run."""

KINDS: dict[str, type] = {
    "setting": Setting,
    "cell": Cell,
    "level": Level,
    "control": Control,
    "budget": BudgetEntry,
    "origin": Origin,
    "diagnosis": Diagnosed,
    "property": PropertyCheck,
}
"""Kind of line → its type, in the order of the file."""

IRREGULAR = {"budget": "error_budget", "diagnosis": "diagnoses", "property": "property_checks"}

ROWS: dict[str, str] = {kind: f"{kind}s" for kind in KINDS} | IRREGULAR
"""Kind of line → the field of ``Run`` that holds such lines."""


def write(path: Path, run: Run) -> None:
    """Write a complete run, replacing any existing file.

    Raises:
        OSError: if the file cannot be written; an existing file is then unchanged.
        ValueError: if the run is unfinished.
    """
    if problem := run.unfinished or gaps(run):
        raise ValueError(f"{path}: not written: {problem}")
    atomic.write(path, (msgspec.json.encode(line) + b"\n" for line in _lines(run)))


def _lines(run: Run) -> Iterator[dict[str, Any]]:
    yield {"kind": "plan", "columns": run.plan}
    for kind, name in ROWS.items():
        yield from ({"kind": kind, **msgspec.to_builtins(row)} for row in getattr(run, name))
    yield {"kind": "run", "versions": run.versions, "command": run.command}
    yield {"kind": "end", "lines": {kind: len(getattr(run, name)) for kind, name in ROWS.items()}}


def gaps(run: Run) -> str:
    """One sentence on planned cells that are missing; empty if there are none."""
    modes_at: dict[tuple[str, str], dict[float, list[int]]] = {}
    for cell in run.cells:
        modes_at.setdefault((cell.case, cell.code), {}).setdefault(cell.omega, []).append(cell.mode)
    missing = [p for p in run.plan if not _done(p, modes_at.get((p.case, p.code), {}))]
    if not missing:
        return ""
    first = f"{missing[0].case} × {missing[0].code}"
    remainder = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
    return f"cells of {first}{remainder} are missing, of {len(run.plan)} planned"


def _done(planned: Planned, modes: dict[float, list[int]]) -> bool:
    answered = (0 in numbers or len(numbers) >= planned.cells for numbers in modes.values())
    return len(modes) >= planned.speeds and all(answered)


def read(path: Path) -> Run:
    """Read a run from a results file, rows in file order. Without a completion record the run is unfinished.

    Raises:
        OSError: if the file cannot be read.
        ValueError: if a complete line is not in the format of this version; the message names file and line.
    """
    rows: dict[str, list[Any]] = {kind: [] for kind in KINDS}
    header: dict[str, Any] = {}
    *lines, truncated = read_bytes(path, LARGEST_DATA).split(b"\n")
    kinds = []
    for number, line in enumerate(lines, 1):
        try:
            data = msgspec.json.decode(line)
            kinds.append(kind := data.pop("kind"))
            if kind == "run":
                header |= {
                    "versions": msgspec.convert(data["versions"], dict[str, str]),
                    "command": msgspec.convert(data["command"], str),
                }
            elif kind == "plan":
                header["plan"] = msgspec.convert(data["columns"], tuple[Planned, ...])
            elif kind == "end":
                header["end"] = data["lines"]
            else:
                row = msgspec.convert(data, KINDS[kind])
                checks.check(row)
                rows[kind].append(row)
        except (ValueError, AttributeError, KeyError, TypeError, RecursionError) as error:
            raise ValueError(
                f"{path}: line {number}: not a result ({error}): check that this version wrote it"
            ) from error
    end = header.pop("end", None)
    run = Run(**{ROWS[kind]: tuple(of_kind) for kind, of_kind in rows.items()}, **header)
    return replace(run, unfinished=_unfinished(kinds, truncated, end) or gaps(run))


def _unfinished(kinds: list[str], truncated: bytes, end: Any) -> str:
    """Why the lines of a file, by kind, are not a complete run; empty if they are."""
    count = Counter(kinds)
    if kinds[:1] != ["plan"] or count["plan"] > 1:
        return "the file does not begin with the plan of the run"
    if truncated or kinds[-1] != "end" or count["end"] > 1:
        return "the file does not end with the completion record of the run"
    if end != {kind: count[kind] for kind in KINDS} or count["run"] != 1:
        return "the number of lines differs from that in the completion record"
    return ""
