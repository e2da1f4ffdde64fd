"""The matrix in somebody else's pytest: an example project's solver passes, a wrong one fails for the right reason."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from southwell.cases.input import library
from southwell.cases.regression import history
from southwell.cases.store import results_file
from southwell.cases.verify import user_solver
from southwell.cases.verify.user_solver import UserSolver
from southwell.core.modes import Modes
from southwell.core.solve import modes
from southwell.reports.ci import pytest_plugin
from southwell.reports.verification import report as matrix_report

from ...test_packaging import ROOT, tracked

pytest_plugins = ["pytester"]

EXAMPLE = Path(__file__).parents[2] / "example_project"
assert matrix_report, pytest_plugin  # imported here, for pytester forgets what is imported first within it


@pytest.fixture
def quick(pytester: pytest.Pytester) -> pytest.Pytester:
    """A case in a file: one flapwise mode at two speeds."""
    case = (ROOT / "cases" / "data" / "wright-flapwise.toml").read_text(encoding="utf-8")
    for key, value in {"name": '"quick"', "gamma": "[0.0, 2.0]", "modes": "1", "tables": "[]"}.items():
        case = re.sub(rf"^{key} = .*$", f"{key} = {value}", case, flags=re.MULTILINE)
    (pytester.path / "quick.toml").write_text(case, encoding="utf-8")
    return pytester


@pytest.fixture
def project(pytester: pytest.Pytester) -> pytest.Pytester:
    """The example project, in a folder of its own."""
    for file in EXAMPLE.iterdir():
        if file.is_file():
            shutil.copy(file, pytester.path)
    return pytester


@pytest.mark.slow
def test_the_example_solver_passes_or_is_skipped_with_a_reason(project: pytest.Pytester) -> None:
    done = project.runpytest("--southwell-cases", "wright-flapwise,tip-mass", "-rs")
    done.assert_outcomes(passed=21, skipped=10)  # 7 speeds × 3 modes; 5 × 2
    done.stdout.fnmatch_lines(["*no twist, precone, pitch or tip mass"])


@pytest.mark.slow
def test_missing_effects_are_expected_failures(project: pytest.Pytester) -> None:
    done = project.runpytest("--southwell-cases", "park-cantilever", "-rx")
    done.assert_outcomes(passed=41, xfailed=1)
    done.stdout.re_match_lines([".*30rad_s-mode1.*no coriolis: .0.11 %.*agrees without them"])


@pytest.mark.slow
def test_the_wrong_solver_fails_at_every_speed_and_its_fault_is_named(project: pytest.Pytester) -> None:
    done = project.runpytest("test_mistaken.py", "--southwell-cases", "park-cantilever", "-rA")
    done.assert_outcomes(failed=36, passed=6)
    output = done.stdout.str()
    assert set(re.findall(r"PASSED .*-(\d+)rad_s", output)) == {"0"}  # at rest there is no mistake to see
    misses = re.findall(r"^park-cantilever at (\d+) rad/s, mode (\d) .*$", output, re.MULTILINE)
    named = re.findall(r"^park-cantilever at (\d+) rad/s, .*no geometric stiffness", output, re.MULTILINE)
    assert len(set(misses)) == 36
    assert sorted(named) == ["10"] * 6 + ["5"] * 6  # faster, core has no steady modes with that mistake to compare with
    # the beam without that stiffness at 10 rad/s: 3.353 edgewise (with rotary inertia), 10.549 flapwise, as at rest
    assert re.search(r"at 10 rad/s, mode 1 \(edgewise\): mistaken: 3.3\d+ rad/s, not 11.71", output)
    assert re.search(r"at 10 rad/s, mode 2 \(flapwise\): mistaken: 10.549\d+ rad/s, not 15.40", output)


@pytest.mark.slow
def test_the_report(project: pytest.Pytester) -> None:
    out = project.path / "out"
    project.runpytest("--southwell-cases", "wright-flapwise,tip-mass", "--southwell-report", str(out))
    run = results_file.read(out / "results.jsonl")
    core = [c for c in run.cells if c.code == "beamfreq"]
    assert len(core) == 21 + 5  # a cell for each speed of a blade that it does not solve
    assert {c.verdict for c in core} == {"pass", "not applicable"}
    assert any(c.code.startswith("beamfreq, wright1982/") and c.verdict == "pass" for c in run.cells)
    assert {s.case for s in run.settings} == {"wright-flapwise", "tip-mass"}
    assert len({(v.omega, v.mode, v.elements) for v in run.levels}) >= 3 * 21
    assert run.command.startswith("pytest --southwell-cases")
    report = (out / "report.md").read_text()
    assert "Wright et al. (1982)" in report
    assert list((out / "figures").glob("wright-flapwise-*.svg"))
    assert len(history.entry(run, "x").cells) == len(run.cells)


@pytest.mark.nightly
def test_the_report_from_several_processes(project: pytest.Pytester) -> None:
    pytest.importorskip("xdist")
    out = project.path / "out"
    options = ("-n", "2", "-k", "mode1", "--southwell-cases", "wright-flapwise", "--southwell-report", str(out))
    project.runpytest_subprocess(*options).assert_outcomes(passed=7)
    assert len([c for c in results_file.read(out / "results.jsonl").cells if c.code == "beamfreq"]) == 7


@pytest.mark.slow
def test_a_tighter_target(project: pytest.Pytester) -> None:
    done = project.runpytest("--southwell-cases", "wright-flapwise", "--southwell-target", "1e-9")
    assert done.parseoutcomes()["failed"] > 10


OFF = """
import pytest
from southwell import modes

