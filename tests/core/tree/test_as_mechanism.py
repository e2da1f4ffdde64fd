"""A blade as a general mechanism: the mechanism solver against the chain solver, with the same bodies and elements."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from southwell.cases.input import library
from southwell.core import solve
from southwell.core.blade import Blade
from southwell.core.element.discretize import Mass, discretize
from southwell.core.element.measures import Measure
from southwell.core.element.mesh import JointLink
from southwell.core.mechanism.description import Body, Load, Mechanism, MechanismError, Motion, inertia
from southwell.core.mechanism.joints import Joint
from southwell.core.space import spatial as sp
from southwell.core.spectrum.eigen import Eigen
from southwell.core.spectrum.modal import linearize, modes
from southwell.core.steady import blade_state
from southwell.core.tree import as_mechanism
from southwell.tests.support.beams import PARK, curved, tapered
from southwell.tests.support.dense import dense
from southwell.tests.support.units import random_blade

BLADES = {v.name: v for case in library.load_all()[0].values() for v in case.variants}
AGREE = 1e-9
Array = np.ndarray
NONE = np.zeros(3)
CLAMPED = np.inf
ROOTS = {
    "flap": [CLAMPED, CLAMPED, CLAMPED, CLAMPED, 0.0, CLAMPED],
    "lag": [CLAMPED, CLAMPED, CLAMPED, CLAMPED, CLAMPED, 0.0],
    "both hinges": [CLAMPED, CLAMPED, CLAMPED, CLAMPED, 0.0, 0.0],
    "both springs": [CLAMPED, CLAMPED, CLAMPED, CLAMPED, 1e8, 1e8],
    "pitch spring": [CLAMPED, CLAMPED, CLAMPED, 1e6, CLAMPED, CLAMPED],
    "all springs": [1e7, 1e8, 1e8, 1e7, 1e7, 1e7],
}


def assert_agreement(blade: Blade, omega: float, elements: int, gravity: Array = NONE, **options: Any) -> None:
    """The six lowest frequencies as a mechanism and as a mesh."""
    built = as_mechanism.mechanism(discretize(blade, elements, **options), omega, tuple(gravity.tolist()))
    hub, *others = built.motions
    frozen = (Motion(hub.coordinate, law=Polynomial([0.0, omega])), *others)  # gravity turns, seen from the blade
    own = modes(linearize(replace(built, motions=frozen)), 6)
    assert isinstance(own, Eigen)
    expected = solve.mesh_modes(blade, omega, elements, 6, gravity=gravity, **options)
    np.testing.assert_allclose(own.frequencies, expected.frequencies, rtol=AGREE)


@pytest.mark.parametrize("name", BLADES)
def test_every_blade_with_consistent_mass(name: str) -> None:
    elements = 50 if name == "rotating-cable" else 16  # whose fewer elements have no stable state
    assert_agreement(BLADES[name].blade, float(BLADES[name].speeds[-1]), elements)


@pytest.mark.parametrize(("mass", "stiffness"), [("consistent", "corotational"), ("half_end", "body_fixed")])
@pytest.mark.parametrize("root", [None, *ROOTS])
@pytest.mark.parametrize("make", [tapered, curved])
def test_loads_gravity_and_joints_at_the_root(
    make: Callable[[], Blade], root: str | None, mass: Mass, stiffness: Measure
) -> None:
    """All at once on a blade that is twisted, and on one that is swept, prebent, coned, pitched, coupled and sheared."""
    blade = make() if root is None else replace(make(), root=np.array(ROOTS[root]))
    weight = blade.mass[:, 0, 0][:, None]
    load, gravity = weight * [1.0, -2.0, 3.0], np.array([3.0, 5.0, -9.81])
    assert_agreement(blade, 2.5, 10, gravity, load=load, mass=mass, stiffness=stiffness)


def test_a_link_of_a_joint_has_one_coordinate() -> None:
    """Clamped coordinates have no link; a hinge off the node's origin keeps its axis."""
    blade = replace(PARK, root=np.array([CLAMPED] * 4 + [0.0, 7.0]), twist=np.array([1.2, 0.0]))
    built = as_mechanism.mechanism(discretize(blade, 3), 10.0)
    assert [joint.kind for joint in built.joints] == ["revolute", "fixed", "revolute", "revolute", *["elastic"] * 3]
    assert [(s.coordinate, s.stiffness) for s in built.coordinate_springs] == [("element 2.rz", 7.0)]
    offset = JointLink(0, np.array([0.0, 0.0, 2.0, 0.0, 1.0, 0.0]))  # about y, through the point 2 m along x
    kind, frame = as_mechanism._along(offset.screw)
    assert kind == "revolute"
    np.testing.assert_allclose(frame[:3, 3], [2.0, 0.0, 0.0])
    np.testing.assert_allclose(frame[:3, 2], [0.0, 1.0, 0.0])


def test_a_root_on_many_springs_is_that_of_the_mechanism() -> None:
    """Three rotations and a displacement on springs, coned and twisted: the two solvers agree to rounding."""
    blade, omega = random_blade(np.random.default_rng(1))
    root = np.array([5.07e6, CLAMPED, CLAMPED, 4.78e9, 1.71e8, 1.68e9])
    mesh = discretize(replace(blade, root=root), 16)
    expected = modes(linearize(as_mechanism.mechanism(mesh, omega)), 6).frequencies
    computed = solve.mesh_modes(replace(blade, root=root), omega, 16, 6).frequencies
    np.testing.assert_allclose(computed, expected, rtol=1e-12)


def test_the_stiffness_on_two_hinges_that_have_turned_is_symmetric() -> None:
    """Flap and lag do not commute: without the geometric stiffness of the reaction, K of the chain is not symmetric."""
    body = discretize(replace(curved(), root=np.array(ROOTS["both hinges"])), 4)
    state = blade_state.steady_state(body, 2.5, np.array([3.0, 5.0, -9.81]))
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
