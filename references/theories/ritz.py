"""The Rayleigh–Ritz method: matrices from shape functions, and modes from matrices.

W. Ritz, "Über eine neue Methode zur Lösung gewisser Variationsprobleme der mathematischen Physik", J. reine angew.
Math. 135 (1909) 1–61. A field (a displacement along one axis, or the rotation about x) is a sum of functions; two
coupled fields have matrices of four blocks.
"""

from collections.abc import Iterable, Sequence

import numpy as np
import scipy.linalg
import scipy.sparse as sp
from numpy.typing import NDArray

from ...core.modes import STATIONS, Modes
from ..matrices.quadratic import gyroscopic_modes
from ..protocol.interface import CodeError

Array = NDArray[np.float64]

X, Y, Z, ROTATION_X = range(4)
"""Columns of ``Modes.shapes``."""

DENSE = 150
"""Coupled problems larger than this use sparse matrices: a function overlaps only those of its interval and the next."""

Part = tuple[Array, NDArray[np.complex128], Array]
"""Frequencies (m,), shapes (m, 21, 4), and relative uncertainties (m,) or none (0,), of an uncoupled set of modes."""


def integral(weight: Array, test: Array, trial: Array | None = None) -> Array:
    """``∫ weight test trial``, (n, k), from values (q, n) and (q, k) at quadrature points; ``trial`` is ``test`` if omitted."""
    return test.T @ (weight[:, None] * (test if trial is None else trial))


def apart(first: Array, second: Array) -> Array:
    """Block-diagonal matrix of two fields, (n + k, n + k)."""
    return np.block([[first, np.zeros((len(first), len(second)))], [np.zeros((len(second), len(first))), second]])


def skew(lower: Array) -> Array:
    """Gyroscopic matrix of two fields, (n + k, n + k), from its lower left block (k, n)."""
    k, n = lower.shape
    return np.block([[np.zeros((n, n)), -lower.T], [lower, np.zeros((k, k))]])


def shape_of(fields: Sequence[tuple[int, Array]]) -> Array:
    """Shapes (21, 4, n) of all coordinates from each field's column of ``Modes.shapes`` and functions (21, k)."""
    out = np.zeros((len(STATIONS), 4, sum(functions.shape[1] for _, functions in fields)))
    first = 0
    for column, functions in fields:
        last = first + functions.shape[1]
        out[:, column, first:last] = functions
        first = last
    return out


def stationary_modes(M: Array, K: Array, count: int) -> tuple[Array, Array]:
    """The ``count`` lowest modes of ``M q̈ + K q = 0``: frequencies (m,), ascending, and shapes (n, m).

    The problem is solved in inverse form, which is most accurate for the lowest.

    Raises:
        CodeError: if K is not positive definite.
    """
    try:
        inverse, q = scipy.linalg.eigh(M, K, subset_by_index=[max(len(M) - count, 0), len(M) - 1])
    except np.linalg.LinAlgError as error:
        raise CodeError(
            f"stiffness: not positive definite ({error}): no stable steady state; lower the rotor speed"
        ) from error
    return 1 / np.sqrt(inverse[::-1]), q[:, ::-1]


def coupled_modes(M: Array, C: Array, K: Array, count: int) -> tuple[Array, NDArray[np.complex128]]:
    """As ``quadratic.gyroscopic_modes``, with dense or sparse matrices depending on the size."""
    if len(K) > DENSE:
        return gyroscopic_modes(sp.csc_array(M), sp.csc_array(C), sp.csc_array(K), count)
    return gyroscopic_modes(M, C, K, count)


def part(shape: Array, frequencies: Array, q: Array | NDArray[np.complex128], uncertainty: Array | None = None) -> Part:
    """Modes from vectors ``q`` (n, m) of coordinates whose shapes are ``shape`` (21, 4, n)."""
    return (
        frequencies,
        np.moveaxis(shape @ q, 2, 0).astype(complex),
        np.zeros(0) if uncertainty is None else uncertainty,
    )


def union(parts: Iterable[Part], omega: float, terms: int, count: int) -> Modes:
    """The ``count`` lowest modes of all parts together."""
    frequencies, shapes, uncertainty = (np.concatenate(column) for column in zip(*parts, strict=True))
    order = np.argsort(frequencies, kind="stable")[:count]
    return Modes(
        omega=omega,
        frequencies=frequencies[order],
        shapes=shapes[order],
        elements=terms,
        uncertainty=uncertainty[order] if len(uncertainty) else uncertainty,
    )
