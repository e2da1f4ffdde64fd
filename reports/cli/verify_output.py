"""What ``southwell verify`` shows: progress, the report and the summary of a run, and why it stopped."""

import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path

from ...cases.input import atomic
from ...cases.input.writing import writable
from ...cases.judge.results import Run
from ...cases.verify.matrix import Progress
from ...cases.verify.pipeline import INTERRUPTED as FROM_KEYBOARD
from ...cases.verify.pipeline import Observer
from ..ci import junit as xml
from ..shared import console, summary
from ..shared.statuses import INTERRUPTED
from .arguments import CONTINUE
from .report import show


class Progressing(Observer):
    """Notes and progress on standard error."""

    def note(self, line: str) -> None:
        """See ``Observer``."""
        print(f"southwell: {line}", file=sys.stderr)

    @contextmanager
    def watching(self) -> Iterator[Callable[[Progress], None]]:
        """See ``Observer``."""
        with console.Watch() as watch:
            yield watch.show


class Output(Progressing):
    """Notes and progress; the report in the folder ``out``, and JUnit XML in the file ``junit``."""

    def __init__(self, out: Path, junit: Path | None) -> None:
        self.out, self.junit = out, junit

    def finished(self, run: Run, pool: Executor | None) -> None:
        """See ``Observer``."""
        show(run, self.out, pool)
        if self.junit:
            with writable(f"--junit {self.junit}", "file"):
                atomic.write(self.junit, xml.render(run))


def status(run: Run) -> int:
    """The exit status of a run; why it was stopped goes to standard error."""
    if run.unfinished:
        progress = f"{len(run.cells)} cells are kept" if run.cells else "no cell was finished"
        print(f"southwell: {run.unfinished}: {progress}; {CONTINUE}", file=sys.stderr)
    return INTERRUPTED if run.unfinished == FROM_KEYBOARD else summary.status(run)
