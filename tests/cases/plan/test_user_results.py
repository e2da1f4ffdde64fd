"""Results without an adapter: read with their rounding, judged like any code's, refused in one line."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.input.errors import CaseError
from southwell.cases.judge.cells import Head
from southwell.cases.judge.convergence import RefinedMode
from southwell.cases.judge.pairing import Pair
from southwell.cases.judge.reference import Converged, Reference
from southwell.cases.judge.results import Cell, Run
from southwell.cases.judge.spectrum import of_blade
from southwell.cases.judge.uncertainty import Estimate
from southwell.cases.judge.witnesses import witnesses
from southwell.cases.plan import names, user_columns, user_results
from southwell.cases.plan.blade import blades
from southwell.cases.plan.subject import speeds_of_blades
from southwell.cases.verify import measurements
from southwell.core.modes import Modes
from southwell.core.participation import numbered
from southwell.references.protocol import registry
from southwell.references.protocol.description import describe
from southwell.references.protocol.interface import BladeAdapter

from ...support import matrix_runs

HEAD = "speed [rad/s], frequency [rad/s], mode\n"

# the full extensible beam, by two independent spectral solutions that agree to 1e-6
EXACT = {"edgewise 1": 11.710953, "flapwise 1": 15.400199, "edgewise 2": 70.419355, "flapwise 2": 71.126584}


def read(tmp_path: Path, text: str, name: str = "rig") -> user_results.UserResults:
    path = tmp_path / "results.csv"
    path.write_text(text, encoding="utf-8")
    return user_results.read(name, path)


def park(speeds: tuple[float, ...] = (0.0, 10.0)):
    case = library.load("park-cantilever")
    (variant,) = case.variants
    return replace(case, variants=(replace(variant, speeds=np.array(speeds)),))


EXACT_SPEED = 7.0
"""A speed between those of the case, rad/s."""

LINES = [f"10, {value:.6f}, {name}" for name, value in EXACT.items()]

FILES = {
    "rig": HEAD + "\n".join([*LINES[:2], f"10, {EXACT['edgewise 2']:.1f}, edgewise 2", "10, 71.30, flapwise 2", "10, 190.1, 6",
                             "10, 800, axial 1"]),
    "few digits": HEAD + "10, 11.7, edgewise 1",
    "rounded speed": "speed [rpm], frequency [rad/s], mode\n95.49, 15.400199, flapwise 1\n",
}  # fmt: skip


@pytest.fixture(scope="module")
def judged(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A run with all files, and two more at a speed that the case does not have: an exact number, and one 1 % larger."""
    code, blade = registry.code("exact-beam"), library.load("park-cantilever").variants[0].blade
    assert isinstance(code, BladeAdapter)
    exact = float(code.solve(blade, EXACT_SPEED, code.levels[-1], 2).frequencies[0])
    texts = {
        **FILES,
        "between": HEAD + f"7, {exact:.7f}, 1\n10, {EXACT['edgewise 1']:.6f}, edgewise 1",
        "too large": HEAD + f"7, {1.01 * exact:.7f}, 1",
    }
    files = [read(tmp_path_factory.mktemp("file"), text, name) for name, text in texts.items()]
    with ThreadPoolExecutor(1) as executor:
        return matrix_runs.solve(blades(park()), ["yoo-shin"], executor, user_results=files, parts=False)


def of(run: Run, name: str = "rig") -> list[Cell]:
    return [c for c in run.cells if c.code == name]


def test_units_and_digits(tmp_path: Path) -> None:
    text = "frequency [Hz], speed [rpm], mode, family # any order\n\n1.50, 30, 2, flapwise\n4e1, 0, 3,\n"
    first, second = read(tmp_path, text).rows
    assert (first.family, first.mode, first.line, first.blade) == ("flapwise", 2, 3, "")
    assert first.omega == pytest.approx(math.pi)
    assert first.value.value == pytest.approx(3 * math.pi)
    assert first.value.uncertainty == pytest.approx(0.005 / 1.5)
    assert first.slack == pytest.approx(0.5 * math.pi / 30)
    assert (second.family, second.mode) == ("", 3)
    assert second.value.uncertainty == pytest.approx(5 / 40)


