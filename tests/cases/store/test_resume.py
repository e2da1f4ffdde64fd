"""A run that is killed continues: nothing is asked twice, nothing is lost, nothing is left behind."""

import os
import resource
import shutil
import subprocess
import sys
from pathlib import Path
from random import Random
from time import monotonic

import pytest

from southwell.cases.store import unfinished

from ...support import killing

pytestmark = pytest.mark.slow

PARTIAL, RESULTS = unfinished.NAME, "results.jsonl"


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run that nobody disturbed."""
    folder = tmp_path_factory.mktemp("undisturbed")
    status, _, err = killing.ended(killing.start(folder))
    assert status == 0, err
    return folder


def same(folder: Path, undisturbed: Path) -> None:
    """Results are those of the undisturbed run but for times; the same files are there, and no process is."""
    assert (folder / "out" / RESULTS).read_text() == (undisturbed / "out" / RESULTS).read_text()
    assert set(killing.files(folder)) == set(killing.files(undisturbed))
    assert killing.running(folder) == []


def reported(folder: Path, command: str) -> tuple[int, str]:
    """Status and first line of a command on the folder of results, in a process of its own."""
    line = [sys.executable, "-m", "southwell", *command.split(), "out"]
    process = subprocess.run(line, cwd=folder, env=killing.environment(folder), capture_output=True, text=True)
    assert "Traceback" not in process.stderr
    return process.returncode, (process.stdout + process.stderr).splitlines()[0]


@pytest.mark.parametrize(
    "count", [pytest.param(1, marks=pytest.mark.nightly), 4, pytest.param(8, marks=pytest.mark.nightly)]
)
def test_a_run_killed_with_some_answers_continues(count: int, tmp_path: Path, undisturbed: Path) -> None:
    path = tmp_path / "out" / PARTIAL
    assert killing.kill(killing.start(tmp_path), lambda: killing.answers(path) >= count)
    stored, before = killing.stored(path), killing.asked(tmp_path)
    assert not (tmp_path / "out" / RESULTS).exists()
    if count == 8:
        for command in ("report", "gate", "dashboard"):
            status, line = reported(tmp_path, command)
            assert status == 3
            assert "ncomplete: " in line
    status, _, err = killing.ended(killing.start(tmp_path))
    assert status == 0, err
    assert not set(killing.asked(tmp_path)[len(before) :]) & set(stored)
    shutil.rmtree(tmp_path / "southwell-dashboard", ignore_errors=True)
    same(tmp_path, undisturbed)


@pytest.mark.nightly
def test_a_run_killed_while_writing_its_report_asks_nothing_again(tmp_path: Path, undisturbed: Path) -> None:
    out = tmp_path / "out"
    assert killing.kill(killing.start(tmp_path), (out / RESULTS).exists)
    before = killing.asked(tmp_path)
    assert reported(tmp_path, "gate")[0] == 3
    assert killing.ended(killing.start(tmp_path))[0] == 0
    assert killing.asked(tmp_path) == before
    same(tmp_path, undisturbed)


@pytest.mark.nightly
def test_a_changed_case_or_version_takes_no_earlier_answer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "out" / PARTIAL
    assert killing.kill(killing.start(tmp_path), lambda: len(killing.stored(path)) >= 2)
    stored = killing.stored(path)
    monkeypatch.setattr(killing, "CASE", killing.CASE.replace("2.5", "2.6").replace("E = 7e10", "E = 7.1e10"))
    before = killing.asked(tmp_path)
    assert killing.ended(killing.start(tmp_path))[0] == 0
    assert set(killing.asked(tmp_path)[len(before) :]) >= set(stored)
    assert killing.kill(killing.start(tmp_path), lambda: len(killing.stored(path)) >= 2)
    stored, before = killing.stored(path), killing.asked(tmp_path)
    monkeypatch.setenv("COUNTED_VERSION", "2.0")
    assert killing.ended(killing.start(tmp_path))[0] == 0
    assert set(killing.asked(tmp_path)[len(before) :]) >= set(stored)


def test_a_second_run_in_the_same_folder_is_refused_and_an_earlier_result_stays(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    earlier = b'{"kind":"plan","columns":[]}\n'
    (out / RESULTS).write_bytes(earlier)
    with unfinished.locked(out):
        status, output, err = killing.ended(killing.start(tmp_path))
    assert (status, output, err.count("\n")) == (2, "", 1)
    assert "--out out: another run is writing in this folder" in err
    assert (out / RESULTS).read_bytes() == earlier


@pytest.mark.nightly
def test_a_disk_that_fills_up_keeps_what_is_there(tmp_path: Path, undisturbed: Path) -> None:
    """A limit on the size of files stands for the disk: no answer can be written, and the next run continues."""

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, resource.RLIM_INFINITY))

    killing.write(tmp_path)
    child = subprocess.Popen(
        killing.command(), cwd=tmp_path, env=killing.environment(tmp_path), preexec_fn=limited,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    status, _, err = killing.ended(child)
    assert status == 3
    assert "Traceback" not in err
    assert f"{PARTIAL}: " in err.splitlines()[-1]
    stored, before = killing.stored(tmp_path / "out" / PARTIAL), killing.asked(tmp_path)
    assert killing.ended(killing.start(tmp_path))[0] == 0
    assert not set(killing.asked(tmp_path)[len(before) :]) & set(stored)
    same(tmp_path, undisturbed)


@pytest.mark.nightly
def test_a_run_killed_at_random_moments_continues(tmp_path: Path, undisturbed: Path) -> None:
    """Every run is killed at a moment of its own, or comes to its end; the next one continues."""
    seed = int(os.environ.get("SOUTHWELL_SEED", "0")) or Random().randrange(10**9)
    random, kills, runs = Random(seed), 0, 0
    began = monotonic()
    assert killing.ended(killing.start(tmp_path))[0] == 0
    longest = monotonic() - began
    path = tmp_path / "out" / PARTIAL
    while kills < int(os.environ.get("SOUTHWELL_KILLS", "100")):
        until = monotonic() + random.uniform(0.2, 1.0) * longest
        stored, before = killing.stored(path), len(killing.asked(tmp_path))
        alive = killing.kill(killing.start(tmp_path), lambda until=until: monotonic() > until)
        kills, runs = kills + alive, runs + (not alive)
        assert not set(killing.asked(tmp_path)[before:]) & set(stored), f"seed {seed}"
        assert killing.running(tmp_path) == [], f"seed {seed}"
        if alive and path.exists():
            assert reported(tmp_path, "gate")[0] == 3, f"seed {seed}"
        elif not alive:
            same(tmp_path, undisturbed)
    assert killing.ended(killing.start(tmp_path))[0] == 0
    same(tmp_path, undisturbed)
    print(f"seed {seed}: {kills} kills, {runs} runs that came to their end before")
