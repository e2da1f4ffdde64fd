"""The console: standard output of the commands, its width, and the display of progress."""

import time
from datetime import timedelta
from types import TracebackType

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    SpinnerColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from ...cases.verify.matrix import Progress as Step

WIDE = 240
"""Width of tables written to a file or a log, characters."""

SILENCE = 10.0
"""Shortest time between two lines of progress in a log, seconds."""


def output() -> Console:
    """The console for tables on standard output; ``WIDE`` characters wide unless it is a terminal."""
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=WIDE)


class Watch:
    """Progress of a run on standard error: a bar on a terminal, otherwise a line from time to time."""

    def __init__(self) -> None:
        self.console = Console(stderr=True, highlight=False)
        self.bar = Progress(
            SpinnerColumn(),
            BarColumn(bar_width=30),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TextColumn("{task.description}", markup=False),
            console=self.console,
            transient=True,
            disable=not self.console.is_terminal,
        )
        self.task = self.bar.add_task("starting")
        self.spoke = time.monotonic()

    def __enter__(self) -> "Watch":
        self.bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.bar.stop()

    def tell(self, line: str) -> None:
        """Print a line above the bar."""
        self.console.print(f"southwell: {line}", markup=False, soft_wrap=True)

    def show(self, step: Step) -> None:
        """Update the progress."""
        running = ", ".join(step.running)
        self.bar.update(self.task, completed=step.done, total=step.total, description=running)
        if self.bar.disable and time.monotonic() - self.spoke > SILENCE:
            self.spoke = time.monotonic()
            shown = f"; running: {running}" if running else ""  # unknown on a cluster
            self.console.print(f"{step.done} of {step.total} done{shown}", markup=False, soft_wrap=True)


class Counter:
    """Progress of many equal tasks on standard error, with the remaining time: a bar, or a line from time to time.

    Args:
        what: name of the tasks, in the plural.
        total: their number.
    """

    def __init__(self, what: str, total: int) -> None:
        self.what, self.total = what, total
        self.console = Console(stderr=True, highlight=False)
        self.bar = Progress(
            SpinnerColumn(),
            BarColumn(bar_width=30),
            MofNCompleteColumn(),
            TextColumn(what),
            TimeElapsedColumn(),
            TextColumn("remaining:"),
            TimeRemainingColumn(),
            console=self.console,
            transient=True,
            disable=not self.console.is_terminal,
        )
        self.task = self.bar.add_task("", total=total)
        self.first: tuple[int, float] | None = None
        self.spoke = time.monotonic()

    def __enter__(self) -> "Counter":
        self.bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.bar.stop()

    def tell(self, line: str) -> None:
        """Print a line above the bar."""
        self.console.print(f"southwell: {line}", markup=False, soft_wrap=True)

    def show(self, done: int) -> None:
        """Update the progress. The first call has the number of tasks finished by earlier runs."""
        now = time.monotonic()
        if self.first is None:
            self.first = done, now
            self.bar.reset(self.task, completed=done, total=self.total)
        self.bar.update(self.task, completed=done)
        before, begun = self.first
        if self.bar.disable and done > before and now - self.spoke > SILENCE:
            self.spoke = now
            left = timedelta(seconds=round((now - begun) / (done - before) * (self.total - done)))
            self.console.print(f"{done} of {self.total} {self.what}; remaining: {left}", markup=False, soft_wrap=True)
