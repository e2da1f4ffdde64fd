"""A blade's modes by the paper's method against those of the chain solver, which never forms B: same discretisation, 1e-9."""

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.input.schema import Case, Variant
from southwell.cases.judge.results import Run
from southwell.cases.judge.witnesses import groups, witnesses
from southwell.cases.verify.columns import OTHER_METHOD, columns
from southwell.cases.verify.reference import references
from southwell.core import solve
from southwell.core import velocity_transformation as vt
from southwell.core.blade import Blade
from southwell.core.effects import Effects
from southwell.core.element.discretize import Mass, discretize
from southwell.core.mechanism.description import Body, Load, Mechanism, MechanismError, Motion, inertia
from southwell.core.mechanism.joints import Joint
from southwell.core.modes import Modes
from southwell.core.space import spatial as sp
from southwell.core.spectrum.eigen import UnstableError
from southwell.core.spectrum.modal import linearize
from southwell.core.steady import blade_state as steady
from southwell.core.steady.blade_state import SteadyStateError
from southwell.core.tree import as_mechanism
from southwell.references.protocol.process import Limits
from southwell.reports.cli import app as cli
from southwell.tests.support.beams import PARK, curved, tapered, yoo_shin
from southwell.tests.support.dense import dense

BLADES: dict[str, tuple[Case, Variant]] = {
    variant.name: (case, variant) for case in library.everything()[0].values() for variant in case.variants
}
AGREE = 1e-9
CLAMPED = np.inf
ROOTS = {
    "flap": [CLAMPED, CLAMPED, CLAMPED, CLAMPED, 0.0, CLAMPED],
    "lag": [CLAMPED, CLAMPED, CLAMPED, CLAMPED, CLAMPED, 0.0],
    "both hinges": [CLAMPED, CLAMPED, CLAMPED, CLAMPED, 0.0, 0.0],
    "both springs": [CLAMPED, CLAMPED, CLAMPED, CLAMPED, 1e8, 1e8],
    "pitch spring": [CLAMPED, CLAMPED, CLAMPED, 1e6, CLAMPED, CLAMPED],
    "all springs": [1e7, 1e8, 1e8, 1e7, 1e7, 1e7],
}


def assert_agreement(blade: Blade, omega: float, elements: int, count: int = 6, **options: Any) -> tuple[Modes, Modes]:
    ours, theirs = (solver(blade, omega, elements, count, **options) for solver in (vt.modes, solve.mesh_modes))
    assert ours.elements == theirs.elements
    np.testing.assert_allclose(ours.frequencies, theirs.frequencies, rtol=AGREE)
    return ours, theirs


def mac(ours: Modes, theirs: Modes) -> np.ndarray:
    """MAC of complex shapes one by one: 1 if they differ by a complex factor only, so phases too must agree."""
    a, b = (m.shapes.reshape(len(m.frequencies), -1) for m in (ours, theirs))
    return np.abs((a.conj() * b).sum(1)) ** 2 / ((np.abs(a) ** 2).sum(1) * (np.abs(b) ** 2).sum(1))


@pytest.mark.parametrize("name", BLADES)
def test_every_blade_with_consistent_mass(name: str) -> None:
    blade, omega = BLADES[name][1].blade, float(BLADES[name][1].speeds[-1])
    elements = 50 if name == "rotating-cable" else 16  # whose fewer elements have no stable state
    assert_agreement(blade, omega, elements)


@pytest.mark.parametrize("name", BLADES)
def test_every_blade_with_the_papers_elements(name: str) -> None:
    """51 bodies with half of each element's mass, stiffness in the parent's frame."""
    blade, omega = BLADES[name][1].blade, float(BLADES[name][1].speeds[-1])
    options: dict[str, Any] = {"mass": "half_end", "stiffness": "body_fixed"}
    if name == "rotating-cable":  # almost no bending stiffness, and no geometric stiffness inside the elements
        for method in (vt, solve):
            with pytest.raises(UnstableError, match="not positive definite"):
                method.modes(blade, omega, 50, 3, **options)
        return
    assert_agreement(blade, omega, 50, **options)


def test_the_papers_table() -> None:
    """Park et al. (2010), Table 1, column Present, to its last digit, by the paper's method."""
    found = vt.modes(PARK, 10.0, 50, 6, mass="half_end", stiffness="body_fixed", effects=Effects(rotary_inertia=False))
    tip = np.abs(found.shapes[:, -1])
    assert [f"{f:.4g}" for f in found.frequencies[tip[:, 1] > tip[:, 2]][:3]] == ["11.71", "70.37", "189.7"]


