"""Modes of a turbine at several speeds as lines: which mode continues which, by their shapes."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from .turbine_modes import TurbineModes

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

LIKE_FIRST = 2.0
"""Weight of the likeness to the mode at the first speed against that to the mode at the last one."""


def tracked(at: Sequence[TurbineModes]) -> list[NDArray[np.intp]]:
    """For each speed the (m,) indices of its modes, in the order of the modes at the first speed.

    A line continues with the mode that is most like the last one and like that at the first speed. Where two modes come close
    and exchange their motions, the lines cross, and each keeps its motion and its name, however small the steps are.
    """
    order = [np.arange(len(at[0].frequencies))]
    for previous, following in pairwise(at):
        last = _assurance(previous.shapes[order[-1]], following.shapes)
        order.append(_paired(last + LIKE_FIRST * _assurance(at[0].shapes, following.shapes)))
    return order


def linked(previous: TurbineModes, following: TurbineModes) -> NDArray[np.intp]:
    """(m,) the mode of ``following`` that continues each mode of ``previous``: the pairs with the largest sum of MACs."""
    return _paired(_assurance(previous.shapes, following.shapes))


def _assurance(x: Complex, y: Complex) -> Array:
    """(m, m) modal assurance criterion of shapes (m, k)."""
    return np.abs(x.conj() @ y.T) ** 2 / np.outer((np.abs(x) ** 2).sum(1), (np.abs(y) ** 2).sum(1))


def _paired(closeness: Array) -> NDArray[np.intp]:
    """(m,) the column of each row, with the largest sum."""
    rows, columns = linear_sum_assignment(-closeness)
    out = np.empty(len(closeness), dtype=np.intp)
    out[rows] = columns
    return out
