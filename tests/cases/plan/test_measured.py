"""Measured frequencies beside core: at their own speeds, never judged, refused in one line where they cannot be used."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.input.errors import CaseError
from southwell.cases.judge.cells import Head
from southwell.cases.judge.measured import Datum, measured
from southwell.cases.judge.reference import Reference
from southwell.cases.judge.results import Run
from southwell.cases.judge.witnesses import groups, witnesses
from southwell.cases.plan import user_results
from southwell.cases.plan.blade import blades
from southwell.cases.plan.user_results import Defaults, UserResults
from southwell.cases.solve.reference import references
from southwell.core.effects import ALL_EFFECTS
from southwell.reports.cli import app as cli

from ...support import matrix_runs

HEAD = "speed [rad/s], measured [rad/s], mode, uncertainty [%]\n"

# the full extensible beam at 10 rad/s, by two independent spectral solutions that agree to 1e-6
EDGEWISE, FLAPWISE = 11.710953, 15.400199

NONE = "speed [rad/s], measured [rad/s], mode\n"


def read(tmp_path: Path, text: str, defaults: Defaults | None = None, name: str = "rig") -> UserResults:
    path = tmp_path / f"{name}.csv"
    path.write_text(text, encoding="utf-8")
    return user_results.read(name, path, defaults)


def park(speeds: tuple[float, ...]):
    case = library.load("park-cantilever")
    (variant,) = case.variants
    return replace(case, variants=(replace(variant, speeds=np.array(speeds)),))


@pytest.fixture(scope="module")
def compared(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A run with two rigs at 10 rad/s, which the case does not have.

    The first is 1 % off with u_D = 2 %, and 10 % off; the second has no other mode.
    """
    folder = tmp_path_factory.mktemp("rigs")
    text = f"{HEAD}10, {1.01 * EDGEWISE:.6f}, edgewise 1, 2\n10, {0.9 * FLAPWISE:.6f}, flapwise 1, 2\n10, 900, axial 1, 2\n"
    files = [read(folder, text), read(folder, f"{HEAD}10, 71.1, flapwise 2, 2\n", name="second")]
    with ThreadPoolExecutor(1) as executor:
        return matrix_runs.solve(blades(park((0.0, 12.0))), [], executor, user_results=files, parts=False)


def test_a_measurement_is_compared_at_its_own_speed_and_not_judged(compared: Run) -> None:
    near, far, absent = (c for c in compared.cells if c.code == "rig")
    assert [(c.verdict, c.role, c.omega, c.shares) for c in (near, far)] == [("measured", "measured", 10.0, "")] * 2
    assert near.difference == pytest.approx(0.01, abs=1e-5)
    assert near.reason.startswith("model error not visible at u_val = 2.0 %: E = −0.99 %, u_val from u_num ")
    assert "u_input 0, u_D 2.00 %" in near.reason
    assert far.reason.startswith(f"model error visible (at least {100 * (1 / 0.9 - 1) - 4:.1f} %): E = +11.11 %")
    assert (absent.verdict, absent.mode) == ("not applicable", 0)
    assert not groups(witnesses(compared, "park-cantilever"))
    assert "rig" not in {w.name for w in witnesses(compared, "park-cantilever")}
    assert compared.versions["rig"] == "measured, in rig.csv"


def test_a_name_needs_no_other_mode_at_that_speed(compared: Run) -> None:
    (cell,) = (c for c in compared.cells if c.code == "second")
    assert cell.name == "flapwise 2"


@cache
def reference() -> Reference:
    (variant,) = park((10.0,)).variants
    (result,) = references(variant.blade, [10.0], library.load("park-cantilever").text.compare, {ALL_EFFECTS})[
        ALL_EFFECTS
    ]
    assert isinstance(result, Reference)
    return result


def test_the_uncertainty_of_inputs_and_that_of_data_add_as_squares() -> None:
    """The uncertainty is 2 √(3² + 4²) % of the simulated frequency; without that of the inputs it would be 6 %."""
    head = Head("park-cantilever", "rig", "measured, in rig.csv", "measured", 1e-3)
    cell = measured(head, 10.0, 0, reference(), Datum(EDGEWISE, data=0.03, inputs=0.04))
    assert cell.uncertainty == pytest.approx(0.10, rel=1e-4)
    assert "u_input 4.00 %, u_D 3.00 %" in cell.reason


