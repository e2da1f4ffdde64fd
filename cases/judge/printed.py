"""Rows of numbers computed with a discretisation that is not refined: printed numbers, and core as in their source."""

from dataclasses import dataclass, replace

from .cells import Head, Rows, failed, join, row
from .convergence import RefinedMode, Refinements
from .pairing import Pair
from .reference import Reference
from .refined import judged, known_effects, refined
from .results import Cell
from .uncertainty import Estimate
from .verdict import AGREES, discretised


def printed(head: Head, omega: float, i: int, reference: Reference, value: Estimate, note: str) -> Cell:
    """The cell of a printed number for the ``i``-th mode that the case compares."""
    refined_modes = RefinedMode(value, Pair(i, 1.0, note), ())
    return judged(row(head, omega, i, reference, None, refined_modes.partner), reference, i, refined_modes, "")


@dataclass(frozen=True)
class Coarse:
    """Core's answer for one mode with an author's discretisation, and the limit of its refinements; both rad/s."""

    frequency: float
    limit: float


def explained_by_discretisation(cell: Cell, coarse: Coarse | None, name: str) -> Cell:
    """The cell of a printed number whose author's discretisation, named ``name``, is known.

    If the number is not within the target of the converged answer, its difference is known if core with that
    discretisation agrees with it and the refinements of that discretisation lead to the converged answer.
    """
    if cell.verdict in AGREES or not coarse or not cell.value or not cell.reference or cell.difference is None:
        return cell
    remainder, limit, size = (
        value - 1.0
        for value in (
            cell.value / coarse.frequency,
            coarse.limit / cell.reference,
            coarse.frequency / cell.reference,
        )
    )
    verdict, reason = discretised(cell.difference, cell.uncertainty, cell.target, remainder, limit, name, size)
    if verdict == cell.verdict and verdict != "fail":
        return cell
    return replace(cell, verdict=verdict, reason=reason)


def source_discretisation_cells(
    head: Head, omega: float, reference: Reference, refinements: Refinements, order: int, name: str
) -> Rows:
    """Cells of core with a given discretisation: its coarsest answer, explained by its refinements.

    Args:
        name: of the discretisation, for the reason.
        refinements: core's answers: the given discretisation first, then finer ones of the same kind.
    """
    if not refinements.answers:
        return [failed(head, omega, refinements.failure)], []
    first = replace(refinements, answers=refinements.answers[:1])
    coarse, levels = refined(head, omega, reference, first, order)
    fine, _ = refined(head, omega, reference, refinements, order)
    cells = []
    for i, (cell, limit) in enumerate(zip(coarse, fine, strict=True)):
        base, difference = reference.core.modes[i].estimate, cell.difference
        if difference is not None and base is not None:
            cell = replace(cell, uncertainty=base.uncertainty)
            verdict, reason = discretised(difference, base.uncertainty, head.target, 0.0, limit.difference, name)
            if verdict != "fail":
                known_verdict, why = known_effects(reference, i, head.target)
                verdict, reason = verdict if known_verdict in AGREES else known_verdict, join(reason, why)
            cell = replace(cell, verdict=verdict, reason=reason)
        cells.append(cell)
    return cells, levels
