"""Section matrices from engineering properties, by sums of energies.

A section's strain energy is a sum of ½ k ε², each strain taken at its own centre and along its own axes. Every strain is a
row in terms of the strains at the reference point, so that the matrix is Σ k rᵀr. Kinetic energy is written out with the
first and second moments of mass (Hodges, *Nonlinear Composite Beam Theory*, 2006, ch. 4–5).
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def strains(y: ArrayLike, z: ArrayLike, angle: ArrayLike) -> Array:
    """Rows (n, 6, 6) of the strains at the point (``y``, ``z``) m along axes rotated by ``angle`` rad, y towards z.

    The strains at the reference point, in section axes, are (γ_x, γ_y, γ_z, κ_x, κ_y, κ_z).
    """
    y, z, angle = np.broadcast_arrays(np.asarray(y, float), np.asarray(z, float), np.asarray(angle, float))
    c, s, unit, zero = np.cos(angle), np.sin(angle), np.ones(y.shape), np.zeros(y.shape)
    rows = (
        (unit, zero, zero, zero, z, -y),  # γ_x + z κ_y − y κ_z
        (zero, c, s, -c * z + s * y, zero, zero),  # along y′: (γ_y − z κ_x) cos + (γ_z + y κ_x) sin
        (zero, -s, c, s * z + c * y, zero, zero),
        (zero, zero, zero, unit, zero, zero),
        (zero, zero, zero, zero, c, s),
        (zero, zero, zero, zero, -s, c),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def energy(rows: Array, values: Array) -> Array:
    """Σ k rᵀr (n, 6, 6) of the rows (n, 6, 6) with stiffnesses ``values`` (n, 6), or full matrices (n, 6, 6)."""
    if values.ndim == 2:
        return np.einsum("nk,nki,nkj->nij", values, rows, rows)
    return np.einsum("nkl,nki,nlj->nij", values, rows, rows)


def mass(m: Array, cy: ArrayLike, cz: ArrayLike, yy: ArrayLike, zz: ArrayLike, yz: ArrayLike = 0.0) -> Array:
    """Mass (n, 6, 6) from mass per length, its centre (m) and ∫y², ∫z², ∫yz (kg m), all about the reference point."""
    m, cy, cz, yy, zz, yz = np.broadcast_arrays(*(np.asarray(v, float) for v in (m, cy, cz, yy, zz, yz)))
    out = np.zeros((len(m), 6, 6))
    for i in range(3):
        out[:, i, i] = m
    for i, j, value in ((0, 4, m * cz), (0, 5, -m * cy), (1, 3, -m * cz), (2, 3, m * cy), (4, 5, -yz)):
        out[:, i, j] = out[:, j, i] = value
    out[:, 3, 3], out[:, 4, 4], out[:, 5, 5] = yy + zz, zz, yy
    return out


def diagonal(*entries: ArrayLike) -> Array:
    """Values (n, 6) of six stiffnesses."""
    return np.stack(np.broadcast_arrays(*(np.asarray(e, float) for e in entries)), axis=-1)


def rigid(stiffness: Array, *strains: int) -> Array:
    """The stiffness (n, 6, 6) with these strains rigid: ``inf`` on the diagonal, no couplings."""
    out = stiffness.copy()
    for i in strains:
        out[:, i] = out[:, :, i] = 0.0
        out[:, i, i] = np.inf
    return out


def permuted(matrices: Array, order: ArrayLike, signs: ArrayLike) -> Array:
    """Matrices (n, 6, 6) in another order: entry (i, j) is ``signs[i] signs[j]`` times (``order[i]``, ``order[j]``)."""
    order, signs = np.asarray(order), np.asarray(signs, float)
    return matrices[:, order[:, None], order[None, :]] * (signs[:, None] * signs[None, :])


OPENFAST = ([2, 1, 0, 5, 4, 3], [1, -1, 1, 1, -1, 1])
"""``permuted`` from OpenFAST's axes (x downwind, y to the trailing edge, z along the blade) and the order (Fx … Mz)."""

HAWC2 = ([2, 0, 1, 5, 3, 4], [1, 1, 1, 1, 1, 1])
"""``permuted`` from HAWC2's axes (x to the leading edge, y downwind, z along the blade)."""
