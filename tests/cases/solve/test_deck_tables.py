"""Numbers that other programs computed from a published deck appear for that deck, and only for it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input.readers import Mount
from southwell.cases.plan.request import Request
from southwell.cases.plan.subjects import subjects
from southwell.cases.solve.published_tables import about, about_deck
from southwell.core.blade import Blade
from southwell.references.protocol.process import Limits

EXAMPLES = Path(__file__).parents[3] / "examples"
MOUNT = Mount(length=61.5, hub_radius=1.5)
RPM = np.pi / 30


def blade(name: str) -> Blade:
    (subject,) = subjects(Request((str(EXAMPLES / name),), rpm="1", mount=MOUNT), lambda _: None)
    assert subject.blade is not None
    return subject.blade


@pytest.mark.parametrize(
    ("name", "rpm", "tables"),
    [
        ("nrel-5mw-blade.dat", 0.0, {"openfast/elastodyn"}),
        ("nrel-5mw-blade.dat", 12.1, set()),
        ("mbwind-5mw-blade.csv", 0.0, {"mbwind/mbwind"}),
        ("mbwind-5mw-blade.csv", 20.0, {"mbwind/mbwind", "mbwind/bladed"}),
    ],
)
def test_a_deck_is_recognised_by_length_and_mass(name: str, rpm: float, tables: set[str]) -> None:
    assert {p.name for p in about_deck(blade(name), np.array([rpm * RPM]))} == tables


def test_another_blade_has_none() -> None:
    correct = blade("nrel-5mw-blade.dat")
    assert not about_deck(replace(correct, mass=1.005 * correct.mass), np.zeros(1))
    assert not [p for p in about(correct, ("hawcstab2", "mbwind")) if p.series.deck]


def test_the_columns_are_those_of_a_file() -> None:
    request = Request((str(EXAMPLES / "mbwind-5mw-blade.csv"),), rpm="10,20", mount=MOUNT)
    (subject,) = subjects(request, lambda _: None)
    columns = [c for c in subject.columns((), Limits(), ()) if c.head.role == "table"]
    assert [c.code for c in columns] == ["mbwind/bladed", "mbwind/mbwind"]
    references = subject.references(columns)()
    bladed, mbwind = (c(subject.points, references[c.effects])[0] for c in columns)
    assert {c.verdict for c in bladed} == {"coarse"}
    assert {c.verdict for c in mbwind} == {"pass"}
    assert max(abs(c.difference or 0.0) for c in bladed) == pytest.approx(9.8e-3, rel=0.02)
