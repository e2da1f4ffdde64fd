"""Errors of a mechanism's eigenvalues due to rounding, its only numerical error since it is not discretised.

For an eigenvalue λ with right and left vectors x and y of Q(λ) = K̂ + λ Ĉ + λ² M̂, the error has three parts. Eigensolver: the
residual Q x, projected on y. Matrices: ``|y|*E|x|``, with E the rounding of every term of which they are sums. Steady state:
the change of Q when the state is computed again from a point a rounding error away. An eigenvalue changes by
``y* δQ x / y* Q′(λ) x`` (P. Lancaster, *Lambda-Matrices and Vibrating Systems*, 1966; F. Tisseur, Linear Algebra Appl. 309,
2000, 339–361, for backward errors and conditions). Defective eigenvalues (as those of a free body seen from a turning frame)
split by a root of that; their mean does not (T. Kato, *Perturbation Theory for Linear Operators*, 1966, ch. 2), so their
distance from the mean is their error.
"""

from typing import cast

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ..mechanism.description import MechanismError
from ..steady.equilibrium import perturbed_again
from ..tree.linearization import Linearization, about
from . import eigen

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

FLOOR = 1e-15
"""Smallest relative error that is claimed for an eigenvalue."""

_EPS = float(np.finfo(float).eps)
_SAFETY = 3.0
_TOGETHER = 1e-6  # relative distance of eigenvalues that rounding may mix


def rounding(linear: Linearization, eigenpairs: eigen.Eigen | eigen.Damped) -> Array:
    """(m,) error of the eigenvalues due to rounding: relative for frequencies, absolute for damping ratios.

    Infinite if it cannot be estimated; 0 for rigid modes, which are exact.
    """
    values: Complex = np.asarray(
        eigenpairs.values if isinstance(eigenpairs, eigen.Damped) else 1j * eigenpairs.frequencies, complex
    )
    if not len(values):
        return np.zeros(0)
    sizes = _sizes(linear)
    try:
        state = perturbed_again(linear.tree, linear.state, linear.names)
        perturbed = about(linear.tree, state, linear.names)
    except MechanismError:  # rounding decides whether there is a steady state
        return np.full(len(values), np.inf)
    changes = [
        np.abs(b - a)
        for a, b in zip((linear.M, linear.C, linear.K), (perturbed.M, perturbed.C, perturbed.K), strict=True)
    ]
    unit = 1.0 / np.sqrt(sizes[2].diagonal() + np.abs(values).max() ** 2 * sizes[0].diagonal() + 1e-300)
    out = np.zeros(len(values))
    for k, value in enumerate(values.tolist()):
        if value == 0.0:
            continue
        M, C, K = (unit[:, None] * a * unit for a in (linear.M, linear.C, linear.K))
        Q, slope = K + value * C + value**2 * M, C + 2.0 * value * M
        cluster = np.abs(values - value) <= _TOGETHER * abs(value)
        x, y = _vectors(Q, int(cluster.sum()))
        sharp = float(np.linalg.svd(y.conj().T @ slope @ x, compute_uv=False).min()) * abs(value)
        computed = eigenpairs.vectors[:, k] / unit
        residual = float(np.linalg.norm(y.conj().T @ (Q @ computed)) / np.linalg.norm(computed))
        powers = (abs(value) ** 2, abs(value), 1.0)
        entry_errors = sum(
            p * (4.0 * _EPS * size + change) for p, size, change in zip(powers, sizes, changes, strict=True)
        )
        change_of_value = float(np.linalg.norm(np.abs(y).T @ (unit[:, None] * entry_errors * unit) @ np.abs(x)))
        simple = (residual + change_of_value) / sharp if sharp > 0 else np.inf
        if simple > _TOGETHER and cluster.sum() > 1:
            simple = float(np.abs(values[cluster] - values[cluster].mean()).max()) / abs(value)
        out[k] = FLOOR + _SAFETY * simple
    return out


def _vectors(Q: Complex, count: int) -> tuple[Complex, Complex]:
    """Right and left singular vectors (n, count) of the smallest singular values."""
    try:
        u, _, vh = cast(tuple[Complex, Array, Complex], scipy.linalg.svd(Q))
    except scipy.linalg.LinAlgError:  # divide and conquer may not converge
        u, _, vh = cast(tuple[Complex, Array, Complex], scipy.linalg.svd(Q, lapack_driver="gesvd"))
    return vh[-count:].conj().T, u[:, -count:]


def _sizes(linear: Linearization) -> tuple[Array, Array, Array]:
    """|M̂|, |Ĉ|, |K̂| (i, i), each the sum of the absolute values of its terms."""
    p = linear.partition
    M, C, K = (np.abs(a[np.ix_(p.free, p.free)]) for a in linear.state.tangent)
    R, R1, R2 = np.abs(p.R), np.abs(p.R1), np.abs(p.R2)
    return R.T @ M @ R, R.T @ (C @ R + 2.0 * M @ R1), R.T @ (K @ R + C @ R1 + M @ R2)
