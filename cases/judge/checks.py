"""Validation of result rows read from files, before a gate, a report or a dashboard uses them."""

import math
from collections.abc import Iterator
from typing import Any

from .quantities import QUANTITIES

MAX_TEXT = 300
"""Maximum number of characters of a name, a version or a title."""

MOST_MODES = 10_000

UNANSWERED = ("not run", "not applicable", "inconclusive", "fail")
"""Verdicts allowed for a cell without an answer."""

CAUSES = ("discretisation", "model form", "rounding")

LINES = frozenset(
    {"case", "code", "family", "version", "role", "shares", "control", "area", "mode", "cause", "part"}
    | {"other", "distribution", "first", "before", "older", "quantity", "where"}
)
"""Fields limited to one line."""


class RowError(ValueError):
    """An invalid row; the message names the field."""


def check(row: Any) -> None:
    """Validate a row of results (a dataclass or a Struct).

    Raises:
        RowError: if a field is invalid; the message names the field.
    """
    for name in type(row).__annotations__:
        value = getattr(row, name)
        if isinstance(value, float) and not math.isfinite(value):
            raise RowError(f"{name}: {value}: not a finite number")
        if name in LINES and isinstance(value, str) and not _line(value):
            raise RowError(f"{name}: {value[:40]!r}: not one line of at most {MAX_TEXT} printable characters")
    for fault in _faults(row):
        raise RowError(fault)


def _line(text: str) -> bool:
    return len(text) <= MAX_TEXT and text.isprintable()


def _faults(row: Any) -> Iterator[str]:
    mode, omega = getattr(row, "mode", None), getattr(row, "omega", 0.0)
    if not 0 <= omega <= 1e9:
        yield f"omega: {omega:g}: no rotor speed"
    if isinstance(mode, int) and not 0 <= mode <= MOST_MODES:
        yield f"mode: {mode}: counted from 1"
    if hasattr(row, "verdict") and hasattr(row, "mode"):
        yield from _cell(row)
    if getattr(row, "cause", CAUSES[0]) not in CAUSES:
        yield f"cause: {row.cause!r}: known are {', '.join(CAUSES)}"


def _cell(row: Any) -> Iterator[str]:
    if not row.case or not row.code:
        yield "case, code: one is empty"
    if row.mode == 0 and (row.value is not None or row.verdict not in UNANSWERED):
        yield f"mode: 0 of a cell with an answer ({row.verdict}): counted from 1"
    if row.verdict in ("pass", "coarse", "known difference", "measured") and row.difference is None:
        yield f"difference: none, with the verdict {row.verdict}"
    measured = getattr(row, "role", row.verdict) == "measured"
    if measured != (row.verdict == "measured") and not (measured and row.verdict in UNANSWERED):
        yield f"verdict: {row.verdict}, with the role {getattr(row, 'role', '')}: this verdict and this role belong together"
    ordinal = getattr(row, "ordinal", row.mode)
    if bool(ordinal) != bool(row.mode) or not 0 <= ordinal <= MOST_MODES:
        yield f"ordinal: {ordinal}, of mode {row.mode}: counted from 1, and 0 without a mode"
    if row.quantity not in QUANTITIES:
        yield f"quantity: {row.quantity[:40]!r}: known are {', '.join(QUANTITIES)}"
    if row.quantity == "frequency" and row.value is not None and row.value < 0:
        yield f"value: {row.value:g}: a negative frequency"
    if row.uncertainty is not None and row.uncertainty < 0:
        yield f"uncertainty: {row.uncertainty:g}: negative"
    if row.target is not None and not 0 < row.target <= 1:
        yield f"target: {row.target:g}: relative, above 0 and at most 1"
