"""``--against-version``: what is refused in one line, and a whole run that names the release that moved a frequency."""

import shlex
from pathlib import Path

import pytest

from southwell.cases.judge import results
from southwell.reports.cli import app as cli

from ...support import killing, wheelhouse

SAME, MOVED = "FACTOR = 1.0", "FACTOR = 1.0004"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    wheelhouse.use(tmp_path, monkeypatch, {"1.0": SAME, "1.1": SAME, "1.2": MOVED, "1.3": MOVED}, installed="1.0")
    (tmp_path / "stub.toml").write_text(killing.CASE.partition("[variants")[0], encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def verify(options: str, capsys: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    """Status, standard output and standard error."""
    with pytest.raises(SystemExit) as ended:
        cli.main(["verify", "stub.toml", "--faults", "none", "--workers", "1", *shlex.split(options)])
    out, err = capsys.readouterr()
    return int(ended.value.code or 0), out, err


@pytest.mark.slow
@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    ("given", "phrase"),
    [
        ("tinybeam", "give a package and a release, as in exudyn==1.13.6"),
        ("tinybeam==latest", "'latest' is no version: give one, as in 1.13.6, or newest"),
        ("tinybeam==1.0.0", "this release is the installed one: give another"),
        ("tinybeam==9.9", "pip install: No matching distribution found for tinybeam==9.9"),
        ("tinybeem==1.1", "no code of this run uses the package 'tinybeem': did you mean tinybeam?"),
        ("tiny==1.1", "tiny is a code: give its package, tinybeam==VERSION"),
        ("ic-sharpy==2.3", "sharpy runs in an environment of its own, whose files are pinned by hashes"),
    ],
)
def test_what_cannot_be_compared_is_refused_in_one_line(
    given: str, phrase: str, capsys: pytest.CaptureFixture[str]
) -> None:
    status, out, err = verify(f"--codes tiny:CODE --against-version {given}", capsys)
    assert (status, out) == (2, "")
    assert phrase in err
    assert err.startswith(f"southwell: --against-version {given}")
    assert err.count("\n") == 1


@pytest.mark.slow
def test_a_run_names_the_first_release_that_moves_a_frequency(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """With the newest release; a move is no failure. The command that is recorded has the release itself."""
    status, out, err = verify("--codes exact-beam,tiny:CODE --against-version tinybeam==newest --out out", capsys)
    assert (status, "Traceback" in err) == (0, False)
    assert "tiny@1.3 against 1.0: 4 frequencies compared, 4 moved beyond uncertainty" in out
    assert "tiny: the first release of tinybeam that moves it is 1.2, by +4.0e-04" in out
    assert "southwell: bisection: tiny, tinybeam 1.2: moved" in err
    report = (folder / "out" / "report.md").read_text(encoding="utf-8")
    assert "the first release of tinybeam that moves it is 1.2, by" in report.partition("## Versions")[2]
    assert "--against-version tinybeam==1.3" in report
    run = results.read(folder / "out" / "results.jsonl")
    assert (run.unfinished, run.versions["tiny"], run.versions["tiny@1.3"]) == ("", "1.0", "1.3")
    assert [(found.before, found.first) for found in run.bisections] == [("1.1", "1.2")]


@pytest.mark.slow
def test_the_newest_release_may_be_the_installed_one(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for path in (folder / "wheels").glob("tinybeam-1.[123]*"):
        path.unlink()
    status, out, err = verify("--codes exact-beam,tiny:CODE --against-version tinybeam==newest --out out", capsys)
    assert status == 0
    assert "--against-version tinybeam==newest: 1.0 is installed and the newest" in err
    assert "tiny@" not in out
