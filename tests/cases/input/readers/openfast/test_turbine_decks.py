"""Towers and whole turbines from ElastoDyn's files."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.campbell.machine import MachineRequest, machine_diagram
from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers.openfast import turbine
from southwell.core import solve
from southwell.core.blade import Blade, section_mass, section_stiffness
from southwell.core.space.inertia import transformed
from southwell.core.turbine.machine import machine, rigid_rotor
from southwell.core.turbine.turbine_modes import turbine_modes
from southwell.tests.support.assumed_modes import blade_mass, frequencies
from southwell.tests.support.turbine_decks import deck

NREL = Path(os.environ.get("SOUTHWELL_BLADES", "missing")).parent / "linearised" / "nrel5mw" / "Main_Onshore.fst"


def test_a_tower_file_is_a_beam_that_stands(tmp_path: Path) -> None:
    deck(tmp_path)
    reading = readers.reading(tmp_path / "tower.dat")
    tower = reading.blade
    assert tower.length == 30.0
    assert reading.speed == 0.0
    assert tower.stiffness[0, 4, 4] == pytest.approx(1.1 * 9e9)  # bends fore-aft, with AdjFASt
    assert tower.stiffness[0, 5, 5] == pytest.approx(8e9)
    assert [str(u).split(":")[1].split("(")[0].strip() for u in reading.source.unused] == [
        "TwrFADmp",
        "TwFAM1Sh, TwFAM2Sh, TwSSM1Sh, TwSSM2Sh",
    ]


def test_tuners_of_a_towers_shapes_are_listed(tmp_path: Path) -> None:
    deck(tmp_path)
    with (tmp_path / "tower.dat").open("a") as file:
        file.write("1.0 FAStTunr(1)\n1.5 SSStTunr(1)\n")
    (tuners,) = (u for u in readers.reading(tmp_path / "tower.dat").source.unused if "Tunr" in u.name)
    assert tuners.values == (1.0, 1.5)


def test_a_tower_without_height_or_with_a_wrong_value_is_refused(tmp_path: Path) -> None:
    deck(tmp_path)
    (tmp_path / "main.dat").unlink()
    with pytest.raises(CaseError, match="--length"):
        readers.reading(tmp_path / "tower.dat")
    assert readers.reading(tmp_path / "tower.dat", readers.Mount(length=10.0)).blade.length == 10.0
    text = (tmp_path / "tower.dat").read_text()
    (tmp_path / "tower.dat").write_text(text.replace("700", "-700"))
    with pytest.raises(CaseError, match=r"line 11: TMassDen: -700"):
        readers.reading(tmp_path / "tower.dat", readers.Mount(length=10.0))


def test_a_deck_is_a_turbine(tmp_path: Path) -> None:
    path = deck(tmp_path)
    assert turbine.is_turbine(path)
    read = turbine.read(path)
    result = read.turbine
    assert result.gravity == 9.81
    assert result.yaw == 3e7
    assert not result.drivetrain.free
    assert result.drivetrain.gear_ratio == 50.0
    assert read.speed == pytest.approx(20 * np.pi / 30)
    # nacelle: 9 t at (0.6, 0.2, 0.9) in OpenFAST's axes is at (0.9, −0.2, 0.6) here, and 100 kg at the tower's top
    mass, static = result.nacelle[0, 0], result.nacelle[:3, 3:]
    assert mass == pytest.approx(9100.0)
    np.testing.assert_allclose(
        [static[1, 2], static[2, 0], static[0, 1]], 9000 * np.array([0.9, -0.2, 0.6]), rtol=1e-12
    )
    assert result.nacelle[3, 3] == pytest.approx(20000.0)  # about the yaw axis, as given
    unused = " ".join(str(u) for u in read.source.unused)
    for damping in ("DTTorDmp", "TwrFADmp", "YawDamp"):  # stated, each in one line
        assert [str(u).endswith(": modes are undamped") for u in read.source.unused if damping in u.name] == [True]
    assert "PtfmMass" not in unused
    assert "CompSub" not in unused


def test_modules_under_the_tower_are_not_used(tmp_path: Path) -> None:
    path = deck(tmp_path)
    path.write_text(path.read_text() + "1 CompHydro\n1 CompSub\n0 CompMooring\n")
    assert str(turbine.read(path).source.unused[0]).startswith(
        "not used: CompHydro, CompSub (largest 1, small.fst): rigid ground"
    )


def test_a_generator_or_a_yaw_bearing_as_the_deck_says(tmp_path: Path) -> None:
    result = turbine.read(deck(tmp_path, free=True, yaw=False)).turbine
    assert result.drivetrain.free
    assert np.isinf(result.yaw)
    names = turbine_modes(machine(result), 1.0, 10).names
    assert "drivetrain torsion" in names
    assert "1st edge collective" not in names[:6]


def test_a_deck_without_its_tower_or_with_one_blade_is_no_turbine(tmp_path: Path) -> None:
    path = deck(tmp_path)
    main = tmp_path / "main.dat"
    text = main.read_text()
    main.write_text(text.replace("3 NumBl", "1 NumBl"))
    assert not turbine.is_turbine(path)
    main.write_text(text)
    (tmp_path / "tower.dat").unlink()
    assert not turbine.is_turbine(path)
    assert not turbine.is_turbine(tmp_path / "none.fst")


NEEDS_NREL = pytest.mark.skipif(not NREL.is_file(), reason="the decks of OpenFAST's regression tests are not here")

PUBLISHED = {
    "1st tower fore-aft": (0.3240, 0.3195),
    "1st tower side-side": (0.3120, 0.3164),
    "drivetrain torsion": (0.6205, 0.6094),
    "1st flap yaw": (0.6664, 0.6296),
    "1st flap tilt": (0.6675, 0.6686),
    "1st flap collective": (0.6993, 0.7019),
    "1st edge tilt": (1.0793, 1.0740),
    "1st edge yaw": (1.0898, 1.0877),
    "2nd flap yaw": (1.9337, 1.6507),
    "2nd flap tilt": (1.9223, 1.8558),
    "2nd flap collective": (2.0205, 1.9601),
    "2nd tower fore-aft": (2.9003, 2.8590),
    "2nd tower side-side": (2.9361, 2.9408),
}
"""Hz, FAST and ADAMS at rest, generator locked: J. Jonkman and others, NREL/TP-500-38060, 2009, table 9-1.

