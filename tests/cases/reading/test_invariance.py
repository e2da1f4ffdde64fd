"""A blade has the same frequencies in every description of it; a mistake of a convention is named."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.judge.results import Cell, PropertyCheck, Run
from southwell.cases.plan.blade import blades
from southwell.cases.reading import invariance
from southwell.cases.solve.invariances import Invariances
from southwell.core.blade import Blade, section_mass, section_stiffness
from southwell.core.element import discretize, sections
from southwell.core.space.inertia import transformed
from southwell.core.space.spatial import pose
from southwell.core.spectrum import refinement
from southwell.reports.shared import summary
from southwell.reports.shared.statuses import FAILED
from southwell.reports.verification import evidence, properties

S = np.linspace(0.0, 10.0, 5)
TIP = transformed(np.diag([20.0, 20.0, 20.0, 3.0, 2.0, 4.0]), pose(np.eye(3), np.array([0.0, 0.3, 0.1])))
OMEGA = 6.0


def blade(**changes: Any) -> Blade:
    """Twisted, prebent, swept, with a tip body and couplings: no sign is without effect."""
    stiffness = section_stiffness(1e8, 2e5, np.linspace(4e5, 1e5, 5), np.linspace(9e5, 3e5, 5), 4e7, 3e7)
    stiffness[:, 3, 4] = stiffness[:, 4, 3] = 4e4
    mass = transformed(section_mass(np.linspace(12.0, 6.0, 5), 0.05, 0.3), pose(np.eye(3), np.array([0.0, 0.05, 0.02])))
    z, y = 0.02 * S**2 / 10.0, -0.015 * S**2 / 10.0
    slope = np.gradient(z, S, edge_order=2) ** 2 + np.gradient(y, S, edge_order=2) ** 2
    x = S - np.concatenate([[0.0], np.cumsum(np.diff(S) * 0.5 * 0.5 * (slope[1:] + slope[:-1]))])
    correct = Blade(
        "wing", S, stiffness, mass, np.linspace(0.3, 0.0, 5), 1.5, np.stack([x, y, z], axis=1), 0.05, 0.03, TIP
    )
    return replace(correct, **changes)


def checked(of: Blade) -> dict[str, PropertyCheck]:
    return {row.part: row for row in Invariances("wing", of, OMEGA, 3)()}


def test_all_descriptions_have_the_same_frequencies() -> None:
    rows = checked(blade())
    assert list(rows) == [i.name for i in invariance.INVARIANCES]
    assert {row.verdict for row in rows.values()} == {"pass"}
    assert max(abs(row.difference or 0.0) for row in rows.values()) < 1e-7


def test_at_a_kink_a_moved_axis_converges_with_the_first_order(monkeypatch: pytest.MonkeyPatch) -> None:
    """A strip swept by 45° (OWENSFEA.jl 1f201a4, scaled): a moved axis was called wrong by 0.034 % ± 0.016 %."""
    s, end = np.array([0.0, 0.25, 0.5]), 0.25 + 0.25 / np.sqrt(2)
    curve = np.array([[0.0, 0.0, 0.0], [0.25, 0.0, 0.0], [end, 0.25 - end, 0.0]])
    stiffness = section_stiffness(np.full(3, 2.1e8), 19824.21875, 7000.0, 43750.0, 6.730769e7, 6.730769e7)
    mass = np.repeat(section_mass(7.8, 2.6e-4, 1.625e-3), 3, axis=0)
    strip = Blade("strip", s, stiffness, mass, np.zeros(3), curve=curve, kinks=(0.25,))
    moved = [i for i in invariance.INVARIANCES if i.name == "reference axis moved"]
    monkeypatch.setattr("southwell.cases.solve.invariances.INVARIANCES", moved)
    [row] = Invariances("strip", strip, 200 * np.pi, 6)()
    assert row.verdict == "pass"
    assert 1e-6 < (row.target or 0.0) < 2e-5


def test_a_hinged_root_turns_with_its_blade() -> None:
    rows = checked(blade(root=np.array([np.inf, np.inf, np.inf, np.inf, 0.0, np.inf]), tip_mass=np.zeros((6, 6))))
    assert rows["pitch stated as twist"].reason == "the root is not clamped: its hinge turns with the pitch"
    assert {r.verdict for r in rows.values()} == {"pass", "not applicable"}


def test_rigid_strains_are_stiff_in_both_descriptions() -> None:
    stiffness = section_stiffness(np.inf, np.inf, np.linspace(4e5, 1e5, 5), np.linspace(9e5, 3e5, 5))
    straight = blade(stiffness=stiffness, curve=np.zeros((0, 3)))
    assert {r.verdict for r in checked(straight).values()} == {"pass"}


def _tip_in_blade_axes(original: Any) -> Any:
    def wrong(of: Blade, *args: Any, **kwargs: Any) -> Any:
        turned = invariance._turned(of.twist[-1])
        return original(replace(of, tip_mass=turned @ of.tip_mass @ turned.T), *args, **kwargs)

    return wrong


def _not_coned(original: Any) -> Any:
    def wrong(of: Blade) -> Any:
        out = original(of)
        out[:3, 3] = [of.hub_radius, 0.0, 0.0]
        return out

    return wrong


def _altered(**fields: Callable[[Blade], Any]) -> Any:
    def make(original: Any) -> Any:
        return lambda of, *args, **kwargs: original(
            replace(of, **{name: value(of) for name, value in fields.items()}), *args, **kwargs
        )

    return make


def _one_sign(i: int, j: int) -> Any:
    """An entry of the sections' inertia loses its sign."""
    entry = np.zeros((6, 6), dtype=bool)
    entry[i, j] = entry[j, i] = True
    return lambda original: lambda of, s: np.where(entry, np.abs(original(of, s)), original(of, s))


