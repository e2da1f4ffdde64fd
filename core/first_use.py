"""What happens when loops are compiled for the first time: it is announced, and a second process compiles a part of them.

The announcement goes to the logger ``southwell``, whose warnings go to standard error by default.
"""

import atexit
import logging
import os
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from multiprocessing import parent_process
from pathlib import Path
from typing import Any

from numba.core import event

ANNOUNCEMENT = "southwell: compiling the solver's loops (first use only, up to half a minute)"

ASSISTANT = f"{__package__}.chain.precompile"
"""The module that the second process runs."""


class FirstUse(event.Listener):
    """Numba's events of compilation; loaded functions cause none.

    Of a process and its workers, only the first to compile announces it. Workers all compile, so that they need no second
    process.
    """

    def __init__(self, folder: Callable[[], Path | None]) -> None:
        self.folder = folder
        """The cache folder, if there is one."""

        self.seen = False

    def on_start(self, event: Any) -> None:
        """Numba begins to compile a function."""
        ours = event.data["dispatcher"].py_func.__module__.startswith(__package__ or "")
        if self.seen or not ours:
            return
        self.seen = True
        main = parent_process() is None
        if self._first() or main:
            logging.getLogger("southwell").warning(ANNOUNCEMENT)
        if main and self.folder() is not None and _processors() > 1:
            _assist()

    def on_end(self, event: Any) -> None:
        """Nothing to do."""

    def _first(self) -> bool:
        """Whether no process has compiled into the folder before."""
        folder = self.folder()
        if folder is None:
            return True
        with suppress(FileExistsError):
            (folder / "announced").touch(exist_ok=False)
            return True
        return False


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _assist() -> None:
    """Start the second process; without it, this one compiles everything. It does not outlive this one's regular end."""
    spec = getattr(sys.modules["__main__"], "__spec__", None)
    if "python" not in Path(sys.executable or "").name.lower() or (spec and spec.name == ASSISTANT):
        return  # a program that embeds Python, or this is the second process
    nothing = subprocess.DEVNULL
    with suppress(OSError):
        second = subprocess.Popen(
            [sys.executable, "-P", "-m", ASSISTANT], stdin=nothing, stdout=nothing, stderr=nothing
        )
        atexit.register(_end, second)


def _end(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.wait()
