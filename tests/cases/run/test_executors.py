"""Executors: which workers do a run's tasks, and the errors when there are none."""

import os
import stat
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor
from importlib import import_module
from pathlib import Path
from time import monotonic, sleep
from typing import Any

import pytest

from southwell.cases.input.errors import CaseError
from southwell.cases.run.executors import Processes, executor
from southwell.cases.run.software import Software, installed
from southwell.tests.support.studies import deadly, sleeping, solved, stub, study, tasks_of

from ...support import clusters


def test_processes_of_this_machine_by_default() -> None:
    with executor(1) as pool:
        assert isinstance(pool, Processes)
        assert pool.submit(os.getpid).result(60) != os.getpid()
    with pytest.raises(RuntimeError, match="shutdown"):
        pool.submit(os.getpid)


STOPPED = """
import os, signal, sys, time
from southwell.cases.run.executors import Processes

if __name__ == "__main__":
    for number in range(12):
        pool = Processes(2)
        tasks = [pool.submit(int, "no number") for _ in range(2)]
        time.sleep(0.05 * number)
        if sys.argv[1] == "interrupted":  # as by Ctrl-C, which every process of the group receives
            signal.signal(signal.SIGINT, signal.SIG_IGN)
            os.killpg(0, signal.SIGINT)
        pool.stop()
        signal.signal(signal.SIGINT, signal.default_int_handler)
"""


@pytest.mark.slow
@pytest.mark.parametrize("how", ["stopped", "interrupted"])
def test_processes_that_are_still_starting_end_silently(how: str, tmp_path: Path) -> None:
    (tmp_path / "stopped.py").write_text(STOPPED, encoding="utf-8")
    line = [sys.executable, "stopped.py", how]
    process = subprocess.run(line, cwd=tmp_path, capture_output=True, text=True, start_new_session=True, timeout=120)
    assert (process.returncode, process.stderr) == (0, "")


