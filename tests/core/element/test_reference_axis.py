"""Results do not depend on the reference axis of a blade or on the body frames of a mechanism."""

from dataclasses import replace

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.cases.input import library
from southwell.core.blade import Blade, section_mass, section_stiffness
from southwell.core.element import beams as bm
from southwell.core.solve import mesh_modes
from southwell.core.space import spatial as sp

OFFSET = np.array([0.0, 0.17, -0.09])


def blade(rng: np.random.Generator) -> Blade:
    """Straight, tapered, with shear, every strain coupled with every other, mass centre off the axis."""
    n, taper = 4, np.linspace(1.0, 0.4, 4)[:, None, None]
    stiffness = section_stiffness(2e7, 1e5, 3e5, 9e5, 4e6, 6e6) * taper
    root = np.sqrt(np.diagonal(stiffness, axis1=1, axis2=2))
    mix = rng.normal(size=(6, 6))
    coupling = 0.1 * (mix + mix.T) * (1 - np.eye(6)) / 4
    shift = sp.adjoint(sp.pose(np.eye(3), np.array([0.0, -0.05, 0.03])))  # from the axis to the mass centre
    inverse = np.linalg.inv(shift)
    return Blade(
        "coupled",
        np.linspace(0.0, 5.0, n),
        stiffness + coupling * root[:, :, None] * root[:, None, :],
        inverse.T @ (section_mass(4.0, 0.02, 0.09) * taper) @ inverse,
        np.zeros(n),
        hub_radius=0.5,
        tip_mass=inverse.T @ section_mass(3.0, 0.1, 0.2)[0] @ inverse,
    )


def about(blade: Blade, offset: np.ndarray) -> Blade:
    """The same blade about an axis shifted by ``offset``.

    Velocities and strains at the new point are v + ω × d and γ + κ × d, with d from the old point to the new.
    """
    to_new = sp.adjoint(sp.pose(np.eye(3), -offset))
    inverse = np.linalg.inv(to_new)
    return replace(
        blade,
        stiffness=inverse.T @ blade.stiffness @ inverse,
        mass=inverse.T @ blade.mass @ inverse,
        tip_mass=inverse.T @ blade.tip_mass @ inverse,
        curve=blade.curve + offset,
    )


def test_the_shift_is_that_of_a_rigid_body() -> None:
    """A point mass on the old axis has, about the new one, the first and second moments of −d."""
    altered = replace(blade(np.random.default_rng(0)), mass=np.repeat(section_mass(2.0), 4, axis=0))
    moved = about(altered, OFFSET).mass[0]
    np.testing.assert_allclose(moved[3:, :3], 2.0 * sp.skew(-OFFSET), atol=1e-15)
    np.testing.assert_allclose(np.diagonal(moved)[3], 2.0 * (0.17**2 + 0.09**2), rtol=1e-14)


@pytest.mark.parametrize("mass", ["consistent", "half_end"])
@pytest.mark.parametrize("stiffness", ["corotational", "body_fixed"])
def test_frequencies_at_rest_do_not_depend_on_the_reference_axis(mass, stiffness) -> None:
    """The discretisations are the same, so the agreement is to rounding."""
    original = blade(np.random.default_rng(3))
    results = [
        mesh_modes(b, 0.0, 12, 8, mass=mass, stiffness=stiffness).frequencies
        for b in (original, about(original, OFFSET))
    ]
    np.testing.assert_allclose(results[1], results[0], rtol=1e-9)


@pytest.mark.parametrize(("elements", "tolerance"), [(12, 1e-8), (24, 1e-9), (48, 1e-10)])
def test_frequencies_of_a_rotating_blade_do_not_depend_on_the_reference_axis(elements, tolerance) -> None:
    """Reissner's strains transform exactly as Γ + κ × d; the difference is the discretisation error, of fourth order."""
    original = blade(np.random.default_rng(3))
    results = [mesh_modes(b, 12.0, elements, 5).frequencies for b in (original, about(original, OFFSET))]
    np.testing.assert_allclose(results[1], results[0], rtol=tolerance)


def test_an_axis_shifted_for_the_stiffness_only_is_detected() -> None:
    """A seeded fault: stiffness about the other axis, mass not."""
    original = blade(np.random.default_rng(3))
    altered = replace(original, stiffness=about(original, OFFSET).stiffness)
    results = [mesh_modes(b, 12.0, 12, 8).frequencies for b in (original, altered)]
    assert np.abs(results[1] / results[0] - 1).max() > 1e-2


def reframed(m: mb.Mechanism, rng: np.random.Generator) -> mb.Mechanism:
    """The mechanism with every body described in another frame: x = new⁻¹ old."""
    new = {b.name: sp.exp(rng.normal(size=6) * 0.5) for b in m.bodies} | {"ground": np.eye(4)}
    old = {name: sp.inverse(x) for name, x in new.items()}  # the old frame in the new

    def body(b: mb.Body) -> mb.Body:
        to_old = sp.adjoint(new[b.name])
        return mb.Body(b.name, to_old.T @ b.inertia @ to_old)

    def point(name: str, p: np.ndarray) -> np.ndarray:
        return old[name][:3, :3] @ p + old[name][:3, 3]

    return replace(
        m,
        bodies=tuple(body(b) for b in m.bodies),
        joints=tuple(
            replace(j, at_parent=old[j.parent] @ j.at_parent, at_child=old[j.child] @ j.at_child) for j in m.joints
        ),
        springs=tuple(
            replace(s, point_a=point(s.body_a, s.point_a), point_b=point(s.body_b, s.point_b)) for s in m.springs
        ),
        beams=tuple(replace(b, at_a=old[b.body_a] @ b.at_a, at_b=old[b.body_b] @ b.at_b) for b in m.beams),
    )


@pytest.mark.parametrize("seed", range(3))
def test_modes_do_not_depend_on_the_bodies_frames(seed: int) -> None:
    """A blade on its pitch link, with a spring and a bushing: frequencies, damping, shapes and steady coordinates."""
    rng = np.random.default_rng(seed)
    m = library.mechanism("pitch-link").mechanism
    m = replace(
        m,
        springs=(mb.Spring("hub", "blade", np.array([0.1, 0, 0.4]), np.array([1.0, 0.1, 0]), 5e3, 20.0, 0.8),),
        beams=(mb.Beam("knuckle", "blade", bm.bushing(np.eye(4), np.diag([1e4] * 3 + [50.0] * 3))),),
        gravity=(0.0, 0.0, -9.81),
    )
    original, other = mb.solve(m), mb.solve(reframed(m, rng))
    np.testing.assert_allclose(other.values, original.values, rtol=1e-10)
    np.testing.assert_allclose(other.shapes, original.shapes, atol=1e-9)
    np.testing.assert_allclose(list(other.steady.values()), list(original.steady.values()), atol=1e-10)
