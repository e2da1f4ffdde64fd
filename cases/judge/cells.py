"""The parts of a cell that do not depend on how a code was refined: its column, its mode, and a missing answer."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from ...references.protocol.interface import MOTIONS
from ...references.protocol.process import Failure
from .pairing import Pair
from .reference import Reference
from .results import Cell, Level, Verdict
from .spectrum import Spectrum
from .verdict import AGREES, Judgement

FAILED: dict[str, Verdict] = {
    "not installed": "not run",
    "unsupported": "not applicable",
    "timed out": "inconclusive",
    "refused": "fail",
    "nonsense": "fail",
    "crashed": "fail",
    "unknown": "fail",
    "internal": "fail",
    "no reference": "fail",
}
"""Verdict of a cell by the kind of failure: a code that takes part and gives no answer has failed."""

Rows = tuple[list[Cell], list[Level]]


@dataclass(frozen=True)
class Head:
    """Fields common to all cells of one column; see ``results.Cell``."""

    case: str
    code: str
    version: str
    role: str
    target: float
    shares: str = ""
    motions: tuple[str, ...] = MOTIONS
    """Motions that the code declares its shapes contain."""


def empty(head: Head, omega: float, verdict: Verdict, reason: str) -> Cell:
    """The cell of a code without an answer at one speed."""
    return Cell(
        case=head.case,
        omega=omega,
        mode=0,
        family="",
        code=head.code,
        version=head.version,
        role=head.role,
        value=None,
        reference=None,
        difference=None,
        uncertainty=None,
        target=head.target,
        verdict=verdict,
        reason=reason,
        shares=head.shares,
    )


def failed(head: Head, omega: float, failure: Failure | None) -> Cell:
    """The cell of a code that failed."""
    failure = failure or Failure("nonsense", "no answer and no reason")
    return empty(head, omega, FAILED[failure.kind], failure.reason)


def failing(head: Head, failure: Failure, speeds: Iterable[float]) -> Rows:
    """A cell at every speed for a code, or a column of this package, without any answer."""
    return [failed(head, omega, failure) for omega in speeds], []


def without_reference(head: Head, omega: float, failure: Failure) -> Cell:
    """The cell of a column at a speed without a reference: it fails if core has no answer with all effects either."""
    if failure.kind == "no reference":
        return failed(head, omega, failure)
    return empty(head, omega, "inconclusive", f"Southwell's own solver with the same effects: {failure.reason}")


def row(
    head: Head,
    omega: float,
    i: int,
    reference: Reference,
    finest: Spectrum | None,
    partner: Pair,
    quantity: str = "frequency",
) -> Cell:
    """A cell without numbers, valid as the cell of a mode without a partner."""
    return replace(
        empty(head, omega, "fail", partner.note),
        **mode_fields(reference, i, quantity),
        elements=(finest.elements or None) if finest else None,
        mac=partner.mac if finest else None,
    )


def joined(parts: Iterable[Rows]) -> Rows:
    """The rows of several points together."""
    cells, levels = zip(*parts, strict=True)
    return [cell for part in cells for cell in part], [level for part in levels for level in part]


def mode_fields(reference: Reference, i: int, quantity: str = "frequency") -> dict[str, Any]:
    """Fields of a cell that follow from core's ``i``-th compared mode and the quantity."""
    family, _, ordinal = reference.core.names[i].rpartition(" ")
    full = reference.full[i] if quantity == "frequency" else None
    return {"mode": i + 1, "family": family, "ordinal": int(ordinal), "full": full, "quantity": quantity}


def unless_ambiguous(judgement: Judgement, partner: Pair) -> Judgement:
    """No agreement if the code has another mode of nearly the same shape at a different frequency."""
    return ("inconclusive", "") if partner.ambiguous and judgement[0] in (*AGREES, "known difference") else judgement


def join(*parts: str) -> str:
    """Reasons in one line; empty ones are left out."""
    return "; ".join(part for part in parts if part)
