"""Transformation of section matrices to another reference point and other axes.

Orders and axes are those of ``core.blade``: force and strain (axial, y, z), then moment and curvature about (x, y, z).
The strain of point p at r from the reference is ε_p = ε + κ × r, so that K = Tᵀ K_p T with T = [1, −r×; 0, 1]
(Hodges, *Nonlinear Composite Beam Theory*, 2006, ch. 4); mass transforms likewise, with velocity in place of strain.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....core.blade import AXIAL, BEND_Y, BEND_Z, SHEAR_Y, SHEAR_Z, TORSION
from ....core.space.spatial import rotation, skew

Array = NDArray[np.float64]

BEAMDYN = np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
"""Rotation of a vector from OpenFAST's blade axes (x downwind, y to the trailing edge, z along the blade) to ours."""

HAWC2 = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""Rotation of a vector from HAWC2's blade axes (x to the leading edge, y downwind, z along the blade) to ours."""


UPPER = np.triu_indices(6)
"""Rows and columns of the upper triangle, row by row."""


def in_axes(matrix: Array, axes: Array) -> Array:
    """Transform matrices (…, 6, 6) to our axes; ``axes`` (…, 3, 3) is the rotation from the original axes to ours."""
    rotation = np.zeros((*axes.shape[:-2], 6, 6))
    rotation[..., :3, :3] = rotation[..., 3:, 3:] = axes
    return rotation @ matrix @ np.swapaxes(rotation, -1, -2)


def rotated(matrix: Array, angle: ArrayLike) -> Array:
    """Transform matrices (n, 6, 6) to section axes, from axes rotated by ``angle`` (n,) rad about x (y towards z)."""
    return in_axes(matrix, rotation(0, np.asarray(angle, float)))


def about(matrix: Array, y: ArrayLike, z: ArrayLike) -> Array:
    """Transfer matrices (n, 6, 6) from the points (``y``, ``z``) (n,) of the section to its origin."""
    y, z = np.broadcast_arrays(np.asarray(y, float), np.asarray(z, float))
    move = np.broadcast_to(np.eye(6), (*y.shape, 6, 6)).copy()
    move[..., :3, 3:] = -skew(np.stack([np.zeros_like(y), y, z], axis=-1))
    return np.swapaxes(move, -1, -2) @ matrix @ move


def bending(EA: ArrayLike, EI_y: ArrayLike, EI_z: ArrayLike) -> Array:
    """Stiffness (n, 6, 6) of axial and bending strains about the tension centre; zero for the others."""
    return _with({AXIAL: EA, BEND_Y: EI_y, BEND_Z: EI_z})


def shearing(GJ: ArrayLike, GA_y: ArrayLike, GA_z: ArrayLike) -> Array:
    """Stiffness (n, 6, 6) of torsion and shear about the shear centre; zero for the others."""
    return _with({TORSION: GJ, SHEAR_Y: GA_y, SHEAR_Z: GA_z})


def rigid(stiffness: Array, *strains: int) -> Array:
    """The same stiffness with some strains rigid; their rows and columns are otherwise zero."""
    out = stiffness.copy()
    for i in strains:
        out[:, i, :] = out[:, :, i] = 0.0
        out[:, i, i] = np.inf
    return out


def between(r: Array, values: Array, at: Array) -> Array:
    """Matrices (n, 6, 6) interpolated linearly from their positions ``r`` (n,) to ``at``, as in ``core``."""
    k = np.clip(np.searchsorted(r, at, side="right") - 1, 0, len(r) - 2)
    t = np.clip((at - r[k]) / (r[k + 1] - r[k]), 0.0, 1.0)[:, None, None]
    return (1.0 - t) * values[k] + t * values[k + 1]


def symmetric(upper: Array) -> Array:
    """Matrices (n, 6, 6) from the rows of their upper triangles (n, 21)."""
    out = np.zeros((len(upper), 6, 6))
    out[:, UPPER[0], UPPER[1]] = out[:, UPPER[1], UPPER[0]] = upper
    return out


def _with(entries: dict[int, ArrayLike]) -> Array:
    columns = np.broadcast_arrays(*[np.atleast_1d(np.asarray(e, float)) for e in entries.values()])
    out = np.zeros((len(columns[0]), 6, 6))
    for i, column in zip(entries, columns, strict=True):
        out[:, i, i] = column
    return out


def fault(matrix: Array) -> str | None:
    """The fault of a section matrix (6, 6): not symmetric to 1e-3 of its diagonal, or not positive definite."""
    d = np.diag(matrix)
    if (d <= 0).any():
        i = int(np.argmax(d <= 0))
        return f"diagonal entry {i + 1} is {d[i]:g}: it must be positive: check its sign and the order of the rows"
    scale = np.sqrt(d)
    with np.errstate(over="ignore"):
        scaled = matrix / scale[:, None] / scale  # np.outer(d, d) may underflow
    if not np.isfinite(scaled).all():
        return "not positive definite: a diagonal entry is far too small for its row: check the exponent"
    i, j = np.unravel_index(np.abs(scaled - scaled.T).argmax(), (6, 6))
    if abs(scaled[i, j] - scaled[j, i]) > 1e-3:
        return (
            f"entries ({i + 1}, {j + 1}) and ({j + 1}, {i + 1}) are {matrix[i, j]:g} and {matrix[j, i]:g}: "
            "it must be symmetric: make both entries equal"
        )
    smallest = np.linalg.eigvalsh((scaled + scaled.T) / 2)[0]
    if smallest <= 0:
        return f"not positive definite (least scaled eigenvalue {smallest:.2g}): check the couplings"
    return None


def mass_fault(matrix: Array) -> str | None:
    """The fault of a section's mass (6, 6): as ``fault``, but moments of inertia may be zero."""
    d = np.diag(matrix)
    nonpositive = np.where(np.arange(6) < 3, d <= 0, d < 0)
    if nonpositive.any():
        i = int(np.argmax(nonpositive))
        return f"diagonal entry {i + 1} is {d[i]:g}: it must be positive: check its sign and the order of the rows"
    scale = np.sqrt(np.outer(d, d)) + max(1e-9 * d[0], np.finfo(float).tiny)
    i, j = np.unravel_index((np.abs(matrix - matrix.T) / scale).argmax(), (6, 6))
    if abs(matrix[i, j] - matrix[j, i]) > 1e-3 * scale[i, j]:
        return (
            f"entries ({i + 1}, {j + 1}) and ({j + 1}, {i + 1}) are {matrix[i, j]:g} and {matrix[j, i]:g}: "
            "it must be symmetric: make both entries equal"
        )
    return None
