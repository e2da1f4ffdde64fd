"""The command line: what a user types, sees and gets; every wrong input is one line and status 2."""

import json
import os
import re
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.judge.results import Cell
from southwell.cases.store import results_file, unfinished
from southwell.cases.verify import matrix
from southwell.core.solve import modes
from southwell.references.protocol.registry import names
from southwell.reports.cli import app as cli
from southwell.tests.support import killing
from southwell.tests.support.killing import BEAM


@pytest.fixture
def beam(tmp_path: Path) -> Path:
    path = tmp_path / "stub.toml"
    path.write_text(BEAM)
    return path


def southwell(arguments: str, capsys: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    """Status, standard output and standard error."""
    with pytest.raises(SystemExit) as exit_info:
        cli.main(shlex.split(arguments))
    out, err = capsys.readouterr()
    assert isinstance(exit_info.value.code, int)
    return exit_info.value.code, out, err


@pytest.mark.parametrize(
    ("arguments", "phrase"),
    [
        ("verify park-cantilevr", "'park-cantilevr' is not known: did you mean park-cantilever?"),
        ("verify park-blade/surrogat", "no such blade: did you mean park-blade/surrogate?"),
        ("verify park-cantilever --codes exudyn-anfc", "'exudyn-anfc' is not known: did you mean exudyn-ancf?"),
        ("verify park-cantilever --codes ''", "code: '' is not known"),
        (
            "verify park-cantilever --codes nowhere:CODE",
            "cannot be loaded from nowhere:CODE: No module named 'nowhere'",
        ),
        ("verify park-cantilever --workers 0", "--workers"),
        ("verify park-cantilever --workers two", "--workers"),
        ("verify missing.toml", "missing.toml: no such file"),
        ("verify --nonsense", "--nonsense"),
        ("modes", "CASE"),
        ("modes no-such-case", "'no-such-case' is not known"),
        ("modes park-cantilever --omega 10 --rpm 95", "given twice: give one of them"),
        ("modes park-cantilever --omega ten", "--omega: 'ten' is neither a speed nor first:last:step, as in 0:30:5"),
        ("modes park-cantilever --rpm 30:0:5", "--rpm: '30:0:5': needs 0 ≤ first ≤ last"),
        ("modes park-cantilever --elements 0", "--elements"),
        ("modes park-cantilever --elements 1.5", "--elements"),
        ("modes park-cantilever --modes 0", "--modes"),
        ("modes park-cantilever wright-flapwise", "wright-flapwise"),
        ("modes yoo-shin-chordwise/delta-0 --omega 200", "200 rad/s"),
        (
            "report no/such/folder",
            "No such file or directory): give a folder that `southwell verify --out` has written",
        ),
        ("vrify", 'Unknown command "vrify"'),
    ],
)
def test_wrong_input_is_reported_in_one_line(arguments: str, phrase: str, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = southwell(arguments, capsys)
    assert status == 2
    assert out == ""
    assert err.startswith("southwell: ")
    assert err.count("\n") == 1
    assert phrase in err


@pytest.mark.parametrize("inside", ["taken", "taken/deeper"])
@pytest.mark.parametrize("command", ["verify", "campbell", "show"])
def test_a_folder_that_cannot_be_written_is_reported_in_one_line(
    command: str, inside: str, beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "taken").write_text("a file")
    status, _, err = southwell(f"{command} {beam} --out {tmp_path / inside}", capsys)
    assert (status, err.count("\n")) == (2, 1)
    assert "cannot be written" in err


@pytest.mark.parametrize(
    ("content", "expected", "phrase"),
    [
        ('{"kind": "cell", "nonsense": 1}\n', 2, "line 1: not a result"),
        ("not json\n", 2, "line 1: not a result"),
        ("", 3, "incomplete: contains no results"),
        ('{"kind": "ce', 3, "incomplete: contains no results"),
    ],
)
def test_unreadable_results_are_reported_in_one_line(
    content: str, expected: int, phrase: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "results.jsonl").write_text(content)
    status, _, err = southwell(f"report {tmp_path}", capsys)
    assert status == expected
    assert phrase in err
    assert err.count("\n") == 1


def test_modes_prints_the_solvers_frequencies_over_a_range_with_both_ends(
    beam: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status, out, err = southwell(f"modes {beam} --rpm 0:200:100 --elements 12 --modes 3 --json", capsys)
    assert (status, err) == (0, "")
    rows = json.loads(out)
    speeds = np.array([0.0, 100.0, 200.0]) * np.pi / 30
    blade = library.load(str(beam)).variants[0].blade
    expected = np.concatenate([modes(blade, omega, 12, 3).frequencies for omega in speeds])
    np.testing.assert_allclose([r["frequency_rad_s"] for r in rows], expected, rtol=1e-12)
    np.testing.assert_allclose([r["frequency_hz"] for r in rows], expected / (2 * np.pi), rtol=1e-12)
    np.testing.assert_allclose([r["omega_rad_s"] for r in rows], np.repeat(speeds, 3), rtol=1e-12)
    assert [r["name"] for r in rows[:3]] == ["flapwise 1", "edgewise 1", "flapwise 2"]


def test_modes_prints_frequencies_in_the_requested_unit(beam: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = southwell(f"modes {beam} --rpm 95.4929658 --modes 2", capsys)
    hertz = modes(library.load(str(beam)).variants[0].blade, 10.0, 50, 1).frequencies[0] / (2 * np.pi)
    assert "frequency, Hz" in out
    assert "95.493 rpm" in out
    (row,) = (line for line in out.splitlines() if "flapwise 1" in line)
    assert float(row.split()[-2]) == pytest.approx(hertz, rel=1e-6)


def test_modes_solves_every_blade_of_a_case_at_the_speeds_of_the_case(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = southwell("modes park-blade --modes 1 --elements 20", capsys)
    assert status == 0
    assert all(v.name in out for v in library.load("park-blade").variants)
    assert "30 rpm" in out


@pytest.mark.slow
def test_verify_writes_results_report_and_figures_and_report_rewrites_them(
    beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    codes = "exact-beam,yoo-shin,southwell.tests.support.misbehaving:ABSENT"
    status, output, _ = southwell(f"verify {beam} --codes {codes} --faults none --out {out} --workers 1", capsys)
    assert status == 0
    run = results_file.read(out / "results.jsonl")
    absent = [c for c in run.cells if c.verdict == "not run"]
    assert [(c.code, c.reason) for c in absent] == [("misbehaving", "not installed: pip install manners")] * 2
    foreign = [c for c in run.cells if c.shares != "everything" and c not in absent]
    assert {(c.code, c.omega, c.mode) for c in foreign} == {
        (code, omega, mode) for code in ("exact-beam", "yoo-shin") for omega in (0.0, 10.0) for mode in (1, 2)
    }
    assert all(c.verdict == "pass" for c in run.cells if c not in absent)
    message = f"{len(run.cells)} cells: {len(run.cells) - 2} ✔ pass, 2 ○ not run."
    assert output.splitlines()[0] == f"Yes: nothing contradicts Southwell's own solver. {message}"
    report = (out / "report.md").read_text()
    assert f"southwell verify {beam} --codes {codes}" in report
    assert "not installed: pip install manners" in report

    written = {p: p.read_bytes() for p in out.rglob("*") if p.is_file()}
    assert {p.name for p in written} >= {"results.jsonl", "report.md", "stub-campbell.svg", "stub-differences.svg"}
    for path in written:
        if path.suffix != ".jsonl":
            path.unlink()
    status, repeated, _ = southwell(f"report {out}", capsys)
    assert (status, repeated) == (0, output)
    assert {p: p.read_bytes() for p in out.rglob("*") if p.is_file()} == written


@pytest.mark.slow
def test_a_failing_code_gives_status_1(beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, output, _ = southwell(
        f"verify {beam} --codes southwell.tests.support.misbehaving:WELL_BEHAVED --faults none --out {tmp_path / 'out'}",
        capsys,
    )
    assert status == 1
    assert "4 ✘ fail" in output.splitlines()[0]


def started(beam: Path, mark: Path) -> tuple[subprocess.Popen[str], Path]:
    """A verification that has finished some cells and now waits for codes that hang; and the file of its answers."""
    out = mark / "out"
    beam.write_text(BEAM + "[variants.a]\n[variants.b]\n[variants.c]\n[variants.d]\n")  # more to do than hands
    command = [sys.executable, "-m", "southwell", "verify", str(beam), "--workers", "2", "--out", str(out)]
    command += ["--codes", "exact-beam,misbehaving:HANG", "--faults", "none"]
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2] / "support"), "SOUTHWELL_TEST": str(mark)}
    child = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        start_new_session=True,
        preexec_fn=heeding,
    )
    results_file = out / unfinished.NAME
    waited = time.monotonic() + 120
    while not any(cell.code == "exact-beam" for cell in kept_cells(results_file)):
        assert child.poll() is None
        assert time.monotonic() < waited
        time.sleep(0.1)
    assert len(killing.processes(mark)) > 2
    return child, results_file


def kept_cells(file: Path) -> tuple[Cell, ...]:
    """The cells in the file of an unfinished run, as soon as it has been begun."""
    return unfinished.read(file).cells if file.exists() else ()


def heeding() -> None:
    """Interrupts are heeded, as at a terminal, even where these tests run in the background, which ignores them."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.slow
def test_an_interrupted_run_keeps_finished_cells_and_leaves_no_process(beam: Path, tmp_path: Path) -> None:
    child, results_file = started(beam, tmp_path)
    began = time.monotonic()
    child.send_signal(signal.SIGINT)
    _, err = child.communicate(timeout=60)
    assert time.monotonic() - began < 30  # the hanging code's own limit is 300 s
    assert child.returncode == 130
    assert "Traceback" not in err
    kept = unfinished.read(results_file)
    assert f"southwell: interrupted: {len(kept.cells)} cells are kept" in err
    assert not (results_file.parent / "results.jsonl").exists()
    assert len(kept.cells) >= 4
    assert {(c.code, c.verdict) for c in kept.cells if c.shares != "everything"} == {("exact-beam", "pass")}
    assert kept.versions
    assert f"** {len(kept.cells)} cells: " in (results_file.parent / "report.md").read_text()
    assert killing.running(tmp_path) == []


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("whom", "how"),
    [
        (os.kill, signal.SIGKILL),
        (os.kill, signal.SIGTERM),
        (os.killpg, signal.SIGTERM),
    ],
)
def test_a_killed_run_leaves_no_process_and_its_results_are_incomplete(
    how: signal.Signals,
    whom: Callable[[int, int], None],
    beam: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    child, results_file = started(beam, tmp_path)
    whom(child.pid, how)
    child.communicate(timeout=30)  # the pool holds its pipes open: it must be gone, too
    assert child.returncode == -how
    assert killing.running(tmp_path) == []
    for command in ("report", "gate"):
        status, output, _ = southwell(f"{command} {results_file.parent}", capsys)
        assert status == 3
        assert output.startswith("Incomplete: cells of stub/")


def test_a_run_interrupted_before_its_first_cell_writes_no_report(
    beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(matrix, "run", interrupt)
    status, out, err = southwell(f"verify {beam} --codes exact-beam --faults none --out {tmp_path / 'out'}", capsys)
    assert (status, out, err.count("\n")) == (130, "", 1)
    assert err.startswith("southwell: interrupted: no cell was finished; run the same `southwell verify` again")
    assert not (tmp_path / "out" / "report.md").exists()


def test_cases_and_codes_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    _, output, _ = southwell("cases", capsys)
    assert all(name in output for name in library.names())
    _, output, _ = southwell("codes", capsys)
    assert all(name in output for name in names())


@pytest.mark.parametrize("command", ["", "verify", "modes", "campbell", "report", "cases", "codes"])
def test_help_lists_the_options(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = southwell(f"{command} --help", capsys)
    assert status == 0
    assert f"Usage: southwell {command}".strip() in out
    options = {
        "verify": ("--codes", "--out", "--workers"),
        "modes": ("--omega", "--rpm", "--elements", "--modes", "--json"),
        "campbell": ("--rpm", "-o", "--per-rev", "--operating", "--margin"),
    }
    assert all(option in out for option in options.get(command, ()))


def test_version_is_that_of_the_package(capsys: pytest.CaptureFixture[str]) -> None:
    assert southwell("--version", capsys)[1].strip() == version("southwell")


@pytest.mark.slow
def test_a_closed_pipe_is_no_error() -> None:
    command = f"{shlex.quote(sys.executable)} -m southwell modes park-cantilever --json | head -n 1"
    process = subprocess.run(["bash", "-c", f"set -o pipefail; {command}"], capture_output=True, text=True)
    assert (process.returncode, process.stdout) == (0, "[\n")
    assert process.stderr == ""


@pytest.mark.parametrize(
    ("arguments", "phrase"),
    [
        ("modes park-cantilever --modes 1.5", "--modes: '1.5' is not a whole number"),
        ("modes park-cantilever --elements 100000000", "--elements. Must be <= 20000"),
        ("modes park-cantilever --rpm 0:30:1e-9", "steps: give at most"),
        ("modes park-cantilever --rpm 0:1e9:1e8", "implausibly fast"),
        ("cases all", "all: unexpected argument"),
        ("verify park-cantilever --codes :CODE", "no module is named"),
        ("report {file}", "cannot be read (Not a directory)"),
        ("campbell park-cantilever --rpm 0:30:10 -o {file}/x", "is a file"),
        ("modes {folder}/a.toml", "no such file"),
        ("mechanism {folder}.toml", "cannot be read (a folder, not a file)"),
        ("condense {folder}.toml", "cannot be read (a folder, not a file)"),
        ("show {blade} --subset 1:1", "subset: ElastoDyn files have no such option, HAWC2 files do"),
        ("show {blade} --precone 95", "--precone 95: beyond ±90 degrees"),
        ("show {blade} --pitch 1e6", "--pitch 1e+06: beyond ±180 degrees"),
        ("show {blade} --length 1e300", "--length 1e+300: not a length"),
        ("show {blade} --main {blade}", "TipRad: missing"),
    ],
)
def test_former_tracebacks_are_reported_in_one_line(
    arguments: str, phrase: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Inputs that once ended in a traceback, in silence, never, or in the words of Python."""
    (tmp_path / "file").write_text("")
    (tmp_path / "folder.toml").mkdir()
    blade = Path(__file__).parents[2] / "data" / "blades" / "elastodyn_blade.dat"
    places = {"file": tmp_path / "file", "folder": tmp_path / "folder", "blade": blade}
    status, out, err = southwell(arguments.format(**places), capsys)
    assert (status, out) == (2, "")
    assert err.startswith("southwell: ")
    assert err.count("\n") == 1
    assert phrase in err
    assert "Traceback" not in err


@pytest.mark.parametrize(
    ("source", "phrase"),
    [
        ("raise RuntimeError('no licence\\nserver')\n", "RuntimeError: no licence server"),
        ("", "no attribute 'CODE'"),
    ],
)
def test_an_adapter_that_cannot_be_imported_is_reported_in_one_line(
    source: str, phrase: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    name = f"adapter{abs(hash(source))}"
    (tmp_path / f"{name}.py").write_text(source)
    monkeypatch.chdir(tmp_path)
    status, _, err = southwell(f"conform {name}:CODE", capsys)
    assert (status, err.count("\n")) == (2, 1)
    assert phrase in err
    assert "in this folder" in err


@pytest.mark.slow
@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("modulus", ["1e-300", "1e-20"])
@pytest.mark.parametrize("command", ["modes", "campbell"])
def test_implausible_stiffness_is_reported_in_one_line(
    command: str, modulus: str, beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    beam.write_text(BEAM.replace("E = 7e10", f"E = {modulus}"))
    out = f"-o {tmp_path / 'out'}" if command == "campbell" else ""
    status, _, err = southwell(f"{command} {beam} {out}", capsys)
    assert (status, err.count("\n")) == (2, 1)
    assert re.search(r"check (their |the )?units?", err)


@pytest.mark.parametrize(
    ("speed", "phrase"),
    [("0", "give speeds above 0"), ("1", "add a spring or clamp it"), ("0:2:1", "give speeds above 0")],
)
def test_a_free_hinge_without_restoring_force_is_reported(
    speed: str, phrase: str, beam: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Lead and lag on a hinge at the rotor's axis: no restoring force at any speed."""
    hinged = BEAM.replace("hub_radius = 0.1", "hub_radius = 0.0\nroot = { lag = 0.0 }")
    beam.write_text(hinged)
    status, _, err = southwell(f"modes {beam} --omega {speed}", capsys)
    assert (status, err.count("\n")) == (2, 1)
    assert phrase in err