@pytest.mark.parametrize("mass", ["consistent", "half_end"])
@pytest.mark.parametrize("root", [None, *ROOTS])
@pytest.mark.parametrize("make", [tapered, curved])
def test_loads_gravity_and_joints_at_the_root(make: Callable[[], Blade], root: str | None, mass: Mass) -> None:
    """All at once on a blade that is twisted, and on one that is swept, prebent, coned, pitched, coupled and sheared."""
    blade = make() if root is None else replace(make(), root=np.array(ROOTS[root]))
    weight = blade.mass[:, 0, 0][:, None]
    options: dict[str, Any] = {"mass": mass, "load": weight * [1.0, -2.0, 3.0], "gravity": np.array([3.0, 5.0, -9.81])}
    loaded, theirs = assert_agreement(blade, 2.5, 10, **options)
    assert mac(loaded, theirs).min() > 1 - 1e-9
    bare = vt.modes(blade, 2.5, 10, 6, mass=mass)
    for name in ("load", "gravity"):
        one = vt.modes(blade, 2.5, 10, 6, **{**options, name: None})
        assert np.abs(one.frequencies / loaded.frequencies - 1).max() > 1e-6
    assert np.abs(bare.frequencies / loaded.frequencies - 1).max() > 1e-4


@pytest.mark.parametrize("root", [None, "both hinges"])
def test_a_sweep_agrees_with_single_speeds(root: str | None) -> None:
    """Up, down and through a speed twice, from extrapolated states, against the chain solver at each speed alone."""
    blade = curved() if root is None else replace(curved(), root=np.array(ROOTS[root]))
    speeds = [0.5, 1.0, 2.0, 2.0, 2.5, 1.5]
    gravity = np.array([3.0, 5.0, -9.81])
    for omega, found in zip(speeds, vt.sweep(blade, speeds, 8, 5, gravity=gravity), strict=True):
        alone = solve.mesh_modes(blade, omega, 8, 5, gravity=gravity)
        np.testing.assert_allclose(found.frequencies, alone.frequencies, rtol=AGREE)
        assert mac(found, alone).min() > 1 - 1e-9


@pytest.mark.parametrize("effects", [Effects(coriolis=False), Effects(rotary_inertia=False)])
def test_effects_left_out(effects: Effects) -> None:
    ours, _ = assert_agreement(yoo_shin(0.1) if effects.rotary_inertia else PARK, 10.0, 12, effects=effects)
    full = vt.modes(yoo_shin(0.1) if effects.rotary_inertia else PARK, 10.0, 12, 6)
    assert np.abs(ours.frequencies / full.frequencies - 1).max() > 1e-4


def test_effects_without_prestress_are_refused() -> None:
    for effects in (Effects(prestretch=False), Effects(geometric=False)):
        with pytest.raises(ValueError, match="use the chain solver"):
            vt.modes(PARK, 10.0, 5, 3, effects=effects)


@pytest.mark.parametrize(
    ("arguments", "match"),
    [((PARK, 10.0, 0), "elements: 0"), ((PARK, 10.0, 201), "at most 200"), ((PARK, 10.0, 5, 0), "count: 0")],
)
def test_bad_arguments_are_named(arguments, match: str) -> None:
    with pytest.raises(ValueError, match=match):
        vt.modes(*arguments)


def test_no_steady_state_past_the_critical_speed() -> None:
    with pytest.raises((SteadyStateError, UnstableError), match=r"rad/s"):
        vt.modes(yoo_shin(0.0), 112.0, 12, 2)


def test_a_free_hinge_at_rest_is_reported() -> None:
    with pytest.raises(UnstableError, match="free hinge"):
        vt.modes(replace(PARK, root=np.array(ROOTS["flap"])), 0.0, 8, 3)


def test_clamped_coordinates_of_a_root_joint_are_prescribed() -> None:
    blade = replace(PARK, root=np.array([CLAMPED] * 4 + [0.0, 0.0]), twist=np.array([1.2, 0.0]))
    built = as_mechanism.mechanism(discretize(blade, 3), 10.0)
    prescribed = {m.coordinate for m in built.motions}
    assert prescribed == {"element 1.rx", "element 1.x", "element 1.y", "element 1.z", "hub.rz"}


