"""A Dask scheduler and workers as separate processes of this machine."""

import json
import os
import random
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from threading import Timer
from time import monotonic, sleep
from typing import Any

import pytest


@contextmanager
def local(workers: int = 2, threads: int = 1) -> Iterator[Any]:
    """A ``LocalCluster`` of processes, which are started again when they die."""
    distributed = pytest.importorskip("distributed", reason="Dask is not installed: pip install -e '.[dev]'")
    # else a worker that starts slowly is given up; not as a context, which a fixture would leave in another order
    import_module("dask.config").set({"distributed.deploy.lost-worker-timeout": "1 h"})
    with distributed.LocalCluster(
        n_workers=workers, threads_per_worker=threads, processes=True, dashboard_address=":0", silence_logs=50
    ) as cluster:
        yield cluster


class Killer:
    """Kills a random worker of a ``LocalCluster`` at random moments of a run, as its ``on_progress``.

    Args:
        cluster: the cluster.
        total: number of tasks of the run.
        kills: number of workers to kill.
        seed: of the moments: the tasks after which a worker is killed, and a delay.
        delay: largest delay after a task has ended, s; within it the next tasks are running.
    """

    def __init__(self, cluster: Any, total: int, kills: int, seed: int, delay: float) -> None:
        self.random, self.cluster, self.delay = random.Random(seed), cluster, delay
        self.moments = set(self.random.sample(range(total - 2), kills))
        self.killed: list[int] = []
        self.timers: list[Timer] = []

    def __call__(self, done: int) -> None:
        if done in self.moments:
            timer = Timer(self.random.uniform(0.0, self.delay), self.kill)
            self.timers.append(timer)
            timer.start()

    def kill(self) -> None:
        """Kill a worker; wait for one if none is running."""
        until = monotonic() + 60
        while monotonic() < until:
            alive = [pid for w in self.cluster.workers.values() if (pid := w.pid) and pid not in self.killed]
            if alive:
                pid = self.random.choice(alive)
                with suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
                    self.killed.append(pid)
                    return
            sleep(0.05)

    def wait(self) -> None:
        """Wait for the last of the kills."""
        for timer in self.timers:
            timer.join()


@contextmanager
def separate(folder: Path) -> Iterator[tuple[str, subprocess.Popen[Any]]]:
    """A scheduler with one worker, processes of their own; yields its address and process."""
    pytest.importorskip("distributed", reason="Dask is not installed: pip install -e '.[dev]'")
    place = folder / "scheduler.json"
    start = [
        sys.executable,
        "-m",
        "distributed.cli.dask_scheduler",
        "--port",
        "0",
        "--no-dashboard",
        "--host",
        "127.0.0.1",
    ]
    join = [sys.executable, "-m", "distributed.cli.dask_worker", "--nthreads", "1", "--no-dashboard"]
    scheduler = subprocess.Popen([*start, "--scheduler-file", str(place)], cwd=folder, stderr=subprocess.DEVNULL)
    worker = None
    try:
        until = monotonic() + 60
        while not place.exists() and monotonic() < until:
            sleep(0.05)
        address = json.loads(place.read_text())["address"]
        worker = subprocess.Popen([*join, address], cwd=folder, stderr=subprocess.DEVNULL)
        yield address, scheduler
    finally:
        for process in filter(None, (worker, scheduler)):
            process.terminate()
            with suppress(subprocess.TimeoutExpired):
                process.wait(20)
            process.kill()
