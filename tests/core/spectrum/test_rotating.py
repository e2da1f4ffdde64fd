"""A rotating mechanism without its beams' internal coordinates against dense matrices in the ground's axes, where B changes."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from southwell.core.blade import Blade
from southwell.core.element.discretize import Mass, discretize
from southwell.core.mechanism.description import Body, Mechanism, Motion, inertia
from southwell.core.mechanism.joints import Joint
from southwell.core.spectrum import eigen, lowest, rotating
from southwell.core.steady import equilibrium
from southwell.core.tree import as_mechanism, linearization
from southwell.core.tree.spanning import compile_tree
from southwell.core.tree.state import State, state_at
from southwell.tests.support.beams import PARK, curved

Array = np.ndarray
HINGED = replace(curved(), root=np.array([np.inf, np.inf, np.inf, 1e7, 0.0, 0.0]))


def steady(blade: Blade, omega: float, elements: int, mass: Mass = "consistent") -> State:
    return equilibrium.steady(compile_tree(as_mechanism.mechanism(discretize(blade, elements, mass), omega)))


def matrices(state: State) -> tuple[Array, Array, Array]:
    of = linearization.about(state.kinematics.tree, state)
    return 0.5 * (of.M + of.M.T), 0.5 * (of.C - of.C.T), 0.5 * (of.K + of.K.T)


@pytest.mark.parametrize("mass", ["consistent", "half_end"])
@pytest.mark.parametrize("blade", [PARK, curved(), HINGED], ids=["park", "curved", "hinged"])
def test_the_matrices_are_those_in_the_grounds_axes(blade: Blade, mass: Mass) -> None:
    state = steady(blade, 2.5, 8, mass)
    p, x = rotating.rotating(state), np.eye(len(matrices(state)[0]))
    scale = 1.0 / np.sqrt(np.diagonal(matrices(state)[2]))
    ours = (*p.inertia_and_coriolis(x), p.stiffness(x))
    for found, expected in zip(ours, matrices(state), strict=True):
        found, expected = (scale[:, None] * a * scale for a in (found, expected))
        assert np.abs(found - expected).max() <= 1e-12 * np.abs(expected).max()
    solved = matrices(state)[2] @ p.solve(x / scale[:, None] ** 2) * scale[:, None] ** 2
    np.testing.assert_allclose(solved, x, atol=1e-9)
    np.testing.assert_array_equal(p.inertia(x), ours[0])
    assert not rotating.rotating(state, coriolis=False).inertia_and_coriolis(x)[1].any()


@pytest.mark.parametrize("mass", ["consistent", "half_end"])
@pytest.mark.parametrize("blade", [PARK, HINGED], ids=["park", "hinged"])
def test_the_count_is_that_of_the_frequencies_below(blade: Blade, mass: Mass) -> None:
    """Also above the frequencies of the internal coordinates of one element, both ends clamped."""
    state = steady(blade, 2.5, 3, mass)
    p, every = rotating.rotating(state), eigen.gyroscopic(*matrices(state)).frequencies
    assert len(every) > 15
    for k, (f, g) in enumerate(itertools.pairwise(every)):
        if g > f * (1.0 + 1e-6):
            assert p.below(float(np.sqrt(f * g))) == k + 1
    assert p.below(2.0 * float(every[-1])) == len(every)


@pytest.mark.parametrize("omega", [0.0, 10.0])  # at rest all bending frequencies are double
@pytest.mark.parametrize("count", [1, 2, 5, 10])
def test_lowest_modes_are_those_of_all(omega: float, count: int) -> None:
    state = steady(PARK, omega, 20)
    M, C, K = matrices(state)
    ours, theirs = lowest.lowest(rotating.rotating(state), count), eigen.gyroscopic(M, C, K, count)
    np.testing.assert_allclose(ours.frequencies, theirs.frequencies, rtol=1e-11)
    for f, x in zip(ours.frequencies, ours.vectors.T, strict=True):
        forces = (K @ x, 1j * f * (C @ x), f**2 * (M @ x))
        assert np.linalg.norm(forces[0] + forces[1] - forces[2]) < 1e-6 * np.linalg.norm(np.abs(forces[0]))
        assert (x.conj() @ K @ x).real == pytest.approx(1.0, rel=1e-9)


def test_a_mode_that_lanczos_loses_is_found_by_the_count(monkeypatch: pytest.MonkeyPatch) -> None:
    state = steady(PARK, 10.0, 20)
    whole, lost = lowest.scipy.linalg.eigh, []

    def lossy(matrix, subset_by_index, **options):
        first, last = subset_by_index
        values, vectors = whole(matrix, subset_by_index=[first - 1, last], **options)
        lost.append(values[-3])
        return np.delete(values, -3), np.delete(vectors, -3, axis=1)

    theirs = eigen.gyroscopic(*matrices(state), 5).frequencies
    dense = eigen.gyroscopic
    monkeypatch.setattr(lowest.scipy.linalg, "eigh", lossy)
    monkeypatch.setattr(lowest.eigen, "gyroscopic", lambda *a: (monkeypatch.undo(), dense(*a))[1])
    np.testing.assert_allclose(lowest.lowest(rotating.rotating(state), 5).frequencies, theirs, rtol=1e-11)
    assert lost


def test_the_factors_count_negative_eigenvalues() -> None:
    rng = np.random.default_rng(7)
    for n in (1, 2, 70, 131):
        H = rng.normal(size=(n, n)) + 1j * rng.normal(size=(n, n))
        H = H + H.conj().T
        assert rotating._negative(H.copy()) == (np.linalg.eigvalsh(H) < 0).sum()


def test_what_does_not_rotate_as_one_body_is_refused() -> None:
    turntable = Mechanism(
        (Body("table", inertia(1.0, 5.0)), Body("wheel", inertia(3.0, 2.0))),
        (Joint("shaft", "revolute", "ground", "table"), Joint("axle", "revolute", "table", "wheel")),
        (Motion("shaft.rz", 0.0, 10.0), Motion("axle.rz", 0.0, 1.0)),
    )
    tree = compile_tree(turntable)
    with pytest.raises(ValueError, match="does not rotate steadily as one rigid body"):
        rotating.rotating(state_at(tree, np.zeros(2)))
