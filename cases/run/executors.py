"""Where the tasks of a run are executed: in this thread, in processes of this machine, or on the workers of a Dask scheduler.

Each is a ``concurrent.futures.Executor``. ``executor`` yields one and stops it at the end, together with the foreign codes that
its workers wait for: the process of a code ends when the worker that started it ends (``references.protocol.supervisor``).

The processes are those of the standard library. Loky, tried in version 3.7, leaves its workers and the codes they wait for
running when the process that started them is killed, and needs the same initializer.
"""

import gc
import os
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing import get_context, parent_process
from pathlib import Path
from threading import Thread
from typing import Any

from ...references.protocol import launch, portable
from ...references.protocol.supervisor import OBJECTS
from .software import Software

SAFE_PATH = "PYTHONSAFEPATH"

ONE_THREAD: dict[str, str] = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


@contextmanager
def executor(
    workers: int | None = None,
    scheduler: str | None = None,
    scratch: Path | None = None,
    software: Software | None = None,
    report: Callable[[str], None] = lambda line: None,
) -> Iterator[Executor]:
    """Context manager that yields the executor of a run.

    Args:
        workers: number of processes, or of Slurm's workers; None for the workers of a running scheduler.
        scheduler: None for processes of this machine; the address of a Dask scheduler, ``tcp://host:8786``; or
            ``slurm``, for jobs as configured for Dask-Jobqueue.
        scratch: folder for temporary files of local processes.
        software: what the workers of a cluster must have in the versions of this process; this package by default.
        report: called with a line on the workers of a cluster.

    Raises:
        CaseError: if the scheduler cannot be reached, is not configured, or Dask is not installed.
    """
    if scheduler is not None:
        from .cluster import cluster

        with cluster(workers, scheduler, software or Software(), report) as pool:
            yield pool
        return
    pool = Processes(workers or 1, scratch)
    try:
        yield pool
    finally:
        pool.stop()


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


class Processes(ProcessPoolExecutor):
    """``workers`` processes with one thread of linear algebra each. They also end when this process ends for any reason.

    If ``scratch`` is given, it holds their temporary files and those of the codes they run: removing it removes
    everything a killed process left.
    """

    def __init__(self, workers: int, scratch: Path | None = None) -> None:
        os.environ.update(ONE_THREAD)  # read by the children when they load their libraries
        super().__init__(workers, mp_context=get_context("spawn"), initializer=_begin, initargs=(scratch,))

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """See ``Executor``."""
        with _starting():  # processes start when they are first needed
            return super().submit(fn, *args, **kwargs)

    def stop(self) -> None:
        """Kill every process, drop pending tasks, and return when all processes have ended."""
        for process in list((self._processes or {}).values()):
            process.kill()
        if queue := self._result_queue:
            with suppress(OSError):  # else a half-written answer of a killed process would be waited for
                queue._writer.close()  # pyright: ignore[reportAttributeAccessIssue]
        self.shutdown(wait=True, cancel_futures=True)


@contextmanager
def _starting() -> Iterator[None]:
    """Context manager within which processes may start.

    They import nothing from the current folder (``random.py``), and take an interrupt only when they are ready, where it is no
    traceback.
    """
    path = os.environ.get(SAFE_PATH)
    with portable.interrupts_blocked():
        os.environ[SAFE_PATH] = "1"
        try:
            yield
        finally:
            os.environ.pop(SAFE_PATH)
            os.environ.update({} if path is None else {SAFE_PATH: path})


def _begin(scratch: Path | None) -> None:
    """Prepare a process. The one that started it decides what an interrupt means."""
    os.environ.pop(SAFE_PATH, None)  # not meant for processes started by foreign codes
    if scratch:
        os.environ["TMPDIR"] = tempfile.tempdir = str(scratch)
    portable.ignore_interrupts()
    launch.warm_up()
    gc.set_threshold(OBJECTS)
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    if parent := parent_process():
        parent.join()
        os._exit(1)
