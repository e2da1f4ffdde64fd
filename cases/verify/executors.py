"""Where the tasks of a run are executed: processes of this machine, or the workers of a cluster through Dask.

Both are a ``concurrent.futures.Executor``. ``executor`` yields one and stops it at the end.
"""

import asyncio
import logging
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import ExitStack, contextmanager, suppress
from importlib import import_module
from pathlib import Path
from typing import Any

from ..input.errors import CaseError
from .pool import Pool
from .software import Software

SLURM = "slurm"

CONNECT = 10.0
"""Time limit for the connection to a scheduler, s."""

MISSING = "--scheduler {}: {} is not installed: pip install 'southwell[cluster]'"


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
    if scheduler is None:
        pool = Pool(workers or 1, scratch)
        try:
            yield pool
        finally:
            pool.stop()
        return
    _import("distributed", scheduler)
    with ExitStack() as stack:
        address = scheduler if scheduler != SLURM else stack.enter_context(_slurm(workers or 1))
        client = stack.enter_context(_client(address, scheduler))
        count = len(client.nthreads())
        report(f"{scheduler}: {count} worker{'s' * (count != 1)}{'' if count else ' so far: waiting for the first'}")
        from .cluster import Cluster

        yield Cluster(client, software or Software())


@contextmanager
def _client(address: str, given: str) -> Iterator[Any]:
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
            f"--scheduler {given}: no Dask scheduler answers ({error}): give the address that `dask scheduler` prints, as in "
            "tcp://host:8786"
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
        raise CaseError(MISSING.format(scheduler, module)) from error
