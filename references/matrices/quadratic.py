"""Free vibration of a gyroscopic system, for codes that return matrices instead of frequencies.

``M q̈ + C q̇ + K q = 0`` with M symmetric and positive *semi*-definite, C skew, K symmetric positive definite: with
``q = φ exp(iωt)`` every ω is real. The problem is solved in inverse form, whose largest eigenvalues 1/ω belong to the
lowest modes, so stiff and massless coordinates do not reduce the accuracy (their eigenvalues cluster at 1/ω = 0).

``damped_modes`` solves the damped or unstable problem of a few coordinates.

Core has different solvers and never uses these.
"""

from collections.abc import Callable
from typing import Any, cast

import numpy as np
import scipy.linalg
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse import linalg as spla

from ..protocol.interface import CodeError

Array = NDArray[np.float64]
Matrix = Array | sp.spmatrix | sp.sparray | spla.LinearOperator
Solve = Callable[[Array], Array]
Eigenpairs = tuple[Array, NDArray[np.complex128]]

DENSE = 150
"""Size above which iteration for a few modes of full matrices is faster than a direct solution for all."""

RESTARTS = 20
"""Restarts of Arnoldi's method before a larger basis is tried; what converges at all does so within ten."""

ASYMMETRY = 1e-6
"""Largest asymmetry attributed to rounding or finite differences, relative to a unit diagonal of K."""


def gyroscopic_modes(M: Matrix, C: Matrix, K: Matrix, count: int) -> Eigenpairs:
    """The ``count`` lowest modes of ``M q̈ + C q̇ + K q = 0``.

    With ``K = L Lᵀ`` and ``M = F Fᵀ`` the states ``(Lᵀ q, Fᵀ q̇)`` make the inverse problem skew, hence i times it
    Hermitian (L. Meirovitch, "A new method of solution of the eigenvalue problem for gyroscopic systems", AIAA Journal
    12, 1974, there with M⁻¹; the inverse form needs none).

    Args:
        M: (n, n) symmetric, positive semi-definite; zero rows and columns are allowed. A linear operator, of a matrix that
            would be full, is applied instead of formed.
        C: (n, n) skew; also as an operator.
        K: (n, n) symmetric, positive definite; not an operator.
        count: number of modes; fewer are returned if there are fewer.

    Returns:
        frequencies (m,), rad/s, positive, ascending; shapes (n, m) complex, largest entry 1.

    Raises:
        CodeError: K is not positive definite (no stable steady state), M not semi-definite, or a symmetry is missing.
    """
    matrices: list[Any] = [M, C, K]
    size = matrices[2].shape[0]
    thin = any(sp.issparse(matrix) for matrix in matrices)
    iterate = 2 * count + 4 < size and (thin or size > DENSE)
    if thin:
        matrices = [sp.csc_array(matrix) if iterate else sp.csc_array(matrix).toarray() for matrix in matrices]
    if not iterate:
        matrices = [matrix @ np.eye(size) if _acts(matrix) else matrix for matrix in matrices]
    scale = _scale(matrices[2])
    m, c, k = (_scaled(matrix, scale) for matrix in matrices)
    k = _symmetric("K", k, 1, 1.0)
    try:
        solve = _factor(k)
    except np.linalg.LinAlgError:
        raise _unstable(matrices[2]) from None
    largest = _largest(m)
    m = _symmetric("M", m, 1, largest)
    # C is also compared with the critical damping of the lowest modes: at zero speed it is only rounding
    c = _symmetric("C", c, -1, max(_largest(c), largest**0.5))
    inverse, q = _iterated(m, c, k, solve, count) if iterate else _direct(m, c, k, count)
    return _ordered(inverse, q * scale[:, None], count)


def _acts(matrix: Any) -> bool:
    return isinstance(matrix, spla.LinearOperator)


