"""Workers and drivers are killed at random moments: no result is lost, none is there twice, none is another."""

import random
import signal
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep

import pytest

from southwell.cases.run.executors import executor
from southwell.tests.support.studies import lines, solved, study, text

from ...support import clusters

pytestmark = pytest.mark.slow

SAMPLES, KILLS = 80, 20


@pytest.mark.nightly
def test_workers_killed_at_twenty_random_moments(tmp_path: Path) -> None:
    seed = random.randrange(10**6)
    print(f"seed of the moments: {seed}")  # shown if the test fails
    design = study(tmp_path, samples=SAMPLES)
    serial = solved(design, tmp_path / "serial.jsonl")
    with clusters.local(2) as cluster, executor(scheduler=cluster.scheduler_address) as pool:
        killer = clusters.Killer(cluster, SAMPLES, KILLS, seed, delay=0.1)
        solution = solved(design, tmp_path / "cluster.jsonl", pool, on_progress=killer)
        killer.wait()
    assert len(set(killer.killed)) == KILLS
    assert len(solution) == 1 + SAMPLES * 2 * 3
    assert solution == serial


def rows(path: Path) -> int:
    return path.read_bytes().count(b"\n") - 1 if path.exists() else 0


def start(folder: Path, *options: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "southwell", "study", "study.toml", "--out", "out.jsonl", *options]
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def until(path: Path, count: int, child: subprocess.Popen[str]) -> None:
    """Wait until a file has some rows."""
    end = monotonic() + 120
    while rows(path) < count and child.poll() is None and monotonic() < end:
        sleep(0.002)


@pytest.mark.nightly
def test_a_driver_that_is_killed_again_and_again(tmp_path: Path) -> None:
    seed = random.randrange(10**6)
    print(f"seed of the moments: {seed}")
    draw = random.Random(seed)
    design, path = study(tmp_path, samples=SAMPLES), tmp_path / "out.jsonl"
    serial = solved(design, tmp_path / "serial.jsonl")
    kills = 0
    for _ in range(5):
        child = start(tmp_path, "--workers", "2")
        until(path, rows(path) + draw.randrange(1, 6 * SAMPLES // 8), child)
        sleep(draw.uniform(0.0, 0.05))
        kills += child.poll() is None
        child.kill()
        child.communicate(timeout=60)
    assert kills == 5
    child = start(tmp_path, "--workers", "2")
    out, err = child.communicate(timeout=300)
    assert child.returncode == 0, err
    assert f"{SAMPLES * 6} frequencies of {SAMPLES} samples at 2 speeds" in out
    assert lines(path) == serial


@pytest.mark.nightly
@pytest.mark.parametrize("where", ["processes", "cluster"])
def test_an_interrupted_study_has_status_130_and_continues(where: str, tmp_path: Path) -> None:
    design, path = study(tmp_path, samples=SAMPLES), tmp_path / "out.jsonl"
    serial = solved(design, tmp_path / "serial.jsonl")
    with clusters.local(1) as cluster:
        options = ["--workers", "1"] if where == "processes" else ["--scheduler", cluster.scheduler_address]
        child = start(tmp_path, *options)
        until(path, 30, child)
        child.send_signal(signal.SIGINT)
        _, err = child.communicate(timeout=60)
        assert child.returncode == 130, err
        assert "southwell: interrupted: " in err
        assert f"of {SAMPLES} samples are in out.jsonl; the same command continues" in err
        assert "Traceback" not in err
        assert 30 <= rows(path) < SAMPLES * 6
        child = start(tmp_path, *options)
        _, err = child.communicate(timeout=300)
        assert child.returncode == 0, err
    assert lines(path) == serial


@pytest.mark.nightly
def test_a_scheduler_that_is_lost_leaves_the_answers_and_status_3(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(text(samples=SAMPLES))
    path = tmp_path / "out.jsonl"
    with clusters.separate(tmp_path) as (address, scheduler):
        child = start(tmp_path, "--scheduler", address)
        until(path, 30, child)
        scheduler.kill()
        _, err = child.communicate(timeout=120)
    assert child.returncode == 3, err
    assert "southwell: workers are lost (the Dask scheduler is lost): " in err
    assert "Traceback" not in err
    design = study(tmp_path, samples=SAMPLES)
    assert solved(design, path) == solved(design, tmp_path / "serial.jsonl")
