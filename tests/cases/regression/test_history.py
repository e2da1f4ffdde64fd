"""The history of runs: appended by many at once, cut short, and read again."""

import re
import subprocess
import sys
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import portalocker
import pytest

from southwell.cases.judge.results import Cell, Control, Run
from southwell.cases.regression import history
from southwell.cases.regression.history import Detection, Entry, Point
from southwell.cases.store import results_file

from ...reports.cli.test_cli import southwell

CELL = Cell(
    case="beam",
    omega=10.0,
    mode=1,
    family="edgewise",
    ordinal=1,
    code="some-code",
    version="1.0",
    role="code",
    value=11.71095,
    reference=11.71,
    difference=8.1e-5,
    uncertainty=1e-6,
    target=1e-3,
    verdict="pass",
)
RUN = Run(
    cells=(CELL, replace(CELL, mode=0, family="", ordinal=0, value=None, verdict="not run")),
    versions={"some-code": "1.0"},
    controls=(Control("frozen frame", "solver", "", "+31 %", "beam", 10.0, ("some-code",), -0.24),),
)
MADE = datetime(2026, 2, 3, 4, 5, 6, tzinfo=UTC)


def test_an_entry_has_the_values_of_the_run(tmp_path: Path) -> None:
    file = tmp_path / "history.jsonl"
    history.append(file, history.entry(RUN, "abc", "a machine", MADE))
    (result,) = history.read(file).entries
    beam = Point("beam", "some-code", 10.0, 1, "edgewise", 11.71095, 8.1e-5, 1e-6, "pass", 1e-3)
    none = Point("beam", "some-code", 10.0, 0, "", None, 8.1e-5, 1e-6, "not run", 1e-3)
    detection = Detection("frozen frame", "beam", 10.0, ("some-code",))
    assert result == Entry(
        "abc", "2026-02-03T04:05:06+00:00", "a machine", {"some-code": "1.0"}, (beam, none), (detection,)
    )
    assert beam.key == ("beam", "some-code", 10.0, 1, "frequency", "")


WRITER = """
import sys
from dataclasses import replace
from pathlib import Path
from southwell.cases.regression import history
source, file, writer, times = sys.argv[1:]
(entry,) = history.read(Path(source)).entries
print("ready", flush=True)
sys.stdin.readline()
for k in range(int(times)):
    history.append(Path(file), replace(entry, commit=f"{writer}-{k}"))
"""