def test_families_by_the_names_that_others_use(tmp_path: Path) -> None:
    rows = read(tmp_path, HEAD + "10, 11.7, chordwise 1\n10, 70, lag 2\n10, 15.4, flap 1\n10, 1, torsion 1").rows
    assert [(r.family, r.mode) for r in rows] == [("edgewise", 1), ("edgewise", 2), ("flapwise", 1), ("torsion", 1)]


def test_a_given_uncertainty_takes_the_place_of_the_digits(tmp_path: Path) -> None:
    text = "speed [gamma], frequency [gamma], mode, uncertainty [%]\n2, 3.6, edgewise 1, 0.5\n2, 3.6, flapwise 1,\n"
    first, second = read(tmp_path, text).rows
    assert first.value.uncertainty == pytest.approx(5e-3)
    assert second.value.uncertainty == pytest.approx(0.05 / 3.6)


@pytest.mark.slow
def test_numbers_are_judged_as_a_codes_are(judged: Run) -> None:
    cells = of(judged)
    assert [c.verdict for c in cells] == ["pass", "pass", "pass", "fail", "pass", "not applicable"]
    assert [f"{c.family} {c.mode}" for c in cells[:5]] == [
        "edgewise 1",
        "flapwise 2",
        "edgewise 3",
        "flapwise 4",
        "flapwise 6",
    ]
    assert {c.shares for c in cells} == {"nothing"}
    assert cells[2].uncertainty == pytest.approx(0.05 / 70.4, rel=1e-2)
    assert cells[3].difference == pytest.approx(71.30 / EXACT["flapwise 2"] - 1.0, abs=1e-6)
    assert "line 7: the case does not compare mode axial 1 at this speed; it compares edgewise 1" in cells[5].reason


@pytest.mark.slow
def test_few_digits_are_inconclusive_and_not_a_pass(judged: Run) -> None:
    """11.7 is 11.7 ± 0.05: 0.43 %, which is more than the target and says nothing within it."""
    (cell,) = of(judged, "few digits")
    assert cell.verdict == "inconclusive"
    assert cell.uncertainty == pytest.approx(0.05 / 11.7, rel=1e-3)


@pytest.mark.slow
def test_a_rounded_speed_is_matched_and_adds_uncertainty(judged: Run) -> None:
    """10 rad/s are 95.4930 rpm; printed as 95.49 the speed is off by 3e-5, and so may the frequency be."""
    (cell,) = of(judged, "rounded speed")
    off = 10.0 / (95.49 * math.pi / 30) - 1.0
    assert cell.omega == 10.0
    assert cell.uncertainty == pytest.approx(abs(off) + 0.5e-6 / 15.4, rel=1e-2)
    assert cell.verdict == "pass"


@pytest.mark.slow
def test_a_speed_between_those_of_the_case_is_solved_too(judged: Run) -> None:
    """At 7 rad/s, by the closed form of the exact beam; a value 1 % larger is a failure."""
    assert [(c.omega, c.verdict) for c in of(judged, "between")] == [(EXACT_SPEED, "pass"), (10.0, "pass")]
    assert [(c.omega, c.verdict) for c in of(judged, "too large")] == [(EXACT_SPEED, "fail")]


@pytest.mark.slow
def test_added_results_declare_no_origin_and_are_in_no_group(judged: Run) -> None:
    (rounded,) = (w for w in witnesses(judged, "park-cantilever") if w.name == "rounded speed")
    assert (rounded.kind, rounded.standing) == ("undeclared", "agrees")
    assert judged.versions["rig"] == "results in results.csv"


