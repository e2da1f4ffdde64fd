"""The columns of a mechanism: codes that accept mechanisms, and its closed form, against core at every speed."""

from collections.abc import Callable, Sequence
from functools import partial
from importlib.metadata import version
from typing import Any

from ...core.effects import ALL_EFFECTS
from ...references.protocol.description import Description
from ...references.protocol.interface import Independence
from ...references.protocol.process import Limits
from ..input.mechanism_schema import Compare
from ..input.mechanisms import Described
from ..judge.cells import Head, Rows
from ..solve.mechanism import asked, compared, formula
from .column import Column, absent_work, failing_work, not_installed

_BY_HAND = Independence(
    engine="closed form",
    theory="second-order Lagrangian by hand",
    rotation="second-order Lagrangian by hand",
    sections="the case's closed_form.parameters",
    eigensolver="the adapters' own, with damping",
)


def columns(described: Described, compare: Compare, codes: Sequence[Description], limits: Limits) -> list[Column]:
    """A column for each code and for the closed form; ``limits`` apply to each solution by a foreign code.

    Codes that accept only blades have no column, unless there are no other codes.
    """
    name, target = described.text.name, compare.target
    out = []
    for code in [code for code in codes if code.mechanisms] or codes:
        head = Head(name, code.name, code.version or "", "same discretisation", target, code.shares)
        work = _work(head, described, code, limits)
        solves = code.mechanisms and not code.failure and code.version is not None
        out.append(Column(code.name, ALL_EFFECTS, head, work, code.independence, solves=solves))
    if form := described.text.closed_form:
        head = Head(name, "closed form", f"southwell {version('southwell')}", "same discretisation", target, "nothing")
        work = partial(compared, head, described, partial(formula, form))
        out.append(Column(head.code, ALL_EFFECTS, head, work, _BY_HAND))
    return out


def _work(head: Head, described: Described, code: Description, limits: Limits) -> Callable[[Any], Rows]:
    if code.failure:
        return failing_work(head, code.failure)
    if not code.mechanisms:
        return absent_work(head, "not applicable", "the code takes blades, not mechanisms")
    if code.version is None:
        return failing_work(head, not_installed(code))
    return partial(compared, head, described, partial(asked, code.asked, code.version, limits))
