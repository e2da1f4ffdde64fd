"""Whole turbines from htc files: the machine of a TOML file, rigid bodies weighed by hand, and clear refusals."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.machines import turbines
from southwell.cases.input.readers.hawc2 import turbine as hawc2
from southwell.core.space import spatial as sp
from southwell.core.space.inertia import about_centre, transformed
from southwell.core.turbine.machine import machine
from southwell.core.turbine.turbine import Turbine
from southwell.core.turbine.turbine_modes import turbine_modes
from southwell.tests.support import htc_decks as deck


def frequencies(turbine: Turbine, omega: float = 2.0) -> np.ndarray:
    return turbine_modes(machine(turbine), omega, 12).frequencies


def test_an_htc_is_the_turbine_of_a_toml_file(tmp_path: Path) -> None:
    """Two readers, one machine: tower and its top mass, nacelle, tilt, overhang, hub, cone, pitch, shaft and generator."""
    path = deck.htc(tmp_path)
    assert turbines.is_turbine(path)
    read, exact = turbines.read(path), turbines.read(deck.toml(tmp_path))
    assert read.speed == pytest.approx(exact.speed)
    for omega in (0.0, 2.0):
        np.testing.assert_allclose(frequencies(read.turbine, omega), frequencies(exact.turbine, omega), rtol=1e-6)
    notes = " ".join(read.source.notes)
    assert "gravity 9.81 m/s² (HAWC2's)" in notes
    assert "generator free (bearing1); shaft 2e+07 N m/rad (G I_p of shaft)" in notes
    assert "below 0.001 %" in notes
    assert [str(u).split(" (")[0] for u in read.source.unused] == ["not used: damping_posdef"]
    assert {f.name for f in read.source.files} == {"small.htc", *(f"{name}.st" for name in deck.ROWS)}


OTHERWISE = {
    "tilt": ("tilt = -5.0", "tilt = 5.0"),
    "overhang": ("overhang = -2.5", "overhang = 2.5"),
    "cone": ("precone = -3.0", "precone = 3.0"),
    "pitch": ("pitch = 2.0", "pitch = -2.0"),
    "nacelle downwind": ("[0.6, 0.2, 0.9]", "[-0.6, 0.2, 0.9]"),
    "nacelle to port": ("[0.6, 0.2, 0.9]", "[0.6, -0.2, 0.9]"),
    "nacelle up": ("[0.6, 0.2, 0.9]", "[0.6, 0.2, -0.9]"),
    "nacelle's moments": ("[9000.0, 12000.0, 16400.0]", "[12000.0, 9000.0, 16400.0]"),
    "tower's top mass": ("[0.1, 0.2, 0.3]", "[0.1, 0.2, -0.3]"),
    "hub's centre": ("centre = 0.1", "centre = -0.1"),
    "hub's moment": ("transverse_inertia = 1500.0", "transverse_inertia = 1600.0"),
    "tower's directions": ("EI_fore_aft = [9e9, 6e9, 4e9]", "EI_fore_aft = [8e9, 5.5e9, 3.5e9]"),
    "generator": ("generator_inertia = 5.0e4", "generator_inertia = 4.0e4"),
}
"""What would not be seen if the test above could not tell it."""


@pytest.mark.parametrize("name", OTHERWISE)
def test_each_of_them_tells(tmp_path: Path, name: str) -> None:
    other = deck.TOML.replace(*OTHERWISE[name])
    assert other != deck.TOML
    both = [frequencies(turbines.read(deck.toml(tmp_path, text)).turbine) for text in (deck.TOML, other)]
    assert np.abs(both[0] / both[1] - 1.0).max() > 1e-5


def test_rigid_bodies_keep_their_mass(tmp_path: Path) -> None:
    """Rods with radii of gyration: a towertop, a shaft, and hubs with their mass centres aside."""
    rows = {
        "towertop": deck.rigid(1.1, 500.0, (0.0, 0.0, 0.4)),
        "shaft": deck.shaft(2.5, 2e7, 300.0),
        "hub1": deck.rigid(1.0, 200.0, (0.1, -0.2, 0.5)),
    }
    base = turbines.read(deck.htc(tmp_path)).turbine
    heavy = turbines.read(deck.htc(tmp_path, rows)).turbine
    mass, centre, moments = about_centre(heavy.nacelle - base.nacelle)
    assert mass == pytest.approx(550.0)
    np.testing.assert_allclose(centre, [0.55, 0.0, 0.0], atol=1e-9)
    across = 550.0 * (0.4**2 + 1.1**2 / 12.0)
    np.testing.assert_allclose(np.diagonal(moments), [2 * 550.0 * 0.4**2, across, across])
    # of a hub, x_cg leads and y_cg is downwind; the radii are about the elastic centre, on the line
    about_line = np.diag([200.0 * 2 * 0.25, 200.0 * (0.25 + 1.0 / 12.0), 200.0 * (0.25 + 1.0 / 12.0)])
    aside = np.array([0.0, 0.1, -0.2])
    rod = np.diag([200.0] * 3 + [0.0] * 3)
    rod[3:, 3:] = about_line - 200.0 * (aside @ aside * np.eye(3) - np.outer(aside, aside))
    hubs = np.zeros((6, 6))
    for k in range(3):
        cone = sp.rotation(1, np.array(np.radians(3.0)))  # upwind
        to_blade = sp.rotation(2, np.array(2.0 * np.pi * k / 3.0)) @ cone
        hubs += transformed(rod, sp.pose(to_blade, to_blade @ (np.array([0.5, 0.0, 0.0]) + aside)))
    along = np.diag([750.0] * 3 + [750.0 * 2.5**2 / 12.0] * 2 + [0.0])
    shaft = transformed(along, sp.pose(np.eye(3), np.array([0.0, 0.0, 1.25])))
    np.testing.assert_allclose(heavy.hub - base.hub, hubs + shaft, atol=1e-5)


def test_the_polar_inertia_of_the_shaft_is_divided_as_its_torsion(tmp_path: Path) -> None:
    """A disc at 2 m of 2.5 m, and a uniform polar inertia per length, half of which belongs to each end."""
    rows = {"shaft": [deck.section(r, 100.0, 1e16, 1e16, 5e7, (0.0, 0.0, 0.5)) for r in (0.0, 2.5)]}
    points: dict[str, list[deck.Point]] = {"shaft": [(0, 0, 0), (0, 0, 2), (0, 0, 2.5)]}
    masses = {"shaft": ["1 0 0 0 0 0 0 5e4", "2 0 0 0 0 0 0 1000", "3 0 0 -0.1 3000 1500 1500 2000"]}
    read = hawc2.read(deck.htc(tmp_path, rows, points, masses))
    polar = 2.5 * 100.0 * 2 * 0.5**2
    assert read.turbine.drivetrain.generator == pytest.approx(5e4 + 0.2 * 1000 + 0.5 * polar)
    assert read.turbine.hub[5, 5] == pytest.approx(2000 + 0.8 * 1000 + 0.5 * polar)
    assert "between the ends of shaft are divided" in " ".join(read.source.notes)


def test_the_orientation_in_other_words(tmp_path: Path) -> None:
    """Euler parameters, blades numbered backwards, a bearing's vector for ini_rotvec, and a yawed nacelle."""
    path = deck.htc(tmp_path)
    text, exact = path.read_text(), frequencies(hawc2.read(path).turbine)
    half = np.radians(95.0) / 2.0
    c, s = float(np.cos(half)), float(np.sin(half))
    changes = {
        "mbdy2_eulerang 90 0 0;\n  mbdy2_eulerang 5 0 0;": f"mbdy2_eulerpar {c!r} {s!r} 0 0;",
        "body2_eulerang 0 60 0": "body2_eulerang 0 -60.0 0",
        "body2_eulerang 0 -60 0": "body2_eulerang 0 60.0 0",
        "  mbdy2_ini_rotvec_d1 0 0 -1 2.0943951023931953;\n": "",
        "  body2 towertop 1;\n  body2_eulerang 0 0 0;": "  body2 towertop 1;\n  body2_eulerang 0 0 20;",
    }
    for old, new in changes.items():
        assert old in text, old
        text = text.replace(old, new)
    path.write_text(text)
    read = hawc2.read(path)
    assert read.speed == 0.0
    np.testing.assert_allclose(frequencies(read.turbine), exact, rtol=1e-9)
    (yaw,) = [u for u in read.source.unused if u.name == "yaw"]
    assert yaw.values == pytest.approx([-20.0])  # about up: HAWC2's z points down


