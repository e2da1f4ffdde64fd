"""An executor on the workers of a Dask scheduler, or of Slurm; a task whose worker dies runs on another one.

The scheduler moves a task of a dead worker to another ``distributed.scheduler.allowed-failures`` times and then gives it
up; here it is submitted again, ``ROUNDS`` times in total, since other tasks may have killed those workers. Dask's
``retries`` are for tasks that raise; tasks of this package are pure, and would raise again.
"""

import asyncio
import logging
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from importlib import import_module
from typing import Any

from ..input.errors import CaseError
from .software import Software, installed

SLURM = "slurm"

CONNECT = 10.0
"""Time limit for the connection to a scheduler, s."""

ROUNDS = 3
"""How often a task is submitted before the run stops because its workers die."""


@contextmanager
def cluster(
    workers: int | None, scheduler: str, software: Software, report: Callable[[str], None]
) -> Iterator["Cluster"]:
    """Context manager that yields an executor on a running scheduler, or on Slurm jobs; see ``executors.executor``."""
    _import("distributed", scheduler)
    with ExitStack() as stack:
        address = scheduler if scheduler != SLURM else stack.enter_context(_slurm(workers or 1))
        client = stack.enter_context(_client(address, scheduler))
        count = len(client.nthreads())
        report(f"{scheduler}: {count} worker{'s' * (count != 1)}{'' if count else ' so far: waiting for the first'}")
        yield Cluster(client, software)


class Cluster(Executor):
    """Tasks on the workers of a scheduler. A future fails with ``BrokenExecutor`` if its workers or the scheduler are lost.

    Args:
        client: ``distributed.Client``, connected to the scheduler.
        software: what the workers must have in the versions of this process.
    """

    def __init__(self, client: Any, software: Software) -> None:
        self.inner = client.get_executor(pure=False)
        self.software, self.expected = software, installed(software)

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """See ``Executor``. The future fails with ``CaseError`` if the worker has other versions or several threads."""
        outer = _Task(partial(self.inner.submit, _checked, self.software, self.expected, partial(fn, *args, **kwargs)))
        outer.start()
        return outer


class _Task(Future[Any]):
    """Future of a task that is submitted again if its workers die.

    It lets go of Dask's future as soon as there is a result; until then the scheduler keeps the result on the worker, and
    would compute it again if that worker died.
    """

    def __init__(self, submit: Callable[[], Future[Any]]) -> None:
        super().__init__()
        self.submit, self.rounds = submit, 0
        self.inner: Future[Any] | None = None

    def start(self) -> None:
        self.rounds += 1
        self.inner = self.submit()
        self.inner.add_done_callback(self._finish)

    def cancel(self) -> bool:
        future = self.inner
        return super().cancel() and (future is None or future.cancel())

    def _finish(self, future: Future[Any]) -> None:
        self.inner = None
        error: Any = BrokenExecutor("the Dask scheduler is lost") if future.cancelled() else future.exception()
        if isinstance(error, import_module("distributed").KilledWorker):
            if self.rounds < ROUNDS and not self.cancelled():
                self.start()
                return
            died = self.rounds * (error.allowed_failures + 1)
            error = BrokenExecutor(f"{died} workers crashed on the same task, probably out of memory")
        if not self.set_running_or_notify_cancel():  # cancelled
            return
        if error is None:
            self.set_result(future.result())
        else:
            self.set_exception(error)


def _checked(software: Software, expected: tuple[tuple[str, str], ...], task: Callable[[], Any]) -> Any:
    """Run a task on a worker.

    Raises:
        CaseError: if the worker's software differs, or it runs several tasks at a time in one process.
    """
    worker = import_module("distributed").get_worker()
    if worker.state.nthreads != 1:
        raise CaseError(f"worker {worker.address}: {worker.state.nthreads} threads: start it with --nthreads 1")
    for (name, expected_version), (_, version) in zip(expected, installed(software), strict=True):
        if expected_version != version:
            raise CaseError(
                f"worker {worker.address}: {name}: {version or 'not installed'}, but "
                f"{expected_version or 'not installed'} in the process that asks: install the same version"
            )
    return task()


@contextmanager
def _client(address: str, scheduler: str) -> Iterator[Any]:
    from distributed import Client
    from distributed.comm.core import connect
    from distributed.utils import silence_logging_cmgr

    async def reach() -> None:  # a Client that cannot connect prints tracebacks when it is collected
        await (await connect(address, timeout=CONNECT)).close()

    try:
        asyncio.run(reach())
        client = Client(address, timeout=CONNECT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise CaseError(
            f"--scheduler {scheduler}: no Dask scheduler answers ({error}): give the address that `dask scheduler` prints, as "
            "in tcp://host:8786"
        ) from error
    logging.getLogger("asyncio").setLevel(logging.CRITICAL)  # what Dask's loop leaves behind when a scheduler is lost
    with silence_logging_cmgr(logging.CRITICAL):  # what concerns the run is raised by its futures
        try:
            yield client
        finally:
            with suppress(OSError, TimeoutError):  # the scheduler has ended
                client.close()


@contextmanager
def _slurm(workers: int) -> Iterator[str]:
    """A scheduler in this process whose workers are Slurm jobs; yields its address."""
    jobqueue = _import("dask_jobqueue", SLURM)
    try:
        cluster = jobqueue.SLURMCluster()
    except (ValueError, OSError) as error:
        raise CaseError(
            f"--scheduler {SLURM}: {error}: set jobqueue.slurm (cores, processes, memory) in ~/.config/dask/jobqueue.yaml"
        ) from error
    with cluster:
        cluster.scale(workers)
        yield cluster.scheduler_address


def _import(module: str, scheduler: str) -> Any:
    try:
        return import_module(module)
    except ImportError as error:
        raise CaseError(
            f"--scheduler {scheduler}: {module} is not installed: pip install 'southwell[cluster]'"
        ) from error