def solve(blade, omega):
    found = modes(blade, omega, elements=60, modes=10)
    return 1.01 * found.frequencies[::-1], found.shapes[::-1]

@pytest.mark.southwell(solve=solve, cases=["quick.toml"], known={known})
def test_the_plugin_can_be_disabled(southwell_cell):
    southwell_cell.check()
"""


@pytest.mark.parametrize(
    ("known", "outcomes"),
    [
        ('{"qui*": ("a per cent too stiff", 0.012)}', {"xfailed": 2}),
        ('{"quick-2rad_s-mode1": ("a per cent too stiff", 0.012)}', {"xfailed": 1, "failed": 1}),
        ('{"qui*": ("less than that", 0.009)}', {"failed": 2}),
        ('{"park-*": ("elsewhere", 1.0)}', {"failed": 2}),
    ],
)
def test_a_known_difference_is_known_as_far_as_it_is_said_to_go(quick: pytest.Pytester, known, outcomes) -> None:
    quick.makepyfile(OFF.replace("{known}", known))
    done = quick.runpytest("-rx")
    done.assert_outcomes(**outcomes)
    if "xfailed" in outcomes:
        done.stdout.fnmatch_lines(["*known, up to 1.20 %: a per cent too stiff: +1.00 %*"])


def test_a_function_of_blade_and_speed_alone() -> None:
    case = library.load("wright-flapwise")

    def solve(blade, omega):
        solution = modes(blade, omega, 100, 12)
        return solution.frequencies, solution.shapes

    cells = [c for c in user_solver.run(UserSolver(solve), case, case.variants[0]).cells if c.role == "code"]
    assert [c.verdict for c in cells] == ["pass"] * 21
    assert max(abs(c.difference or 1.0) for c in cells) < 1e-6


@pytest.mark.slow
def test_printed_numbers_are_compared_too() -> None:
    case = library.load("wright-flapwise")

    def solve(blade, omega, elements, count):
        result: Modes = modes(blade, omega, elements, count)
        return result.frequencies * (1 + 2e-3), result.shapes

    cells = user_solver.run(UserSolver(solve, target=5e-3), case, case.variants[0]).cells
    assert {c.verdict for c in cells if c.role == "code"} == {"pass"}
    printed = [c for c in cells if c.role == "table"]
    assert len(printed) >= 15
    assert all(c.difference == pytest.approx(2e-3, abs=6e-4) for c in printed)  # printed digits, pre-stretch


@pytest.mark.parametrize(
    ("text", "phrase"),
    [
        ("return [1.0], np.zeros((1, 20, 4))", "not (frequencies, shapes): shapes: (1, 20, 4), expected (1, 21, 4)"),
        ("return [np.nan], np.ones((1, 21, 4))", "not finite"),
        ("return None", "not (frequencies, shapes)"),
        ("return [1.0], np.zeros((1, 21, 4))", "whose shape is zero"),
        ("return [], np.zeros((0, 21, 3))", "no modes"),
    ],
)
def test_an_invalid_answer_fails_with_its_reason(quick: pytest.Pytester, text: str, phrase: str) -> None:
    mark = 'import numpy as np\n@pytest.mark.southwell(solve=solve, cases=["quick.toml"])'
    body = re.sub(r"    found.*\n.*\n", f"    {text}\n", OFF).replace("def solve", "import numpy as np\ndef solve")
    quick.makepyfile(re.sub(r"@pytest.mark.*", mark, body))
    done = quick.runpytest("-x")
    done.assert_outcomes(failed=1)
    assert phrase in done.stdout.str()


def test_an_exception_of_the_solver_is_shown(quick: pytest.Pytester) -> None:
    body = re.sub(r"    found.*\n.*\n", "    return 1 / omega - 1 / omega\n", OFF)
    quick.makepyfile(body.replace("{known}", "{}"))
    done = quick.runpytest("-x")
    done.assert_outcomes(failed=1)
    done.stdout.fnmatch_lines([">*return 1 / omega - 1 / omega", "*: ZeroDivisionError*"])
    assert "ColumnError" not in done.stdout.str()


@pytest.mark.parametrize(
    ("mark", "phrase"),
    [
        ("", "uses southwell_cell but has no mark southwell"),
        ("@pytest.mark.southwell()", "missing 1 required positional argument: 'solve'"),
        ("@pytest.mark.southwell(solve=print, colour=1)", "unexpected keyword argument 'colour'"),
        ('@pytest.mark.southwell(solve=print, lacks=("weight",))', "weight"),
        ('@pytest.mark.southwell(solve=print, cases=["wright-flapwis"])', "did you mean wright-flapwise"),
    ],
)
def test_an_invalid_mark_is_reported_in_one_line(pytester: pytest.Pytester, mark: str, phrase: str) -> None:
    pytester.makepyfile(f"import pytest\n{mark}\ndef test_it(southwell_cell):\n    southwell_cell.check()\n")
    done = pytester.runpytest("--strict-markers")
    assert done.ret != 0
    output = done.stdout.str() + done.stderr.str()
    assert phrase in output
    assert "Traceback" not in output


def test_an_unknown_case_is_reported(project: pytest.Pytester) -> None:
    done = project.runpytest("--southwell-cases", "wright")
    assert done.ret != 0
    assert "did you mean wright-flapwise" in done.stdout.str() + done.stderr.str()


def test_tests_of_other_projects_are_unchanged(pytester: pytest.Pytester) -> None:
    pytester.makepyfile("def test_it():\n    pass\n")
    pytester.runpytest().assert_outcomes(passed=1)


@pytest.mark.nightly
def test_installed_in_a_clean_environment(tmp_path: Path) -> None:
    """``pip install`` of a copy of the checkout and of the example, nothing else."""
    for path in tracked():
        copy = tmp_path / "southwell" / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, copy)
    example = shutil.copytree(EXAMPLE, tmp_path / "example", ignore=shutil.ignore_patterns("__pycache__"))
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "env"], check=True)
    bin_ = tmp_path / "env" / ("Scripts" if os.name == "nt" else "bin")
    install = [bin_ / "python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    installed = subprocess.run([*install, tmp_path / "southwell", example, "pytest"], capture_output=True, text=True)
    if "No matching distribution" in installed.stderr:
        pytest.skip("no package index to install from")
    assert installed.returncode == 0, installed.stderr
    environment = {k: v for k, v in os.environ.items() if k not in {"PYTHONPATH", "PYTEST_ADDOPTS"}}

    def tests(*arguments: str) -> tuple[int, str]:
        command = [bin_ / "python", "-m", "pytest", "-q", "--southwell-cases", "wright-flapwise", *arguments]
        process = subprocess.run(command, cwd=example, capture_output=True, text=True, env=environment)
        return process.returncode, process.stdout

    status, output = tests("--southwell-report", "out")
    assert (status, "21 passed" in output) == (0, True), output
    assert (example / "out" / "report.md").exists()
    status, output = tests("test_mistaken.py")
    assert (status, "18 failed, 3 passed" in output) == (1, True), output
    assert "agrees with Southwell's own solver with this fault: no geometric stiffness" in output
