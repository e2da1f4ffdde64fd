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


def rounding(core_answer: Answer, scaled_answers: Sequence[Answer]) -> Array:
    """Relative uncertainty (m,) of the frequencies of ``core_answer`` due to rounding.

    It is estimated from core's answers ``scaled_answers`` to the same equations scaled by common factors, which differ only by
    rounding. The largest change of any mode is used for all modes, as rounding in the steady state affects them
    together. The uncertainty that core reports is used if it is larger.
    """
    answers = [answer for answer in (core_answer, *scaled_answers) if not isinstance(answer, Failure)]
    if (
        isinstance(core_answer, Failure)
        or len(answers) <= len(scaled_answers)
        or len({len(m.frequencies) for m in answers}) > 1
    ):
        return np.zeros(0)
    change = max(float(np.abs(answer.frequencies / core_answer.frequencies - 1.0).max()) for answer in answers)
    rounding_of_core = np.full(len(core_answer.frequencies), max(ROUNDING, WARY * change))
    return np.maximum(rounding_of_core, core_answer.rounding) if len(core_answer.rounding) else rounding_of_core


def same_discretisation_cells(
    head: Head,
    omega: float,
    reference: Reference,
    answer: Answer,
    core_answer: Answer,
    rounding_of_core: Array | None = None,
) -> Rows:
    """Cells of a code that shares core's discretisation, against core's modes ``core_answer`` with as many elements.

    A mechanism has no other discretisation, and ``core_answer`` is the reference itself.

    ``rounding_of_core``: (m,) relative uncertainty of core's frequencies due to rounding. The other code's equations
    are equally sensitive, so it is assumed to have the same uncertainty, or the one that it reports.
    """
    if isinstance(answer, Failure):
        return [failed(head, omega, answer)], []
    if isinstance(core_answer, Failure):
        return [
            empty(
                head,
                omega,
                "inconclusive",
                f"Southwell's own solver with the same discretisation: {core_answer.reason}",
            )
        ], []
    core = reference.core
    if reason := fault(core.spectrum, answer):
        return [failed(head, omega, Failure("nonsense", reason))], []
    weighted = replace(core_answer, weight=core.spectrum.weight)
    cells = []
    for i, base in enumerate(pair(core.spectrum, core_answer, core.indices)):
        (partner,) = pair(weighted, answer, [base.mode]) if base.mode is not None else (base,)
        uncertainty = _uncertainty(base.mode, partner.mode, answer, rounding_of_core)
        for quantity in reference.quantities:
            cell = row(head, omega, i, reference, answer, partner, quantity)
            if base.mode is not None and partner.mode is not None:
                value, expected = (
                    float(s.of(quantity)[k]) for s, k in ((answer, partner.mode), (core_answer, base.mode))
                )
                deviation = difference(quantity, value, expected)
                verdict, reason = unless_ambiguous(judge(deviation, uncertainty, head.target), partner)
                cell = replace(cell, value=value, reference=expected, difference=deviation, uncertainty=uncertainty)
                cell = replace(cell, verdict=verdict, reason=join(reason, partner.note))
            cells.append(cell)
    return cells, []


def _uncertainty(base: int | None, partner: int | None, answer: Spectrum, rounding_of_core: Array | None) -> float:
    """Uncertainty of a difference due to rounding, of core and of the other code."""
    if base is None or partner is None:
        return 0.0
    noise = float(rounding_of_core[base]) if rounding_of_core is not None and len(rounding_of_core) else ROUNDING
    own = float(answer.rounding[partner]) if len(answer.rounding) else noise
    return noise + max(own, noise)
