"""Errors of frequencies due to discretisation, estimated from three meshes, and due to rounding.

Since no mode of any mesh is missing (``completeness``), the k-th lowest of one mesh corresponds to the k-th lowest of
another, whatever their shapes: ordered eigenvalues are continuous functions of the matrices. (Roache, *Verification and
Validation in Computational Science and Engineering*, 1998, for Richardson's extrapolation and the safety factors.)
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..effects import Effects
from ..element.mesh import Mesh
from ..space import spatial as sp
from ..steady.blade_state import Steady
from ..tree.pencil import linearize
from .lanczos import frequencies_of

Array = NDArray[np.float64]

FLOOR = 1e-13
"""Smallest relative error that is claimed for a frequency."""

_NEAR_THEORY = 0.1  # relative distance from the theoretical order that counts as the asymptotic range
_FIRM, _WARY = 1.25, 3.0  # safety factors within that range, and outside it
_CHANCE = 0.2  # smallest fraction of a lower mode's uncertainty: changes may cancel by chance
_SLOWEST = 0.5  # smallest order of convergence that is assumed for a converging sequence


@dataclass(frozen=True)
class Estimate:
    """Frequencies (m,) extrapolated from three meshes, and relative uncertainties (m,) of these and of the finest mesh's."""

    values: Array
    of_values: Array
    of_finest: Array


def estimate(f: Array, order: int) -> Estimate:
    """Extrapolate frequencies (3, m) of meshes each twice as fine as the previous one, with a theoretical ``order``.

    With f₁, f₂, f₃ from coarse to fine, Richardson's estimate of the error of f₃ is r = |f₃ − f₂|/(2ᵖ − 1), p the theoretical
    order, and c is the change between the extrapolations from (f₁, f₂) and (f₂, f₃). Where the observed order agrees with p,
    the uncertainty of the extrapolated value is max(c, r), since three meshes may have the theoretical order by chance, and
    that of f₃ is 1.25 r + c. Otherwise f₃ is not extrapolated, and its uncertainty is 3 d/(2^q − 1) with the lower of the two
    orders, q, and d the larger of |f₃ − f₂| and |f₂ − f₁|/2ᵖ: a difference smaller than the theory predicts is one where terms
    of different order cancel by chance, which the next ones need not do. For a sequence that does not converge, it is three
    times the larger difference. No uncertainty is smaller than a fifth of that of a lower mode, for the same reason.

    These uncertainties cover 99.9 % of the errors; see docs/uncertainty.md.
    """
    first_step, second_step = f[1] - f[0], f[2] - f[1]
    quiet = np.abs(first_step) <= 1e3 * FLOOR * f[2]  # rounding, which has no order
    with np.errstate(divide="ignore", invalid="ignore"):
        observed = np.log2(first_step / second_step)
    converging = np.isfinite(observed) & (observed > _SLOWEST) & ~quiet
    firm = converging & (np.abs(observed - order) <= _NEAR_THEORY * order)
    slow = np.clip(np.where(converging, observed, _SLOWEST), _SLOWEST, order)
    gain = 2.0**order - 1.0
    first, second = f[1] + first_step / gain, f[2] + second_step / gain
    change = _WARY * np.maximum(np.abs(first_step), np.abs(second_step))
    expected = np.maximum(np.abs(second_step), np.abs(first_step) / 2.0**order)
    wary = np.where(converging, _WARY * expected / (2.0**slow - 1.0), change)
    values = np.where(firm, second, f[2])
    of_values = np.where(firm, np.maximum(np.abs(second - first), np.abs(second_step) / gain), wary) / f[2]
    of_finest = np.where(firm, _FIRM * np.abs(second_step) / gain + np.abs(second - first), wary) / f[2]
    return Estimate(values, *(np.maximum(u, _CHANCE * np.maximum.accumulate(u)) for u in (of_values, of_finest)))


def rounding(
    body: Mesh, state: Steady, omega: float, gravity: Array, effects: Effects, vectors: NDArray[np.complex128]
) -> Array:
    """(m,) error of frequencies due to rounding, rad/s: three times the change caused by rounding the relative poses.

    It includes the effect of rigid or nearly rigid strains on the tension. The vectors are unchanged: their error enters
    squared.
    """
    shape = state.shape
    length = np.linalg.norm(shape.relative[:, :3, 3], axis=1)
    size = np.repeat(np.stack([length, np.ones_like(length)], 1), 3, axis=1)
    sign = np.random.default_rng(1921).choice([-1.0, 1.0], size.shape)
    relative = shape.relative @ sp.exp(float(np.finfo(float).eps) * size * sign)
    rounded = replace(shape, relative=relative)
    perturbed = linearize(body, rounded, omega, gravity, effects)
    a, b = (frequencies_of(p, vectors) for p in (state.pencil, perturbed))
    change = np.abs(b - a)
    return 3.0 * np.maximum(change, a * np.median(change / a))
