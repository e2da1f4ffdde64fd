"""Turbines and towers in TOML: the same machine as that of a deck, springs in the right directions, and clear refusals."""

from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import library, readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.machines import towers, turbines
from southwell.cases.input.readers.openfast import turbine as openfast
from southwell.cases.plan.request import Request
from southwell.cases.plan.subjects import subjects
from southwell.cases.plan.turbine import TurbineSubject
from southwell.core.turbine.machine import machine
from southwell.core.turbine.tower_modes import tower_modes
from southwell.core.turbine.turbine_modes import turbine_modes
from southwell.references.exudyn.turbine import ExudynTurbine
from southwell.tests.support.turbine_decks import deck

TURBINE = """
name = "small"
gravity = 9.81
rotor_speed = 20.0

[tower]
height = 30.0
file = "tower.dat"
top = {mass = 100.0}

[nacelle]
mass = 9000.0
centre = [0.6, 0.2, 0.9]
moments = [0.0, 0.0, 16400.0]  # 20000 kg m² about the yaw axis
shaft_height = 1.1
overhang = -2.5
tilt = -5.0
yaw_stiffness = 3.0e7

[hub]
mass = 3000.0
inertia = 2000.0
centre = 0.1

[rotor]
blade = "blade.dat"
length = 20.0
hub_radius = 1.0
precone = -3.0

[drivetrain]
stiffness = 2.0e7
generator_inertia = 20.0
gear_ratio = 50.0
"""

TOWER = """
gravity = 0.0

[tower]
height = 20.0
stations = [0.0, 20.0]
mass = [100.0, 100.0]
EI_fore_aft = [3e7, 3e7]
EI_side_side = [2e7, 2e7]
GJ = [1e8, 1e8]
"""


def write(folder: Path, text: str) -> Path:
    path = folder / "machine.toml"
    path.write_text(text)
    return path


def test_a_turbine_in_toml_is_that_of_the_deck(tmp_path: Path) -> None:
    fst = deck(tmp_path)
    exact = openfast.read(fst)
    content = turbines.read(write(tmp_path, TURBINE))
    assert turbines.is_turbine(tmp_path / "machine.toml")
    assert content.speed == pytest.approx(exact.speed)
    both = [turbine_modes(machine(read.turbine), 1.0, 12) for read in (content, exact)]
    np.testing.assert_allclose(both[0].frequencies, both[1].frequencies, rtol=1e-9)
    assert both[0].names == both[1].names
    assert "AdjBlMs" in " ".join(content.source.notes)
    assert "BldFl1Sh" not in str(content.source.unused)


def test_a_turbine_in_toml_can_be_verified(tmp_path: Path) -> None:
    deck(tmp_path)
    path = write(tmp_path, TURBINE)
    (subject,) = subjects(Request((str(path),), rpm="0,10"), lambda _: None)
    assert isinstance(subject, TurbineSubject)
    np.testing.assert_allclose(subject.points, [0.0, np.pi / 3])
    soft = write(tmp_path, TURBINE + "\n[[tower.support.springs]]\nheight = 9.0\ndownwind = 1e5\nport = 0.0\n")
    assert ExudynTurbine().unsupported_turbine(turbines.read(soft).turbine) == "springs along the tower"


def test_a_free_generator_and_springs_under_the_tower(tmp_path: Path) -> None:
    deck(tmp_path)
    text = TURBINE.replace("gear_ratio", 'generator = "free"\ngear_ratio')
    matrix = np.diag([2e8, 1e8, 3e9, 4e9, 5e9, 6e9]).tolist()
    text += f"\n[tower.support]\nstiffness = {matrix}\n"
    turbine = turbines.read(write(tmp_path, text)).turbine
    assert turbine.drivetrain.free
    assert turbine.support.base is not None
    # ours: up, to starboard, downwind
    np.testing.assert_allclose(np.diagonal(turbine.support.base), [3e9, 1e8, 2e8, 6e9, 5e9, 4e9])
    assert turbine_modes(machine(turbine), 1.0, 1).frequencies[0] > 0


def test_a_deck_on_a_floater(tmp_path: Path) -> None:
    path = deck(tmp_path)
    main = tmp_path / "main.dat"
    main.write_text(main.read_text().replace("False PtfmPDOF", "True PtfmPDOF\n7.0E+06 PtfmMass"))
    alone = turbines.read(path)
    assert "rigid ground" in " ".join(alone.source.notes)
    assert [u.why for u in alone.source.unused if u.name == "PtfmMass"] == [openfast.FLOATER]
    K, M = (np.diag(row).tolist() for row in ([2e8, 1e8, 3e9, 4e9, 5e9, 6e9], [1e6, 2e6, 3e6, 4e6, 5e6, 6e6]))
    text = write(tmp_path, f'openfast = "{path.name}"\n[support]\nstiffness = {K}\nmass = {M}\n')
    reading = turbines.read(text)
    support = reading.turbine.support
    assert support.base is not None
    assert support.mass is not None
    np.testing.assert_allclose(np.diagonal(support.base), [3e9, 1e8, 2e8, 6e9, 5e9, 4e9])
    np.testing.assert_allclose(np.diagonal(support.mass), [3e6, 2e6, 1e6, 6e6, 5e6, 4e6])
    np.testing.assert_array_equal(reading.turbine.nacelle, alone.turbine.nacelle)
    assert "held by the support of machine.toml, with its inertia" in " ".join(reading.source.notes)
    assert "rigid ground" not in " ".join([*reading.source.notes, *map(str, reading.source.unused)])
    (subject,) = subjects(Request((str(text),)), lambda _: None)
    assert isinstance(subject, TurbineSubject)
    assert subject.deck == path
    assert ExudynTurbine().unsupported_turbine(subject.turbine) is None
    with pytest.raises(CaseError, match=r"support: mass: the base does not move"):
        turbines.read(write(tmp_path, f'openfast = "{path.name}"\n[support]\nmass = {M}\n'))


