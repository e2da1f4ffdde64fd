"""``southwell gate``: compares a run with an earlier one; status 1 if something got worse."""

import os
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import msgspec
from cyclopts import Parameter
from cyclopts.validators import Number

from ...cases.input import atomic
from ...cases.input.errors import CaseError, nearest
from ...cases.input.writing import writable
from ...cases.judge.results import Run
from ...cases.regression import history
from ...cases.regression.gate import MOVED, Comparison, compare, misses, nothing, within
from ...cases.regression.history import Entry
from ...core.regular_files import LARGEST_DATA, read_bytes
from ..ci import gate_text, junit
from ..shared.console import output
from ..shared.log_safe import commands
from ..shared.statuses import FAILED, INCOMPLETE, PASSED
from ..shared.summary import incomplete
from ..shared.units import BY_KEY, Units
from ..verification import report as matrix_report
from .arguments import RESULTS, finished, run_in
from .history import load


def command(
    folder: Path,
    /,
    *,
    against: Path | None = None,
    commit: str = "",
    strict: bool = False,
    partial: bool = False,
    failed_baseline: bool = False,
    tolerance: Annotated[float, Parameter(validator=Number(gte=0))] = MOVED,
    junit_file: Annotated[Path | None, Parameter(name="--junit")] = None,
    summary: Path | None = None,
    annotations: bool = False,
) -> int:
    """Compare a run with an earlier one; status 1 if anything got worse.

    Worse means a worse verdict, a missing answer, a wider target, a seeded fault that is no longer detected or tried, or a
    property of a blade that is wrong or no longer checked. Changed frequencies are listed. The status is 3 for an incomplete
    run.

    Parameters
    ----------
    folder
        Output folder of `southwell verify`, or its results.jsonl.
    against
        History (written by `southwell history add`), whose last run is used, or the output folder or results.jsonl of another
        run. Without this option, every failure counts.
    commit
        Compare with the last run of this commit in the history; its first characters suffice.
    strict
        End with status 1 also if a frequency changed.
    partial
        Compare only the cases and seeded faults that are in the run.
    failed_baseline
        Accept an earlier run with failures; these failures do not count.
    tolerance
        Relative change of a frequency above which it counts as changed.
    junit_file
        Output file for JUnit XML, one test case per cell.
    summary
        File to which a summary in Markdown is appended, such as GitHub's `$GITHUB_STEP_SUMMARY`.
    annotations
        Print GitHub workflow commands that mark the files of cases that got worse.
    """
    run = run_in(folder)
    after = history.entry(run, str(folder))
    if commit and not against:
        raise CaseError(f"--commit {commit}: no history is given: name its file with --against")
    before = earlier(against, commit) if against else nothing(after)
    if partial:
        before = within(before, after)
    if (count := misses(before)) and not failed_baseline:
        raise CaseError(
            f"--against {against}: the run {before.commit} has {count} failure{'s' * (count > 1)}: compare with a run that "
            "passed, or accept them with --failed-baseline"
        )
    units = {s.case: BY_KEY[s.unit] for s in run.settings}
    undetected = [c.control for c in run.controls if c.missed]
    gate = compare(before, after, tolerance, undetected)
    console = output()
    if message := incomplete(run):
        console.print(message, markup=False, soft_wrap=True)
    console.print(gate_text.verdict(gate, strict), markup=False, soft_wrap=True)
    for table in gate_text.tables(gate, units, console.width):
        console.print(table)
    if annotations:
        for line in gate_text.annotations(gate, Path(), units):
            print(line, file=commands())
    if junit_file:
        with writable(f"--junit {junit_file}", "file"):
            atomic.write(junit_file, junit.render(run, gate, strict))
    if summary:
        with writable(f"--summary {summary}", "file"), summary.open("a", encoding="utf-8") as file:
            file.write(_page(run, gate, strict, units))
    if run.unfinished:
        return INCOMPLETE
    return PASSED if gate.passed(strict) else FAILED


def earlier(path: Path, commit: str) -> Entry:
    """The run to compare with: of a folder or results file, or the last of a history, of the ``commit`` if given.

    Raises:
        CaseError: if there is none.
    """
    if os.path.isdir(path) or _is_run(path):
        if commit:
            raise CaseError(f"--commit {commit}: {path} is one run, not a history: leave it out, or give a history")
        return replace(history.entry(finished(path), str(path)), date="", machine="")
    entries = load(path).entries
    if not entries:
        raise CaseError(f"--against {path}: contains no runs: add one with `southwell history add`")
    matches = [e for e in entries if e.commit.startswith(commit)]
    if not matches:
        raise CaseError(
            f"--commit {commit}: not in {path}: {nearest(commit, dict.fromkeys(e.commit for e in entries))}"
        )
    return matches[-1]


def _is_run(path: Path) -> bool:
    """Whether a file has the results of a run, whose lines each state their kind."""
    try:
        first = msgspec.json.decode(read_bytes(path, LARGEST_DATA).partition(b"\n")[0])
    except (OSError, msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return path.name == RESULTS
    return isinstance(first, dict) and "kind" in first


def _page(run: Run, gate: Comparison, strict: bool, units: dict[str, Units]) -> str:
    """The page with the headline of the run and the findings of the gate."""
    parts = [
        "### Southwell",
        *matrix_report.marked(run, matrix_report.headline(run)),
        gate_text.markdown(gate, strict, units),
        matrix_report.heat(run),
    ]
    return "\n\n".join(parts) + "\n"
