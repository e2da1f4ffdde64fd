"""Output that cannot be written, or not as it is, and a defect of the program: one clear line, and the right status."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from southwell.reports.cli import app as cli
from southwell.reports.cli import report


def shell(line: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """A command line through the shell, ``southwell`` being this one."""
    line = line.replace("southwell", f"'{sys.executable}' -m southwell")
    return subprocess.run(["bash", "-c", line], env={**os.environ, **variables}, capture_output=True, text=True)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("line", "variables", "status", "errors"),
    [
        ("southwell --help", {"PYTHONIOENCODING": "ascii"}, 0, 0),
        ("southwell --help >&-", {}, 0, 0),
        ("southwell --help >&- 2>&-", {}, 0, 0),
        ("southwell codes | true; exit ${PIPESTATUS[0]}", {}, 0, 0),
        ("southwell report /nowhere | true; exit ${PIPESTATUS[0]}", {}, 2, 1),
        ("southwell --help > /dev/full", {}, 2, 1),
    ],
)
def test_closed_full_or_ascii_output_has_the_right_status(
    line: str, variables: dict[str, str], status: int, errors: int
) -> None:
    done = shell(line, **variables)
    assert (done.returncode, done.stderr.count("\n")) == (status, errors), done.stderr


@pytest.mark.slow
def test_a_run_without_home_or_temporary_folder_in_an_unusual_path(tmp_path: Path) -> None:
    folder = tmp_path / "a b\nü'$x"
    folder.mkdir()
    line = "env -u HOME southwell verify rotating-cable --codes southwell-equation --faults none --workers 1 --out ."
    process = subprocess.run(
        ["bash", "-c", line.replace("southwell verify", f"'{sys.executable}' -m southwell verify")],
        cwd=folder,
        env={**os.environ, "TMPDIR": str(tmp_path / "missing")},
        capture_output=True,
        text=True,
    )
    assert (process.returncode, (folder / "results.jsonl").exists()) == (0, True), process.stderr


def test_a_defect_of_the_program_has_a_status_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(_: object) -> None:
        raise ZeroDivisionError("division by zero")

    monkeypatch.setattr(report, "run_in", fails)
    with pytest.raises(SystemExit) as exit_info:
        cli.main(["report", str(tmp_path)])
    assert exit_info.value.code == 70
    last = capsys.readouterr().err.splitlines()[-1]
    assert last.startswith("southwell: internal error: ZeroDivisionError: division by zero: please report it")