def test_the_stiffness_on_two_hinges_that_have_turned_is_symmetric() -> None:
    """Flap and lag do not commute: without the geometric stiffness of the reaction, K of the chain is not symmetric."""
    body = discretize(replace(curved(), root=np.array(ROOTS["both hinges"])), 4)
    state = steady.steady(body, 2.5, np.array([3.0, 5.0, -9.81]))
    K = dense(state.pencil, state.pencil.K)
    assert np.abs(K - K.T).max() < 1e-9 * np.abs(K[:12, :12]).max()
    turned = sp.inverse(state.shape.nodes[0]) @ state.shape.nodes[1]
    assert np.abs(turned[:3, 3]).max() < 1e-14  # it stays on the hinge


# loads of any mechanism -----------------------------------------------------------------------------------------------


def swung(load: Load, prescribed: bool = True) -> Mechanism:
    """A mass on a rod of 2 m hinged to the hub 0.5 m off the axis, in the plane of rotation."""
    hinge = np.eye(4)
    hinge[0, 3] = 0.5
    tip = np.eye(4)
    tip[0, 3] = -2.0
    return Mechanism(
        (Body("hub", inertia(1.0, 5.0)), Body("mass", inertia(3.0))),
        (
            Joint("shaft", "revolute", "ground", "hub"),
            Joint("lag", "revolute", "hub", "mass", hinge, tip),
        ),
        (Motion("shaft.rz", 0.0, 10.0, prescribed=prescribed),),
        loads=(load,),
    )


def test_a_load_that_turns_with_the_hub_bends_the_pendulum() -> None:
    """m e r Ω² sin θ = F r cos θ; stiffness of that balance over m r²: Ω² e cos θ / r + F sin θ / (m r)."""
    linear = linearize(swung(Load("mass", np.array([0.0, 40.0, 0.0]), "hub")))
    theta = np.arctan(40.0 / (3.0 * 0.5 * 100.0))
    assert linear.state.q[1] == pytest.approx(theta, rel=1e-12)
    K = 3.0 * 2.0 * 0.5 * 100.0 * np.cos(theta) + 40.0 * 2.0 * np.sin(theta)
    assert linear.K[0, 0] == pytest.approx(K, rel=1e-12)


def test_a_load_in_axes_that_vibrate_is_refused() -> None:
    with pytest.raises(MechanismError, match=r"load in the axes of 'hub': coordinate 'shaft.rz'"):
        linearize(swung(Load("mass", np.array([0.0, 40.0, 0.0]), "hub"), prescribed=False))
    with pytest.raises(MechanismError, match="give three finite components"):
        linearize(swung(Load("mass", np.array([0.0, np.nan, 0.0]), "hub")))
    with pytest.raises(MechanismError, match="'wing' is unknown"):
        linearize(swung(Load("wing", np.zeros(3), "hub")))


# in the matrix and on the command line --------------------------------------------------------------------------------


@pytest.mark.parametrize("name", BLADES)
def test_the_column_is_there_for_every_blade_and_is_no_witness(name: str) -> None:
    case, variant = BLADES[name]
    (column,) = (c for c in columns(case, variant, [], Limits()) if c.name == OTHER_METHOD)
    if name not in (
        "tip-mass",
        "articulated/both",
    ):  # the matrix's tests run the column for the others
        return
    speeds = variant.speeds.tolist()[-2:]
    cells, _ = column(speeds, references(variant.blade, speeds, case.text.compare, [column.effects])[column.effects])
    assert [c.mode for c in cells] == list(range(1, case.text.compare.modes + 1))
    assert {(c.verdict, c.omega, c.role, c.shares) for c in cells} == {
        ("pass", speeds[-1], "same discretisation", "everything")
    }
    assert max(abs(c.difference or 0.0) for c in cells) < AGREE
    assert not groups(witnesses(Run(tuple(cells)), cells[0].case))


def command(*arguments: str) -> int:
    with pytest.raises(SystemExit) as end:
        cli.main(["modes", "park-cantilever", "--omega", "10", "--json", *arguments])
    return int(end.value.code or 0)


def test_the_command_takes_the_method(capsys: pytest.CaptureFixture[str]) -> None:
    found = []
    for method in ("chain", "velocity-transformation"):
        assert command("--elements", "8", "--method", method) == 0
        found.append([row["frequency_rad_s"] for row in json.loads(capsys.readouterr().out)])
    np.testing.assert_allclose(*found, rtol=AGREE)
    assert command("--elements", "300", "--method", "velocity-transformation") == 2
    assert "--elements 300" in capsys.readouterr().err