def _scaled(matrix: Any, scale: Array) -> Any:
    if _acts(matrix):
        units = spla.aslinearoperator(sp.diags_array(scale))
        return units @ matrix @ units
    return matrix * scale[:, None] * scale[None, :]


def _largest(matrix: Any) -> float:
    """The largest entry; of an operator, the largest of its products with the columns of ``_probes``."""
    return float(abs(matrix @ _probes(matrix) if _acts(matrix) else matrix).max())


def _probes(matrix: Any) -> Array:
    """(n, 4) unit vectors in random directions."""
    out = np.random.default_rng(1).standard_normal((matrix.shape[0], 4))
    return out / np.linalg.norm(out, axis=0)


def _scale(K: Any) -> Array:
    """(n,) units of the coordinates for which K has a unit diagonal."""
    diagonal = K.diagonal()
    if (diagonal <= 0).any():
        raise _unstable(K)
    return cast(Array, 1 / np.sqrt(diagonal))


def _symmetric(name: str, matrix: Any, sign: int, size: float) -> Any:
    """The symmetric (sign 1) or skew (sign -1) part; the rest must be rounding, relative to ``size``.

    An operator is returned as it is, after a test with a few vectors.

    Raises:
        CodeError: it is not, or the matrix is not finite.
    """
    if _acts(matrix):
        products = _probes(matrix).T @ (matrix @ _probes(matrix))
        difference = products - sign * products.T
    else:
        difference = matrix - sign * matrix.T
    asymmetry = max(difference.max(), -difference.min())
    if not np.isfinite(asymmetry):
        raise CodeError(f"{name}: not finite: the linearisation of the code is not usable")
    if asymmetry > ASYMMETRY * size:
        kind = "symmetric" if sign == 1 else "skew"
        raise CodeError(
            f"{name}: {asymmetry / size:.1e} from {kind}: the system is damped, or not linearised about a steady state"
        )
    return matrix if _acts(matrix) else matrix - difference / 2


