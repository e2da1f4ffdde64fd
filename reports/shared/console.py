"""The console: where commands print, how wide, and progress while a run goes on."""

import time
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from ...cases.verify.matrix import Progress as Step

WIDE = 240
"""Columns for tables that go into a file or a log."""

SILENCE = 10.0
"""Seconds between two lines in a log."""


def output() -> Console:
    """Where tables go: standard output; wide if that is no terminal."""
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=WIDE)


class Watch:
    """A bar with what is running and what is left, on standard error; a line now and then where there is no terminal."""

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

    def show(self, step: Step) -> None:
        """Bring the bar up to date."""
        running = ", ".join(step.running)
        self.bar.update(self.task, completed=step.done, total=step.total, description=running)
        if self.bar.disable and running and time.monotonic() - self.spoke > SILENCE:
            self.spoke = time.monotonic()
            self.console.print(f"{step.done} of {step.total} done; running: {running}", markup=False, soft_wrap=True)
