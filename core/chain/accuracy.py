"""How far frequencies are from those of ever finer meshes, from a few meshes, and from rounding.

With all modes of every mesh proved to be there (``completeness``), the k-th lowest of one mesh belongs to the k-th lowest of
another, whatever their shapes: eigenvalues in order are continuous functions of the matrices. (Roache, *Verification and
Validation in Computational Science and Engineering*, 1998, for Richardson's extrapolation and the safety factors.)
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..effects import Effects
from ..element.discretize import Chain
from ..space import spatial as sp
from .lanczos import frequencies_of
from .pencil import linearize
from .steady import Steady

Array = NDArray[np.float64]

FLOOR = 1e-13
"""No frequency is claimed to be more accurate, relative."""

_NEAR_THEORY = 0.1  # relative distance from the theoretical order that counts as the asymptotic range
_FIRM, _WARY = 1.25, 3.0  # safety factors there, and elsewhere
_CHANCE = 0.1  # of a lower mode's uncertainty, the least: changes may cancel by chance
_SLOWEST = 0.5  # order of convergence taken for granted, of a sequence that converges at all


@dataclass(frozen=True)
class Estimate:
    """From three meshes, each (m,): the extrapolated frequencies, and relative uncertainties of these and of the finest's."""

    values: Array
    of_values: Array
    of_finest: Array


def estimate(f: Array, order: int) -> Estimate:
    """From frequencies (3, m) of meshes each twice as fine as the one before, of a theoretical ``order``.

    Where the observed order is the theoretical one, the error of the finest is Richardson's, and that of the extrapolated
    value is bounded by its change from the extrapolation of the first two. Elsewhere the finest is not extrapolated, and the
    slower of both orders counts; a sequence that does not converge has three times its spread.
    """
    before, last = f[1] - f[0], f[2] - f[1]
    quiet = np.abs(before) <= 1e3 * FLOOR * f[2]  # rounding, of which there is no order
    with np.errstate(divide="ignore", invalid="ignore"):
        observed = np.log2(before / last)
    converging = np.isfinite(observed) & (observed > _SLOWEST) & ~quiet
    firm = converging & (np.abs(observed - order) <= _NEAR_THEORY * order)
    slow = np.clip(np.where(converging, observed, _SLOWEST), _SLOWEST, order)
    gain = 2.0**order - 1.0
    first, second = f[1] + before / gain, f[2] + last / gain
    spread = _WARY * np.maximum(np.abs(before), np.abs(last))
    wary = np.where(converging, _WARY * np.abs(last) / (2.0**slow - 1.0), spread)
    values = np.where(firm, second, f[2])
    of_values = np.where(firm, np.abs(second - first), wary) / f[2]
    of_finest = np.where(firm, _FIRM * np.abs(last) / gain + np.abs(second - first), wary) / f[2]
    return Estimate(values, *(np.maximum(u, _CHANCE * np.maximum.accumulate(u)) for u in (of_values, of_finest)))


def rounding(
    body: Chain, state: Steady, omega: float, gravity: Array, effects: Effects, vectors: NDArray[np.complex128]
) -> Array:
    """(m,) relative error by rounding: three times the change that a rounding of the relative poses makes.

    What rigid or nearly rigid strains do to the tension is in it. The vectors stay; their own error counts squared.
    """
    shape = state.shape
    length = np.linalg.norm(shape.relative[:, :3, 3], axis=1)
    size = np.repeat(np.stack([length, np.ones_like(length)], 1), 3, axis=1)
    sign = np.random.default_rng(1921).choice([-1.0, 1.0], size.shape)
    relative = shape.relative @ sp.exp(float(np.finfo(float).eps) * size * sign)
    rounded = replace(shape, relative=relative)
    near = linearize(body, rounded, omega, gravity, effects)
    a, b = frequencies_of(state.pencil, vectors), frequencies_of(near, vectors)
    change = np.abs(b / a - 1.0)
    return FLOOR + 3.0 * np.maximum(change, np.median(change))
