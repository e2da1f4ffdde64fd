"""Worker processes for a run that stop at once, and take the foreign codes they wait for with them.

They do when told to, and when the process that started them is gone, however it went.
"""

import os
import signal
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing import active_children, get_context, parent_process
from pathlib import Path
from threading import Thread, main_thread
from time import sleep
from types import FrameType
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")

SAFE_PATH = "PYTHONSAFEPATH"

ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

_leaving = False
_orphaned = False


class Pool(ProcessPoolExecutor):
    """``workers`` processes, one thread of linear algebra each; their temporary files, and those of the codes they run, are
    in ``scratch`` if it is given: who removes that folder has removed all that a killed process left."""

    def __init__(self, workers: int, scratch: Path | None = None) -> None:
        os.environ.update(dict.fromkeys(ONE_THREAD, "1"))  # read by the children when they load their libraries
        super().__init__(workers, mp_context=get_context("spawn"), initializer=_begin, initargs=(scratch,))

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """As any executor's; a task that was handed over but not begun when the stop came is not begun."""
        with _safe_path():  # processes are started when they are first needed
            return super().submit(_unless_leaving, fn, *args, **kwargs)  # type: ignore[arg-type, return-value]

    def stop(self) -> None:
        """Interrupt every process and drop what is pending; returns when all are gone."""
        for child in active_children():
            if child.pid is not None:
                with suppress(ProcessLookupError):  # it has just gone
                    os.kill(child.pid, signal.SIGINT)
        self.shutdown(wait=True, cancel_futures=True)


@contextmanager
def _safe_path() -> Iterator[None]:
    """Python processes that are started meanwhile execute no ``random.py`` of the current folder."""
    before = os.environ.get(SAFE_PATH)
    os.environ[SAFE_PATH] = "1"
    try:
        yield
    finally:
        os.environ.pop(SAFE_PATH)
        if before is not None:
            os.environ[SAFE_PATH] = before


def _begin(scratch: Path | None) -> None:
    os.environ.pop(SAFE_PATH, None)  # it was meant for this process, and not for what foreign codes start
    if scratch:
        os.environ["TMPDIR"] = tempfile.tempdir = str(scratch)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _leave)
    Thread(target=_follow_parent, daemon=True).start()


def _follow_parent() -> None:
    global _orphaned
    if (parent := parent_process()) and (here := main_thread().ident):
        parent.join()
        _orphaned = True
        for _ in range(3):  # one may come just where the executor's loop catches everything
            signal.pthread_kill(here, signal.SIGTERM)
            sleep(2)
        os._exit(1)


def _leave(number: int, frame: FrameType | None) -> None:
    """Unwind whatever runs (a wait for a foreign code kills it on its way out), once; without a parent, whenever told."""
    global _leaving
    if _orphaned or not _leaving:
        _leaving = True
        raise SystemExit(128 + number)


def _unless_leaving(fn: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
    if _leaving:
        raise SystemExit(128 + signal.SIGINT)
    try:
        return fn(*args, **kwargs)
    finally:
        if _orphaned:  # nobody is left to hear of the result, or to say that there is no more to do
            os._exit(1)
