"""Modes about a steady state that gyroscopic forces alone stabilise: K is indefinite, as of a shaft above its critical speed.

Let n be the number of negative eigenvalues of K. Of the eigenvalues, n₁ are real and positive, n₂ are complex with a positive
real part, and n₃ pairs ±iω have a negative energy x*Kx + ω² x*Mx. Then

    n = n₁ + n₂ + 2 n₃                                          (Kapitula, Kevrekidis, Sandstede, Physica D 195, 2004, 263),

so n/2 frequencies with negative energy prove that the state is stable and that there are no more of them. Each raises a
negative eigenvalue of H(ω) = K + iωC − ω²M to a positive one, and each of positive energy does the opposite (``completeness``):
the number of negative eigenvalues of H(ω) proves that no mode below ω is missing.
"""

import warnings
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import ArpackError, LinearOperator, eigs

from ..tree.elimination import solve
from ..tree.links import allowed, product
from ..tree.pencil import TreePencil
from .completeness import below
from .eigen import Eigen

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_OPERATOR: Any = LinearOperator

_EXTRA_MODES = 4  # modes beyond those requested, to locate a gap
_MAX_REAL_PART = 1e-6  # of an eigenvalue, as a fraction of its modulus: rounding
_MAX_RESTARTS = 100  # of ARPACK
_MIN_GAP = 1e-6  # relative distance of two frequencies between which modes are counted

MAX_NEGATIVE = 32
"""Largest number of negative eigenvalues of K for which stability is examined: a uniform shaft above its 16th critical speed
has that many. More are those of a cable that the mesh does not resolve, and half as many modes would have to converge."""


class GyroscopicStabilityWarning(UserWarning):
    """A steady state is stable by gyroscopic forces alone."""


def stabilised(p: TreePencil, count: int) -> Eigen | None:
    """The ``count`` lowest modes of a tree with an indefinite K; None unless they are proved to be stable and complete."""
    negative = below(p, 0.0)
    if negative % 2 or negative > MAX_NEGATIVE:
        return None
    lowest = _nearest_zero(p, count + negative // 2 + _EXTRA_MODES)
    if lowest is None:
        return None
    frequencies, x, energy = lowest
    if 2 * int((energy < 0).sum()) != negative:
        return None
    gaps = np.flatnonzero(frequencies[1:] > (1.0 + _MIN_GAP) * frequencies[:-1])
    gaps = gaps[gaps >= count - 1]
    if not len(gaps):
        return None
    lower = slice(0, gaps[0] + 1)
    shift = float(np.sqrt(frequencies[gaps[0]] * frequencies[gaps[0] + 1]))
    if below(p, shift) != negative + int(np.sign(energy[lower]).sum()):
        return None
    warnings.warn(
        "the stiffness is indefinite: gyroscopic forces alone stabilise this state, and internal damping may not",
        GyroscopicStabilityWarning,
        stacklevel=2,
    )
    return Eigen(frequencies[:count], x[:, :count])


def _nearest_zero(p: TreePencil, count: int) -> tuple[Array, Complex, Array] | None:
    """Frequencies (m,) ascending, vectors (dn, m) and energies (m,) of the lowest modes; None if one grows or decays."""
    n = len(p.residual)

    def step(w: Array) -> Array:  # A⁻¹S of ``eigen``, with the eigenvalues −1/λ
        x, y = w.reshape(2, 1, n)
        force = product(p.C, -1.0, p.links, x) + product(p.M, 1.0, p.links, y)
        solve(p.factor, force)
        return np.concatenate([force[0], -x[0]])

    start = np.random.default_rng(1921).normal(size=(2, n))
    start = step(allowed(p.links, start).ravel())
    try:
        operator = _OPERATOR((2 * n, 2 * n), step, dtype=float)
        values, w = cast(
            tuple[Complex, Complex], eigs(operator, k=min(2 * count, 2 * n - 2), v0=start, maxiter=_MAX_RESTARTS)
        )
    except ArpackError:
        return None
    eigenvalues, x = -1.0 / values, w[:n]
    if (np.abs(eigenvalues.real) > _MAX_REAL_PART * np.abs(eigenvalues)).any():
        return None
    positive = eigenvalues.imag > 0
    omega, x = eigenvalues.imag[positive], x[:, positive]
    rows = np.ascontiguousarray(np.concatenate([x.real, x.imag], axis=1).T)
    kappa, inertia = ((rows * product(a, 1.0, p.links, rows)).sum(1).reshape(2, -1).sum(0) for a in (p.K, p.M))
    m = len(omega)
    coriolis = (rows[m:] * product(p.C, -1.0, p.links, np.ascontiguousarray(rows[:m]))).sum(1)  # ½i x*Cx
    energy = kappa + omega**2 * inertia
    omega = (
        coriolis + np.sign(energy) * np.sqrt(np.maximum(coriolis**2 + inertia * kappa, 0.0))
    ) / inertia  # Rayleigh quotient
    order = np.argsort(omega)
    return omega[order], (x / np.sqrt(np.abs(kappa)))[:, order], energy[order]
