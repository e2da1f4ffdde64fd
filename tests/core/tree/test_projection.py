"""B and Bᵀ by sweeps over the tree, against the paths from the ground to each body."""

import numpy as np
import pytest

from southwell.core.element.discretize import discretize
from southwell.core.mechanism.description import Body, Mechanism, Spring, at_time, inertia
from southwell.core.mechanism.joints import Joint
from southwell.core.tree import as_mechanism, dynamics
from southwell.core.tree.kinematics import Kinematics, kinematics, projected
from southwell.core.tree.spanning import compile_tree
from southwell.core.tree.topology import Tree
from southwell.tests.support.beams import curved
from southwell.tests.support.mechanisms import CASES


def between_branches() -> Mechanism:
    """A spring whose ends move with different coordinates."""
    offset = np.eye(4)
    offset[0, 3] = 1.0
    return Mechanism(
        (Body("one", inertia(1.0, 5.0)), Body("other", inertia(3.0, 2.0))),
        (Joint("a", "revolute", "ground", "one"), Joint("b", "revolute", "ground", "other", offset)),
        springs=(Spring("one", "other", np.array([0.0, 0.4, 0.1]), np.array([0.2, 0.5, 0.3]), 7.0, free_length=0.3),),
    )


def trees() -> dict[str, Tree]:
    blades = {mass: as_mechanism.mechanism(discretize(curved(), 5, mass), 3.0) for mass in ("consistent", "half_end")}
    return {name: compile_tree(m) for name, m in {**blades, "branches": between_branches()}.items()}


def moving(name: str) -> tuple[Kinematics, dynamics.Cartesian]:
    tree = trees()[name] if name not in CASES else compile_tree(at_time(CASES[name]()[0], 0.0))
    n = len(tree.coordinates)
    q, v, a = 0.1 * np.random.default_rng(5).normal(size=(3, n))
    if len(tree.first_internal):  # beams with mass are carried steadily
        v, a = np.eye(n)[0], np.zeros(n)
    k = kinematics(tree, q, v, a)
    return k, dynamics.cartesian(tree, k)


def path(tree: Tree, body: int) -> list[int]:
    """The coordinates between the ground and a body."""
    out, link = [], int(tree.link[body])
    while link >= 0:
        out.append(link)
        link = int(tree.parent[link])
    return out


@pytest.mark.parametrize("name", [*CASES, "consistent", "half_end", "branches"])
def test_a_body_has_the_screws_of_the_coordinates_on_its_path(name: str) -> None:
    k, c = moving(name)
    for rows, screws in ((k.B, k.J), (k.B1, k.J1), (k.B2, k.J2)):
        for body in range(len(k.poses)):
            expected = np.zeros_like(screws)
            on_path = path(k.tree, body)
            expected[:, on_path] = screws[:, on_path]
            assert (rows[body] == expected).all()
    forces = np.einsum("bin,bi->n", k.B, c.g)
    assert np.abs(projected(k, c.g) - forces).max() <= 1e-14 * np.abs(k.B).max() * np.abs(c.g).sum()
    for body in range(len(k.poses)):
        assert sorted(path(k.tree, body)) == np.flatnonzero(k.tree.moves_body[body]).tolist()