def test_a_locked_generator_and_gravity(tmp_path: Path) -> None:
    path = deck.htc(tmp_path)
    path.write_text(
        path.read_text().replace("bearing1", "bearing3").replace("name tower ;", "name tower ;\n  gravity 9.5 ;")
    )
    read = hawc2.read(path)
    exact = turbines.read(deck.toml(tmp_path, deck.TOML.replace('"free"', '"locked"'))).turbine
    assert read.turbine.gravity == 9.5
    assert "generator locked (bearing3)" in " ".join(read.source.notes)
    np.testing.assert_allclose(frequencies(read.turbine), frequencies(replace(exact, gravity=9.5)), rtol=1e-6)


def test_a_shaft_without_generator_does_not_twist(tmp_path: Path) -> None:
    masses = {"shaft": ["2 0 0 -0.1 3000 1500 1500 2000"]}
    rows = {"shaft": [row.replace(str(deck.ROD), "1e-30") for row in deck.ROWS["shaft"]]}
    turbine = hawc2.read(deck.htc(tmp_path, rows, masses=masses)).turbine
    assert "drivetrain torsion" not in turbine_modes(machine(turbine), 1.0, 12).names


def test_a_flexible_shaft_is_stated(tmp_path: Path) -> None:
    rows = {"shaft": deck.shaft(2.5, 2e7, bending=1e9), "hub1": deck.rigid(1.0, stiff=1e10)}
    notes = hawc2.read(deck.htc(tmp_path, rows)).source.notes
    (message,) = [note for note in notes if note.startswith("taken as rigid")]
    shaft = message.partition("shaft besides its torsion ")[2]
    assert 0.1 < float(shaft.split()[0]) < 10.0
    assert "flap" in shaft.split(")")[0]