The print was not at hand. FAST's values of tower and blades agree with a public transcription that names page 30 of the
report, and ADAMS's 2.8590 Hz with a quotation on NREL's forum (topic 517). FAST's drivetrain torsion and the other values of
ADAMS are from memory: no source confirmed them.
"""


@NEEDS_NREL
def test_nrel_5mw_against_published_frequencies() -> None:
    """FAST and ADAMS differ by up to 15 % from each other; each frequency is within 2 % of their range."""
    read = turbine.read(NREL).turbine
    locked = replace(read, drivetrain=replace(read.drivetrain, free=False), yaw=9.02832e9)
    full_machine = machine(locked)
    rotor = rigid_rotor(locked, full_machine.blade_mesh)
    assert rotor[0, 0] == pytest.approx(110_000, rel=5e-3)  # kg, printed
    assert read.nacelle[0, 0] == 240_000
    modes = turbine_modes(full_machine, 0.0, 14)
    at = dict(zip(modes.names, modes.frequencies / (2 * np.pi), strict=True))
    for name, both in PUBLISHED.items():
        if name not in ("1st edge tilt", "1st edge yaw", "2nd tower side-side"):  # other names of mixed motions
            assert min(both) * 0.98 < at[name] < max(both) * 1.02, name


@NEEDS_NREL
def test_nrel_5mw_in_assumed_modes_has_the_frequencies_of_fast() -> None:
    """FAST's fore-aft mode is 3 % above the continuous tower's: the deck's polynomial is stiffer; see docs/machine.md."""
    read = turbine.read(NREL).turbine
    folder = NREL.parent / "5MW_Baseline"
    files = (
        folder / "NRELOffshrBsline5MW_Onshore_ElastoDyn_Tower.dat",
        folder / "NRELOffshrBsline5MW_Blade.dat",
    )
    assert blade_mass(read) == pytest.approx(17_740, abs=0.5)  # kg, printed
    values, names = frequencies(read, *files, gravity=read.gravity)
    at = dict(zip(names[:3] + names[11:13], values[[0, 1, 2, 11, 12]].tolist(), strict=True))
    assert at["fore-aft 1"] == pytest.approx(0.3240, rel=2e-3)
    assert at["side-side 1"] == pytest.approx(0.3120, rel=6e-3)
    assert at["shaft"] == pytest.approx(0.6205, rel=1e-3)
    assert at["fore-aft 2"] == pytest.approx(2.9003, rel=6e-3)
    assert at["side-side 2"] == pytest.approx(2.9361, rel=6e-3)
    # the same machine without assumed modes is lower, as it must be (Rayleigh), and softened as much by its weight
    locked = replace(read, drivetrain=replace(read.drivetrain, free=False))
    free = [
        turbine_modes(machine(replace(locked, gravity=g)), 0.0, 2).frequencies / (2 * np.pi) for g in (read.gravity, 0)
    ]
    assert free[0][0] == pytest.approx(at["side-side 1"], rel=7e-3)
    assert 0.965 < free[0][1] / at["fore-aft 1"] < 0.97
    without, _ = frequencies(read, *files, gravity=0.0)
    np.testing.assert_allclose(free[1] - free[0], without[:2] - values[:2], rtol=0.06)


