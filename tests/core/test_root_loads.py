"""Steady loads at the root against closed forms and a boundary value problem of the elastica."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from southwell.cases.input.properties import about_hub
from southwell.core.blade import Blade, uniform_blade
from southwell.core.root_loads import root_loads
from southwell.core.steady.blade_state import LargeStrainError, SteadyStateError

Array = np.ndarray[Any, np.dtype[np.float64]]

OMEGA = 30.0
BEAM = uniform_blade("beam", 6.0, 0.3, EA=1e6, GJ=1e3, EI_y=1e4, EI_z=4e4, mass=1.2)


def stiff() -> Blade:
    """Practically rigid: coned, pitched, twisted and curved, with mass centres off the axis, and a body at the tip."""
    s = np.linspace(0.0, 6.0, 13)
    mass = np.zeros((13, 6, 6))
    for k, x in enumerate(s):
        y, z, m = 0.1 + 0.02 * x, -0.05, 3.0 - 0.2 * x
        arm = np.array([[0.0, z, -y], [-z, 0.0, 0.0], [y, 0.0, 0.0]])
        mass[k, :3, :3], mass[k, :3, 3:], mass[k, 3:, :3] = m * np.eye(3), m * arm, m * arm.T
        mass[k, 3:, 3:] = m * arm.T @ arm + np.diag([0.05, 0.01, 0.04])
    curve = np.stack([s, 0.002 * s**2, -0.003 * s**2], axis=1)
    curve[:, 0] = np.concatenate(
        [[0.0], np.cumsum(np.sqrt(np.diff(s) ** 2 - (np.diff(curve[:, 1:], axis=0) ** 2).sum(1)))]
    )
    return Blade(
        name="stiff",
        stations=s,
        stiffness=np.tile(1e14 * np.eye(6), (13, 1, 1)),
        mass=mass,
        twist=np.linspace(0.4, -0.1, 13),
        hub_radius=1.0,
        curve=curve,
        precone=0.12,
        pitch=0.2,
        tip_mass=np.diag([2.0, 2.0, 2.0, 0.1, 0.2, 0.3]),
    )


def test_a_rod_that_stretches() -> None:
    """(EA w′)′ + m Ω² w = 0 for the radius w of a section, with w = R at the root and w′ = 1 at the tip."""
    k = OMEGA * np.sqrt(1.2 / 1e6)
    slope = (1.0 + 0.3 * k * np.sin(6.0 * k)) / np.cos(6.0 * k)
    loads = root_loads(BEAM, OMEGA)
    np.testing.assert_allclose(loads.force, [1e6 * (slope - 1.0), 0.0, 0.0], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(loads.moment, np.zeros(3), atol=1e-9)
    assert loads.uncertainty[1] >= 0.999e-13 * 6.0 * loads.force[0]  # rounding of a force at the tip


def test_a_rigid_blade_has_the_loads_of_its_moments_of_inertia() -> None:
    """∫ r⊥ Ω² dm, and its moment about the hub's centre, Ω² (I_yz, −I_xz, 0): none about the rotor's axis."""
    blade, loads = stiff(), root_loads(stiff(), OMEGA)
    hub = about_hub(blade)
    inertia = hub.moments
    first = hub.first * [1.0, 1.0, 0.0]
    assert abs(first[1]) > 1.0  # the mass centre is off the pitch axis
    np.testing.assert_allclose(loads.force, OMEGA**2 * first, rtol=1e-8, atol=1e-8 * OMEGA**2 * hub.mass)
    expected = OMEGA**2 * np.array([inertia[1, 2], -inertia[0, 2], 0.0])
    np.testing.assert_allclose(loads.moment_about_hub, expected, atol=1e-8 * OMEGA**2 * inertia[2, 2])


def test_no_moment_about_the_rotor_axis_however_the_blade_deforms() -> None:
    soft = replace(stiff(), stiffness=np.tile(np.diag([1e7, 1e7, 1e7, 2e4, 2e5, 4e5]), (13, 1, 1)))
    loads = root_loads(soft, OMEGA)
    assert np.abs(loads.force / root_loads(stiff(), OMEGA).force - 1.0).max() > 1e-3
    assert abs(loads.moment_about_hub[2]) < 1e-9 * np.abs(loads.moment_about_hub).max()


def test_a_coned_blade_is_an_elastica() -> None:
    """Inextensible, in the plane of the rotor's axis: x′ = cos θ, z′ = sin θ, EI θ″ = (N sin θ − V cos θ), N′ = −m Ω² x, V = 0.

    N is the radial force in a section; no force acts along the axis.
    """
    cone, EI, m, radius = 0.3, 1e4, 1.2, 0.3

    def rates(_: Array, y: Array) -> Array:
        x, theta, bend, tension = y
        return np.array([np.cos(theta), bend / EI, tension * np.sin(theta), -m * OMEGA**2 * x])

    def ends(a: Array, b: Array) -> Array:
        return np.array([a[0] - radius * np.cos(cone), a[1] - cone, b[2], b[3]])

    s = np.linspace(0.0, 6.0, 41)
    start = np.array([radius + s, cone * np.exp(-s), 0 * s, m * OMEGA**2 * (6.3**2 - (radius + s) ** 2) / 2])
    exact = solve_bvp(rates, ends, s, start, tol=1e-8, max_nodes=5000)
    assert exact.success
    blade = replace(uniform_blade("elastica", 6.0, radius, EA=np.inf, GJ=1e3, EI_y=EI, EI_z=4e4, mass=m), precone=cone)
    loads = root_loads(blade, OMEGA, accuracy=1e-8)
    bend, tension = exact.y[2:, 0]
    np.testing.assert_allclose(loads.force, [tension, 0.0, 0.0], rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(loads.moment[1], -bend, rtol=1e-6)


def test_weight_and_given_loads_at_rest() -> None:
    blade, gravity = stiff(), np.array([1.0, -2.0, -9.0])
    hub = about_hub(blade)
    loads = root_loads(blade, 0.0, gravity=gravity)
    np.testing.assert_allclose(loads.force, hub.mass * gravity, rtol=1e-9)
    np.testing.assert_allclose(loads.moment_about_hub, np.cross(hub.first, gravity), rtol=1e-8)
    pushed = root_loads(BEAM, 0.0, load=np.tile([0.0, 2.0, 0.0], (2, 1)))
    np.testing.assert_allclose(pushed.force, [0.0, 12.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(pushed.moment, [0.0, 0.0, 36.0], atol=2e-2)  # the blade bends, which shortens the arm


def test_springs_at_the_root_carry_the_same_loads() -> None:
    clamped = replace(BEAM, precone=0.1, pitch=0.3)
    sprung = replace(clamped, root=np.array([np.inf, np.inf, np.inf, 1e9, 1e9, 1e9]))
    a, b = root_loads(clamped, OMEGA), root_loads(sprung, OMEGA)
    np.testing.assert_allclose(a.force, b.force, rtol=1e-5, atol=1e-2)
    np.testing.assert_allclose(a.moment, b.moment, rtol=1e-4)
    hinged = root_loads(replace(clamped, root=np.array([np.inf, np.inf, np.inf, np.inf, 0.0, np.inf])), OMEGA)
    assert abs(hinged.in_blade_axes[1][1]) < 1e-9 * np.abs(hinged.force).max()  # a flap hinge bears no moment


def test_the_axes_of_the_blade() -> None:
    loads = root_loads(replace(BEAM, precone=0.1, pitch=0.3), OMEGA)
    force, moment = loads.in_blade_axes
    np.testing.assert_allclose(np.linalg.norm(force), np.linalg.norm(loads.force))
    assert force[0] > 0.99 * loads.force[0]
    np.testing.assert_allclose(np.linalg.norm(moment), np.linalg.norm(loads.moment))


def test_uncertainty_covers_the_error() -> None:
    blade = replace(BEAM, precone=0.2)
    fine, coarse = root_loads(blade, OMEGA, accuracy=1e-10), root_loads(blade, OMEGA, accuracy=1e-3)
    assert coarse.elements < fine.elements
    assert np.abs(coarse.force - fine.force).max() <= coarse.uncertainty[0]
    assert np.abs(coarse.moment - fine.moment).max() <= coarse.uncertainty[1]


def test_refusals() -> None:
    with pytest.raises(ValueError, match="omega: nan"):
        root_loads(BEAM, float("nan"))
    with pytest.raises(ValueError, match="load: shape"):
        root_loads(BEAM, 1.0, load=np.zeros((3, 3)))
    with pytest.raises(LargeStrainError, match="steady strain"):
        root_loads(BEAM, 140.0)
    with pytest.raises(SteadyStateError):
        root_loads(BEAM, 240.0)
