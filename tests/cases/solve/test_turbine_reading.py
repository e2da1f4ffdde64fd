"""A second reading of a turbine's primary file: agreement, and mistakes of the reader that it names."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input.readers.openfast import elastodyn_tower
from southwell.cases.input.readers.openfast import turbine as reader
from southwell.cases.plan import turbine as plan
from southwell.cases.solve.turbine_reading import read_again
from southwell.core.blade import Blade
from southwell.core.turbine.turbine import shaft_pose
from southwell.references.protocol.process import Limits
from southwell.tests.support.turbine_decks import deck

pytest.importorskip("weio")


def wrong(path: Path) -> set[str]:
    return {row.part for row in read_again("small", reader.read(path).turbine, path) if row.verdict == "fail"}


def test_both_readings_agree(tmp_path: Path) -> None:
    path = deck(tmp_path)
    reading = reader.read(path)
    rows = plan.subject(path, reading.turbine, reading.source, (2.0,), rpm=False).property_checks((), Limits()).rows
    assert {row.verdict for row in rows} == {"pass"}
    assert {"rise of the shaft downwind", "flapwise stiffness", "precone"} <= {row.part for row in rows}


MISTAKES = {
    "sign of the tilt": (
        (reader, "shaft_pose", lambda up, over, tilt: shaft_pose(up, over, -tilt)),
        {"rise of the shaft downwind", "hub's centre above the tower's top"},
    ),
    "sign of the overhang": (
        (reader, "shaft_pose", lambda up, over, tilt: shaft_pose(up, -over, tilt)),
        {"hub's centre downwind of the tower's top", "hub's centre above the tower's top"},
    ),
    "nacelle's inertia about its mass centre": (
        (
            reader,
            "_nacelle",
            lambda main, named, right=reader._nacelle: right(main, named) + np.diag([0.0] * 3 + [500.0] * 3),
        ),
        {"nacelle's inertia about the yaw axis"},
    ),
    "gear ratio ignored": (
        (reader, "Drivetrain", lambda k, J, ratio, free, right=reader.Drivetrain: right(k, J, 1.0, free)),
        {"generator's inertia on the rotor's side"},
    ),
    "fore-aft for side-to-side": (
        (
            elastodyn_tower,
            "beam",
            lambda text, height, right=elastodyn_tower.beam: (exchanged(right(text, height)[0]), ()),
        ),
        {"fore-aft stiffness along the tower", "side-to-side stiffness along the tower"},
    ),
}


def exchanged(tower: Blade) -> Blade:
    stiffness = tower.stiffness.copy()
    stiffness[:, 4, 4], stiffness[:, 5, 5] = tower.stiffness[:, 5, 5], tower.stiffness[:, 4, 4]
    return replace(tower, stiffness=stiffness)


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_of_the_reader_is_named(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seam, parts = MISTAKES[name]
    path = deck(tmp_path)
    monkeypatch.setattr(*seam)
    assert wrong(path) == parts


def test_a_file_that_weio_cannot_read_is_said(tmp_path: Path) -> None:
    path = deck(tmp_path)
    turbine = reader.read(path).turbine
    (tmp_path / "tower.dat").unlink()
    (row,) = read_again("small", turbine, path)
    assert row.verdict == "not run"
    assert row.reason