OC3 = {
    "1st tower fore-aft": (0.2785, 0.0049),
    "1st tower side-side": (0.2773, 0.0046),
    "1st flap collective": (0.6955, 0.0143),
    "1st flap tilt": (0.6643, 0.0143),
    "1st flap yaw": (0.6288, 0.0294),
}
"""Hz, median and standard deviation of the participants of OC3, phase I, load case 1.2, as the documentation of Ashes quotes
figure 6 of J. Jonkman and others, *Offshore Code Comparison Collaboration within IEA Wind Annex XXIII*, 2010."""

MONOPILE = np.array(
    [
        [0.0, 9517.14, 1037.13e9],
        [29.9999, 9517.14, 1037.13e9],
        [30.0, 4306.51, 474.49e9],
        [37.76, 4030.44, 413.08e9],
        [45.52, 3763.45, 357.83e9],
        [53.28, 3505.52, 308.30e9],
        [61.04, 3256.66, 264.08e9],
        [68.8, 3016.86, 224.80e9],
        [76.56, 2786.13, 190.06e9],
        [84.32, 2564.46, 159.49e9],
        [92.08, 2351.87, 132.77e9],
        [99.84, 2148.34, 109.54e9],
        [107.6, 1953.87, 89.49e9],
    ]
)
"""Height above the mudline, m, mass, kg/m, and bending stiffness, N m², of OC3's monopile on rigid ground and its tower."""


@NEEDS_NREL
def test_oc3_monopile_is_in_the_middle_of_its_participants() -> None:
    """Without weight, which the two tower modes tell: with it they are 2 % lower, as those of the NREL 5 MW on land."""
    read = turbine.read(NREL).turbine
    height, mass, EI = MONOPILE.T
    rigid = np.full_like(EI, np.inf)
    tower = Blade("monopile", height, section_stiffness(rigid, rigid, EI, EI), section_mass(mass), np.zeros_like(EI))
    machines = (
        replace(read, tower=tower, yaw=9.02832e9, drivetrain=replace(read.drivetrain, free=False), gravity=g)
        for g in (0.0, 9.80665)
    )
    light, heavy = (
        dict(zip(m.names, m.frequencies / (2 * np.pi), strict=True))
        for m in (turbine_modes(machine(full_machine), 0.0, 8) for full_machine in machines)
    )
    for name in ("1st tower fore-aft", "1st tower side-side"):
        assert light[name] == pytest.approx(OC3[name][0], rel=1.5e-3)
        assert 0.975 < heavy[name] / light[name] < 0.985
    for name, (median, deviation) in OC3.items():
        assert abs(light[name] - median) < 1.5 * deviation, name


