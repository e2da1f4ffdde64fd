"""Beams and turbines restricted to assumed shapes: Rayleigh's quotients in closed form, and upper bounds."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.core.blade import Blade, uniform_blade
from southwell.core.effects import ALL_EFFECTS
from southwell.core.element.discretize import discretize
from southwell.core.spectrum import eigen
from southwell.core.spectrum.mesh_solver import balance
from southwell.core.turbine import component
from southwell.core.turbine.assumed import Assumed, Curvatures, Field, bending, restricted_motions
from southwell.core.turbine.machine import machine
from southwell.core.turbine.turbine_modes import turbine_modes
from southwell.tests.support.turbines import small

LENGTH, EI, MASS = 10.0, 2.0e5, 3.0


def beam(**options: float) -> Blade:
    rigid = np.inf
    blade = uniform_blade("beam", LENGTH, 0.0, EA=rigid, GJ=rigid, EI_y=EI, EI_z=4 * EI, mass=MASS)
    return replace(blade, **options)


def parabola(blade: Blade, edgewise: bool = False) -> Field:
    """The deflection (x/L)²."""
    curvature, none = np.full((1, 2), 2.0 / LENGTH**2), np.zeros((1, 2))
    rows = (none, curvature) if edgewise else (curvature, none)
    return bending(blade, Curvatures(np.array([0.0, LENGTH]), *rows))


def frequency(blade: Blade, omega: float, edgewise: bool = False, elements: int = 8) -> float:
    mesh = discretize(blade, elements)
    state = balance(mesh, omega, np.zeros(3), ALL_EFFECTS)
    part = component.restricted(mesh, state, restricted_motions(blade, mesh, parabola(blade, edgewise)))
    return float(np.abs(eigen.damped(part.M[:1, :1], part.C[:1, :1], part.K[:1, :1]).values[0]))


@pytest.mark.parametrize("omega", [0.0, 15.0])
@pytest.mark.parametrize("hub", [0.0, 2.0])
def test_a_parabola_has_rayleighs_quotient(omega: float, hub: float) -> None:
    """ω² = 20 EI/mL⁴ + (4/3 + 5 r/3L) Ω², and −Ω² edgewise: ∫m(r + x)·½∫φ′² over ∫mφ²."""
    square = 20.0 * EI / (MASS * LENGTH**4) + (4.0 / 3.0 + 5.0 * hub / (3.0 * LENGTH)) * omega**2
    blade = beam(hub_radius=hub)
    assert frequency(blade, omega) == pytest.approx(np.sqrt(square), rel=1e-5)
    edgewise = 4.0 * 20.0 * EI / (MASS * LENGTH**4) + (1.0 / 3.0 + 5.0 * hub / (3.0 * LENGTH)) * omega**2
    assert frequency(blade, omega, edgewise=True) == pytest.approx(np.sqrt(edgewise), rel=1e-5)


def test_a_bent_blade_is_restricted_to_the_same_strains() -> None:
    """Centrifugal forces bend a coned blade; its edgewise motion must not twist it, which is rigid in torsion."""
    straight, coned = (frequency(beam(precone=angle), 5.0, edgewise=True, elements=24) for angle in (0.0, 0.05))
    assert coned == pytest.approx(straight, rel=1e-4)


def test_a_curved_beam_is_refused() -> None:
    blade = beam()
    curved = replace(blade, curve=np.outer(blade.stations, [0.8, 0.0, 0.6]))
    with pytest.raises(ValueError, match="a curved beam"):
        restricted_motions(curved, discretize(curved, 4), parabola(blade))


def test_a_rigid_tower_carries_a_rotor_of_two_parabolas() -> None:
    """The turbine's frequencies are those of a blade at rest, and restricting it raises them all."""
    turbine = small()
    rigid = bending(
        turbine.tower, Curvatures(np.array([0.0, turbine.tower.length]), np.zeros((0, 2)), np.zeros((0, 2)))
    )
    free = turbine_modes(machine(turbine, None, Assumed(rigid, None)), 0.5, 4).frequencies
    s = np.array([0.0, turbine.blade.length])
    flap, none = np.full((1, 2), 2.0 / s[1] ** 2), np.zeros((1, 2))
    shapes = bending(turbine.blade, Curvatures(s, np.concatenate([flap, none]), np.concatenate([none, flap])))
    restricted = turbine_modes(machine(turbine, None, Assumed(rigid, shapes)), 0.5, 4)
    assert (restricted.frequencies > free[: len(restricted.frequencies)]).all()
    assert len(restricted.groups) > 0
