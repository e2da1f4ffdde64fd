"""Towers in HAWC2's and windIO's files of a turbine: uniform tubes against the cantilever's closed form."""

from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input.errors import CaseError
from southwell.cases.input.machines import towers
from southwell.core.turbine.tower_modes import tower_modes

HEIGHT, E, RHO, DIAMETER, WALL = 80.0, 2.1e11, 8500.0, 6.0, 0.03
INNER = DIAMETER - 2 * WALL
AREA, SECOND = np.pi / 4 * (DIAMETER**2 - INNER**2), np.pi / 64 * (DIAMETER**4 - INNER**4)

HTC = """begin new_htc_structure;
begin main_body;
  name tower ;
  begin timoschenko_input ;
    filename tower_st.dat ;
    set 1 1 ;
  end timoschenko_input;
  concentrated_mass 2 0 0 0 {mass} 0 0 0 ;
  begin c2_def ;
    nsec 2 ;
    sec 1 0.0 0.0 0.0 {twist} ;
    sec 2 0.0 0.0 -80.0 0.0 ;
  end c2_def ;
end main_body;
begin main_body;
  name blade1 ;
end main_body;
end new_htc_structure;
"""

WINDIO = """name: small
components:
  tower:
    {shape}:
      outer_diameter:
        grid: [0.0, 1.0]
        values: [6.0, {top}]
      reference_axis:
        z: {{grid: [0.0, 1.0], values: [10.0, 90.0]}}
    {structure}:
      outfitting_factor: 1.07
      layers:
        - name: wall
          material: steel
          thickness:
            grid: [0.0, 0.5, 1.0]
            values: [0.03, 0.03, 0.03]
materials:
  - {{name: steel, E: 2.1e11, nu: 0.3, rho: 8500.0}}
"""


def exact(stiffness_over_mass: float) -> float:
    return 3.51601527 / HEIGHT**2 * np.sqrt(stiffness_over_mass)


def hawc2(folder: Path, twist: float = 0.0, mass: float = 0.0, offset: float = 0.0) -> Path:
    rows = [
        f"{r} {RHO * AREA} {offset} 0 0.5 0.5 0 0 {E} 8e10 {SECOND} {2 * SECOND} {3 * SECOND} 1e3 1e3 {AREA} 0 0 0"
        for r in (0.0, HEIGHT)
    ]
    (folder / "tower_st.dat").write_text("#1 tower\n$1 2 steel\n" + "\n".join(rows) + "\n")
    path = folder / "small.htc"
    path.write_text(HTC.format(twist=twist, mass=mass))
    return path


def test_a_hawc2_tower_is_read(tmp_path: Path) -> None:
    tower, source = towers.read(hawc2(tmp_path, mass=5.0))
    solution = tower_modes(tower, 2)
    assert solution.names == ("1st fore-aft", "1st side-side")  # I_x and I_y
    unit = exact(E * SECOND / (RHO * AREA))
    np.testing.assert_allclose(solution.frequencies, [unit, np.sqrt(2) * unit], rtol=3e-4)
    assert "concentrated_mass" in str(source.unused[0])


@pytest.mark.parametrize(
    ("invalid", "message"), [({"twist": 3.0}, "not straight and vertical"), ({"offset": 0.2}, "offsets of centres")]
)
def test_a_hawc2_tower_that_is_not_symmetric_is_refused(
    tmp_path: Path, invalid: dict[str, float], message: str
) -> None:
    with pytest.raises(CaseError, match=message):
        towers.read(hawc2(tmp_path, **invalid))


@pytest.mark.parametrize(
    ("shape", "structure"), [("outer_shape_bem", "internal_structure_2d_fem"), ("outer_shape", "structure")]
)
def test_a_windio_tower_is_read(tmp_path: Path, shape: str, structure: str) -> None:
    path = tmp_path / "small.yaml"
    path.write_text(WINDIO.format(shape=shape, structure=structure, top=6.0))
    tower, _ = towers.read(path)
    assert tower.beam.length == 80.0
    result = tower_modes(tower, 1).frequencies[0]
    slender = exact(E * SECOND / (1.07 * RHO * AREA))
    assert 0.985 < result / slender < 1.0  # rotary inertia of a tube of 80 m and 6 m
    assert tower.beam.mass[0, 0, 0] == pytest.approx(1.07 * RHO * AREA)
    assert tower.beam.mass[0, 4, 4] == pytest.approx(RHO * SECOND)


def test_a_cone_in_windio(tmp_path: Path) -> None:
    """Sections in between are those of the tube there, not means of stiffness."""
    path = tmp_path / "cone.yaml"
    path.write_text(WINDIO.format(shape="outer_shape", structure="structure", top=4.0))
    beam = towers.read(path)[0].beam
    k = int(np.abs(beam.stations - 40.0).argmin())
    assert beam.stations[k] == 40.0
    assert beam.stiffness[k, 4, 4] == pytest.approx(E * np.pi / 64 * (5.0**4 - 4.94**4))


def test_heights_in_windio(tmp_path: Path) -> None:
    """The middle of the grid is 20 m above the base: cones 6 to 4.5 m, 4.5 to 3 m in diameter, with walls of 30 mm."""
    path = tmp_path / "cone.yaml"
    text = WINDIO.format(shape="outer_shape", structure="structure", top=3.0)
    z = "z: {grid: [0.0, 1.0], values: [10.0, 90.0]}"
    path.write_text(text.replace(z, "z: {grid: [0.0, 0.5, 1.0], values: [10.0, 30.0, 90.0]}"))
    beam = towers.read(path)[0].beam
    mass = np.trapezoid(beam.mass[:, 0, 0], beam.stations)
    area = np.pi * 0.03 * (np.array([20.0, 60.0]) @ np.array([5.25 - 0.03, 3.75 - 0.03]))
    assert mass == pytest.approx(1.07 * RHO * area, rel=1e-12)


@pytest.mark.parametrize(
    ("axis", "message"),
    [
        ("z: {grid: [0.0, 1.0], values: [90.0, 10.0]}", "reference_axis.z: does not rise from the base to the top"),
        ("z: {grid: [0.0, 0.5, 1.0], values: [10.0, 95.0, 90.0]}", "reference_axis.z: does not rise"),
        (
            "x: {grid: [0.0, 1.0], values: [0.0, 8.0]}\n        z: {grid: [0.0, 1.0], values: [10.0, 90.0]}",
            "reference_axis.x: the tower is not vertical",
        ),
    ],
)
def test_a_tower_that_does_not_stand_is_refused(tmp_path: Path, axis: str, message: str) -> None:
    path = tmp_path / "small.yaml"
    text = WINDIO.format(shape="outer_shape", structure="structure", top=6.0)
    path.write_text(text.replace("z: {grid: [0.0, 1.0], values: [10.0, 90.0]}", axis))
    with pytest.raises(CaseError, match=message):
        towers.read(path)


def test_a_file_without_a_tower_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "other.dat"
    path.write_text("nothing\n")
    with pytest.raises(CaseError, match="no tower in a supported format"):
        towers.read(path)