@NEEDS_NREL
def test_lines_do_not_depend_on_the_speed_steps() -> None:
    """Collective and yawing flap meet near rest; small steps would follow the exchange of their motions."""
    read = turbine.read(NREL).turbine
    ends = []
    for count in (5, 41):
        request = MachineRequest(tuple(np.linspace(0.0, 1.3, count)), modes=6)
        lines = machine_diagram(read, request).lines
        ends.append([(line.name, *line.frequencies[[0, -1]].round(6).tolist()) for line in lines])
    assert ends[0] == ends[1]
    assert [name for name, *_ in ends[0]][2:5] == [
        "1st flap backward whirl",
        "1st flap forward whirl",
        "1st flap collective",
    ]


def test_the_rotor_is_carried_by_the_tower(tmp_path: Path) -> None:
    """The tower of the machine with a stiff rotor is the plain solver's beam with nacelle and rotor at its tip."""
    read = turbine.read(deck(tmp_path, yaw=False)).turbine
    locked = replace(read, drivetrain=replace(read.drivetrain, stiffness=np.inf))
    stiff = replace(locked, blade=replace(locked.blade, stiffness=1e4 * locked.blade.stiffness))
    full_machine = machine(stiff)
    tip = read.nacelle + transformed(rigid_rotor(stiff, full_machine.blade_mesh), read.shaft)
    tower = replace(read.tower, tip_mass=np.ascontiguousarray(tip))
    exact = solve.modes(tower, 0.0, count=2, gravity=np.array([-9.81, 0.0, 0.0])).frequencies
    np.testing.assert_allclose(turbine_modes(full_machine, 0.0, 2).frequencies, exact, rtol=1e-4)


def notes_of(path: Path) -> str:
    source = turbine.read(path).source
    return "\n".join([*source.notes, *map(str, source.unused)])


def test_unused_inputs_that_change_the_model_are_stated(tmp_path: Path) -> None:
    path, main = deck(tmp_path), tmp_path / "main.dat"
    before = notes_of(path)
    for word in ("furling", "MHK", "TwSSDOF1", "BldFile"):
        assert word not in before
    with main.open("a") as file:
        file.write('---- FURLING ----\nTrue Furling\nFalse TwSSDOF1\nTrue TwFADOF1\n"other.dat" BldFile(2)\n')
    with path.open("a") as file:
        file.write("1 MHK\n")
    after = notes_of(path)
    assert "furling is not included" in after
    assert "not used: MHK" in after
    assert "False of TwSSDOF1 (main.dat)" in after
    assert "only the blade of BldFile(1) is read; main.dat names other files" in after


def test_the_yaw_spring_and_tuned_masses_of_servodyn(tmp_path: Path) -> None:
    path = deck(tmp_path, yaw=True)
    servo = tmp_path / "servo.dat"
    assert np.isfinite(turbine.read(path).turbine.yaw)
    with servo.open("a") as file:
        file.write("2 NumTStC\nTrue CompNTMD\n")
    assert "not used: NumTStC, CompNTMD (largest 2, servo.dat): tuned masses" in notes_of(path)
    with path.open("a") as file:
        file.write("0 CompServo\n")
    assert np.isinf(turbine.read(path).turbine.yaw)
    assert "with CompServo = 0, OpenFAST has no yaw spring" in notes_of(path)
    assert "NumTStC" not in notes_of(path)