MISTAKES = {
    "the tip body is given in the blade's axes": ((discretize, "discretize", _tip_in_blade_axes), "section axes turned"),
    "the hub radius is not coned": (
        (sections, "root", _not_coned),
        "precone stated by the curve",
    ),
    "the pitch has the opposite sense": (
        (sections, "root", _altered(pitch=lambda b: -b.pitch)), "pitch stated as twist",
    ),
    "the precone has the opposite sense": (
        (sections, "root", _altered(precone=lambda b: -b.precone)), "precone stated by the curve",
    ),
    "the twist has the opposite sense": (
        (sections, "twist_at", lambda right: lambda of, s: -right(of, s)), "section axes turned",
    ),
    "the twist is that of the station before": (
        (sections, "twist_at", lambda right: lambda of, s: right(of, np.asarray(s) - np.diff(of.stations).min())),
        "stations split",
    ),
    "the edgewise offset of mass has one sign": (
        (discretize, "mass_at", _one_sign(0, 5)), "mirror image with reversed rotation",
    ),
    "the flapwise offset of mass has one sign": (
        (discretize, "mass_at", _one_sign(0, 4)), "mirror image in the rotor's plane",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MISTAKES)
def test_a_wrong_convention_is_named(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    (owner, attribute, make), first = MISTAKES[name]
    original = getattr(owner, attribute)
    monkeypatch.setattr(owner, attribute, make(original))
    if attribute == "discretize":
        monkeypatch.setattr(refinement, attribute, make(original))
    kind = next(i for i in invariance.INVARIANCES if i.name == first)
    row = Invariances("wing", blade(), OMEGA, 2)._row(kind, [])
    assert row.verdict == "fail"
    assert row.reason.startswith(f"{first}: mode ")
    assert row.reason.endswith(f": wrong: {kind.convention}")


def test_only_blades_of_users_are_redescribed() -> None:
    (subject,) = blades(library.load("pretwisted-beam"))
    assert not subject.users
    assert replace(subject, case=replace(subject.case, path="elsewhere/blade.toml")).users


def test_frequencies_that_depend_on_the_description_give_status_1() -> None:
    cell = Cell(
        *("wing", 1.0, 1, "flapwise", "a-code", "1", "code", 5.0, 5.0, 0.0, 1e-9, 1e-3, "pass"),
        shares="nothing",
        ordinal=1,
    )
    row = partial(PropertyCheck, "wing", "southwell", "1", "invariance")
    reason = "stations split: mode 1 changes by +2.00 %"
    altered = row("stations split", 1e-8, "fail", reason, value=5.1, reference=5.0, unit="rad/s", difference=0.02)
    run = Run((cell,), property_checks=(altered,))
    assert summary.status(run) == FAILED
    assert evidence.verdict(run) == "No: frequencies change in 1 other description of the same blade."
    assert properties.lines(run) == ["Invariance: stations split: mode 1 changes by +2.00 % (wing)."]
    correct = Run((cell,), property_checks=(replace(altered, difference=1e-9, verdict="pass", reason=""),))
    assert properties.lines(correct) == [
        "Invariances: frequencies of wing are equal in 1 other descriptions, to 1.0e-07 %."
    ]
