"""An executor on the workers of a Dask scheduler; a task whose worker dies runs on another one.

The scheduler moves a task of a dead worker to another ``distributed.scheduler.allowed-failures`` times and then gives it
up; here it is submitted again, ``ROUNDS`` times in total, since other tasks may have killed those workers. Dask's
``retries`` are for tasks that raise; tasks of this package are pure, and would raise again.
"""

from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from functools import partial
from typing import Any

from distributed import Client, KilledWorker, get_worker

from ..input.errors import CaseError
from .software import Software, installed

ROUNDS = 3
"""How often a task is submitted before the run stops because its workers die."""


class Cluster(Executor):
    """Tasks on the workers of a scheduler. A future fails with ``BrokenExecutor`` if its workers or the scheduler are lost.

    Args:
        client: connected to the scheduler.
        software: what the workers must have in the versions of this process.
    """

    def __init__(self, client: Client, software: Software) -> None:
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
        inner = self.inner
        return super().cancel() and (inner is None or inner.cancel())

    def _finish(self, inner: Future[Any]) -> None:
        self.inner = None
        error = BrokenExecutor("the Dask scheduler is lost") if inner.cancelled() else inner.exception()
        if isinstance(error, KilledWorker):
            if self.rounds < ROUNDS and not self.cancelled():
                self.start()
                return
            died = self.rounds * (error.allowed_failures + 1)
            error = BrokenExecutor(f"{died} workers died while they had the same task, probably out of memory")
        if not self.set_running_or_notify_cancel():  # cancelled
            return
        if error is None:
            self.set_result(inner.result())
        else:
            self.set_exception(error)


def _checked(software: Software, expected: tuple[tuple[str, str], ...], task: Callable[[], Any]) -> Any:
    """Run a task on a worker.

    Raises:
        CaseError: if the worker's software differs, or it runs several tasks at a time in one process.
    """
    worker = get_worker()
    if worker.state.nthreads != 1:
        raise CaseError(f"worker {worker.address}: {worker.state.nthreads} threads: start it with --nthreads 1")
    for (name, here), (_, there) in zip(expected, installed(software), strict=True):
        if here != there:
            raise CaseError(
                f"worker {worker.address}: {name}: {there or 'not installed'}, but {here or 'not installed'} in the "
                "process that asks: install the same version"
            )
    return task()
