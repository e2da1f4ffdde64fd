"""M*, C*, K* summed over the tree against products with a dense B, and matrices of full rank."""

import numpy as np
import pytest

from southwell.core import rank
from southwell.core.element.discretize import discretize
from southwell.core.mechanism.description import Body, Mechanism, Spring, at_time, inertia
from southwell.core.mechanism.joints import Joint
from southwell.core.tree import as_mechanism, congruence, dynamics
from southwell.core.tree.kinematics import Kinematics, kinematics, projected
from southwell.core.tree.spanning import compile_tree
from southwell.core.tree.topology import Tree
from southwell.tests.support.beams import curved
from southwell.tests.support.mechanisms import CASES

Array = np.ndarray


def written_out(k: Kinematics, c: dynamics.Cartesian) -> tuple[Array, Array, Array]:
    """Bᵀ M B, Bᵀ (2 M Ḃ + C B), Bᵀ (M B̈ + C Ḃ + K B) with the springs between two bodies in K."""
    n = len(k.q)
    B, B1, B2 = (b.reshape(-1, n) for b in (k.B, k.B1, k.B2))
    M, C, K = np.zeros((3, len(B), len(B)))
    for row, column, blocks in zip(c.row, c.column, c.blocks, strict=True):
        for whole, block in zip((M, C, K), blocks, strict=True):
            whole[6 * row : 6 * row + 6, 6 * column : 6 * column + 6] += block
    padded = np.concatenate([k.B, np.zeros((1, 6, n))])
    stretch = padded[c.ends[:, 1]] - padded[c.ends[:, 0]]
    springs = np.einsum("sin,sij,sjm->nm", stretch, c.stiffness, stretch)
    return B.T @ M @ B, B.T @ (2.0 * M @ B1 + C @ B), B.T @ (M @ B2 + C @ B1 + K @ B) + springs


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
    if len(tree.inner):  # beams with mass are carried steadily
        v, a = np.eye(n)[0], np.zeros(n)
    k = kinematics(tree, q, v, a)
    return k, dynamics.cartesian(tree, k)


@pytest.mark.parametrize("name", [*CASES, "consistent", "half_end", "branches"])
def test_sums_over_the_tree_are_products_with_b(name: str) -> None:
    k, c = moving(name)
    M, C, K = congruence.congruent(k, c.row, c.column, c.blocks)
    j = k.tree.joints
    congruence.add_springs(k, c.ends, c.stiffness, K[:j, :j])
    for ours, theirs in zip((M, C, K), written_out(k, c), strict=True):
        assert np.abs(ours - theirs).max() <= 1e-14 * np.abs(theirs).max(initial=1e-300)
    forces = np.einsum("bin,bi->n", k.B, c.g)
    assert np.abs(projected(k, c.g) - forces).max() <= 1e-14 * np.abs(k.B).max() * np.abs(c.g).sum()


@pytest.mark.parametrize(("least", "regular"), [(1.0, True), (1e-4, True), (1e-8, False), (1e-10, False), (0.0, False)])
def test_lu_only_if_full_rank_is_certain(least: float, regular: bool) -> None:
    rng = np.random.default_rng(3)
    u, v = (np.linalg.qr(rng.normal(size=(12, 12)))[0] for _ in range(2))
    A = (u * np.array([*[1.0] * 11, least])) @ v
    found = rank.factored(A)
    assert isinstance(found, rank.Regular) == regular
    assert found.null.shape[1] == (least < rank.TOLERANCE) == found.left_null.shape[1]
    b = A @ np.arange(12.0)
    np.testing.assert_allclose(A @ found.solve(b), b, atol=1e-6)
