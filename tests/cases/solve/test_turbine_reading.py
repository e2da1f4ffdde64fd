"""A second reading of a turbine's files: agreement, and mistakes of the reader that it names."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from southwell.cases.input.readers.hawc2 import drivetrain, orientation, rigid
from southwell.cases.input.readers.hawc2 import turbine as hawc2
from southwell.cases.input.readers.openfast import elastodyn_tower
from southwell.cases.input.readers.openfast import turbine as reader
from southwell.cases.input.readers.source import Mount
from southwell.cases.plan import turbine as plan
from southwell.cases.solve import turbine_weights
from southwell.cases.solve.turbine_reading import read_again
from southwell.core.blade import Blade
from southwell.core.turbine.turbine import Drivetrain, shaft_pose
from southwell.references.protocol.process import Limits
from southwell.tests.support import htc_decks
from southwell.tests.support.turbine_decks import deck

pytest.importorskip("weio")


def wrong(path: Path) -> set[str]:
    return {row.part for row in read_again("small", reader.read(path).turbine, path) if row.verdict == "fail"}


def test_both_readings_agree(tmp_path: Path) -> None:
    path = deck(tmp_path)
    reading = reader.read(path)
    rows = plan.subject(path, reading, (2.0,), False, Mount()).property_checks((), Limits()).rows
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


HEAVY = {
    "towertop": htc_decks.rigid(1.1, 500.0, (0.0, 0.0, 0.4)),
    "shaft": [htc_decks.section(r, 100.0 + r, 1e16, 1e16, 5e7 - r * 1e7, (0.0, 0.0, 0.5)) for r in (0.0, 2.5)],
    "hub1": htc_decks.rigid(1.0, 200.0, (0.0, 0.0, 0.5)),
}
"""Bodies of an htc with sections that weigh something."""


def htc_rows(path: Path) -> dict[str, str]:
    """Verdict of each quantity, and of what core's turbine weighs, by the second reading of an htc."""
    read = hawc2.read(path)
    subject = plan.subject(path, read, (2.0,), False, Mount())
    rows, weighed = subject.second_reading(path)
    assert weighed
    rows += turbine_weights.of_solver("small", read.turbine, weighed)
    return {row.part: row.verdict for row in rows}


def test_both_readings_of_an_htc_agree(tmp_path: Path) -> None:
    rows = htc_rows(htc_decks.htc(tmp_path, HEAVY))
    assert {"stiffness of the shaft", "cone of the blades", "inertia about the base, roll"} <= rows.keys()
    assert set(rows.values()) == {"pass"}


def other_way(original: Callable[..., Any], sign: Sequence[int]) -> Callable[..., Any]:
    """A concentrated mass with its place from the node mirrored."""

    def masses(body: Sequence[Any], nodes: np.ndarray) -> Any:
        out, left = original(body, nodes)
        mirror = np.diag([*sign, *(int(np.prod(sign)) * s for s in sign)]).astype(float)
        return tuple(replace(m, inertia=mirror @ m.inertia @ mirror) for m in out), left

    return masses


HTC_MISTAKES = {
    "sign of the cone": (
        (
            orientation,
            "mounted",
            lambda root, axes, axis, right=orientation.mounted: replace(
                m := right(root, axes, axis), precone=-m.precone
            ),
        ),
        {"cone of the blades"},
    ),
    "nacelle upwind": (
        (rigid, "_masses", other_way(rigid._masses, (1, -1, 1))),
        {"moment of the nacelle's mass downwind"},
    ),
    "nacelle to starboard": (
        (rigid, "_masses", other_way(rigid._masses, (-1, 1, 1))),
        {"moment of the nacelle's mass to port"},
    ),
    "generator doubled": (
        (drivetrain, "Drivetrain", lambda k, J, ratio, free: Drivetrain(k, 2.0 * J, ratio, free)),
        {"generator's inertia on the rotor's side"},
    ),
}


@pytest.mark.parametrize("name", HTC_MISTAKES)
def test_a_mistake_of_the_htcs_reader_is_named(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seam, parts = HTC_MISTAKES[name]
    path = htc_decks.htc(tmp_path)
    monkeypatch.setattr(*seam)
    turbine = hawc2.read(path).turbine
    assert {row.part for row in read_again("small", turbine, path) if row.verdict == "fail"} >= parts


def test_an_htc_with_a_body_beside_is_not_read_again(tmp_path: Path) -> None:
    path = htc_decks.htc(tmp_path)
    held = "begin relative;\n  body1 towertop last;\n  body2 box 1;\nend relative;\n"
    path.write_text(path.read_text().replace("end orientation;", held + "end orientation;"))
    (row,) = read_again("small", reader.read(deck(tmp_path)).turbine, path)
    assert row.verdict == "not run"
    assert "box carries no blade" in row.reason