def test_the_output_of_bmodes_is_read_with_the_speed_of_its_input(tmp_path: Path) -> None:
    """As BModes 3.00 prints it; 0.6711E+00 Hz is known to half a unit of its last digit."""
    path = tmp_path / "blade.out"
    path.write_text(
        "BModes v3.00\n rotating blade frequencies\n -------- Mode No.   1  (freq =   0.6711E+00 Hz)\n 0.0 0.0\n"
        " -------- Mode No.   2  (freq =   0.1087E+01 Hz)\n"
    )
    with pytest.raises(CaseError, match=r"blade\.bmi is not beside it"):
        user_results.read("bmodes", path)
    (tmp_path / "blade.bmi").write_text("1 beam_type\n12.1   rot_rpm: rotor speed\n")
    first, second = user_results.read("bmodes", path).rows
    assert (first.mode, second.mode, first.family) == (1, 2, "")
    assert first.omega == pytest.approx(12.1 * math.pi / 30)
    assert first.value.value == pytest.approx(2 * math.pi * 0.6711)
    assert first.value.uncertainty == pytest.approx(0.5e-4 / 0.6711)
    assert second.value.uncertainty == pytest.approx(0.5e-3 / 1.087)


BAD = [
    ("", "empty: check that it was written"),
    (HEAD, "only a header"),
    ("speed [rad/s], frequency [rad/s]\n10, 11.7\n", "line 1: column 'mode' is missing"),
    (
        "speed [m/s], frequency [Hz], mode\n1, 1, 1\n",
        r"line 1: unknown column 'speed [m/s]': did you mean speed [rad/s]",
    ),
    ("speed [rpm], frequency, mode\n1, 1, 1\n", "line 1: unknown column 'frequency'"),
    ("frequency [Hz], mode\n1, 1\n", "line 1: 0 columns of speed: give exactly one of speed [rad/s]"),
    ("speed [rpm], speed [rad/s], frequency [Hz], mode\n1, 1, 1, 1\n", "line 1: 2 columns of speed"),
    ("speed [rpm], mode, frequency [Hz], mode\n1, 1, 1, 1\n", "line 1: column 'mode' occurs 2 times"),
    (HEAD + "10, 11.7\n", "line 2: 2 columns instead of 3: check for a missing or stray comma"),
    (HEAD + "10, 11,7, edgewise 1\n", "line 2: 4 columns instead of 3"),
    (HEAD + "ten, 11.7, edgewise 1\n", "line 2: speed [rad/s]: 'ten' is not a number, 0 or more"),
    (HEAD + "-10, 11.7, edgewise 1\n", "line 2: speed [rad/s]: '-10' is not a number, 0 or more"),
    (HEAD + "10, 0.0, edgewise 1\n", "line 2: frequency [rad/s]: '0.0' is not a number above 0"),
    (HEAD + "10, nan, edgewise 1\n", "line 2: frequency [rad/s]: 'nan' is not a number above 0"),
    (HEAD + "10, , edgewise 1\n", "line 2: frequency [rad/s]: '' is not a number above 0"),
    (HEAD + "10, 11.7, flapways 1\n", "line 2: mode: 'flapways' is no family: did you mean flapwise?"),
    (HEAD + "10, 11.7, edgewise\n", "line 2: mode: 'edgewise': give a family and a whole number"),
    (HEAD + "10, 11.7, edgewise 0\n", "line 2: mode: '0': give"),
    (HEAD + "10, 11.7, 1.5\n", "line 2: mode: '1.5': give"),
    (
        HEAD + "# note\n10, 11.7, edgewise 1\n10, 11.8, edgewise 1\n",
        "line 4: mode: edgewise 1 at this speed is in line 3",
    ),
]


@pytest.mark.parametrize(("text", "words"), BAD)
def test_an_invalid_file_is_reported_in_one_line(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(CaseError) as caught:
        read(tmp_path, text)
    message = str(caught.value)
    assert message.startswith(str(tmp_path / "results.csv"))
    assert words in message
    assert "\n" not in message


def test_a_missing_or_binary_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=r"none\.csv: no such file: give NAME=FILE\.csv"):
        user_results.read("rig", tmp_path / "none.csv")
    (tmp_path / "binary.csv").write_bytes(b"\x7f\xfe\x00\x01")
    with pytest.raises(CaseError, match="not a text file"):
        user_results.read("rig", tmp_path / "binary.csv")


