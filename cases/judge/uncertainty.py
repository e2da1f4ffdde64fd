"""Discretisation uncertainty of a computed frequency.

Three refinements give the observed order of convergence, and from it the Richardson extrapolation and Roache's grid
convergence index (GCI). The extrapolated value is reported, so the index is that of the extrapolated value: three
refinements give two extrapolated values, and the index of the second follows from their change, assumed to shrink with at
least first order; it is at least ``CHANCE`` times the correction. If the observed order is not the theoretical one,
extrapolation is unreliable: the index is then that of the finest refinement, with the larger safety factor. Sources:
Roache, *Verification and Validation in Computational Science and Engineering* (1998); Celik et al., J. Fluids Eng. 130
(2008) 078001, for the order at unequal refinement ratios; Oberkampf and Roy, *Verification and Validation in Scientific
Computing* (2010), §8.6, for the choice of the safety factor; Eça and Hoekstra, J. Comput. Phys. 262 (2014) 104, for three
times the spread where the order of convergence is meaningless.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import root_scalar

ROUNDING = 1e-12
"""Smallest relative uncertainty claimed for a result in double precision."""

NOISE = 1e-8
"""If three refinements agree to this (relative), the rest is rounding and its order of convergence is meaningless."""

QUIET = 1e-5
"""Up to this relative spread, the uncertainty of a sequence without monotone convergence is based on the spread."""

NEAR_THEORY = 0.1
"""Relative distance from the theoretical order within which a sequence counts as asymptotic (Oberkampf and Roy)."""

FIRM, WARY = 1.25, 3.0
"""Roache's safety factors: for a sequence seen to converge at the theoretical order, and for any other."""

CHANCE = 0.03
"""Smallest uncertainty of an extrapolated value, as a fraction of the extrapolation's correction: terms of higher order may
cancel in two extrapolated values, whose change is then no measure of their error."""


@dataclass(frozen=True)
class Estimate:
    """The best estimate of a frequency and its uncertainty.

    Attributes:
        value: rad/s; extrapolated if the refinements allow it, otherwise the finest.
        uncertainty: relative; None if it cannot be estimated.
        order: observed order of convergence, if available.
        note: why the uncertainty is missing or large.
    """

    value: float
    uncertainty: float | None
    order: float | None = None
    note: str = ""


def from_refinement(elements: Sequence[int], frequencies: Sequence[float], order: int) -> Estimate:
    """Estimate a frequency from its values at increasing numbers of elements (or terms); the three finest are used.

    Args:
        elements: numbers of elements, ascending.
        frequencies: rad/s, one per number of elements.
        order: theoretical order of convergence; 0 for spectral convergence: the last change is the uncertainty.
    """
    n, f = np.asarray(elements, float)[-3:], np.asarray(frequencies, float)[-3:]
    if not f.any():
        return Estimate(0.0, ROUNDING, note="the frequency is zero at every refinement")
    if order == 0 and len(f) >= 2:
        return Estimate(float(f[-1]), _at_least(abs(f[-1] - f[-2]) / abs(f[-1])))
    if len(f) < 3:
        return Estimate(
            float(f[-1]), None, note=f"{len(f)} of 3 refinements were solved: the order of convergence is unknown"
        )
    range_ = float((f.max() - f.min()) / abs(f[-1]))
    scattered = Estimate(float(f[-1]), _at_least(WARY * range_))
    if range_ <= NOISE:
        return scattered
    scattered = replace(scattered, note=f"refinements scatter by {range_:.1g} instead of converging with order {order}")
    listed = f"{f[0]:.9g}, {f[1]:.9g}, {f[2]:.9g} rad/s"
    if (f[1] - f[0]) * (f[2] - f[1]) <= 0:
        return scattered if range_ <= QUIET else Estimate(float(f[-1]), None, note=f"not monotone: {listed}")
    observed = observed_order(n.tolist(), f.tolist())
    if observed <= 0:
        return scattered if range_ <= QUIET else Estimate(float(f[-1]), None, observed, f"not converging: {listed}")
    firm = abs(observed - order) <= NEAR_THEORY * order
    order_used = float(order) if firm else min(max(observed, 0.5), float(order))
    previous, value = (f[k] + (f[k] - f[k - 1]) / ((n[k] / n[k - 1]) ** order_used - 1.0) for k in (1, 2))
    if firm:
        change = abs(value - previous) / (n[2] / n[1] - 1.0)
        error = max(FIRM * change, CHANCE * abs(value - f[2]))
        return Estimate(float(value), _at_least(error / abs(value)), observed)
    note = f"observed order {observed:.2f} instead of {order}: safety factor {WARY:g}"
    return Estimate(float(value), _at_least(WARY * abs(value / f[2] - 1.0)), observed, note)


def observed_order(elements: Sequence[float], values: Sequence[float]) -> float:
    """Order p of a monotone sequence of three values, ``v = v∞ + C n⁻ᵖ``, at any three ascending ``elements``.

    The root of ``(n₁⁻ᵖ − n₂⁻ᵖ) / (n₂⁻ᵖ − n₃⁻ᵖ) = (v₂ − v₁) / (v₃ − v₂)``, which grows with p (equivalent to Celik et
    al., eq. 5). Negative if the changes grow; ±20 are the limits of the search.
    """
    n1, n2, n3 = (float(n) for n in elements)
    ratio = (values[1] - values[0]) / (values[2] - values[1])

    def excess(p: float) -> float:
        if abs(p) < 1e-9:
            return float(np.log(np.log(n2 / n1) / np.log(n3 / n2) / ratio))
        return float(np.log(((n2 / n1) ** p - 1.0) / (1.0 - (n2 / n3) ** p) / ratio))

    low, high = -20.0, 20.0
    if excess(low) >= 0:
        return low
    return high if excess(high) <= 0 else float(root_scalar(excess, bracket=(low, high)).root)


def widened(estimate: Estimate, added: float) -> Estimate:
    """The estimate with ``added``, an uncertainty that the solver reports (such as rounding), added; relative."""
    return estimate if estimate.uncertainty is None else replace(estimate, uncertainty=estimate.uncertainty + added)


def from_bracket(frequency: float, uncertainty: float) -> Estimate:
    """The estimate of a code that gives an error bound for its answer; ``uncertainty`` is relative."""
    return Estimate(frequency, _at_least(uncertainty))


def from_print(text: str, unit: float = 1.0) -> Estimate:
    """The estimate from a printed number in ``unit``: half a unit of its last digit (``189.7`` is 189.7 ± 0.05)."""
    digits = text.strip().lower().partition("e")
    decimals = len(digits[0].partition(".")[2]) - int(digits[2] or 0)
    value = float(text)
    return Estimate(value * unit, _at_least(0.5 * 10.0**-decimals / abs(value)))


def _at_least(uncertainty: float) -> float:
    return max(float(uncertainty), ROUNDING)