def test_defaults_are_for_rows_without_their_own(tmp_path: Path) -> None:
    text = f"{HEAD.replace('mode', 'mode, input uncertainty [%]')}10, 11.7, 1, 1.5, 0.5\n10, 15.4, 2, , \n"
    own, default = read(tmp_path, text, Defaults(data=0.03, inputs=0.02)).rows
    assert (own.value.uncertainty, own.inputs) == (pytest.approx(0.005), pytest.approx(0.015))
    assert (default.value.uncertainty, default.inputs) == (0.03, 0.02)


def test_an_uncertainty_in_the_frequencys_unit(tmp_path: Path) -> None:
    (row,) = read(tmp_path, "speed [rpm], measured [Hz], mode, uncertainty [Hz]\n20, 2.5, flapwise 1, 0.05\n").rows
    assert row.value.uncertainty == pytest.approx(0.02)
    assert row.value.value == pytest.approx(5.0 * np.pi)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            NONE + "10, 11.7, 1\n",
            "line 2: uncertainty: missing for a measured frequency: add a column 'uncertainty [%]'",
        ),
        (HEAD + "10, 11.7, 1, 1\n10, 15.4, 2,\n", "line 3: uncertainty: missing"),
        (HEAD + "10, 11.7, 1, 0\n", "line 2: uncertainty [%]: '0' is not a number above 0"),
        (HEAD + "10, 11.7, 1, -1\n", "line 2: uncertainty [%]: '-1' is not a number above 0"),
        (HEAD + "10, 11.7, 1, 101\n", "line 2: uncertainty [%]: '101' is not a number above 0, and at most 100"),
        (HEAD + "10, -11.7, 1, 1\n", "line 2: measured [rad/s]: '-11.7' is not a number above 0"),
        (HEAD + "10, 0, 1, 1\n", "line 2: measured [rad/s]: '0' is not a number above 0"),
        (HEAD + "10, inf, 1, 1\n", "line 2: measured [rad/s]: 'inf' is not a number above 0"),
        (
            HEAD + "10, 11.7, 1, 1\n10, 11.8, 1, 1\n",
            "line 3: mode: 1 at this speed is in line 2 too: give their mean, and their scatter",
        ),
        (
            "speed [rpm], measured [Hz], frequency [Hz], mode\n1, 1, 1, 1\n",
            "line 1: 2 columns of frequency: give exactly one of",
        ),
        (
            "speed [rpm], measured [Hz], mode, uncertainty [rad/s]\n1, 1, 1, 1\n",
            "line 1: columns of uncertainty: uncertainty [rad/s]: give one at most, uncertainty [%] or uncertainty [Hz]",
        ),
        (
            "speed [rpm], frequency [Hz], mode, input uncertainty [%]\n1, 1, 1, 1\n",
            "line 1: column 'input uncertainty [%]' is for measured frequencies",
        ),
    ],
)
def test_an_invalid_row_is_reported_with_its_remedy(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(CaseError) as caught:
        read(tmp_path, text)
    message = str(caught.value)
    assert message.startswith(str(tmp_path / "rig.csv"))
    assert words in message
    assert "\n" not in message


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        (HEAD + "90, 11.7, 1, 1\n", (), "line 2: speed: 90 rad/s is above the highest speed of park-cantilever"),
        (NONE + "10, 11.7, 1\n", ("--data-uncertainty", "much"), "--data-uncertainty: 'much' is not a percentage"),
        (NONE + "10, 11.7, 1\n", ("--data-uncertainty", "0"), "--data-uncertainty: '0': needs more than 0"),
        (
            NONE.replace("measured", "frequency") + "10, 11.7, 1\n",
            ("--input-uncertainty", "1%"),
            "no file of --add has",
        ),
    ],
)
def test_measurements_outside_the_run_are_bad_input(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, options: tuple[str, ...], words: str
) -> None:
    path = tmp_path / "rig.csv"
    path.write_text(text)
    arguments = ["verify", "park-cantilever", "--codes", "yoo-shin", "--add", f"rig={path}", *options]
    with pytest.raises(SystemExit) as exit_info:
        cli.main([*arguments, "--out", str(tmp_path / "out")])
    assert exit_info.value.code == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert words in line
    assert not (tmp_path / "out").exists()
