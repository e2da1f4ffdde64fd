"""The eigenproblem λ² M + λ C + K of a few coordinates with positive definite M, damped or unstable."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def damped_modes(M: Array, C: Array, K: Array) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Eigenvalues (m,), 1/s, and vectors (n, m) of ``λ² M + λ C + K``, all (n, n).

    Of each conjugate pair only the eigenvalue with positive imaginary part is returned; sorted by modulus.
    """
    n = len(M)
    zero, one = np.zeros((n, n)), np.eye(n)
    found = np.linalg.eig(np.block([[zero, one], [-np.linalg.solve(M, np.hstack([K, C]))]]))
    values, z = (np.asarray(a, np.complex128) for a in found)
    kept = values.imag >= -1e-12 * np.abs(values).max(initial=0.0)
    values, x = values[kept], z[:n, kept]
    order = np.argsort(np.abs(values), kind="stable")
    return values[order], x[:, order]