def _factor(K: Any) -> Solve:
    """Factorise K, which must be positive definite, and return a function that solves with it.

    Raises:
        LinAlgError: it is not.
    """
    if not sp.issparse(K):
        L = np.asfortranarray(scipy.linalg.cholesky(K, lower=True))
        (trsv,) = scipy.linalg.get_blas_funcs(("trsv",), (L,))
        return lambda b: trsv(L, trsv(L, b, lower=1), lower=1, trans=1)  # for one vector faster than LAPACK's potrs
    # no rows are exchanged, so that the pivots' signs are the inertia of K (Sylvester)
    factor = spla.splu(
        sp.csc_matrix(K), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    if (factor.perm_r != factor.perm_c).any() or (factor.U.diagonal() <= 0).any():
        raise np.linalg.LinAlgError("not positive definite")
    return factor.solve


def _direct(M: Array, C: Array, K: Array, count: int) -> Eigenpairs:
    """1/ω and shapes, by all of the Hermitian problem."""
    n = len(K)
    L = scipy.linalg.cholesky(K, lower=True)
    m, V = np.linalg.eigh(M)
    if m[0] < -1e-10 * m[-1]:
        raise CodeError(f"M: lowest eigenvalue {m[0] / m[-1]:.1e} of the largest: negative mass")
    real = m > n * np.finfo(float).eps * m[-1]
    F = V[:, real] * np.sqrt(m[real])
    # K q = -λ (C q + F p), p = λ Fᵀ q with λ = iω:  i [[-L⁻¹CL⁻ᵀ, -L⁻¹F], [FᵀL⁻ᵀ, 0]] y = (1/ω) y
    coupling = scipy.linalg.solve_triangular(L, F, lower=True)
    gyro = scipy.linalg.solve_triangular(L, scipy.linalg.solve_triangular(L, C, lower=True).T, lower=True).T
    size = n + F.shape[1]
    T = np.zeros((size, size), complex)
    T[:n, :n], T[:n, n:], T[n:, :n] = -1j * gyro, -1j * coupling, 1j * coupling.T
    # the spectrum is ± pairs and zeros, so no more than half of it is positive
    inverse, y = scipy.linalg.eigh(T, subset_by_index=[max(size - count, (size + 1) // 2), size - 1])
    return inverse, scipy.linalg.solve_triangular(L, y[:n], lower=True, trans=1)


def _iterated(M: Any, C: Any, K: Any, solve: Solve, count: int) -> Eigenpairs:
    """1/ω and shapes, by Arnoldi's method on A⁻¹S with A = diag(K, M), S = [[-C, -M], [M, 0]]."""
    n = K.shape[0]
    start = np.random.default_rng(0).standard_normal(2 * n)
    # velocities in units of a frequency near the lowest, so both halves of a state have similar magnitude
    guess = solve(M @ start[:n])
    unit = np.sqrt((guess @ (K @ guess)) / (guess @ (M @ guess)))

    def inverse(x: Array) -> Array:
        """A⁻¹ S x: one solve with K, none with M."""
        q, v = x[:n], x[n:]
        return np.concatenate([-solve(C @ q + unit * (M @ v)), q / unit])

    operator = spla.LinearOperator((2 * n, 2 * n), matvec=inverse, dtype=float)  # pyright: ignore[reportCallIssue]
    k = 2 * count + 2  # ± pairs, and one spare
    # with a basis of 2 k, most problems need several restarts; with 11/4 k, none or one
    # with a double pair the restarts may not converge to the last digit; a larger basis needs none
    for basis, tolerance in ((max(11 * k // 4, 40), 1e-14), (max(4 * k, 120), 1e-13), (max(8 * k, 240), 1e-12)):
        try:
            limits: dict[str, Any] = {"ncv": min(2 * n, basis), "tol": tolerance, "maxiter": RESTARTS}
            solution = spla.eigs(operator, k=k, which="LM", v0=start, **limits)
        except spla.ArpackError:
            continue
        values, x = cast(tuple[NDArray[np.complex128], NDArray[np.complex128]], solution)
        return -values.imag, x[:n]  # 1/(iω) = -i/ω
    raise CodeError(f"eigenproblem: ARPACK did not converge for {k} eigenvalues of {2 * n}: request fewer modes")


def _ordered(inverse: Array, q: NDArray[np.complex128], count: int) -> Eigenpairs:
    """Modes from eigenvalues 1/ω: the positive ones, ascending in ω, largest entry 1."""
    selected = np.flatnonzero(inverse > 1e-12 * inverse.max())
    selected = selected[np.argsort(-inverse[selected])][:count]
    q = q[:, selected]
    largest = q[np.abs(q).argmax(axis=0), np.arange(len(selected))]
    return 1 / inverse[selected], cast(NDArray[np.complex128], q / largest)


def _unstable(K: Any) -> CodeError:
    full = K.toarray() if sp.issparse(K) else K  # only for the error message
    lowest = np.linalg.eigvalsh((full + full.T) / 2)[0]
    return CodeError(f"stiffness: lowest eigenvalue {lowest:.3g}: no stable steady state at this rotor speed; lower it")


def damped_modes(M: Array, C: Array, K: Array) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Eigenvalues (m,), 1/s, and vectors (n, m) of ``λ² M + λ C + K``, all (n, n).

    Of each conjugate pair only the eigenvalue with positive imaginary part is returned; sorted by modulus.
    """
    n = len(M)
    zero, identity = np.zeros((n, n)), np.eye(n)
    eigenpairs = np.linalg.eig(np.block([[zero, identity], [-np.linalg.solve(M, np.hstack([K, C]))]]))
    values, z = (np.asarray(a, np.complex128) for a in eigenpairs)
    upper = values.imag >= -1e-12 * np.abs(values).max(initial=0.0)
    values, x = values[upper], z[:n, upper]
    order = np.argsort(np.abs(values), kind="stable")
    return values[order], x[:, order]