@pytest.mark.parametrize("module", ["distributed", "dask_jobqueue"])
def test_without_dask_there_is_a_hint(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    if module == "dask_jobqueue":
        pytest.importorskip("distributed", reason="Dask is not installed: pip install -e '.[dev]'")
    monkeypatch.setitem(sys.modules, module, None)
    with (
        pytest.raises(
            CaseError, match=rf"--scheduler slurm: {module} is not installed: pip install 'southwell\[cluster\]'"
        ),
        executor(1, "slurm"),
    ):
        pass


@pytest.mark.parametrize(
    ("address", "message"),
    [("host", "missing port number"), ("nothing://host:1", "unknown address scheme"), ("tcp://127.0.0.1:1", "after")],
)
def test_an_address_without_a_scheduler_is_one_line(
    address: str, message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed", reason="Dask is not installed: pip install -e '.[dev]'")
    monkeypatch.setattr("southwell.cases.run.cluster.CONNECT", 0.5)
    with (
        pytest.raises(CaseError, match=f"--scheduler {address}: no Dask scheduler answers .*{message}"),
        executor(1, address),
    ):
        pass


def test_software_is_versions_and_sources() -> None:
    result = dict(installed(Software(("numpy", "no-such-package"), ("no-such-code",))))
    assert result["numpy"] == import_module("numpy").__version__
    assert result["no-such-package"] == result["the source of no-such-code"] == ""
    assert len(result["Southwell or its libraries"]) == 12


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    with clusters.local(1) as design:
        yield design


@pytest.mark.slow
def test_workers_with_other_software_are_refused(cluster: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("southwell.cases.run.cluster.installed", lambda _: (("exudyn", "0.1"),))
    with executor(scheduler=cluster.scheduler_address, software=Software(("exudyn",))) as pool:
        error = pool.submit(os.getpid).exception(60)
    assert isinstance(error, CaseError)
    assert "worker tcp://" in str(error)
    assert "but 0.1 in the process that asks: install the same version" in str(error)


@pytest.mark.slow
def test_workers_with_several_threads_are_refused() -> None:
    with clusters.local(1, threads=2) as cluster, executor(scheduler=cluster.scheduler_address) as pool:
        error = pool.submit(os.getpid).exception(60)
    assert isinstance(error, CaseError)
    assert "2 threads: start it with --nthreads 1" in str(error)


def _in_memory(cluster: Any) -> int:
    return sum(task.state == "memory" for task in list(cluster.scheduler.tasks.values()))


@pytest.mark.slow
def test_finished_tasks_are_forgotten_on_the_cluster(cluster: Any, tmp_path: Path) -> None:
    """Otherwise results pile up in the workers' memory, and those of a dead worker are computed again."""
    with executor(scheduler=cluster.scheduler_address) as pool:
        solved(study(tmp_path, samples=50), tmp_path / "out.jsonl", pool, answer=stub)
        held = [pool.submit(os.getpid) for _ in range(5)]
        assert all(future.result(60) for future in held)
        until = monotonic() + 30  # the scheduler hears of it a moment later
        while (kept := _in_memory(cluster)) > 1 and monotonic() < until:
            sleep(0.05)
        assert kept <= 1


@pytest.mark.slow
def test_a_task_that_kills_every_worker_ends_the_run(tmp_path: Path) -> None:
    (task,) = tasks_of(study(tmp_path, samples=1))
    with (
        import_module("dask.config").set({"distributed.scheduler.allowed-failures": 0}),
        clusters.local(1) as cluster,
        executor(scheduler=cluster.scheduler_address) as pool,
    ):
        error = pool.submit(deadly, task).exception(120)
        assert isinstance(error, BrokenExecutor)
        assert "3 workers crashed on the same task" in str(error)
        assert pool.submit(stub, task).result(120) == stub(task)


@pytest.mark.slow
def test_a_cancelled_task_stays_cancelled(cluster: Any, tmp_path: Path) -> None:
    (task,) = tasks_of(study(tmp_path, samples=1))
    with executor(scheduler=cluster.scheduler_address) as pool:
        futures = [pool.submit(sleeping, task) for _ in range(20)]
        assert futures[-1].cancel()
        assert futures[0].result(60) == stub(task)
        assert futures[-1].cancelled()


SBATCH = """#!/bin/sh
sh "$1" > job.log 2>&1 &
echo "Submitted batch job $!"
"""


@pytest.mark.slow
def test_slurm_jobs_are_submitted_and_cancelled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The commands of Slurm are replaced by scripts that run the job on this machine."""
    pytest.importorskip("distributed", reason="Dask is not installed: pip install -e '.[dev]'")
    pytest.importorskip("dask_jobqueue", reason="Dask-Jobqueue is not installed: pip install -e '.[cluster]'")
    for name, text in (("sbatch", SBATCH), ("scancel", '#!/bin/sh\necho "$@" >> cancelled; kill "$@"\n')):
        path = tmp_path / name
        path.write_text(text)
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(CaseError, match=r"--scheduler slurm: .*jobqueue\.slurm"), executor(1, "slurm"):
        pass
    options = {"cores": 1, "processes": 1, "memory": "1GB", "interface": "lo"}
    with import_module("dask.config").set({f"jobqueue.slurm.{key}": value for key, value in options.items()}):
        design = study(tmp_path, samples=3)
        with executor(1, "slurm") as pool:
            assert solved(design, tmp_path / "slurm.jsonl", pool) == solved(design, tmp_path / "serial.jsonl")
    assert (tmp_path / "cancelled").read_text().strip()


@pytest.mark.nightly
def test_verify_gives_the_same_results_on_a_cluster(cluster: Any, tmp_path: Path) -> None:
    result = {}
    for name, options in (("here", ["--workers", "1"]), ("there", ["--scheduler", cluster.scheduler_address])):
        line = ["verify", "tip-mass", "--codes", "exact-beam", "--faults", "none", "--out", name, *options]
        process = subprocess.run(
            [sys.executable, "-m", "southwell", *line], cwd=tmp_path, capture_output=True, text=True
        )
        assert process.returncode == 0, process.stderr
        result[name] = (tmp_path / name / "results.jsonl").read_text()
    assert result["here"] == result["there"]
    assert len(result["here"].splitlines()) > 10
