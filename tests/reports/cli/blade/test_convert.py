"""``southwell convert``: what is written is read as the same blade; what a format cannot hold is refused."""

from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import library, readers
from southwell.cases.input.readers import Mount
from southwell.tests.support.blade_files import assert_same

from ..test_cli import southwell

DATA = Path(__file__).parents[3] / "data" / "blades"


MOUNT = Mount(hub_radius=2.0, precone=np.radians(-2.5), pitch=np.radians(3.0))
MOUNTED = "--hub-radius 2 --precone -2.5 --pitch 3"


@pytest.mark.parametrize(
    "file",
    ["elastodyn_main.dat", "fast7_main.fst", "beamdyn_main.dat", "beamdyn_old_main.dat", "bmodes.bmi", "hawc2.htc"],
)
def test_every_format_is_written_in_toml(tmp_path: Path, capsys: pytest.CaptureFixture[str], file: str) -> None:
    out = tmp_path / "blade.toml"
    status, output, err = southwell(f"convert {DATA / file} {out} {MOUNTED}", capsys)
    assert (status, err) == (0, "")
    assert str(out) in output
    assert_same(readers.read(out), readers.read(DATA / file, MOUNT))


@pytest.mark.parametrize("file", ["beamdyn_main.dat", "beamdyn_old_main.dat"])
def test_beamdyn_has_two_files_and_entries_of_the_main_file(
    file: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "it.dat"
    status, output, _ = southwell(f"convert {DATA / file} {out} --to beamdyn {MOUNTED}", capsys)
    assert status == 0
    assert f"{out}, {tmp_path / 'it_blade.dat'}" in output
    assert "must say HubRad = 2, PreCone(1) = -2.5; the pitch is in none of the files" in output
    assert "BlPitch(1) = -3 in OpenFAST, --pitch 3 here" in output  # OpenFAST's pitch has the other sign
    assert_same(readers.read(out, MOUNT), readers.read(DATA / file, MOUNT), 1e-12)


def test_elastodyn_has_a_table_and_entries_of_the_main_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "it.dat"
    line = f"convert {DATA / 'elastodyn_blade.dat'} {out} --to elastodyn --length 50 --hub-radius 1.5 --precone 0 --pitch 0"
    source = tmp_path / "alone.dat"  # without the main file that lies beside it
    source.write_bytes((DATA / "elastodyn_blade.dat").read_bytes())
    status, output, _ = southwell(line.replace(str(DATA / "elastodyn_blade.dat"), str(source)), capsys)
    assert status == 0
    assert "must say TipRad = 51.5, HubRad = 1.5, PreCone(1) = 0" in output
    assert "BlPitch(1) =" not in output
    mount = Mount(length=50.0, hub_radius=1.5)
    assert_same(readers.read(out, mount), readers.read(source, mount), 1e-12)


def test_one_blade_of_a_case_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, *_ = southwell(f"convert park-blade/windpact {tmp_path / 'w.toml'}", capsys)
    assert status == 0
    (blade,) = [v.blade for v in library.load("park-blade").variants if v.name == "park-blade/windpact"]
    assert_same(readers.read(tmp_path / "w.toml"), blade)


@pytest.mark.parametrize(
    ("line", "phrase"),
    [
        ("convert park-blade {out}.toml", "park-blade: 3 blades (park-blade/windpact"),
        ("convert park-cantilever {out}.dat", "out.dat: ends in .dat: give the format with --to"),
        ("convert park-cantilever {out}", "out: ends in nothing: give the format with --to"),
        ("convert park-cantilever {out}.dat --to fast", "--to"),
        ("convert park-cantilever {out}.dat --to beamdyn", "BeamDyn cannot represent rigid strains"),
        ("convert park-cantilever {out}.dat --to elastodyn", "ElastoDyn cannot represent finite stiffness in stretch"),
        ("convert {data}/elastodyn_main.dat {out}.dat --to elastodyn", "ElastoDyn cannot represent a tip mass"),
        ("convert park-cantilever {data}/hawc2.htc --to toml", "hawc2.htc: exists already: give another name"),
        ("convert park-cantilever {out}/no/such.toml", "such.toml: cannot be written (No such file or directory)"),
        ("convert nothing.dat {out}.toml", "nothing.dat: no such file"),
    ],
)
def test_invalid_input_is_one_line_and_status_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], line: str, phrase: str
) -> None:
    status, output, err = southwell(line.format(out=tmp_path / "out", data=DATA), capsys)
    assert (status, output) == (2, "")
    assert phrase in err
    assert err.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_a_curve_beginning_beside_the_root_is_refused_for_beamdyn(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    moved = (DATA / "hawc2.htc").read_text().replace("sec 1   0.00   0.00    0.0", "sec 1   0.05   0.00    0.0")
    (tmp_path / "h.htc").write_text(moved)
    (tmp_path / "hawc2_st.dat").write_bytes((DATA / "hawc2_st.dat").read_bytes())
    status, _, err = southwell(f"convert {tmp_path / 'h.htc'} {tmp_path / 'o.dat'} --to beamdyn", capsys)
    assert status == 2
    assert "BeamDyn cannot represent a curve that begins beside the root" in err