def test_a_tower_in_toml(tmp_path: Path) -> None:
    path = write(tmp_path, TOWER)
    assert towers.is_tower(path)
    assert not turbines.is_turbine(path)
    tower, source = towers.read(path)
    solution = tower_modes(tower, 2)
    unit = 3.51601527 / 20.0**2 * np.sqrt(1 / 100.0)
    np.testing.assert_allclose(solution.frequencies, [unit * np.sqrt(2e7), unit * np.sqrt(3e7)], rtol=1e-6)
    assert solution.names == ("1st side-side", "1st fore-aft")
    assert "rigid ground: platform and water are not included" in source.notes


def test_springs_act_in_their_directions(tmp_path: Path) -> None:
    """A spring downwind raises the fore-aft mode alone, and so does soft tilting about the port axis lower it alone."""
    stiff = TOWER + "[[tower.support.springs]]\nheight = 20.0\ndownwind = 1e5\nport = 0.0\n"
    rows = np.diag([0.0, 0.0, 0.0, 0.0, 1e7, 0.0]).tolist()
    rest = '["downwind", "port", "up", "roll", "yaw"]'
    soft = f"{TOWER}[tower.support]\nstiffness = {rows}\nclamped = {rest}\n"
    plain, stiffened, softened = (
        dict(zip(m.names, m.frequencies, strict=True))
        for m in (tower_modes(towers.read(write(tmp_path, text))[0], 4) for text in (TOWER, stiff, soft))
    )
    assert stiffened["1st side-side"] == pytest.approx(plain["1st side-side"], rel=1e-9)
    assert stiffened["1st fore-aft"] > 1.5 * plain["1st fore-aft"]
    assert softened["1st side-side"] == pytest.approx(plain["1st side-side"], rel=1e-9)
    assert softened["1st fore-aft"] < 0.95 * plain["1st fore-aft"]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[hub]\nmass = 3000.0\ninertia = 2000.0\ncentre = 0.1\n", "", "hub: missing"),
        ("overhang", "overhung", "overhung: unknown key"),
        ('blade = "blade.dat"', 'blade = "blade.dat"\nblades = 1', ">= 2"),
        ("[hub]", "[hub]\nteeter = {undersling = 0.1}", "with 3 blades: only a hub of two teeters"),
        ('file = "tower.dat"', "stations = [0.0, 30.0]", "tower.mass: missing"),
        ('file = "tower.dat"', 'file = "tower.dat"\nmass = [1.0]', "leave one out"),
        ("height = 30.0", "height = 30.0\nsupport = {stiffness = [[1.0]]}", "6 rows of 6"),
        ("height = 30.0", 'height = 30.0\nsupport = {clamped = ["up"]}', "leave it out"),
        ("height = 30.0", "height = 30.0\nsupport = {soil = [[0.0, 1e6], [40.0, 1e6]]}", "30 m high"),
    ],
)
def test_a_wrong_file_is_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    deck(tmp_path)
    path = write(tmp_path, TURBINE.replace(old, new))
    with pytest.raises(CaseError, match=message):
        turbines.read(path)


def test_other_files_are_no_machines(tmp_path: Path) -> None:
    blade = write(tmp_path, '[blade]\nkind = "beam"\n')
    assert not turbines.is_turbine(blade)
    assert not towers.is_tower(blade)
    assert not towers.is_tower(tmp_path / "missing.bmi")


@pytest.mark.parametrize(("head", "file"), [("[rotor]\nblade = ", "blade.dat"), ("openfast = ", "turbine.fst")])
def test_a_turbine_where_a_blade_is_wanted_names_the_file_of_the_blade(tmp_path: Path, head: str, file: str) -> None:
    path = tmp_path / "turbine.toml"
    path.write_text(f'{head}"{file}"\n')
    with pytest.raises(CaseError) as error:
        readers.reading(path)
    assert str(error.value).startswith(f"{path}: a turbine, not a blade: give {tmp_path / file} for its blade;")


def test_the_case_of_a_turbine_is_none_of_blades(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text('name = "case"\nturbine = "turbine.toml"\n')
    for name in ("nrel-5mw-turbine", str(path)):
        with pytest.raises(CaseError, match="it is a turbine, not a blade: see `southwell verify"):
            library.load(name)
