"""Rotors with equal blades, for codes that return matrices at an azimuth: Fourier coordinates of the blades.

The coordinates of blades 0 … N − 1 are ``q_k = Σ_m a_m e^{i m ψ_k}/√N`` with ψ_k = ψ + 2πk/N and m from −(N − 1)/2 to (N − 1)/2
(for even N also (−1)^k, which does not turn). They are complex, and their transformation is unitary, unlike core's cosine and
sine coordinates, which are not used here. With a = e^{λt} both are seen from the support.
"""

from collections.abc import Callable, Sequence

import numpy as np
import scipy.linalg
from numpy.typing import NDArray
from scipy.sparse import linalg as spla

from ..protocol.interface import CodeError

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Matrices = tuple[Array, Array, Array]

AZIMUTHS = (0.0, 0.9, 2.3)
"""rad; the transformed matrices must be the same at all of them."""

CHANGE = 1e-7
"""Largest change with the azimuth, relative to the largest entry, that counts as rounding."""

RIGID = 1e-2
"""Modulus, relative to a typical frequency, below which a mode is the rotor that turns freely."""


def modes(at: Callable[[float], Matrices], omega: float, groups: Sequence[Sequence[int]]) -> tuple[Complex, Complex]:
    """Eigenvalues (m,) with imaginary part ≥ 0, by modulus, and shapes (n, m) at the azimuth 0.

    Args:
        at: M, C, K (n, n) at an azimuth, rad.
        omega: rotor speed, rad/s.
        groups: indices of the coordinates of equal name on all blades, in the order of their azimuths.

    Raises:
        CodeError: the transformed matrices change with the azimuth.
    """
    M, C, K = _constant(at, omega, groups)
    n = len(M)
    lower = -np.linalg.solve(M, np.hstack([K, C]))
    eigenpairs = np.linalg.eig(np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), lower]))
    values, vectors = (np.asarray(a, np.complex128) for a in eigenpairs)
    order = np.argsort(np.abs(values), kind="stable")
    order = order[values[order].imag >= -1e-12 * np.abs(values).max()]
    T, _ = _fourier(n, groups, 0.0)
    return values[order], T @ vectors[:n, order]


def lowest(
    at: Callable[[float], Matrices],
    omega: float,
    groups: Sequence[Sequence[int]],
    count: int,
    scale: float,
    free: bool,
) -> tuple[Complex, Complex]:
    """The ``count`` lowest modes, as ``modes``, of many coordinates, some of which may be massless.

    Args:
        at, omega, groups: as for ``modes``.
        count: number of modes.
        scale: a typical frequency, rad/s.
        free: whether the rotor turns freely; that motion is left out.

    Raises:
        CodeError: the transformed matrices change with the azimuth, or the iteration fails.
    """
    M, C, K = _constant(at, omega, groups)
    n, shift = len(M), 0.1 * scale  # real: all modes are as far from it as their modulus says
    factor = scipy.linalg.lu_factor(shift**2 * M + shift * C + K)

    def inverse(state: Complex) -> Complex:
        """(A − s B)⁻¹ B of the pencil A = [[0, 1], [−K, −C]], B = [[1, 0], [0, M]], applied to (x, λ x)."""
        x, v = state[:n], state[n:]
        out = -scipy.linalg.lu_solve(factor, M @ v + (C + shift * M) @ x)
        return np.concatenate([out, x + shift * out])

    operator = spla.LinearOperator((2 * n, 2 * n), matvec=inverse, dtype=complex)  # pyright: ignore[reportCallIssue]
    requested = min(2 * (count + 2 + free), 2 * n - 2)
    try:
        start = np.random.default_rng(0).standard_normal(2 * n).astype(complex)
        solution = spla.eigs(operator, k=requested, which="LM", v0=start, ncv=min(2 * n, 3 * requested))
    except spla.ArpackError as error:
        raise CodeError(f"eigenproblem: {error}: request fewer modes") from error
    inverses, vectors = (np.asarray(a, np.complex128) for a in solution)
    values = shift + 1.0 / inverses
    selected = np.flatnonzero((values.imag > 0) & (np.abs(values) > (RIGID * scale if free else 0.0)))
    selected = selected[np.argsort(np.abs(values[selected]), kind="stable")][:count]
    T, _ = _fourier(n, groups, 0.0)
    return values[selected], T @ vectors[:n, selected]


def _constant(at: Callable[[float], Matrices], omega: float, groups: Sequence[Sequence[int]]) -> tuple[Complex, ...]:
    """M, C, K (n, n) in Fourier coordinates of the blades.

    Raises:
        CodeError: they change with the azimuth.
    """
    first, *rest = [_transformed(at(psi), omega, groups, psi) for psi in AZIMUTHS]
    for matrices in rest:
        for power, (a, b) in zip((2, 1, 0), zip(first, matrices, strict=True), strict=True):
            size = max(float(np.abs(part).max()) * abs(omega) ** p for p, part in zip((2, 1, 0), first, strict=True))
            if float(np.abs(a - b).max()) * abs(omega) ** power > CHANGE * size:
                raise CodeError(
                    "periodic: the matrices change with the azimuth, also in Fourier coordinates of the blades"
                )
    return first


def _transformed(matrices: Matrices, omega: float, groups: Sequence[Sequence[int]], psi: float) -> tuple[Complex, ...]:
    M, C, K = matrices
    T, orders_of_columns = _fourier(len(M), groups, psi)
    D = 1j * omega * orders_of_columns  # q̇ = T (ȧ + D a), q̈ = T (ä + 2 D ȧ + D² a)
    adjoint = T.conj().T
    mass, damping = adjoint @ M @ T, adjoint @ C @ T
    return mass, damping + 2.0 * mass * D, adjoint @ K @ T + damping * D + mass * D**2


def _fourier(n: int, groups: Sequence[Sequence[int]], psi: float) -> tuple[Complex, Array]:
    """T (n, n) at an azimuth, and the order (n,) at which each of its columns turns."""
    T, orders_of_columns = np.eye(n, dtype=np.complex128), np.zeros(n)
    for group in groups:
        blades, k = len(group), np.arange(len(group))
        orders = list(range(-((blades - 1) // 2), (blades - 1) // 2 + 1))
        columns = [np.exp(1j * m * (psi + 2.0 * np.pi * k / blades)) for m in orders]
        if blades % 2 == 0:
            columns.append((-1.0) ** k + 0j)
            orders.append(0)
        index = np.array(group, dtype=np.intp)
        T[np.ix_(index, index)] = np.stack(columns, axis=-1) / np.sqrt(blades)
        orders_of_columns[index] = orders
    return T, orders_of_columns
