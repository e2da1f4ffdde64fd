"""The console: standard output of the commands, its width, and the display of progress."""

import time
from datetime import timedelta
from textwrap import fill
from types import TracebackType
from typing import Any, Self

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
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


class _Output(Console):
    """A console that wraps long lines between words if it is a terminal, which would break them anywhere."""

    def print(self, *objects: Any, soft_wrap: bool | None = None, **options: Any) -> None:
        """As ``Console.print``; with ``soft_wrap``, text is wrapped, and words longer than a line, such as paths, are whole."""
        if soft_wrap and self.is_terminal:
            objects = tuple(_wrapped(text, self.width) if isinstance(text, str) else text for text in objects)
        super().print(*objects, soft_wrap=soft_wrap, **options)


def _wrapped(text: str, width: int) -> str:
    return "\n".join(
        fill(line, width, break_long_words=False, break_on_hyphens=False) if len(line) > width else line
        for line in text.split("\n")
    )


def output() -> Console:
    """The console for tables on standard output; ``WIDE`` characters wide unless it is a terminal."""
    console = _Output(highlight=False)
    return console if console.is_terminal else _Output(highlight=False, width=WIDE)


class Display:
    """A progress bar on standard error; without a terminal, a line from time to time."""

    def __init__(self, *columns: ProgressColumn) -> None:
        self.console = Console(stderr=True, highlight=False)
        self.bar = Progress(
            SpinnerColumn(),
            BarColumn(bar_width=30),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            *columns,
            console=self.console,
            transient=True,
            disable=not self.console.is_terminal,
        )
        self.spoke = time.monotonic()

    def __enter__(self) -> Self:
        self.bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.bar.stop()

    def report(self, line: str) -> None:
        """Print a line above the bar."""
        self.console.print(f"southwell: {line}", markup=False, soft_wrap=True)

    def due(self, now: float) -> bool:
        """Whether a line of progress should be printed at the time ``now``, s."""
        if not self.bar.disable or now - self.spoke <= SILENCE:
            return False
        self.spoke = now
        return True


class Watch(Display):
    """Progress of a run."""

    def __init__(self) -> None:
        super().__init__(TextColumn("{task.description}", markup=False))
        self.task = self.bar.add_task("starting")

    def show(self, step: Step) -> None:
        """Update the progress."""
        running = ", ".join(step.running)
        self.bar.update(self.task, completed=step.done, total=step.total, description=running)
        if self.due(time.monotonic()):
            current = f"; running: {running}" if running else ""  # unknown on a cluster
            self.console.print(f"{step.done} of {step.total} done{current}", markup=False, soft_wrap=True)


class Counter(Display):
    """Progress of many equal tasks, with the remaining time.

    Args:
        label: name of the tasks, in the plural.
        total: their number.
    """

    def __init__(self, label: str, total: int) -> None:
        remaining = (TextColumn("remaining:"), TimeRemainingColumn())
        super().__init__(TextColumn(label), *remaining)
        self.label, self.total = label, total
        self.task = self.bar.add_task("", total=total)
        self.first: tuple[int, float] | None = None

    def show(self, done: int) -> None:
        """Update the progress. The first call has the number of tasks finished by earlier runs."""
        now = time.monotonic()
        if self.first is None:
            self.first = done, now
            self.bar.reset(self.task, completed=done, total=self.total)
        self.bar.update(self.task, completed=done)
        first_done, start_time = self.first
        if done > first_done and self.due(now):
            remaining = timedelta(seconds=round((now - start_time) / (done - first_done) * (self.total - done)))
            self.console.print(
                f"{done} of {self.total} {self.label}; remaining: {remaining}", markup=False, soft_wrap=True
            )