def test_appended_by_many_processes_at_once(tmp_path: Path) -> None:
    # some 150 KB: more than a pipe or a block of a disk takes at once
    cells = tuple(replace(CELL, mode=k, value=1 / (k + 3)) for k in range(1, 1501))
    source = tmp_path / "source.jsonl"
    history.append(source, history.entry(replace(RUN, cells=cells), "source", "a machine", MADE))
    assert source.stat().st_size > 100_000
    file, writers, times = tmp_path / "history.jsonl", 4, 10
    jobs = [
        subprocess.Popen(
            [sys.executable, "-c", WRITER, source, file, str(w), str(times)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        for w in range(writers)
    ]
    for job in jobs:
        assert job.stdout
        assert job.stdout.readline() == b"ready\n"
    for job in jobs:  # all begin together
        assert job.stdin
        job.stdin.close()
    assert [job.wait(120) for job in jobs] == [0] * writers
    content = history.read(file)
    assert content.truncated == ()
    assert {e.commit for e in content.entries} == {f"{w}-{k}" for w in range(writers) for k in range(times)}
    assert all(len(e.cells) == 1500 for e in content.entries)
    for w in range(writers):  # each in its own order
        own_answer = [e.commit for e in content.entries if e.commit.startswith(f"{w}-")]
        assert own_answer == [f"{w}-{k}" for k in range(times)]
    assert {p.name for p in tmp_path.iterdir()} == {"source.jsonl", "history.jsonl"}  # no lock file is left


@pytest.mark.parametrize("size", [1, 100, -2, -1])
def test_a_line_cut_short_is_named_and_spoils_no_other(tmp_path: Path, size: int) -> None:
    file = tmp_path / "history.jsonl"
    history.append(file, history.entry(RUN, "first", date=MADE))
    whole = file.read_bytes()
    history.append(file, history.entry(RUN, "second", date=MADE))
    cut = file.read_bytes()[len(whole) :][:size]
    file.write_bytes(whole + cut)
    content = history.read(file)
    # a line that lacks only its end is whole
    assert [e.commit for e in content.entries] == (["first", "second"] if size == -1 else ["first"])
    assert content.truncated == (() if size == -1 else (2,))
    history.append(file, history.entry(RUN, "third", date=MADE))
    after = history.read(file)
    assert after.truncated == content.truncated
    assert [e.commit for e in after.entries] == [*(e.commit for e in content.entries), "third"]


def test_a_line_truncated_within_a_character_is_skipped(tmp_path: Path) -> None:
    file = tmp_path / "history.jsonl"
    history.append(file, history.entry(RUN, "first", date=MADE))
    with file.open("ab") as cut:
        cut.write('{"commit":"é'.encode()[:-1])
    assert history.read(file).truncated == (2,)


@pytest.mark.parametrize(
    ("text", "phrase"),
    [
        ('{"commit": "abc"}\n', "line 1: not a run .*date.*this version"),
        ('\n{"commit": 1}\n', "line 2: not a run .*commit"),
        ("a,b\nc,d\n", "line 1: not JSON.*southwell history"),
    ],
)
def test_a_file_of_another_format_is_refused(tmp_path: Path, text: str, phrase: str) -> None:
    file = tmp_path / "other"
    file.write_text(text)
    with pytest.raises(ValueError, match=phrase):
        history.read(file)


def test_the_command_adds_and_lists_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    results_file.write(tmp_path / "results.jsonl", RUN)
    file = tmp_path / "history.jsonl"
    for where in (tmp_path, tmp_path / "results.jsonl"):  # the folder, or the file in it
        line = f"history add {where} --history {file} --commit abc --machine quiet"
        status, out, err = southwell(line, capsys)
        assert (status, err) == (0, "")
        assert "abc: 2 cells, 1 seeded faults" in out
    entries = history.read(file).entries
    assert [(e.commit, e.machine, e.versions) for e in entries] == [("abc", "quiet", {"some-code": "1.0"})] * 2
    with file.open("a") as cut:
        cut.write('{"commit"')
    status, out, err = southwell(f"history list {file}", capsys)
    assert (status, err) == (0, f"southwell: {file}: line 3: truncated, ignored\n")
    assert out.count("quiet") == 2


def test_the_commit_is_that_of_the_checkout(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch) -> None:
    results_file.write(tmp_path / "results.jsonl", RUN)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    status, _, err = southwell("history add . --history history.jsonl", capsys)
    assert status == 2
    assert "--commit: missing" in err


@pytest.mark.parametrize(
    ("line", "phrase"),
    [
        ("history add {0} --history {0}/h.jsonl", "results.jsonl: cannot be read (No such file"),
        ("history add {0}/good --history {0}/none/h.jsonl --commit a", "--history .*cannot be written"),
        ("history list {0}/none", "cannot be read"),
        ("history list {0}/good", "not a run"),
    ],
)
def test_invalid_input_is_reported_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], line: str, phrase: str
) -> None:
    (tmp_path / "empty").write_bytes(b"")
    results_file.write(tmp_path / "good", RUN)
    status, _, err = southwell(line.format(tmp_path), capsys)
    assert status == 2
    assert err.count("\n") == 1
    assert re.search(phrase.replace("(", r"\("), err)


ADD, GATE = "history add {0}/cut --history {0}/h.jsonl --commit a", "gate {0}/good --against {0}/cut"


@pytest.mark.parametrize(("line", "lines"), [(ADD, 0), (ADD, 2), (ADD, -1), (GATE, 2), (GATE, -1)])
def test_an_incomplete_run_is_not_what_others_are_compared_with(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], line: str, lines: int
) -> None:
    results_file.write(tmp_path / "good", RUN)
    content = (tmp_path / "good").read_bytes().splitlines(keepends=True)
    (tmp_path / "cut").write_bytes(b"".join(content[:lines]))
    status, out, err = southwell(line.format(tmp_path), capsys)
    assert (status, out, err.count("\n")) == (3, "", 1)
    assert err.startswith(f"southwell: {tmp_path / 'cut'}: incomplete: ")
    assert not (tmp_path / "h.jsonl").exists()


@pytest.mark.slow
def test_a_writer_waits_for_its_turn(tmp_path: Path) -> None:
    source, file = tmp_path / "source.jsonl", tmp_path / "history.jsonl"
    history.append(source, history.entry(RUN, "source", date=MADE))
    with file.open("ab") as own_answer:
        portalocker.lock(own_answer, portalocker.LockFlags.EXCLUSIVE)
        job = subprocess.Popen([sys.executable, "-c", WRITER, source, file, "w", "1"])
        with pytest.raises(subprocess.TimeoutExpired):
            job.wait(4)  # what it needs to start is half of that
        assert file.stat().st_size == 0
        portalocker.unlock(own_answer)
    assert job.wait(60) == 0
    assert [e.commit for e in history.read(file).entries] == ["w-0"]
