"""Worker processes for a run that stop immediately, together with the foreign codes they wait for.

They stop on request, and when the process that started them ends for any reason.
"""

import gc
import os
import signal
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing import active_children, get_context, parent_process
from pathlib import Path
from threading import Thread, main_thread
from time import sleep
from types import FrameType
from typing import Any, ParamSpec, TypeVar

from ...references.protocol import launch
from ...references.protocol.supervisor import OBJECTS

P = ParamSpec("P")
T = TypeVar("T")

SAFE_PATH = "PYTHONSAFEPATH"

ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

_working = False
_leaving = False
_orphaned = False


class Pool(ProcessPoolExecutor):
    """``workers`` processes with one thread of linear algebra each.

    If ``scratch`` is given, it holds their temporary files and those of the codes they run: removing it removes
    everything a killed process left.
    """

    def __init__(self, workers: int, scratch: Path | None = None) -> None:
        os.environ.update(dict.fromkeys(ONE_THREAD, "1"))  # read by the children when they load their libraries
        super().__init__(workers, mp_context=get_context("spawn"), initializer=_begin, initargs=(scratch,))
        self._open: set[Future[Any]] = set()

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """See ``Executor``. A task that is pending when the pool stops is not started."""
        with _safe_path(), _held():  # processes start when they are first needed
            future: Future[T] = super().submit(_unless_leaving, fn, *args, **kwargs)  # type: ignore[arg-type, assignment]
        self._open.add(future)
        future.add_done_callback(self._open.discard)
        return future

    def stop(self) -> None:
        """Interrupt every process and drop pending tasks; return when all processes have ended.

        If all tasks are done, the processes end by themselves: one interrupted while it reads the message to end would leave a
        part of it to the next one.
        """
        for child in active_children() if self._open else ():
            if child.pid is not None:
                with suppress(ProcessLookupError):  # it has just ended
                    os.kill(child.pid, signal.SIGTERM)  # ends a process silently that is still starting
        self.shutdown(wait=True, cancel_futures=True)


class Serial(Executor):
    """An executor that runs each task immediately, in this thread."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """See ``Executor``."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


@contextmanager
def _safe_path() -> Iterator[None]:
    """Prevent Python processes started meanwhile from importing modules of the current folder (``random.py``)."""
    before = os.environ.get(SAFE_PATH)
    os.environ[SAFE_PATH] = "1"
    try:
        yield
    finally:
        os.environ.pop(SAFE_PATH)
        if before is not None:
            os.environ[SAFE_PATH] = before


@contextmanager
def _held() -> Iterator[None]:
    """Let processes started meanwhile take an interrupt only when they are ready, where it is no traceback."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(scratch: Path | None) -> None:
    os.environ.pop(SAFE_PATH, None)  # meant for this process, not for processes started by foreign codes
    if scratch:
        os.environ["TMPDIR"] = tempfile.tempdir = str(scratch)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _leave)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    launch.keep()
    gc.set_threshold(OBJECTS)
    Thread(target=_follow_parent, daemon=True).start()


def _follow_parent() -> None:
    global _orphaned
    if (parent := parent_process()) and (here := main_thread().ident):
        parent.join()
        _orphaned = True
        for _ in range(3):  # one may arrive where the executor's loop catches everything
            signal.pthread_kill(here, signal.SIGTERM)
            sleep(2)
        os._exit(1)


def _leave(number: int, frame: FrameType | None) -> None:
    """Unwind the running task once (a wait for a foreign code kills that code); without a parent, at every signal.

    Before the first task the executor would log the exception, so the process ends at once.
    """
    global _leaving
    if not _working:
        os._exit(128 + number)
    if _orphaned or not _leaving:
        _leaving = True
        raise SystemExit(128 + number)


def _unless_leaving(fn: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
    global _working
    _working = True
    if _leaving:
        raise SystemExit(128 + signal.SIGINT)
    try:
        return fn(*args, **kwargs)
    finally:
        if _orphaned:  # no process is left to receive the result or to end this one
            os._exit(1)
