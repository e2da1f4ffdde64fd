"""A sample of the nightly fuzz (``tests/support/fuzz.py``): the same trials in every run."""

import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from southwell.cases.input.errors import CaseError
from southwell.tests.support import fuzz

SEED, TRIALS = 1, 300


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    path = tmp_path_factory.mktemp("fuzz")
    fuzz.seeds(path)
    yield path
    shutil.rmtree(path)


@pytest.mark.parametrize("kind", [k for k in fuzz.FIRST if k != "arguments"])
def test_inputs_are_valid_before_mutation(folder: Path, kind: str) -> None:
    assert (
        fuzz.take(kind, folder / fuzz.FIRST[kind], fuzz.random.Random(0)) is None
    )  # neither CaseError nor AssertionError


@pytest.mark.parametrize("first", range(0, TRIALS, 50))
def test_mutated_input_is_refused_in_one_line_or_makes_sense(folder: Path, first: int) -> None:
    for number in range(first, first + 50):
        kind, problem = fuzz.trial(SEED, number, folder)
        assert not problem, f"seed {SEED}, trial {number}, {kind}: {problem}"


def test_a_trial_detects_invalid_output(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A traceback, a message of two lines, nonsense that is taken, and a hang."""
    reported = []

    def fault(kind: str) -> None:
        if kind == "two lines":
            error = CaseError("x")
            error.args = ("one\ntwo",)
            raise error
        if kind == "hang":
            while True:
                pass
        assert kind != "nonsense"
        raise KeyError(kind)

    monkeypatch.setattr(fuzz, "SECONDS", 0.2)
    for kind in ("two lines", "hang", "nonsense", "traceback"):
        monkeypatch.setattr(fuzz, "take", lambda *_, kind=kind: fault(kind))
        reported.append(fuzz.trial(SEED, 0, folder)[1])
    assert reported[0].startswith("message")
    assert reported[1].startswith("more than 0.2 s")
    assert "AssertionError" in reported[2]
    assert "KeyError" in reported[3]


def test_a_crashed_process_is_reported_and_the_others_continue(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    dies = "import os, sys, json; n = int(sys.argv[2]); f = open(sys.argv[4], 'a')\n"
    dies += "f.write(json.dumps({'begins': n}) + '\\n'); f.close()\nif n == 0: os.abort()\n"
    dies += "open(sys.argv[4], 'a').write(json.dumps(dict(number=n, kind='k', wrong='', seconds=0.1)) + '\\n')\n"
    (tmp_path / "dies.py").write_text(dies)
    monkeypatch.setattr(fuzz, "__file__", str(tmp_path / "dies.py"))
    rows = fuzz.run(2, SEED)
    assert [(r["number"], bool(r["wrong"])) for r in rows] == [(0, True), (1, False)]
    assert "-6" in rows[0]["wrong"]


@pytest.mark.slow
def test_the_script_runs_alone() -> None:
    process = subprocess.run([sys.executable, fuzz.__file__, "5", "--seed", "3"], capture_output=True, text=True)
    assert process.returncode == 0, process.stdout + process.stderr
    assert "seed 3: 5 trials, 0 wrong" in process.stdout
