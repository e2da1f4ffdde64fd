"""The foreign codes' eigenproblem against closed forms, for each of the three solution methods."""

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import aslinearoperator

from southwell.references.matrices.quadratic import DENSE, gyroscopic_modes
from southwell.references.protocol.interface import CodeError


@pytest.fixture(params=["direct", "full, iterated", "sparse"])
def way(request):
    """Number of points and form of the matrices that select each method."""
    points = 30 if request.param == "direct" else DENSE
    return points, sparse.csc_array if request.param == "sparse" else np.asarray


def row(points: int, omega: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A row of unit masses in a rotating plane, joined by unit springs, the same in both directions.

    With z = x + iy: z̈ + 2iΩ ż + κ z = 0 for each eigenvalue κ of the row's stiffness, hence ω = √(Ω² + κ) ± Ω.
    """
    line = 2 * np.eye(points) - np.eye(points, k=1) - np.eye(points, k=-1)
    own = 4 * np.sin(np.arange(1, points + 1) * np.pi / (2 * points + 2)) ** 2
    M, K = np.eye(2 * points), np.kron(line, np.eye(2))
    C = 2 * omega * np.kron(np.eye(points), [[0.0, -1.0], [1.0, 0.0]])
    exact = np.sort(np.concatenate([np.sqrt(omega**2 + own) + omega, np.sqrt(omega**2 + own) - omega]))
    return M, C, K, exact


@pytest.mark.parametrize("omega", [0.0, 1e-3, 0.05])
def test_whirling_row_has_its_closed_form_frequencies(way, omega):
    points, form = way
    M, C, K, exact = row(points, omega)
    frequencies, shapes = gyroscopic_modes(form(M), form(C), form(K), 8)
    np.testing.assert_allclose(frequencies, exact[:8], rtol=1e-11)
    for w, q in zip(frequencies, shapes.T, strict=True):
        force = K @ q
        assert np.linalg.norm(force - w**2 * (M @ q) + 1j * w * (C @ q)) < 1e-8 * np.linalg.norm(force)
    if omega:  # exp(iωt) with the slower motion forward, the faster backward, in rotating axes: y leads x by ∓90°
        slow, fast = shapes[:, 0], shapes[:, -1 if omega > 1e-2 else 1]
        np.testing.assert_allclose(slow[1::2] / slow[::2], -1j, atol=1e-6)
        if omega < 1e-2:
            np.testing.assert_allclose(fast[1::2] / fast[::2], 1j, atol=1e-6)


def test_two_springs_on_a_turntable():
    """m ẍ − 2mΩẏ + (k₁ − mΩ²) x = 0 and likewise in y: a quadratic in ω²."""
    m, k1, k2, omega = 2.0, 50.0, 90.0, 3.0
    M, K = m * np.eye(2), np.diag([k1 - m * omega**2, k2 - m * omega**2])
    C = np.array([[0.0, -2 * m * omega], [2 * m * omega, 0.0]])
    a, b = K[0, 0] / m, K[1, 1] / m
    squares = np.roots([1.0, -(a + b + 4 * omega**2), a * b])
    frequencies, _ = gyroscopic_modes(M, C, K, 5)
    np.testing.assert_allclose(frequencies, np.sort(np.sqrt(squares)), rtol=1e-14)


def test_massless_coordinates_are_condensed_exactly(way):
    points, form = way
    M, C, K, _ = row(points, 0.02)
    massless = np.arange(len(K)) % 3 == 0
    M[massless], C[massless], C[:, massless] = 0.0, 0.0, 0.0
    own = ~massless
    inner = K[np.ix_(own, own)] - K[np.ix_(own, massless)] @ np.linalg.solve(
        K[np.ix_(massless, massless)], K[np.ix_(massless, own)]
    )
    condensed, _ = gyroscopic_modes(M[np.ix_(own, own)], C[np.ix_(own, own)], inner, 6)
    frequencies, shapes = gyroscopic_modes(form(M), form(C), form(K), 6)
    np.testing.assert_allclose(frequencies, condensed, rtol=1e-11)
    assert np.abs((K @ shapes)[massless]).max() < 1e-10


def test_only_as_many_modes_as_there_are_masses():
    frequencies, shapes = gyroscopic_modes(np.diag([1.0, 0.0, 4.0]), np.zeros((3, 3)), np.eye(3), 10)
    np.testing.assert_allclose(frequencies, [0.5, 1.0], rtol=1e-14)
    assert shapes.shape == (3, 2)


def test_stiff_coordinates_do_not_reduce_the_accuracy(way):
    """Half the row is joined to the ground by springs 10¹² times stiffer: a shorter row remains (K itself keeps 4
    digits of it)."""
    points, form = way
    M, C, K, _ = row(points, 0.0)
    held = np.arange(len(K)) >= points
    frequencies, _ = gyroscopic_modes(form(M), form(C), form(K + 1e12 * np.diag(held)), 4)
    own = 4 * np.sin(np.arange(1, 3) * np.pi / (points + 2)) ** 2
    np.testing.assert_allclose(frequencies, np.repeat(np.sqrt(own), 2), rtol=1e-10)


def test_the_same_call_gives_the_same_bits(way):
    points, form = way
    M, C, K = (form(matrix) for matrix in row(points, 0.01)[:3])
    first, second = gyroscopic_modes(M, C, K, 6), gyroscopic_modes(M, C, K, 6)
    assert (first[0] == second[0]).all()
    assert (first[1] == second[1]).all()


def test_no_stable_steady_state_is_an_error_with_the_lowest_eigenvalue(way):
    points, form = way
    M, C, K, exact = row(points, 0.0)
    beyond = K - 1.5 * exact[0] ** 2 * np.eye(len(K))
    lowest = f"{-0.5 * exact[0] ** 2:.3g}"
    with pytest.raises(CodeError, match=f"lowest eigenvalue {lowest}: no stable steady state"):
        gyroscopic_modes(form(M), form(C), form(beyond), 4)


def test_a_negative_diagonal_is_no_stable_steady_state():
    with pytest.raises(CodeError, match="lowest eigenvalue -2: no stable"):
        gyroscopic_modes(np.eye(3), np.zeros((3, 3)), np.diag([1.0, -2.0, 3.0]), 1)


@pytest.mark.parametrize(
    ("kind", "entry", "message"),
    [(0, (0, 5), "M: .* from symmetric"), (1, (2, 2), "C: .* from skew"), (2, (0, 5), "K: .* from symmetric")],
)
def test_matrices_without_the_required_symmetry_are_an_error(way, kind, entry, message):
    points, form = way
    matrices = list(row(points, 0.01)[:3])
    matrices[kind][entry] += 1e-3
    M, C, K = (form(matrix) for matrix in matrices)
    with pytest.raises(CodeError, match=message):
        gyroscopic_modes(M, C, K, 4)


def test_non_finite_matrices_are_an_error(way):
    points, form = way
    M, C, K, _ = row(points, 0.0)
    C[0, 1] = np.nan
    with pytest.raises(CodeError, match="C: not finite"):
        gyroscopic_modes(form(M), form(C), form(K), 4)


def test_negative_mass_is_an_error():
    with pytest.raises(CodeError, match="negative mass"):
        gyroscopic_modes(np.diag([1.0, -1.0]), np.zeros((2, 2)), np.eye(2), 1)


@pytest.mark.parametrize("points", [30, DENSE])
def test_operators_are_as_good_as_matrices(points):
    M, C, K, exact = row(points, 0.05)
    frequencies, shapes = gyroscopic_modes(aslinearoperator(M), aslinearoperator(C), K, 8)
    np.testing.assert_allclose(frequencies, exact[:8], rtol=1e-11)
    for w, q in zip(frequencies, shapes.T, strict=True):
        force = K @ q
        assert np.linalg.norm(force - w**2 * (M @ q) + 1j * w * (C @ q)) < 1e-8 * np.linalg.norm(force)


@pytest.mark.parametrize(("invalid", "reported"), [(0, "M: .* from symmetric"), (1, "C: .* from skew")])
def test_an_operator_without_its_symmetry_is_refused(invalid, reported):
    matrices = list(row(DENSE, 0.05))[:3]
    matrices[invalid] = matrices[invalid].copy()
    matrices[invalid][0, 5] += 1e-2
    M, C, K = matrices
    with pytest.raises(CodeError, match=reported):
        gyroscopic_modes(aslinearoperator(M), aslinearoperator(C), K, 8)


def test_an_operator_that_is_not_finite_is_refused():
    M, C, K, _ = row(DENSE, 0.05)
    M[3, 3] = np.nan
    with pytest.raises(CodeError, match="M: not finite"):
        gyroscopic_modes(aslinearoperator(M), aslinearoperator(C), K, 8)
