"""Dense matrices of a tree, from the definition of its elements' coordinates."""

import numpy as np

from southwell.core.tree.pencil import TreePencil


def dense(p: TreePencil, matrix: np.ndarray) -> np.ndarray:
    """The sum (dn, dn) of the elements' matrices (n, d + 6, d + 6) of a pencil, on (ρ, β) of one element after the other."""
    n, d = len(matrix), matrix.shape[1] - 6
    beyond, out = to_twists(p, d), np.zeros((d * n, d * n))
    free = np.eye(d * n)
    for k, a in enumerate(p.links.parent):
        to_element = np.zeros((d + 6, d * n))  # (ξ_a, ρ, β)
        to_element[6:, d * k : d * (k + 1)] = np.eye(d)
        if a > 0:
            to_element[:6] = beyond[d * (a - 1) : d * (a - 1) + 6]
        out += to_element.T @ matrix[k] @ to_element
        if p.links.clamped_directions.size:
            free[d * k : d * k + 6, d * k : d * k + 6] -= p.links.clamped_directions[k]
    return free @ out @ free


def to_twists(p: TreePencil, d: int) -> np.ndarray:
    """(dn, dn) from (ρ, β) to (ξ_b, β) of one element after the other: Ad ξ_b = ρ + ξ_a."""
    out = np.eye(d * len(p.links.parent))
    for k, (a, to_child) in enumerate(zip(p.links.parent, p.links.to_child, strict=True)):
        if a > 0:
            out[d * k : d * k + 6] += out[d * (a - 1) : d * (a - 1) + 6]
        out[d * k : d * k + 6] = to_child @ out[d * k : d * k + 6]
    return out
