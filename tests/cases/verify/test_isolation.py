"""A whole run with codes that misbehave: their cells fail, their neighbours' do not, and nothing looks complete that is not."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import pytest

from southwell.cases.input.schema import Case, read
from southwell.cases.judge.results import Cell, Run
from southwell.cases.plan import blade_columns as columns
from southwell.cases.plan.blade import blades
from southwell.cases.verify import matrix
from southwell.references.protocol import registry
from southwell.references.protocol.description import describe
from southwell.references.protocol.process import Limits
from southwell.reports.cli import app as cli
from southwell.reports.shared import summary
from southwell.reports.shared.statuses import INCOMPLETE

from ...support import matrix_runs
from ...support.misdeeds import TABLE

CASE = """
name = "rest"
title = "At rest, and turning"
description = "A slender uniform beam."
source = "Rayleigh (1877)"
[blade]
kind = "dimensionless"
slenderness = 1000
[speeds]
gamma = [0, 0.1]
[compare]
motions = ["edgewise", "flapwise"]
modes = 2
time_limit = 20
"""

BAD = {
    "import-exit_0": "fail",
    "unsupported-two_lines": "not applicable",
    "solve-patches_json": "fail",
}
"""The verdict of every cell."""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    support = str(Path(__file__).parents[2] / "support")
    monkeypatch.setenv("PYTHONPATH", support)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def case(tmp_path: Path) -> Case:
    path = tmp_path / "rest.toml"
    path.write_text(CASE, encoding="utf-8")
    return read(path)


def written(key: str, folder: Path) -> str:
    (misdeed,) = (m for m in TABLE if f"{m.when}-{m.name}" == key)
    return misdeed.write(folder)


def run(case: Case, *codes: str) -> Run:
    with ThreadPoolExecutor(2) as executor:
        return matrix_runs.solve(blades(case), codes, executor, parts=False)


def of(run: Run, code: str) -> list[Cell]:
    return [c for c in run.cells if c.code == code]


@pytest.mark.slow
def test_failing_codes_do_not_affect_other_codes(case: Case, folder: Path) -> None:
    """They declare the name ``misdeed``, if they come so far; else they go by what they were asked for."""
    alone = of(run(case, "southwell-equation"), "southwell-equation")
    assert len(alone) == 4
    for key, verdict in BAD.items():
        path = written(key, folder)
        result = run(case, path, "southwell-equation")
        failures = [c for c in result.cells if c.code in ("misdeed", path)]
        assert {(c.omega > 0, c.verdict) for c in failures} == {(False, verdict), (True, verdict)}, (key, failures)
        assert all(c.reason for c in failures)
        good = of(result, "southwell-equation")
        assert [(c.value, c.verdict) for c in good] == [(c.value, c.verdict) for c in alone]
        assert summary.status(result) == (1 if verdict == "fail" else 0)


def test_an_entry_point_that_exits_affects_its_own_code_only(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written("import-exit_0", folder)
    info = folder / "theirs-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: theirs\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[southwell.codes]\ntheirs = misdeed_import_exit_0:CODE\ngone = no_such_module:CODE\n"
    )
    monkeypatch.syspath_prepend(str(folder))
    monkeypatch.setenv("PYTHONPATH", str(folder))
    assert {"theirs", "gone"} <= set(registry.names())
    actual, expected, gone = describe(["yoo-shin", "theirs", "gone"], limits=Limits(30.0))
    assert actual.failure is None
    assert expected.failure
    assert "exit status 0" in expected.failure.reason
    assert gone.failure
    assert "No module named 'no_such_module'" in gone.failure.reason


def test_an_internal_error_affects_its_own_column_only(case: Case, monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(*_: object) -> None:
        raise IndexError("list index out of range")

    monkeypatch.setattr(columns, "papers_equations", wrong)
    result = run(case, "yoo-shin")
    lost = of(result, columns.PAPER)
    assert [c.verdict for c in lost] == ["fail", "fail"]
    assert lost[0].reason == "internal error of southwell, not of the code: IndexError: list index out of range"
    assert {c.verdict for c in of(result, "yoo-shin")} <= {"pass", "known difference"}
    assert summary.status(result) == 1


def test_a_lost_pool_worker_is_no_interruption(
    case: Case, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def lost(*_: object, **__: object) -> None:
        raise BrokenProcessPool

    monkeypatch.setattr(matrix, "run", lost)
    with pytest.raises(SystemExit) as exit_info:
        cli.main(["verify", case.path, "--codes", "yoo-shin", "--faults", "none", "--workers", "1"])
    message = capsys.readouterr().err
    assert exit_info.value.code == INCOMPLETE
    assert "a worker process was killed" in message
    assert "interrupted" not in message


@pytest.mark.slow
def test_no_process_of_a_run_executes_files_of_the_current_folder(case: Case, folder: Path) -> None:
    """As installed: neither the command, nor its pool's processes, nor the codes' workers."""
    (folder / "southwell").mkdir()
    for name in ("random.py", "json.py", "numpy.py", "ctypes.py", "southwell/__init__.py"):
        (folder / name).write_text("import os\nos._exit(9)\n", encoding="utf-8")
    command = [
        str(Path(sys.executable).with_name("southwell")),
        "verify",
        case.path,
        "--faults",
        "none",
        "--codes",
        "yoo-shin",
    ]
    process = subprocess.run([*command, "--workers", "1"], capture_output=True, text=True, timeout=200)
    assert process.returncode == 0, process.stderr
    assert "pass" in process.stdout
