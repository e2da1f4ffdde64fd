"""The IEA-15 as HAWC2 and as BeamDyn has it: other axes, centres, reference lines and senses of twist, one blade.

HAWC2's model has the half-chord line, x to the leading edge, and twist from x to y; BeamDyn's has the pitch axis, y to the
trailing edge, and twist against it. Whatever is converted wrongly at either door shows in the frequencies. The files differ
in their sections' grids and, beyond the manual, in what the radii of gyration are about: torsion is 4 % apart and left out.
"""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.cases import data as cases_data
from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.properties import about_root
from southwell.cases.input.readers import Mount, text
from southwell.cases.input.readers.hawc2.bodies import matches_format
from southwell.core.blade import Blade
from southwell.core.solve import modes
from southwell.tests.support.blade_files import real

DATA = Path(__file__).parents[3] / "data" / "blades"
HUB = Mount(hub_radius=3.97, precone=np.radians(-4.0))
RATED = 7.56 * np.pi / 30
BENDING = 5
"""Modes below the first torsion, at 4.1 Hz."""


@pytest.fixture
def blades(tmp_path: Path) -> tuple[Blade, Blade]:
    """By HAWC2, by BeamDyn."""
    published = ("IEA_15MW_RWT_Blade_st_FPM.st", "IEA-15-240-RWT_BeamDyn_blade.dat")
    own_files = [*DATA.glob("iea15*"), Path(cases_data.__file__).with_name("iea15_beamdyn_main.dat")]
    for file in [real(f"iea15/{name}") for name in published] + own_files:
        shutil.copy(file, tmp_path)
    return readers.read(tmp_path / "iea15.htc", HUB), readers.read(tmp_path / "iea15_beamdyn_main.dat", HUB)


def hertz(blade: Blade, omega: float) -> np.ndarray:
    return modes(blade, omega, 30, BENDING).frequencies / (2 * np.pi)


@pytest.mark.parametrize("omega", [0.0, RATED])
def test_frequencies_agree(blades: tuple[Blade, Blade], omega: float) -> None:
    hawc2, beamdyn = (hertz(blade, omega) for blade in blades)
    np.testing.assert_allclose(hawc2, beamdyn, rtol=3e-3)


def test_frequencies_with_reversed_twist_differ(blades: tuple[Blade, Blade]) -> None:
    hawc2, beamdyn = blades
    altered = hertz(replace(hawc2, twist=-hawc2.twist), 0.0) / hertz(beamdyn, 0.0) - 1
    assert np.abs(altered[:2]).max() > 8e-3


def test_mass_and_its_centre_agree(blades: tuple[Blade, Blade]) -> None:
    """Centres in the blade's axes: the half-chord line lies up to 1 m behind the pitch axis."""
    hawc2, beamdyn = (about_root(blade) for blade in blades)
    assert hawc2.mass == pytest.approx(beamdyn.mass, rel=2e-3)
    np.testing.assert_allclose(hawc2.centre, beamdyn.centre, atol=0.02)
    assert hawc2.centre[1] < -0.3


def test_the_half_chord_line_may_begin_beside_the_axis(blades: tuple[Blade, Blade]) -> None:
    np.testing.assert_allclose(blades[0].curve[0], [0.0, 0.02277, -0.00635], atol=1e-12)
    assert blades[0].length == pytest.approx(117.18, abs=0.05)  # where the structural file ends


@pytest.mark.parametrize(
    ("old", "new", "phrase"),
    [
        ("./iea15_bodies.htc", "./nowhere.htc", r"iea15.htc: line 2: continue_in_file: ./nowhere.htc: not found"),
        (
            "./iea15_bodies.htc",
            "./iea15.htc",
            r"iea15.htc: line 2: continue_in_file: files are nested more than 10 deep",
        ),
        ("./iea15_bodies.htc ;", ";", r"iea15.htc: line 2: continue_in_file: no name: add it"),
    ],
)
def test_files_to_go_on_in_that_are_not_there(tmp_path: Path, old: str, new: str, phrase: str) -> None:
    path = tmp_path / "iea15.htc"
    path.write_text((DATA / "iea15.htc").read_text().replace(old, new))
    with pytest.raises(CaseError, match=phrase):
        readers.read(path)


def test_a_part_of_an_htc_with_the_bodies_is_one() -> None:
    assert matches_format(text.load(DATA / "iea15_bodies.htc"))
