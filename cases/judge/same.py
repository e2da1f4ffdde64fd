"""Rows of a code that solves the same discrete equations as core: only rounding separates the two answers."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...references.protocol.process import Failure
from .cells import Head, Rows, empty, failed, join, row, unless_ambiguous
from .pairing import pair
from .quantities import difference
from .reference import Reference
from .spectrum import Answer, Spectrum, fault
from .uncertainty import ROUNDING, WARY
from .verdict import judge

Array = NDArray[np.float64]


def rounding(mine: Answer, again: Sequence[Answer]) -> Array:
    """Relative uncertainty (m,) of core's frequencies ``mine`` due to rounding.

    It is estimated from core's answers ``again`` to the same equations scaled by common factors, which differ only by
    rounding. The largest change of any mode is used for all modes, as rounding in the steady state affects them
    together. The uncertainty that core reports is used if it is larger.
    """
    found = [other for other in (mine, *again) if not isinstance(other, Failure)]
    if isinstance(mine, Failure) or len(found) <= len(again) or len({len(m.frequencies) for m in found}) > 1:
        return np.zeros(0)
    change = max(float(np.abs(other.frequencies / mine.frequencies - 1.0).max()) for other in found)
    rounding_of_core = np.full(len(mine.frequencies), max(ROUNDING, WARY * change))
    return np.maximum(rounding_of_core, mine.rounding) if len(mine.rounding) else rounding_of_core


def same(
    head: Head, omega: float, reference: Reference, theirs: Answer, mine: Answer, rounding_of_core: Array | None = None
) -> Rows:
    """Cells of a code that shares core's discretisation, against core's modes ``mine`` with as many elements.

    A mechanism has no other discretisation, and ``mine`` is the reference itself.

    ``rounding_of_core``: (m,) relative uncertainty of core's frequencies due to rounding. The other code's equations
    are equally sensitive, so it is assumed to have the same uncertainty, or the one that it reports.
    """
    if isinstance(theirs, Failure):
        return [failed(head, omega, theirs)], []
    if isinstance(mine, Failure):
        return [empty(head, omega, "inconclusive", f"core with the same discretisation: {mine.reason}")], []
    core = reference.core
    if reason := fault(core.spectrum, theirs):
        return [failed(head, omega, Failure("nonsense", reason))], []
    weighted = replace(mine, weight=core.spectrum.weight)
    cells = []
    for i, base in enumerate(pair(core.spectrum, mine, core.indices)):
        (partner,) = pair(weighted, theirs, [base.mode]) if base.mode is not None else (base,)
        sure = _uncertainty(base.mode, partner.mode, theirs, rounding_of_core)
        for quantity in reference.quantities:
            cell = row(head, omega, i, reference, theirs, partner, quantity)
            if base.mode is not None and partner.mode is not None:
                value, expected = (float(s.of(quantity)[k]) for s, k in ((theirs, partner.mode), (mine, base.mode)))
                away = difference(quantity, value, expected)
                verdict, reason = unless_ambiguous(judge(away, sure, head.target), partner)
                cell = replace(cell, value=value, reference=expected, difference=away, uncertainty=sure)
                cell = replace(cell, verdict=verdict, reason=join(reason, partner.note))
            cells.append(cell)
    return cells, []


def _uncertainty(base: int | None, partner: int | None, theirs: Spectrum, rounding_of_core: Array | None) -> float:
    """Uncertainty of a difference due to rounding, of core and of the other code."""
    if base is None or partner is None:
        return 0.0
    noise = float(rounding_of_core[base]) if rounding_of_core is not None and len(rounding_of_core) else ROUNDING
    own = float(theirs.rounding[partner]) if len(theirs.rounding) else noise
    return noise + max(own, noise)
