"""Tables of modes: what is read, multiples of the rotor speed, modes over operating points."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input.errors import CaseError
from southwell.cases.linearisation import hawcstab2, mode_tables
from southwell.cases.linearisation.judgement import judge, judge_set
from southwell.cases.linearisation.lin_file import parsed
from southwell.cases.linearisation.sets import azimuth_set
from southwell.cases.linearisation.tracking import drift, track
from southwell.tests.support.linearised_defects import healthy
from southwell.tests.support.linearised_machines import Machine

CSV = "rpm,mode,frequency_hz,damping_ratio\n" + "".join(
    f"{rpm},tower,{0.33},0.01\n{rpm},flap,{0.65 + 0.002 * rpm:.6f},0.4\n{rpm},spurious,{3 * rpm / 60:.6f},0.0\n"
    for rpm in (6, 8, 10, 12)
)
CMB = "# Mode number: 1 2\n 4.0 0.33 0.66 1.0 40.0\n 8.0 0.33 0.67 -0.5 41.0\n"


def test_a_multiple_of_the_rotor_speed_is_no_mode(tmp_path: Path) -> None:
    path = tmp_path / "modes.csv"
    path.write_text(CSV)
    judgement = judge([path])
    lines = [finding for finding in judgement.findings if finding.name == "order line"]
    assert [(line.value, line.observation.split(" is ")[0]) for line in lines] == [(3.0, "spurious")]
    assert judgement.verdict == "No"
    path.write_text("\n".join(line for line in CSV.splitlines() if "spurious" not in line))
    assert judge([path]).verdict == "Open"


def test_eigenvalues_are_read(tmp_path: Path) -> None:
    path = tmp_path / "modes.csv"
    path.write_text("omega_rad_s;mode;real_rad_s;imag_rad_s\n1.0;tower;-0.3;0.4\n")
    table = mode_tables.read_csv(path)
    assert table.frequencies[0, 0] == pytest.approx(0.5 / (2 * np.pi))
    assert table.damping[0, 0] == pytest.approx(0.6)


def test_a_table_of_hawcstab2_is_read(tmp_path: Path) -> None:
    path = tmp_path / "turbine.cmb"
    path.write_text(CMB)
    table = hawcstab2.read(path)
    assert table.unit == "m/s"
    assert table.frequencies.tolist() == [[0.33, 0.33], [0.66, 0.67]]
    assert table.damping.tolist() == [[0.01, -0.005], [0.4, 0.41]]
    assert "negative damping" in {finding.name for finding in judge([path]).findings}


def amplitudes(largest: list[int], points: tuple[float, ...] = (4.0, 8.0)) -> str:
    """An ``.amp`` file of HAWCStab2 whose mode k moves with amplitude 2 in motion ``largest[k]`` and 1 in the next."""
    head = "# Mode number\n# Column num.\n#\n#\n# Wind speed\n"
    values = np.zeros((len(largest), len(hawcstab2.MOTIONS), 2))
    for k, motion in enumerate(largest):
        values[k, motion, 0], values[k, motion - 1, 0] = 2.0, 1.0
    values[:, :, 1] = 90.0
    return head + "".join(f"{point} {' '.join(map(str, values.ravel()))}\n" for point in points)


def test_the_amplitudes_of_hawcstab2_name_its_modes(tmp_path: Path) -> None:
    """The second motion of the file is fore-aft, the eleventh backward flap; the share is 2² / (2² + 1²)."""
    (tmp_path / "turbine.cmb").write_text(CMB)
    (tmp_path / "turbine.amp").write_text(amplitudes([1, 10]))
    (table,) = judge([tmp_path / "turbine.amp", tmp_path / "turbine.cmb"]).tables
    assert table.names == ("tower fore-aft 1", "flapwise 1 backward")
    assert table.shares == pytest.approx((0.8, 0.8))
    (tmp_path / "turbine.amp").write_text(amplitudes([5, 5]))
    assert hawcstab2.read(tmp_path / "turbine.cmb", tmp_path / "turbine.amp").names == ("drivetrain 1", "drivetrain 2")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (amplitudes([1]), "31 numbers in a row, expected 61"),
        (amplitudes([1, 10], (4.0, 9.0)), "its wind speeds differ"),
        (amplitudes([1, 10]).replace("2.0", "0").replace("1.0", "0"), "mode 1 has no amplitude"),
        ("#\n", "0 numbers in a row"),
    ],
)
def test_amplitudes_of_another_analysis_are_refused(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "turbine.cmb").write_text(CMB)
    (tmp_path / "turbine.amp").write_text(text)
    with pytest.raises(CaseError, match=words):
        judge([tmp_path / "turbine.cmb", tmp_path / "turbine.amp"])
    with pytest.raises(CaseError, match=r"amplitudes without frequencies: give turbine\.cmb"):
        judge([tmp_path / "turbine.amp"])


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("a.csv", "speed,f\n1,2\n", "a table of modes has the columns"),
        ("a.csv", "rpm,mode,frequency_hz\n1,a,nan\n", "line 2: frequency_hz: 'nan' is not a finite number"),
        ("a.csv", "rpm,mode,frequency_hz\n1,a\n", "2 fields instead of 3"),
        ("a.csv", "rpm,mode,frequency_hz\n1,a,2\n1,a,3\n", "given twice"),
        ("a.csv", "rpm,mode,frequency_hz\n", "a header without rows"),
        ("a.cmb", "# none\n1 2 3\n", "not a .cmb file"),
        ("a.cmb", "# 3\n1 2 3\n", "3 numbers for 3 modes"),
        ("a.cmb", "# 1\n1 2 3\n1 2\n", "2 numbers instead of 3"),
        ("a.cmb", "# 1\n1 2 inf\n", "not a row of finite numbers"),
    ],
)
def test_tables_that_cannot_be_used_are_refused(tmp_path: Path, name: str, text: str, words: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(CaseError, match=words.replace(".", r"\.")):
        judge([tmp_path / name])


def test_modes_are_tracked_by_shape() -> None:
    """Tower modes cross flapwise ones from 0.3 to 2 rad/s; rows stay with their motions."""
    sets = []
    for omega in (0.3, 1.0, 2.0):
        lins = healthy(Machine(omega=omega, gravity=0.0, tower=(0.9, 0.33)), 3)
        sets.append(judge_set(azimuth_set("a", [parsed(Path(f"a.{k}.lin"), lin.text()) for k, lin in enumerate(lins)])))
    rows = track(sets)
    assert len(rows) == 13
    tower = next(row for row in rows if row.name.startswith("tower side-side"))
    assert [mode.frequency for mode in tower.at if mode] == pytest.approx([0.33, 0.33, 0.33], rel=0.05)
    assert all(mode is not None for row in rows for mode in row.at)


def test_versions_that_differ_between_operating_points_are_noted() -> None:
    sets = [
        judge_set(azimuth_set(name, [parsed(Path(f"{name}.1.lin"), replace(healthy(n=1)[0], version=version).text())]))
        for name, version in (("a", "v3.5.1"), ("b", "v4.0.0"))
    ]
    assert [finding.name for finding in drift(sets)] == ["version drift"]
    assert not drift(sets[:1])
