"""Seeded faults on the blade that is verified: faults of core and of pairing.

A fault counts as detected only if a code that shares nothing with core *fails* with it and did not without it. Those of the
paper's discretisation must let the paper's equations fail, which core's references do not contain. A fault that changes no
compared frequency of this blade by more than the target is *without effect here*. Mistakes of readers are in ``own_reading``,
those of extrapolation and uncertainty in ``own_uncertainty``.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...references.protocol.description import Description, describe
from ...references.protocol.process import Limits
from ..judge.results import Cell, Control
from ..judge.verdict import unsigned
from ..plan.blade import BladeSubject
from ..plan.blade_columns import PAPER
from ..plan.column import Column
from ..plan.subject import Subject
from ..plan.user_results import UserResults
from ..run.executors import Serial
from ..solve.works import papers_equations
from ..verify import matrix
from .seeding import seeded
from .table import BY_NAME, FAST

OF_THE_PAPER = ("whole end mass",)
"""Faults of the paper's discretisation, which is not that of core's references."""

NAMES = (*FAST, "twist across ±180°", "paired with the next", "paired by number")
"""Faults of core and of pairing that are run on the blade that is verified."""

ELEMENTS = 8
"""Number of elements of the paper's equations, whose matrices are dense."""

WITNESSES = 2
"""Number of codes that are asked about each fault."""

NO_WITNESS = "an independent code that agrees on this blade"


@dataclass(frozen=True)
class _Witnessed(BladeSubject):
    """A blade with the columns of independent codes only, or with that of the paper's equations."""

    paper: bool = False

    def columns(
        self, codes: Sequence[Description], limits: Limits, user_results: Sequence[UserResults]
    ) -> list[Column]:
        """See ``Subject``."""
        columns = super().columns(codes, limits, user_results)
        if self.paper:
            head = next(column.head for column in columns if column.head.code == PAPER)
            work = partial(papers_equations, head, self.blade, elements=ELEMENTS)
            return [replace(column, work=work) for column in columns if column.head.code == PAPER]
        return [column for column in columns if column.head.role == "code" and column.head.shares == "nothing"]


def witnesses(cells: Iterable[Cell], subject: Subject, codes: Iterable[Description]) -> tuple[str, ...]:
    """What to ask of ``codes`` that share nothing with core and pass at the highest speed in every mode.

    A column that is no code, as that of a program which reads the deck itself, would not see a fault of a blade.
    """
    identifiers = {code.name: code.asked for code in codes if not code.failure}
    fastest = max(subject.points)
    has_passed: dict[str, bool] = {}
    for cell in cells:
        if cell.case == subject.name and cell.omega == fastest and cell.role == "code" and cell.shares == "nothing":
            has_passed[cell.code] = has_passed.get(cell.code, True) and cell.verdict == "pass" and bool(cell.version)
    return tuple(identifiers[code] for code, passes in has_passed.items() if passes and code in identifiers)[:WITNESSES]


def chosen(names: Sequence[str], own: Sequence[str] = NAMES) -> tuple[str, ...]:
    """All of the ``own`` faults of a blade or a turbine if ``names`` has all that every run seeds; else those in both."""
    return tuple(own) if set(FAST) <= set(names) else tuple(name for name in names if name in own)


def run(subject: BladeSubject, codes: Sequence[str], names: Sequence[str], reuse: bool = False) -> list[Control]:
    """Run faults on a blade at its highest speed, against some codes; a task for any process."""
    variant = replace(subject.variant, speeds=np.array([max(subject.points)]))
    descriptions = describe(codes, [variant.blade])
    correct_cells: dict[bool, tuple[Cell, ...]] = {}
    out = []
    for fault in (BY_NAME[name] for name in names):
        paper = fault.name in OF_THE_PAPER
        fastest = _Witnessed(subject.case, variant, paper)
        if not codes and not paper:
            out.append(replace(fault.control(fastest.name, max(fastest.points)), needs=NO_WITNESS))
            continue

        def solve(of: BladeSubject = fastest) -> tuple[Cell, ...]:
            return matrix.run([of], descriptions, Serial(), reuse=reuse, parts=False).cells

        if paper not in correct_cells:
            correct_cells[paper] = solve()
        with seeded(fault.seams):
            faulty_cells = solve()
        out.append(judged(fault.control(fastest.name, max(fastest.points)), correct_cells[paper], faulty_cells))
    return out


def judged(control: Control, correct_cells: Sequence[Cell], faulty_cells: Sequence[Cell]) -> Control:
    """The result of a fault from the cells of independent codes without and with it."""
    by_key = {cell.key: cell for cell in correct_cells}
    failures = [c for c in faulty_cells if c.verdict == "fail" and getattr(by_key.get(c.key), "verdict", "") != "fail"]
    if failures:
        changes = [c.difference for c in failures if c.difference is not None]
        detections = tuple(f"{c.case}, {c.code}, {c.name or 'no answer'}, {c.omega:g} rad/s: fail" for c in failures)
        return replace(control, detected_by=detections, change=max(changes, key=abs, default=None))
    pairs = [(by_key[c.key], c) for c in faulty_cells if c.key in by_key]
    compared = [pair for a, b in pairs for pair in ((a.reference, b.reference), (a.value, b.value))]
    relative_changes = [abs(y / x - 1.0) for x, y in compared if x and y]
    has_lost = any(a.value is not None and b.value is None for a, b in pairs)
    target = min((c.target for c in faulty_cells), default=0.0)
    if relative_changes and not has_lost and max(relative_changes) <= target:
        size = f" by more than {unsigned(max(relative_changes))}" if max(relative_changes) else ""
        return replace(control, without_effect=f"changes no compared frequency{size}")
    return control
