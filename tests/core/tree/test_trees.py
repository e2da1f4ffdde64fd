"""Trees with branches and joints: against the dense equations of the same bodies, and against one blade."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.effects import ALL_EFFECTS
from southwell.core.element.branches import CLAMPED, attached, hub
from southwell.core.element.discretize import discretize
from southwell.core.element.mesh import Mesh
from southwell.core.mechanism.description import inertia
from southwell.core.space import spatial as sp
from southwell.core.space.inertia import transformed
from southwell.core.spectrum import completeness
from southwell.core.spectrum.lanczos import lanczos
from southwell.core.spectrum.mesh_solver import Options, balance, solve
from southwell.core.spectrum.modal import linearize, modes
from southwell.core.steady.blade_state import Steady
from southwell.core.tree.as_mechanism import mechanism
from southwell.tests.support.dense import dense


def around_hub(blade: Mesh, count: int) -> Mesh:
    """A rotor of ``count`` equal blades, clamped at equal angles to a hub that rotates about z."""
    rotor = hub(blade, np.eye(4))
    for k in range(count):
        azimuth = sp.pose(sp.rotation(2, np.array(2.0 * np.pi * k / count)), np.zeros(3))
        rotor = attached(rotor, 0, blade, azimuth @ blade.nodes[0])
    return rotor


def blade(seed: int = 1, **changes) -> Blade:
    """A curved, twisted, tapered blade with offset mass centres."""
    rng = np.random.default_rng(seed)
    n, s = 5, np.linspace(0.0, 8.0, 5)
    taper = np.linspace(1.0, 0.4, n)
    stiffness = section_stiffness(3e8 * taper, 2e6 * taper**2, 2e6 * taper**2, 8e6 * taper**2)
    mass = transformed(
        section_mass(20.0 * taper, 0.1 * taper, 0.5 * taper), sp.pose(np.eye(3), np.array([0.0, 0.08, 0.03]))
    )
    curve = np.stack([s, 0.004 * s**2, 0.006 * s**2], axis=1)
    steps = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    given = {"hub_radius": 0.7, "precone": 0.03, "pitch": 0.1, "curve": curve, "twist": rng.uniform(-0.2, 0.3, n)}
    return Blade("b", np.append(0.0, np.cumsum(steps)), stiffness, mass, **(given | changes))


def state(mesh: Mesh, omega: float, gravity=(0.0, 0.0, 0.0)) -> Steady:
    return balance(mesh, omega, np.array(gravity), ALL_EFFECTS)


def frequencies(mesh: Mesh, omega: float, count: int) -> np.ndarray:
    return lanczos(state(mesh, omega).pencil, count).frequencies


def elastic_hub() -> Mesh:
    """Three blades on a hub with inertia, on a shaft that twists and bends, with one blade on hinges."""
    branch = discretize(blade(), 4)
    shaft = np.array([np.inf, 3e6, 3e6, 4e5, np.inf, 9e5])
    body = replace(hub(branch, np.eye(4)), lumps=inertia(300.0, (40.0, 50.0, 60.0), centre=(0.0, 0.0, 0.1))[None])
    rotor = attached(hub(branch, np.eye(4)), 0, body, np.eye(4), stiffness=shaft)
    for k in range(3):
        azimuth = sp.pose(sp.rotation(2, np.array(2.0 * np.pi * k / 3)), np.zeros(3))
        hinges = (
            CLAMPED if k else np.array([np.inf, np.inf, np.inf, 8e4, 0.0, 3e4])
        )  # pitch spring, free flap, lag spring
        rotor = attached(rotor, 1, branch, azimuth @ branch.nodes[0], stiffness=hinges)
    return rotor


def grafted() -> Mesh:
    """A blade that carries another one at its middle, on a sliding and turning joint with springs, and a rigid tip fin."""
    trunk, twig = discretize(blade(1), 5), discretize(blade(2, hub_radius=0.0, precone=0.0), 3)
    frame = sp.exp(np.array([0.1, -0.2, 0.3, 0.4, 0.9, -0.2]))
    in_twig = sp.exp(np.array([0.0, 0.1, 0.0, 0.1, 0.2, 0.3]))
    tree = attached(trunk, 3, twig, frame, in_twig, np.array([2e6, np.inf, np.inf, 5e4, 6e4, 7e4]))
    fin = replace(hub(trunk, np.eye(4)), lumps=inertia(3.0, (0.1, 0.2, 0.25), centre=(0.2, 0.1, 0.0))[None])
    return attached(tree, 5, fin, sp.exp(np.array([0.3, 0.0, 0.1, 0.0, 0.2, 0.0])))


TREES = {"elastic hub": elastic_hub, "grafted": grafted}


@pytest.mark.parametrize("name", TREES)
@pytest.mark.parametrize(
    ("omega", "gravity"), [(3.0, (0.0, 0.0, 0.0)), (12.0, (0.0, 0.0, 0.0)), (12.0, (0.0, 0.0, -9.81))]
)
def test_frequencies_are_those_of_the_dense_equations(name: str, omega: float, gravity) -> None:
    mesh = TREES[name]()
    engine = lanczos(state(mesh, omega, gravity).pencil, 12).frequencies
    dense = modes(linearize(mechanism(mesh, omega, gravity))).frequencies
    np.testing.assert_allclose(engine, dense[:12], rtol=1e-9)


@pytest.mark.parametrize("name", TREES)
def test_the_tangent_is_symmetric_in_the_steady_state(name: str) -> None:
    p = state(TREES[name](), 12.0, (0.0, 0.0, -9.81)).pencil
    K, C, M = (dense(p, matrix) for matrix in (p.K, p.C, p.M))
    for matrix, sign in ((K, 1.0), (M, 1.0), (C, -1.0)):
        scale = np.sqrt(np.abs(np.outer(K.diagonal(), K.diagonal()))) if matrix is K else np.abs(matrix).max()
        assert (np.abs(matrix - sign * matrix.T) <= 1e-9 * scale).all()


def test_a_rotor_on_a_rigid_hub_has_the_frequencies_of_its_blade_three_times() -> None:
    branch = discretize(blade(), 8)
    alone, rotor = frequencies(branch, 9.0, 4), frequencies(around_hub(branch, 3), 9.0, 12)
    np.testing.assert_allclose(rotor, alone.repeat(3), rtol=1e-10)


def test_shapes_of_a_rotor_are_those_of_its_blades_one_after_the_other() -> None:
    branch = discretize(blade(), 4)
    alone, rotor = (solve(mesh, 9.0, Options(3)) for mesh in (branch, around_hub(branch, 3)))
    np.testing.assert_allclose(rotor.frequencies, alone.frequencies[[0, 0, 0]], rtol=1e-10)
    assert rotor.shapes.shape == (3, 63, 4)
    first = alone.modes.shapes[0, :, :3]
    for k, shape in enumerate(np.split(rotor.shapes[0, :, :3], 3)):
        own = shape @ sp.rotation(2, np.array(2.0 * np.pi * k / 3))  # in the axes of its blade
        assert abs(np.vdot(own, first)) == pytest.approx(np.linalg.norm(own) * np.linalg.norm(first), rel=1e-8)
    with pytest.raises(ValueError, match="shapes"):
        _ = rotor.modes


def test_the_count_covers_all_branches() -> None:
    p = state(around_hub(discretize(blade(), 4), 3), 9.0).pencil
    f = lanczos(p, 12).frequencies
    assert [completeness.below(p, 0.5 * (f[k - 1] + f[k])) for k in (3, 6, 9)] == [3, 6, 9]


def test_a_branch_with_other_elements_is_refused() -> None:
    beam = uniform_blade("u", 2.0, 0.1, EA=1e8, GJ=1e5, EI_y=1e5, EI_z=2e5, mass=4.0)
    with pytest.raises(ValueError, match="another strain measure or mass"):
        attached(discretize(beam, 2), 1, discretize(beam, 2, "half_end"), np.eye(4))


@pytest.mark.parametrize("count", [3, 10, 13])
def test_frequencies_with_more_modes_than_a_block_has_vectors_are_complete(count: int) -> None:
    """Three blades with equal flap and lag stiffness at rest: each frequency six times."""
    beam = uniform_blade("u", 4.0, 0.5, EA=1e9, GJ=1e6, EI_y=1e5, EI_z=1e5, mass=4.0)
    alone, rotor = frequencies(discretize(beam, 6), 0.0, 6), frequencies(around_hub(discretize(beam, 6), 3), 0.0, count)
    np.testing.assert_allclose(rotor, alone.repeat(3)[:count], rtol=1e-10)
