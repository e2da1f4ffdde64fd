"""Which bodies of an htc are the blade and the tower, and where the rotor's axis is."""

from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.machines import towers
from southwell.cases.input.readers import Mount
from southwell.cases.input.readers.hawc2 import turbine as hawc2
from southwell.core.space.spatial import rotation
from southwell.references.readers import NotReadError, ReadingOptions, hawc2_turbine
from southwell.references.readers import hawc2 as second
from southwell.references.readers import read as read_again
from southwell.tests.support import htc_decks as deck


def with_first(folder: Path, body: str) -> Path:
    """The turbine with another main_body before the others."""
    path = deck.htc(folder)
    path.write_text(path.read_text().replace("begin main_body;", body + "begin main_body;", 1))
    return path


def test_the_tower_is_the_body_on_the_ground(tmp_path: Path) -> None:
    """A body ``tower_top`` of 1.1 m may come first."""
    path = with_first(tmp_path, deck.body("tower_top", "towertop.st", deck.POINTS["towertop"], ()))
    tower, source = towers.read(path)
    assert tower.beam.length == 30.0
    assert source.notes[0] == "main_body tower, clamped at the base, without weight"


def test_a_body_without_orientation_is_no_blade(tmp_path: Path) -> None:
    (tmp_path / "old.st").write_text("#1 old\n$1 2\n" + "\n".join(deck.rigid(5.0, 999.0)) + "\n")
    path = with_first(tmp_path, deck.body("blade_old", "old.st", [(0, 0, 0), (0, 0, 5)], ()))
    for blade in (readers.read(path), hawc2.read(path).turbine.blade):
        mass = np.trapezoid(blade.mass[:, 0, 0], blade.stations)
        assert mass == pytest.approx(10.0 * (0.5 * 120 + 60 + 0.5 * 15))
    pytest.importorskip("weio")
    assert second.read(path, ReadingOptions()).s[-1] == pytest.approx(20.0)


@pytest.mark.parametrize("names", [("blade1in", "blade1"), ("blade1", "blade1tip")])
def test_a_blade_of_two_bodies_is_refused(tmp_path: Path, names: tuple[str, str]) -> None:
    inner, outer = names
    path = deck.htc(tmp_path)
    tip = deck.body(outer, "blade1.st", deck.POINTS["blade1"], ())
    joined = f"begin relative;\n  body1 {inner} last;\n  body2 {outer} 1;\nend relative;\nend orientation;"
    text = path.read_text().replace("blade1 ", f"{inner} ").replace("blade1 ;", f"{inner} ;")
    path.write_text(text.replace("end orientation;", joined).replace("begin orientation;", tip + "begin orientation;"))
    with pytest.raises(CaseError, match=f"{outer} is on {inner}: a blade of several bodies is not supported"):
        readers.read(path)


def test_a_rotor_that_turns_with_its_hubs(tmp_path: Path) -> None:
    """``ini_rotvec_d1`` of each hub, in the hub's axes, instead of that of the shaft: hub 1 m long, cone 3° upwind."""
    path = deck.htc(tmp_path)
    text = path.read_text().replace("  mbdy2_ini_rotvec_d1 0 0 -1 2.0943951023931953;\n", "")
    for n, azimuth in ((1, 180.0), (2, 60.0), (3, -60.0)):
        hub = np.eye(3)
        for k, degrees in ((0, -90.0), (1, azimuth), (0, 3.0)):
            hub = hub @ rotation(k, np.array(np.radians(degrees)))
        vector = " ".join(map(repr, (hub.T @ [0.0, 0.0, -1.0]).tolist()))
        text = text.replace(f"body2 hub{n} 1;", f"body2 hub{n} 1;\n  body2_ini_rotvec_d1 {vector} 2.0;", 1)
    path.write_text(text)
    blade = readers.read(path)
    assert blade.hub_radius == pytest.approx(1.0, rel=1e-12)
    np.testing.assert_allclose(np.degrees([blade.precone, blade.pitch]), [-3.0, 2.0], rtol=1e-9)
    pytest.importorskip("weio")
    with pytest.raises(NotReadError, match="no ini_rotvec_d1 of a shaft"):
        hawc2_turbine.read(path)