NOT_OF_THE_RUN = [
    (
        "park-cantilever",
        HEAD + "31, 11.7, edgewise 1\n",
        "line 2: speed: 31 rad/s is above the highest speed of park-c",
    ),
    ("park-blade", HEAD + "0, 5.8, flapwise 1\n", "line 2: blade: not given, and the run has 3: add a column"),
    (
        "park-blade",
        HEAD.replace("mode", "mode, blade") + "0, 5.8, flapwise 1, park-blade/windpakt\n",
        "line 2: blade: 'park-blade/windpakt' is not in this run: did you mean park-blade/windpact?",
    ),
]


@pytest.mark.parametrize(("case", "text", "words"), NOT_OF_THE_RUN)
def test_rows_of_other_blades_or_speeds_are_bad_input(tmp_path: Path, case: str, text: str, words: str) -> None:
    with pytest.raises(CaseError) as caught:
        user_results.check([read(tmp_path, text)], speeds_of_blades(blades(library.load(case))))
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("add", ["results.csv", "=results.csv", "rig="])
def test_a_name_and_a_file_are_needed(add: str) -> None:
    with pytest.raises(CaseError, match=f"--add {add}: give a name and a file, as in --add rig=results.csv"):
        measurements.user_results(add, measurements.defaults(None, None))


def test_a_file_cannot_have_the_name_of_a_code(tmp_path: Path) -> None:
    rig = read(tmp_path, HEAD + "10, 11.7, edgewise 1\n", "yoo-shin")
    with pytest.raises(CaseError, match="code: 'yoo-shin' is given twice, by --codes yoo-shin and by --add "):
        names.unique(blades(park()), describe(["yoo-shin"], []), [rig])


def test_two_files_cannot_have_one_name(tmp_path: Path) -> None:
    content = read(tmp_path, HEAD + "10, 11.7, edgewise 1\n")
    with pytest.raises(CaseError, match=r"code: 'rig' is given twice, by --add .* and by --add "):
        names.unique(blades(park()), describe(["yoo-shin"], []), [content, content])


def hand_made(names: tuple[str, ...], frequencies: tuple[float, ...]) -> Reference:
    """Core's modes at one speed, known by name and frequency only."""
    values = np.array(frequencies)
    spectrum = of_blade(Modes(1.0, values, np.zeros((len(names), 21, 4), complex), 10), np.zeros((21, 4, 4)))
    labelled, indices = replace(spectrum, labels=numbered(names)), tuple(range(len(names)))
    modes = tuple(RefinedMode(Estimate(f, 1e-9), Pair(k, 1.0), ()) for k, f in enumerate(frequencies))
    return Reference(Converged(labelled, indices, modes, names), frequencies, (1.0,) * len(names), ((),) * len(names))


@pytest.mark.parametrize(
    ("families", "verdict"),
    [(("mixed", "mixed", "flapwise"), "inconclusive"), (("edgewise", "torsion", "flapwise"), "fail")],
)
def test_a_family_is_a_convention_only_where_core_has_mixed_modes(
    tmp_path: Path, families: tuple[str, ...], verdict: str
) -> None:
    """5.355 is core's second mode, named flapwise: an error, unless core itself cannot name a mode."""
    core = [(1.0, hand_made(families, (5.2, 5.355, 7.8)))]
    head = Head("blade", "rig", "from results.csv", "code", 1e-3, "nothing")
    rows = read(tmp_path, HEAD + "1.0000, 5.35500, flapwise 1\n1.0000, 5.35500, 2").rows
    rows = [*rows, *read(tmp_path, HEAD + "1.0000, 6.50000, flapwise 1").rows]
    blade = library.load("park-cantilever").variants[0].blade
    (names, numbered, altered), _ = user_columns._rows(
        user_columns._of_a_program, head, blade, park().text.compare, rows, core
    )
    assert [c.verdict for c in (names, altered, numbered)] == [verdict, "fail", "pass"]
    if verdict == "inconclusive":
        assert "not that of flapwise 1 but of mixed 2" in names.reason
        assert "number among all modes" in names.reason
