"""OpenFAST's primary file is followed to the blade that it names."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers import Mount
from southwell.tests.support.blade_files import assert_same

DATA = Path(__file__).parents[4] / "data" / "blades"

FST = """\
------- OpenFAST INPUT FILE -------------------------------------------
Invented machine for tests
---------------------- FEATURE SWITCHES AND FLAGS ---------------------
          {kind}   CompElast       - Compute structural dynamics (switch) {{1=ElastoDyn; 2=ElastoDyn + BeamDyn for blades}}
---------------------- INPUT FILES ------------------------------------
"{ed}"    EDFile          - Name of file containing ElastoDyn input parameters (quoted string)
"{bd}"    BDBldFile(1)    - Name of file containing BeamDyn input parameters for blade 1 (quoted string)
"unused"      BDBldFile(2)    - Name of file containing BeamDyn input parameters for blade 2 (quoted string)
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The primary file's folder, with the ElastoDyn and BeamDyn files in one below."""
    (tmp_path / "parts").mkdir()
    for name in ("elastodyn_main.dat", "elastodyn_blade.dat", "beamdyn_main.dat", "beamdyn_blade.dat"):
        shutil.copy(DATA / name, tmp_path / "parts" / name)
    return tmp_path


def primary(
    folder: Path, kind: str = "1", ed: str = r"parts\elastodyn_main.dat", bd: str = "parts/beamdyn_main.dat"
) -> Path:
    path = folder / "machine.fst"
    path.write_text(FST.format(kind=kind, ed=ed, bd=bd))
    return path


def test_a_primary_file_leads_to_elastodyns_blade(folder: Path) -> None:
    reading = readers.reading(primary(folder))
    assert_same(reading.blade, readers.read(DATA / "elastodyn_main.dat"))
    assert [p.name for p in reading.source.files] == ["machine.fst", "elastodyn_blade.dat", "elastodyn_main.dat"]
    assert "BlPitch" in {u.name for u in reading.source.unused}


def test_a_primary_file_leads_to_beamdyns_blade_on_elastodyns_hub(folder: Path) -> None:
    main = folder / "parts" / "elastodyn_main.dat"
    main.write_text(main.read_text().replace("         52   TipRad", "    42.0578   TipRad"))
    reading = readers.reading(primary(folder, "2"))
    alone = readers.read(DATA / "beamdyn_main.dat")
    np.testing.assert_array_equal(reading.blade.curve, alone.curve)
    np.testing.assert_array_equal(reading.blade.stiffness, alone.stiffness)
    assert reading.blade.hub_radius == 2.0
    assert np.degrees(reading.blade.precone) == pytest.approx(-2.5)
    assert reading.blade.tip_mass[0, 0] == 40.0


def test_a_primary_file_of_fast_8_without_compelast(folder: Path) -> None:
    path = primary(folder)
    path.write_text("\n".join(line for line in path.read_text().splitlines() if "CompElast" not in line))
    assert_same(readers.read(path), readers.read(DATA / "elastodyn_main.dat"))


def test_fast_7s_primary_file_is_the_main_file() -> None:
    reading = readers.reading(DATA / "fast7_main.fst")
    assert reading.blade.hub_radius == 1.5
    assert np.degrees(reading.blade.precone) == pytest.approx(3.0)
    assert reading.blade.curve[-1, 0] == 40.0
    assert_same(reading.blade, readers.read(DATA / "fast7_blade.dat"))  # which finds the .fst beside it


@pytest.mark.parametrize(
    ("change", "mount", "phrase"),
    [
        (
            {"kind": "3"},
            Mount(),
            r"machine.fst: line 4: CompElast: 3: only blades of ElastoDyn \(1\) and BeamDyn \(2\)",
        ),
        ({"ed": "none.dat"}, Mount(), r"machine.fst: line 6: EDFile: .*none.dat: no such file: correct the name"),
        ({"kind": "2", "bd": "unused"}, Mount(), r"machine.fst: line 7: BDBldFile1: .*unused: no such file"),
        ({}, Mount(main=DATA / "elastodyn_main.dat"), r"--main .*: the .fst file names its main file itself"),
    ],
)
def test_invalid_primary_files_are_refused(folder: Path, change: dict[str, str], mount: Mount, phrase: str) -> None:
    with pytest.raises(CaseError, match=phrase) as caught:
        readers.read(primary(folder, **change), mount)
    assert "\n" not in str(caught.value)
