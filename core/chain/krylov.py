"""The block Lanczos steps of ``lanczos``, compiled. Vectors (x, y) are rows (2n,)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..compiled import apply, compiled, inner, reduction
from . import elimination, matrices
from .elimination import Factor

Array = NDArray[np.float64]

_MAX_OVERLAP, _MAX_PASSES = 1e-8, 3  # tolerated overlap with the basis; orthogonalisation passes


class Operator(NamedTuple):
    """The operator A⁻¹S with A = diag(K, M) and S = [[C, M], [−M, 0]].

    Attributes:
        M, C, K: matrices of the elements, see ``matrices``.
        back: Ad⁻¹.
        factor: factors of K.
        massive: (n, 6, 6) projectors of the nodes' twists on directions with mass; (0, 6, 6) for a consistent mass.
        lever: (n, 6, 6) Ad.
    """

    M: Array
    C: Array
    K: Array
    back: Array
    factor: Factor
    massive: Array
    lever: Array


@compiled
def keep_massive(a: Operator, y: Array) -> None:
    """Remove the motion of nodes without inertia from vectors y (k, n).

    It has no part in M y, but is amplified by every orthogonalisation, and its rounding errors are not without mass.
    """
    d, xi = y.shape[1] // len(a.back), np.empty((1, 6))
    here, before = np.empty(6), np.empty(6)
    for v in range(len(y) if len(a.massive) else 0):
        for i in range(6):
            xi[0, i] = before[i] = 0.0
        for k in range(len(a.massive)):
            matrices.outwards(a.back, k, y, v, d * k, xi, 0)
            apply(a.massive[k], xi[0], here)
            apply(a.lever[k], here, y[v, d * k : d * k + 6])
            for i in range(6):
                y[v, d * k + i] -= before[i]
                before[i] = here[i]


class Work(NamedTuple):
    """Results and intermediate arrays of a step, allocated once: large new ones cost the system as much as the step itself.

    Attributes:
        w, force: (k, 2n) A⁻¹S v and S v.
        My: (k, n) M y.
        both: (2k, n) M x and M y.
        x: (k, n).
    """

    w: Array
    force: Array
    My: Array
    both: Array
    x: Array


@compiled
def work(k: int, n: int) -> Work:
    """Arrays for steps with k vectors (2n,)."""
    return Work(np.empty((k, 2 * n)), np.empty((k, 2 * n)), np.empty((k, n)), np.empty((2 * k, n)), np.empty((k, n)))


@compiled
def forward(a: Operator, v: Array, out: Work) -> None:
    """w = A⁻¹S v, A w = S v, and M y, for rows v (k, 2n), into the first rows of ``out``."""
    k, n = len(v), v.shape[1] // 2
    x, w, force = out.x[:k], out.w, out.force
    for m in range(k):
        for i in range(n):
            x[m, i] = v[m, i]
    keep_massive(a, x)
    for m in range(k):
        for i in range(n):
            w[m, n + i] = -x[m, i]
    matrices.times(a.C, -1.0, a.back, v, x)
    matrices.times(a.M, 1.0, a.back, v.reshape((2 * k, n)), out.both)  # x and y in turn
    for m in range(k):
        for i in range(n):
            out.My[m, i] = out.both[2 * m + 1, i]
            x[m, i] += out.My[m, i]  # C x + M y
            force[m, i], force[m, n + i] = x[m, i], -out.both[2 * m, i]
    elimination.solve(a.factor, x)
    for m in range(k):
        for i in range(n):
            w[m, i] = x[m, i]


@inner
def _dual(a: Operator, w: Array, My: Array, out: Array) -> None:
    """out = A w for rows w (k, 2n) with M y (k, n)."""
    k, n = len(w), w.shape[1] // 2
    matrices.times(a.K, 1.0, a.back, w, out)
    for m in range(k):
        for i in range(n):
            out[m, n + i] = My[m, i]


@compiled
def extend(
    a: Operator, w: Array, basis: Array, projected: Array, size: int, before: int, look: int
) -> tuple[Array, Array, int, int, bool]:
    """Take block Lanczos steps until the basis has ``look`` vectors or cannot grow.

    Args:
        a: the operator.
        w: (k, 2n) result of the last step; overwritten.
        basis: (limit, 2n), with ``size`` rows filled, those of the last step from ``before`` on; extended in place.
        projected: (limit, limit) the operator on the basis, zero beyond the filled part; extended in place.
        size, before: see ``basis``; both 0 at the start.
        look: requested number of vectors.

    Returns:
        w orthogonal to the basis, its Gram matrix (k, k), the new size and before, and whether the basis is exhausted.
    """
    k, n = len(w), w.shape[1] // 2
    room, own, last = work(k, n), np.empty((k, n)), np.empty((k, n))
    My = own[:k]  # M y of w
    matrices.times(a.M, 1.0, a.back, w[:, n:].copy(), My)
    of_last = last[: size - before]  # M y of the last step's vectors
    matrices.times(a.M, 1.0, a.back, basis[before:size, n:].copy(), of_last)
    while True:
        gram, largest = _orthogonalise(a, w, My, basis, projected, size, before, room.force[: len(w)])
        value, turn = _axes(gram)
        least = 1e-20 * max(value[-1], largest**2, 1e-300)
        kept = 0
        for i in range(len(value)):
            if value[i] > least:
                kept += 1
        exhausted = kept == 0 or size + 2 > len(basis) - 2
        if exhausted or size >= look:
            return w, gram, size, before, exhausted
        end = size + kept
        for m in range(kept):
            column = len(value) - kept + m
            scale = 1.0 / np.sqrt(value[column])
            first, other = scale * turn[0, column], scale * turn[-1, column] if len(w) > 1 else 0.0
            for j in range(w.shape[1]):
                basis[size + m, j] = first * w[0, j] + other * w[-1, j]
        forward(a, basis[size:end], room)
        w, force, of_these = room.w[:kept], room.force[:kept], room.My[:kept]
        overlap = _products(basis[before:end], force)
        for i in range(len(overlap)):
            for j in range(kept):
                projected[before + i, size + j] = overlap[i, j]
        _project_out(w, overlap, basis[before:end])
        My = own[:kept]
        for m in range(kept):
            for i in range(n):
                My[m, i] = force[m, n + i]  # M y = −M x is known
        _project_out(My, overlap[: size - before], of_last)
        _project_out(My, overlap[size - before :], of_these)
        of_last = last[:kept]
        for m in range(kept):
            for i in range(n):
                of_last[m, i] = of_these[m, i]
        before, size = size, end


@inner
def _orthogonalise(
    a: Operator, w: Array, My: Array, basis: Array, projected: Array, size: int, before: int, dual: Array
) -> tuple[Array, float]:
    """Orthogonalise w, with M y = ``My``, against the basis in the A product; the overlaps are added to ``projected``.

    ``dual`` (k, 2n) is overwritten. Returns the Gram matrix (k, k) of w and the largest overlap of the last pass.
    """
    gram, largest = np.zeros((len(w), len(w))), 0.0
    n = My.shape[1]
    for turn in range(_MAX_PASSES):
        if turn > 0:
            matrices.times(a.M, 1.0, a.back, w[:, n:].copy(), My)
        _dual(a, w, My, dual)
        overlap = _products(basis[:size], dual)
        _project_out(w, overlap, basis[:size])
        largest = 0.0
        for i in range(size):
            for j in range(size - before):
                projected[i, before + j] += overlap[i, j]
                largest = max(largest, abs(overlap[i, j]))
        gram = _products(w, dual)
        smallest = gram[0, 0]
        for i in range(len(w)):
            smallest = min(smallest, gram[i, i])
        if largest <= _MAX_OVERLAP * np.sqrt(max(smallest, 0.0)):
            break
    return gram, largest


@reduction
def _products(a: Array, b: Array) -> Array:
    """a bᵀ (m, k) for rows a (m, n) and one or two rows b (k, n)."""
    m, k = len(a), len(b)
    out = np.empty((m, k))
    for i in range(m):
        first = other = 0.0
        for c in range(a.shape[1]):
            first += a[i, c] * b[0, c]
            other += a[i, c] * b[k - 1, c]
        out[i, 0] = first
        out[i, k - 1] = other
    return out


@inner
def _project_out(w: Array, overlap: Array, basis: Array) -> None:
    """w −= overlapᵀ basis for one or two rows w; four rows of the basis at a time."""
    m = len(basis)
    for i in range(0, m, 4):
        i1, i2, i3 = min(i + 1, m - 1), min(i + 2, m - 1), min(i + 3, m - 1)
        for v in range(len(w)):
            h0 = overlap[i, v]
            h1 = overlap[i1, v] if i1 == i + 1 else 0.0
            h2 = overlap[i2, v] if i2 == i + 2 else 0.0
            h3 = overlap[i3, v] if i3 == i + 3 else 0.0
            for c in range(w.shape[1]):
                w[v, c] -= h0 * basis[i, c] + h1 * basis[i1, c] + h2 * basis[i2, c] + h3 * basis[i3, c]


@inner
def _axes(gram: Array) -> tuple[Array, Array]:
    """Eigenvalues, ascending, and eigenvectors, as columns, of a symmetric matrix (1, 1) or (2, 2)."""
    if len(gram) == 1:
        return gram[0].copy(), np.ones((1, 1))
    a, b, c = gram[0, 0], gram[0, 1], gram[1, 1]
    angle = 0.5 * np.arctan2(2.0 * b, a - c)
    cos, sin = np.cos(angle), np.sin(angle)
    turn, value = np.empty((2, 2)), np.empty(2)
    turn[0, 0], turn[1, 0], turn[0, 1], turn[1, 1] = -sin, cos, cos, sin
    value[0], value[1] = a * sin**2 - 2.0 * b * sin * cos + c * cos**2, a * cos**2 + 2.0 * b * sin * cos + c * sin**2
    return value, turn
