"""The compiled corotational strain measure of one element; see ``measures``."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..compiled import apply, compiled, invert, product, transposed_apply, transposed_product
from ..space import rigid
from .body_fixed import add_tangent_variation

Array = NDArray[np.float64]


class StrainLawArrays(NamedTuple):
    """``measures.StrainLaw`` for compiled code."""

    undeformed: Array
    shortening: Array
    mean: Array
    slope: Array
    eta: Array


@compiled
def strains(law: StrainLawArrays, k: int, eta: Array, beta: Array, strain: Array, J: Array, undo: Array) -> None:
    """Strain ε (6,) and J = ∂ε/∂(η, β) (6, 12) of element ``k``, from ``(1 + ad(A δ) B_δ/12) ε = δ − ad(A δ) B_β β/12``.

    ``undo`` (6, 6) is the inverse of the matrix on the left, which ``add_curvature`` needs.
    """
    mean, slope = law.mean[k], law.slope[k]
    delta, bow, r = np.empty(6), np.empty(6), np.empty(6)
    for i in range(6):
        delta[i] = eta[i] - law.eta[k, i]
    apply(law.shortening[k], delta, bow)
    apply(mean, delta, r)
    across, by = np.empty((6, 6)), np.empty((6, 12))
    rigid.ad(r, across)  # of A δ
    product(across, slope, J)
    for i in range(6):  # (1 + ad(A δ) B_δ/12) ε = r
        r[i] = delta[i]
        for j in range(6):
            by[i, 6 + j] = -J[i, 6 + j] / 12.0
            r[i] += by[i, 6 + j] * beta[j]
            undo[i, j] = J[i, j] / 12.0
        undo[i, i] += 1.0
    for j in range(6):  # G contains the axial part of Magnus' term, except that of β
        undo[0, j] = 1.0 if j == 0 else 0.0
        r[0] += delta[j] * bow[j]
    invert(undo, 0)  # near the unit matrix
    apply(undo, r, strain)
    changes, inner_changes = np.zeros(6), np.zeros(6)
    for i in range(6):
        for j in range(6):
            changes[i] += slope[i, j] * strain[j]
            inner_changes[i] += slope[i, 6 + j] * beta[j]
    inner_across = np.empty((6, 6))
    rigid.ad(changes, across)
    rigid.ad(inner_changes, inner_across)
    for i in range(6):
        for j in range(6):
            across[i, j] = (inner_across[i, j] + (across[i, j] if i > 0 else 0.0)) / 12.0
    product(across, mean, by)
    for i in range(6):
        by[i, i] += 1.0
        by[0, i] += 2.0 * bow[i]
    product(undo, by, J)


@compiled
def add_curvature(
    law: StrainLawArrays, k: int, eta: Array, back: Array, J: Array, undo: Array, s: Array, on_eta: Array, out: Array
) -> None:
    """Add the geometric stiffness (12, 12) of forces ``s`` and ``on_eta`` (6,) to ``out``, with the results of ``strains``."""
    mean, slope = law.mean[k], law.slope[k]
    force, conjugate = np.empty(6), np.empty(6)
    transposed_apply(undo, s, force)
    for i in range(6):
        conjugate[i] = on_eta[i]
        for j in range(6):
            conjugate[i] += J[j, i] * s[j]
    crossed, through, on_slope, half = np.empty((6, 6)), np.empty((6, 12)), np.empty((6, 12)), np.empty((6, 12))
    axial, force[0] = force[0], 0.0
    rigid.cross(force, crossed)
    transposed_product(crossed, slope, through)
    product(through, J, on_slope)
    force[0] = axial
    rigid.cross(force, crossed)
    transposed_product(crossed, slope, through)
    for i in range(6):
        for j in range(6, 12):
            on_slope[i, j] += through[i, j]
    transposed_product(mean, on_slope, half)
    both, left = np.empty((6, 12)), np.empty((6, 12))
    for i in range(6):
        for j in range(6):
            both[i, j] = 2.0 * axial * law.shortening[k, i, j] - (half[i, j] + half[j, i]) / 12.0
            both[i, 6 + j] = -half[i, 6 + j] / 12.0
    transposed_product(back, both, left)
    product(left, back, both)
    for i in range(6):
        for j in range(6):
            out[i, j] += both[i, j]
            out[i, 6 + j] += left[i, 6 + j]
            out[6 + j, i] += left[i, 6 + j]
    add_tangent_variation(eta, conjugate, back, out)