def test_a_blade_whose_axis_meets_the_shaft_ahead_of_its_end(tmp_path: Path) -> None:
    """A hub of two pieces, 0.3 m upwind and 1 m along the blade: its centre is where the axes of blade and shaft meet."""
    points: dict[str, list[deck.Point]] = {"hub1": [(0, 0, 0), (0, -0.3, 0), (0, -0.3, 1)]}
    path = deck.htc(tmp_path, {"hub1": deck.rigid(1.3)}, points)
    read, cone, tilt = hawc2.read(path), np.radians(3.0), np.radians(5.0)
    for blade in (readers.read(path), read.turbine.blade):
        assert blade.hub_radius == pytest.approx(1.0 - 0.3 * np.tan(cone), rel=1e-9)
        assert blade.precone == pytest.approx(-cone)
    moved = read.turbine.shaft[:3, 3] - hawc2.read(deck.htc(tmp_path)).turbine.shaft[:3, 3]
    np.testing.assert_allclose(moved, 0.3 / np.cos(cone) * np.array([np.sin(tilt), 0.0, -np.cos(tilt)]), atol=1e-9)


def test_other_lengths_are_stated(tmp_path: Path) -> None:
    """HAWC2 stretches the structural file: 20 m to 20.09 m."""
    path = deck.htc(tmp_path)
    path.write_text(path.read_text().replace("sec 3 0 0 20 8.0", "sec 3 0 0 20.09 8.0"))
    reading = readers.reading(path)
    assert "positions r of the structural file times 1.0045, so that they end with c2_def's arc" in " ".join(
        reading.source.notes
    )
    assert np.trapezoid(reading.blade.mass[:, 0, 0], reading.blade.stations) == pytest.approx(1275.0 * 1.0045)


FPM_DIAGONAL = (0, 6, 11, 15, 18, 20)
"""Places of the diagonal in the upper triangle of a 6×6 matrix, row by row."""

ROWS = {
    "shear": (["0 10 0 0 0 0 0 0 1 1 1e16 1e16 1e16 0 1 1e16 0 0 0"] * 2, "line 3: k_x: 0: it must be positive"),
    "beginning": (deck.rigid(1.0)[1:] * 2, "line 3: r: 1: the first station is the root; begin at 0"),
    "order": ([*deck.rigid(2.0), *deck.rigid(1.0)[1:]], "line 5: r: 1: before the previous station"),
    "end": (deck.rigid(1.0)[:1], "line 3: r: 0: the last station is the end: give two or more"),
}
"""Rows of a hub and why they are wrong."""


@pytest.mark.parametrize("name", ROWS)
def test_rows_of_a_rigid_body_are_checked_as_those_of_a_blade(tmp_path: Path, name: str) -> None:
    rows, message = ROWS[name]
    with pytest.raises(CaseError, match=rf"hub1.st: {message}"):
        hawc2.read(deck.htc(tmp_path, {"hub1": rows}))


def test_an_htc_that_only_continues_in_others(tmp_path: Path) -> None:
    path, main = deck.htc(tmp_path), tmp_path / "main.htc"
    main.write_text("begin simulation ;\nend simulation ;\ncontinue_in_file ./small.htc ;\nexit ;\n")
    assert hawc2.is_turbine(main)
    np.testing.assert_array_equal(hawc2.read(main).turbine.hub, hawc2.read(path).turbine.hub)
    np.testing.assert_array_equal(readers.read(main).mass, readers.read(path).mass)


def test_a_second_reading_of_tables_of_both_widths_is_not_a_wrong_one(tmp_path: Path) -> None:
    """wetb keeps the columns of the last table of a file only."""
    pytest.importorskip("weio")
    path = tmp_path / "blade.st"
    full = [
        f"{r} 100 0 0 0.1 0.2 0 0 0 " + " ".join("1e9" if k in FPM_DIAGONAL else "0" for k in range(21))
        for r in (0, 20)
    ]
    path.write_text("#1 both\n$1 3\n" + "\n".join(deck.ROWS["blade1"]) + "\n$2 2\n" + "\n".join(full) + "\n")
    for subset, mass in (((1, 1), 1275.0), ((1, 2), 2000.0)):
        blade = readers.read(path, Mount(subset=subset))
        assert np.trapezoid(blade.mass[:, 0, 0], blade.stations) == pytest.approx(mass)
    assert read_again("HAWC2", path, ReadingOptions(subset=(1, 2))).s[-1] == 20.0
    with pytest.raises(NotReadError, match="ValueError: zip"):
        read_again("HAWC2", path, ReadingOptions(subset=(1, 1)))
