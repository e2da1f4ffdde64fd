"""The hub radius of a blade that turns is read from the files or given, never assumed."""

import shutil
from pathlib import Path

import numpy as np
import pytest

import southwell
from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers import Mount
from southwell.reports.cli.app import main

DATA = Path(__file__).parents[3] / "data" / "blades"

HUB = """
  begin main_body;
    name hub1 ;
    begin c2_def;
      nsec 2 ;
      sec 1 0.0 0.0 0.0 0.0 ;
      sec 2 0.0 0.0 {radius} 0.0 ;
    end c2_def ;
  end main_body;
"""
ORIENTATION = """
  begin orientation;
    begin base;
      body tower;
      body_eulerang 0.0 0.0 0.0;
    end base;
    begin relative;
      body1 tower last;
      body2 shaft 1;
      body2_eulerang 90.0 0.0 0.0;
      body2_eulerang 5.0 0.0 0.0;  tilt
      mbdy2_ini_rotvec_d1 0.0 0.0 -1.0 0.2 ;
    end relative;
    begin relative;
      body1 shaft last;
      body2 hub1 1;
      body2_eulerang -90.0 0.0 0.0;
      body2_eulerang 0.0 {azimuth} 0.0;
      body2_eulerang {cone} 0.0 0.0;
    end relative;
    begin relative;
      mbdy1 hub1 last;
      mbdy2 blade1 1;
      mbdy2_eulerang 0.0 0.0 {pitch};
    end relative;
  end orientation;
"""


def htc(folder: Path, radius: float = 2.8, azimuth: float = 180.0, cone: float = 2.5, pitch: float = 0.0) -> Path:
    """The test's blade on a rotor with the layout of the DTU 10 MW turbine (Bak et al., DTU Wind Energy I-0092, 2013)."""
    shutil.copy(DATA / "hawc2_st.dat", folder)
    before, end, after = (DATA / "hawc2.htc").read_text().rpartition("end new_htc_structure;")
    path = folder / "rotor.htc"
    filled = ORIENTATION.format(azimuth=azimuth, cone=cone, pitch=pitch)
    path.write_text(before + HUB.format(radius=radius) + filled + end + after)
    return path


@pytest.mark.parametrize("azimuth", [180.0, 60.0, -60.0])
def test_an_htc_gives_hub_radius_and_precone(tmp_path: Path, azimuth: float) -> None:
    """The DTU 10 MW rotor: a hub of 2.8 m, the blades coned by 2.5° upwind, which is negative here; for each of its blades."""
    reading = readers.reading(htc(tmp_path, azimuth=azimuth))
    assert reading.unstated == ()
    assert reading.blade.hub_radius == pytest.approx(2.8, rel=1e-12)
    assert np.degrees([reading.blade.precone, reading.blade.pitch]) == pytest.approx([-2.5, 0.0], abs=1e-9)
    assert any("hub_radius 2.8 m, precone -2.5°" in note for note in reading.source.notes)


def test_a_blade_turned_in_its_bearing_is_pitched(tmp_path: Path) -> None:
    """HAWC2's rotation about z turns x (to the leading edge) towards y (downwind): positive here too."""
    assert np.degrees(readers.read(htc(tmp_path, cone=0.0, pitch=3.0)).pitch) == pytest.approx(3.0)


def test_an_option_counts_more_than_the_htc(tmp_path: Path) -> None:
    blade = readers.read(htc(tmp_path), Mount(hub_radius=1.0, precone=0.0))
    assert (blade.hub_radius, blade.precone) == (1.0, 0.0)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("mbdy2_ini_rotvec_d1", "; "),
        ("sec 2 0.0 0.0 2.8 0.0", "sec 2 0.5 0.0 2.8 0.0"),
        ("body2_eulerang -90.0", "body2_eulerpar 1 -90.0"),
        ("mbdy1 hub1 last", "mbdy1 hub1 2"),
        ("mbdy1 hub1 last", "mbdy1 nowhere last"),
    ],
)
def test_an_orientation_that_does_not_define_the_hub_is_not_guessed(tmp_path: Path, old: str, new: str) -> None:
    path = htc(tmp_path)
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    assert "hub_radius" in readers.reading(path).unstated
    with pytest.raises(
        CaseError,
        match=r"rotor.htc: hub_radius: not in the files read \(HAWC2\), but required at speed: .*--hub-radius",
    ):
        southwell.read(path)


@pytest.mark.parametrize("name", ["beamdyn_main.dat", "hawc2.htc", "elastodyn_blade.dat"])
def test_a_turning_blade_needs_a_hub_radius(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for file in DATA.glob("*"):
        if file.name != "elastodyn_main.dat":
            shutil.copy(file, tmp_path)
    length = ["--length", "50"] if name.startswith("elastodyn") else []
    path, hub = str(tmp_path / name), ["--hub-radius", "0"]
    for command, status in (
        (["modes", path, "--rpm", "5"], 2),
        (["campbell", path, "--rpm", "0:5:5", "-o", str(tmp_path / "out")], 2),
        (["convert", path, str(tmp_path / "out.toml")], 2),
        (["show", path], 0),
        (["modes", path, "--rpm", "0", "--modes", "1", "--elements", "4"], 0),
        (["modes", path, "--rpm", "5", "--modes", "1", "--elements", "4", *hub], 0),
    ):
        with pytest.raises(SystemExit, match=f"^{status}$"):
            main([*command, *length])
        err = capsys.readouterr().err
        assert not status or ("--hub-radius" in err and err.count("\n") == 1)
