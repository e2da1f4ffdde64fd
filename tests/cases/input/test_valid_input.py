"""Input that is right and was once refused: rounded roots, rigid shear, anchors used again, lists of speeds, percentages."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.campbell.required import required_margin
from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.tests.support.blade_files import assert_same

from ...reports.cli.test_cli import southwell
from .readers.test_readers_windio_as_beamdyn import samples, written

DATA = Path(__file__).parents[2] / "data" / "blades"


def changed(tmp_path: Path, file: str, old: str, new: str, *others: str) -> Path:
    for other in others:
        shutil.copy(DATA / other, tmp_path)
    text = (DATA / file).read_text()
    assert old in text
    (tmp_path / file).write_text(text.replace(old, new, 1))
    return tmp_path / file


POINT = "0.0000000E+00  0.0000000E+00  0.0000000E+00  1.2000000E+01"
SECTION = "sec 1   0.00   0.00    0.0  -12.0"


@pytest.mark.parametrize(
    ("file", "old", "new", "others", "first"),
    [
        ("beamdyn_main.dat", POINT, "0.0 -4.4E-16 3.6E-12 12.0", ("beamdyn_blade.dat",), "beamdyn_main.dat"),
        ("beamdyn_blade.dat", "  0.000000\n", "  4.4E-16\n", ("beamdyn_main.dat",), "beamdyn_main.dat"),
        ("elastodyn_blade.dat", "0.0000000E+00  2.5", "4.0E-16  2.5", ("elastodyn_main.dat",), "elastodyn_main.dat"),
        (
            "elastodyn_blade.dat",
            "1.0000000E+00  3.75",
            "0.9999999999999998  3.75",
            ("elastodyn_main.dat",),
            "elastodyn_main.dat",
        ),
        ("hawc2.htc", SECTION, "sec 1   0.00   0.00    3.6e-12  -12.0", ("hawc2_st.dat",), "hawc2.htc"),
    ],
)
def test_a_rounded_root_is_accepted(
    tmp_path: Path, file: str, old: str, new: str, others: tuple[str, ...], first: str
) -> None:
    changed(tmp_path, file, old, new, *others)
    assert_same(readers.read(tmp_path / first), readers.read(DATA / first), 1e-12)


def test_a_rounded_root_of_hawc2s_stations_is_accepted(tmp_path: Path) -> None:
    shutil.copy(DATA / "hawc2.htc", tmp_path)
    lines = (DATA / "hawc2_st.dat").read_text().splitlines()
    rows = [k for k, line in enumerate(lines) if line.startswith("0.000000e+00")]
    assert len(rows) == 2
    for k in rows:
        lines[k] = lines[k].replace("0.000000e+00", "3.6e-12", 1)
    (tmp_path / "hawc2_st.dat").write_text("\n".join(lines) + "\n")
    assert_same(readers.read(tmp_path / "hawc2.htc"), readers.read(DATA / "hawc2.htc"), 1e-12)


def test_a_root_away_from_zero_is_refused(tmp_path: Path) -> None:
    path = changed(tmp_path, "beamdyn_main.dat", POINT, "0.0 0.0 1.0E-6 12.0", "beamdyn_blade.dat")
    with pytest.raises(CaseError, match="kp_zr: 1e-06: the first key point is the root"):
        readers.read(path)


@pytest.mark.parametrize("version", [1, 2])
def test_windio_with_zero_shear_stiffness_is_rigid_in_shear(tmp_path: Path, version: int) -> None:
    data = samples()[version - 1]
    blade = data["components"]["blade"]
    if version == 1:
        rows = blade["elastic_properties_mb"]["six_x_six"]["stiff_matrix"]["values"]
        for row in rows:
            row[:11] = [0.0] * 11  # K11 … K16, K22 … K26
    else:
        matrix = blade["structure"]["elastic_properties"]["stiffness_matrix"]
        for key in [k for k in matrix if k.startswith(("K1", "K2"))]:
            matrix[key] = [0.0] * len(matrix[key])
    reading = readers.reading(written(tmp_path / "b.yaml", data))
    shear, rest = reading.blade.stiffness[:, [1, 2], [1, 2]], reading.blade.stiffness[:, [0, 3, 4, 5], [0, 3, 4, 5]]
    assert np.isinf(shear).all()
    assert np.isfinite(rest).all()
    assert "K11, K22 zero or not given: those strains are rigid" in reading.source.notes


def test_windio_1_with_coupled_zero_shear_is_refused(tmp_path: Path) -> None:
    data = samples()[0]
    for row in data["components"]["blade"]["elastic_properties_mb"]["six_x_six"]["stiff_matrix"]["values"]:
        row[0] = 0.0
    with pytest.raises(CaseError, match="K11 is missing, although couplings with it are given"):
        readers.read(written(tmp_path / "b.yaml", data))


def test_yaml_may_reuse_an_anchor(tmp_path: Path) -> None:
    path = written(tmp_path / "b.yaml", samples()[1])
    plain = readers.read(path)
    second = "one: &x [1, 2]\ntwo: *x\nthree: &x [3, 4]\nfour: *x\n"
    path.write_text(second + path.read_text())
    assert_same(readers.read(path), plain)
    from southwell.cases.input.readers import text, yaml_fields

    top = yaml_fields.fields(text.load(path))
    np.testing.assert_array_equal([top.get("two").numbers(), top.get("four").numbers()], [[1, 2], [3, 4]])


def test_yaml_with_an_alias_of_nothing_is_refused(tmp_path: Path) -> None:
    (tmp_path / "b.yaml").write_text("one: *x\n")
    with pytest.raises(CaseError, match="line 1: not YAML: found undefined alias"):
        readers.read(tmp_path / "b.yaml")


def test_the_rotor_speed_of_a_bmodes_file_is_used(capsys: pytest.CaptureFixture[str]) -> None:
    status, output, _ = southwell(f"modes {DATA / 'bmodes.bmi'} --modes 1 --elements 5 --json", capsys)
    assert status == 0
    (row,) = json.loads(output)
    assert row["omega_rad_s"] == pytest.approx(10 * np.pi / 30)


@pytest.mark.parametrize(
    ("text", "value"), [("10", 0.1), ("10%", 0.1), ("0.1", 0.1), ("1", 0.01), ("0.5%", 0.005), ("0", 0.0)]
)
def test_margins(text: str, value: float) -> None:
    assert required_margin(text).value == pytest.approx(value)


@pytest.mark.parametrize("text", ["100", "100%", "-1", "ten"])
def test_bad_margins(text: str) -> None:
    with pytest.raises(CaseError, match=r"--margin: .*10%(,| or) 0\.1"):
        required_margin(text, "--margin")


CABLE = """
name = "cable"
[blade]
kind = "beam"
length = 10.0
E = 1e9
G = 1e6
density = 1.0
A = 1.0
I_y = 1e-13
I_z = 2e-13
J = 1e-5
"""


@pytest.mark.parametrize("command", ["modes", "campbell"])
def test_an_unresolved_cable_wants_more_elements(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    (tmp_path / "cable.toml").write_text(CABLE)
    out = f" --out {tmp_path / 'o'}" if command == "campbell" else ""
    status, _, err = southwell(f"{command} {tmp_path / 'cable.toml'} --rpm 300,400 --elements 50{out}", capsys)
    assert status == 2
    assert "use more elements" in err
    assert "speed: 300 rpm" in err  # as typed, not 31.4159 rad/s
    assert "rad/s" not in err
    status, *_ = southwell(f"modes {tmp_path / 'cable.toml'} --rpm 300 --elements 2000 --modes 2", capsys)
    assert status == 0