def test_a_turbine_that_its_tower_does_not_carry_is_read(tmp_path: Path) -> None:
    path = deck.htc(tmp_path)
    path.write_text(path.read_text().replace("name tower ;", "name tower ;\n  gravity 1e6 ;"))
    assert "the effect of their flexibility is unknown" in " ".join(hawc2.read(path).source.notes)


LACKING = {
    "a shaft's file": ("filename shaft.st", "filename other.st", "other.st of shaft is not there"),
    "a hub": ("begin main_body;\n  name hub2 ;", "begin main_body;\n  name other ;", "the htc has no main_body hub2"),
    "a blade": ("  body2 blade3 1;", "  body2 other 1;", "the htc has 2 oriented bodies whose name begins with blade"),
    "a copy's mass": (
        "name hub2 ;",
        "name hub2 ;\n  concentrated_mass 2 0 0 0 500 0 0 0 ;",
        "hub2, a copy_main_body with its own concentrated_mass, is not supported",
    ),
    "one orientation": (
        "begin relative;\n  body1 tower last;",
        "begin relative;\n  body1 tower last;\n  body2 shaft 1;\n  body2_eulerang 90 0 0;\nend relative;\n"
        "begin relative;\n  body1 tower last;",
        "the orientation of shaft from tower is not defined",
    ),
    "a position": (
        "  body2 hub1 1;",
        "  body2 hub1 1;\n  relpos 0 0 1;",
        "the orientation of hub1 from tower is not defined",
    ),
    "fix0": ("begin fix0;", "begin fix2;", "tower is not clamped to the ground by fix0"),
    "a tower on the ground": ("  body tower;\n  inipos", "  body pile;\n  inipos", "the body on the ground is pile"),
}


@pytest.mark.parametrize("name", LACKING)
def test_what_lacks_a_body_is_one_blade(tmp_path: Path, name: str) -> None:
    old, new, message = LACKING[name]
    path = deck.htc(tmp_path)
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    assert not turbines.is_turbine(path)
    assert f"not the whole turbine: {message}" in " ".join(readers.reading(path).source.notes)
    with pytest.raises(CaseError, match="--blade-only takes one blade"):
        turbines.read(path)


HUB_SECTIONS = "nsec 2 ;\n    sec 1 0 0 0 0.0 ;\n    sec 2 0 0 1 0.0"

