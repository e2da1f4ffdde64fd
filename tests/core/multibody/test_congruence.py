"""M*, C*, K* summed over the tree against products with a dense B, and the lowest modes against the dense solver."""

import numpy as np
import pytest

from southwell.core import eigen, rank
from southwell.core.chain import as_mechanism
from southwell.core.element.discretize import discretize
from southwell.core.multibody import congruence, dynamics, equilibrium, linearization, lowest
from southwell.core.multibody.kinematics import Kinematics, kinematics, projected
from southwell.core.multibody.mechanism import at_time
from southwell.core.multibody.spanning import compile_tree
from southwell.core.multibody.tree import Tree
from southwell.tests.support.beams import PARK, curved
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


def trees() -> dict[str, Tree]:
    blades = {mass: as_mechanism.mechanism(discretize(curved(), 5, mass), 3.0) for mass in ("consistent", "half_end")}
    return {name: compile_tree(m) for name, m in blades.items()}


@pytest.mark.parametrize("name", [*CASES, "consistent", "half_end"])
def test_sums_over_the_tree_are_products_with_b(name: str) -> None:
    tree = trees()[name] if name not in CASES else compile_tree(at_time(CASES[name]()[0], 0.0))
    n = len(tree.coordinates)
    q, v, a = 0.1 * np.random.default_rng(5).normal(size=(3, n))
    if len(tree.inner):  # beams with mass are carried steadily
        v, a = np.eye(n)[0], np.zeros(n)
    k = kinematics(tree, q, v, a)
    c = dynamics.cartesian(tree, k)
    M, C, K = congruence.congruent(k, c.row, c.column, c.blocks)
    for at, spring in congruence.stretched(k, c.ends, c.stiffness):
        K[np.ix_(at, at)] += spring
    for ours, theirs in zip((M, C, K), written_out(k, c), strict=True):
        assert np.abs(ours - theirs).max() <= 1e-14 * np.abs(theirs).max(initial=1e-300)
    forces = np.einsum("bin,bi->n", k.B, c.g)
    assert np.abs(projected(k, c.g) - forces).max() <= 1e-14 * np.abs(k.B).max() * np.abs(c.g).sum()


def pencil(omega: float, elements: int) -> tuple[Array, Array, Array]:
    tree = compile_tree(as_mechanism.mechanism(discretize(PARK, elements), omega))
    of = linearization.about(tree, equilibrium.steady(tree))
    return 0.5 * (of.M + of.M.T), 0.5 * (of.C - of.C.T), 0.5 * (of.K + of.K.T)


@pytest.mark.parametrize("omega", [0.0, 10.0])  # at rest all bending frequencies are double
@pytest.mark.parametrize("count", [1, 2, 5, 10])
def test_lowest_modes_are_those_of_all(omega: float, count: int) -> None:
    matrices = pencil(omega, 20)
    ours, theirs = lowest.lowest(lowest.definite(*matrices), count), eigen.gyroscopic(*matrices, count)
    np.testing.assert_allclose(ours.frequencies, theirs.frequencies, rtol=1e-11)
    M, C, K = matrices
    for f, x in zip(ours.frequencies, ours.vectors.T, strict=True):
        forces = (K @ x, 1j * f * (C @ x), f**2 * (M @ x))
        assert np.linalg.norm(forces[0] + forces[1] - forces[2]) < 1e-6 * np.linalg.norm(np.abs(forces[0]))
        assert (x.conj() @ K @ x).real == pytest.approx(1.0, rel=1e-9)


def test_a_mode_that_lanczos_loses_is_found_by_the_count(monkeypatch: pytest.MonkeyPatch) -> None:
    matrices = pencil(10.0, 20)
    whole, lost = lowest.scipy.linalg.eigh, []

    def lossy(matrix, subset_by_index, **options):
        first, last = subset_by_index
        values, vectors = whole(matrix, subset_by_index=[first - 1, last], **options)
        lost.append(values[-3])
        return np.delete(values, -3), np.delete(vectors, -3, axis=1)

    theirs = eigen.gyroscopic(*matrices, 5).frequencies
    dense = eigen.gyroscopic
    monkeypatch.setattr(lowest.scipy.linalg, "eigh", lossy)
    monkeypatch.setattr(lowest.eigen, "gyroscopic", lambda *a: (monkeypatch.undo(), dense(*a))[1])
    np.testing.assert_allclose(lowest.lowest(lowest.definite(*matrices), 5).frequencies, theirs, rtol=1e-11)
    assert lost


def test_the_count_is_that_of_negative_eigenvalues() -> None:
    rng = np.random.default_rng(7)
    for n in (1, 2, 70, 131):
        H = rng.normal(size=(n, n)) + 1j * rng.normal(size=(n, n))
        H = H + H.conj().T
        assert lowest._negative(H.copy()) == (np.linalg.eigvalsh(H) < 0).sum()


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
