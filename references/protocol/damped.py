"""The eigenproblem λ² M + λ C + K of a few coordinates, damped or growing, all of them with mass."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def damped_modes(M: Array, C: Array, K: Array) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """One of each conjugate pair of eigenvalues, and real ones, by modulus, with vectors (i, m)."""
    n = len(M)
    zero, one = np.zeros((n, n)), np.eye(n)
    found = np.linalg.eig(np.block([[zero, one], [-np.linalg.solve(M, np.hstack([K, C]))]]))
    values, z = (np.asarray(a, np.complex128) for a in found)
    kept = values.imag >= -1e-12 * np.abs(values).max(initial=0.0)
    values, x = values[kept], z[:n, kept]
    order = np.argsort(np.abs(values), kind="stable")
    return values[order], x[:, order]
