"""``southwell history``: records the results of runs by commit, for the gate and the dashboard."""

import subprocess
import sys
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from ...cases.input.errors import CaseError
from ...cases.input.writing import writable
from ...cases.regression import history
from ...cases.regression.history import History
from ..shared import console
from ..shared.table_columns import tables
from .arguments import finished

app = App(name="history", help="Record the results of runs by commit.", result_action="return_value")


@app.command
def add(
    folder: Path,
    /,
    *,
    file: Annotated[Path, Parameter(name="--history")],
    commit: str = "",
    machine: str = "",
) -> int:
    """Append a run to a history.

    A run is one line of JSON with every frequency, difference and verdict. Several jobs may append at the same time;
    a truncated line does not affect the others.

    Parameters
    ----------
    folder
        Output folder of `southwell verify`, or its results.jsonl.
    file
        History file; created if it does not exist.
    commit
        Commit or release of the run. Default: the commit of the Git checkout in the current folder, with `-dirty` if it has
        changes.
    machine
        Name of the machine. Default: system and processors.
    """
    entry = history.entry(finished(folder), commit or _checked_out(), machine)
    with writable(f"--history {file}", "file"):
        history.append(file, entry)
    print(f"{file}: {entry.commit}: {len(entry.cells)} cells, {len(entry.controls)} seeded faults")
    return 0


@app.command(name="list")
def listing(file: Path, /) -> int:
    """List the runs in a history.

    Parameters
    ----------
    file
        History file (`southwell history add`).
    """
    rows = []
    for entry in load(file).entries:
        verdicts = [p.verdict for p in entry.cells]
        counts = [str(verdicts.count(v)) for v in ("pass", "fail", "inconclusive")]
        rows.append((entry.commit, entry.date, str(len(verdicts)), *counts, entry.machine))
    out = console.output()
    head = ("commit", "date", "cells", "pass", "fail", "inconclusive", "machine")
    out.print(*tables(head, rows, out.width), sep="\n")
    return 0


def load(file: Path) -> History:
    """Read the history in a file; truncated lines are reported on standard error.

    Raises:
        CaseError: if there is no such file, or it is not a history.
    """
    try:
        recorded = history.read(file)
    except OSError as error:
        raise CaseError(
            f"{file}: cannot be read ({error.strerror}): give a file written by `southwell history add`"
        ) from error
    except ValueError as error:
        raise CaseError(str(error)) from error
    for number in recorded.truncated:
        print(f"southwell: {file}: line {number}: truncated, ignored", file=sys.stderr)
    return recorded


def _checked_out() -> str:
    """The commit of the checkout in the current folder."""
    command = ["git", "describe", "--always", "--abbrev=40", "--exclude=*", "--dirty"]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError) as error:
        raise CaseError(
            "--commit: missing, and the current folder is not a Git checkout: name the commit that was run"
        ) from error