REFUSED = {
    "no bearing": ("begin bearing1", "begin other", "shaft: no bearing1, bearing2, bearing3 or fix1 holds it"),
    "free pitch": ("begin bearing2", "begin bearing1", r"blade1: it turns freely \(bearing1\) on hub1"),
    "unequal cone": (
        "0 60 0;\n  body2_eulerang 3 0 0",
        "0 60 0;\n  body2_eulerang 4 0 0",
        "blade1 …: mounted differently",
    ),
    "unequal angles": ("body2_eulerang 0 60 0", "body2_eulerang 0 61 0", "blade1 …: not at equal angles"),
    "uneven shaft": ("3000 1500 1500", "3000 1500 1900", "moments of inertia of shaft and hubs across the axis differ"),
    "vertical axis": ("mbdy2_eulerang 90 0 0", "mbdy2_eulerang 0 0 0", "shaft: its axis is not horizontal"),
    "no such node": ("mass 2 0 0 -0.1", "mass 3 0 0 -0.1", "node 3: the body has 2 nodes"),
    "half a node": ("mass 2 0 0 -0.1", "mass 1.5 0 0 -0.1", "node 1.5: the body has 2 nodes"),
    "number of sections": (HUB_SECTIONS, HUB_SECTIONS.replace("nsec 2", "nsec 3"), "nsec: 3: c2_def has 2 sections"),
    "section's number": (
        HUB_SECTIONS,
        HUB_SECTIONS.replace("sec 2 0", "sec 3 0"),
        "sec: number 3, but it is section 2",
    ),
    "gravity": ("name tower ;", "name tower ;\n  gravity 9,81 ;", "gravity: 9,81: not a number"),
    "gravity upwards": ("name tower ;", "name tower ;\n  gravity -9.81 ;", "gravity: -9.81: not a number, or negative"),
    "beginning": (
        "sec 1 0 0 0 0.0 ;\n    sec 2 0 0 1 ",
        "sec 1 0 0 0.5 0 ;\n sec 2 0 0 1.5 ",
        "hub1 does not begin at 0, 0, 0",
    ),
    "a text": ("filename shaft.st", "filename small.htc", r"no line that begins with \$, set and number of rows"),
    "direction of an offset": (
        "filename towertop.st",
        "filename aside.st",
        "not zero on towertop, which points along −z",
    ),
    "length": ("sec 2 0 0 2.5", "sec 2 0 0 3.5", None),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_no_turbine_of_this_kind_is_refused(tmp_path: Path, name: str) -> None:
    old, new, message = REFUSED[name]
    path = deck.htc(tmp_path)
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    aside = deck.rigid(1.1, 500.0, (0.1, 0.0, 0.4))
    (tmp_path / "aside.st").write_text("#1 aside\n$1 2\n" + "\n".join(aside) + "\n")
    if message is None:  # a uniform body may be longer than its table
        assert hawc2.read(path).turbine.drivetrain.stiffness == pytest.approx(2e7 * 2.5 / 3.5)
        return
    with pytest.raises(CaseError, match=rf"{message}.*--blade-only takes one blade"):
        hawc2.read(path)


def test_bodies_beside(tmp_path: Path) -> None:
    """A body fixed to the nacelle is a part of it; one on the tower is not used."""
    extra = deck.body("box", "box.st", [(0, 0, 0), (0, 0, 2)], ())
    (tmp_path / "box.st").write_text("#1 box\n$1 2\n" + "\n".join(deck.rigid(2.0, 100.0)) + "\n")
    path = deck.htc(tmp_path, extra=extra)
    base = hawc2.read(path).turbine
    for holder in ("towertop", "tower"):
        held = f"begin relative;\n  body1 {holder} last;\n  body2 box 1;\n  body2_eulerang 90 0 0;\nend relative;\n"
        joined = f"begin fix1;\n  body1 {holder} last;\n  body2 box 1;\nend fix1;\n"
        text = deck.htc(tmp_path, extra=extra).read_text()
        path.write_text(text.replace("end orientation;", held + "end orientation;") + joined)
        read = hawc2.read(path)
        if holder == "tower":
            np.testing.assert_array_equal(read.turbine.nacelle, base.nacelle)
            assert "main_body box (200 kg" in str(read.source.unused[1])
        else:
            mass, centre, _ = about_centre(read.turbine.nacelle - base.nacelle)
            assert mass == pytest.approx(200.0)
            np.testing.assert_allclose(centre, [1.1, 0.0, -1.0], atol=1e-9)
