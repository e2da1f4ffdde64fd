"""The columns of the matrix: one for each code, for the source's own discretisation, and for each printed table.

A column's work is a picklable function of the speeds and of core's references there, and gives the column's rows.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version
from typing import Any

from ...core import velocity_transformation
from ...core.blade import Blade, straight
from ...core.effects import FULL, Model
from ...core.modes import Modes
from ...references.protocol.interface import CORE, Code, Independence, brackets, independence, motions
from ...references.protocol.registry import cap, version_of
from ...references.protocol.worker import Answer, Failure, answers, one_line
from ...references.protocol.worker import Run as Asked
from ..input.schema import Case, Discretisation, Variant
from ..judge.results import Cell, Level, Verdict
from . import core_solver
from .cells import Head, empty, given, refined, rounding, same
from .published_tables import about, rows
from .reference import Reference, felt
from .refinement import Refining, Wanted, solve

SAME = 1e-8
"""Target for two codes given the very same discretisation."""

OTHER_METHOD = "core, velocity transformation"
"""The column of core's other method, which the chain solver's numbers are checked with."""

ELEMENTS = (20, 50)
"""Of that column, whose cost is their cube: the second, where the first are too few for a stable state of either method."""

References = Sequence[tuple[float, Reference]]
"""Rotor speeds, rad/s, and core's references there."""

Rows = tuple[list[Cell], list[Level]]


@dataclass(frozen=True)
class Column:
    """A column of one blade.

    Attributes:
        name: as shown while it is being solved.
        model: the effects that its references keep.
        head: what its cells have in common.
        work: rows from core's references.
        origin: where its answers come from, as declared; None if nothing is.
    """

    name: str
    model: Model
    head: Head
    work: Callable[[Any], Rows]
    origin: Independence | None = None

    def __call__(self, speeds: Sequence[float], core: Sequence[Any]) -> Rows:
        """Rows at all speeds; without a reference there is nothing to compare with."""
        pairs = list(zip(speeds, core, strict=True))
        without = [
            empty(self.head, omega, "inconclusive", f"core with the same effects: {r.reason}")
            for omega, r in pairs
            if isinstance(r, Failure)
        ]
        cells, levels = self.work([(omega, r) for omega, r in pairs if not isinstance(r, Failure)])
        return without + cells, levels


def columns(case: Case, variant: Variant, codes: dict[str, Any], timeout: float) -> list[Column]:
    """All columns of one blade; ``codes`` by the name or import path they were asked for.

    Codes that take mechanisms only have none, unless there are no others.
    """
    target, blade, source = case.text.compare.target, variant.blade, case.text.discretisation
    out = []
    if source:
        head = Head(variant.name, "core", version("southwell"), "discretisation", target)
        out.append(
            Column("core, as in the source", felt(source.model, blade), head, partial(_source, head, blade, source))
        )
    head = Head(variant.name, OTHER_METHOD, version("southwell"), "same discretisation", SAME, "everything")
    out.append(Column(OTHER_METHOD, FULL, head, partial(_other_method, head, blade)))
    for table in about(blade, case.text.compare.tables):
        head = Head(variant.name, table.name, "", "table", target, "nothing")
        computed = source if source and table.name in source.tables else None
        work = partial(rows, head, table, blade, computed)
        theory = CORE if computed else table.series.theory or table.source
        origin = Independence(table.source, theory, theory, sections=table.source, eigensolver=table.source)
        out.append(Column(table.name, felt(table.series.model, blade), head, work, origin))
    takers = {name: code for name, code in codes.items() if hasattr(code, "solve")}
    if codes and not takers:
        out += [_mechanisms_only(variant.name, code, target) for code in codes.values()]
    for name, code in takers.items():
        told, raised = version_of(code)
        head = Head(variant.name, code.name, told, "code", target, getattr(code, "shares", ""), motions(code))
        column = _raised(head, raised) if raised else _code(head, name, code, blade, timeout)
        out.append(replace(column, origin=_origin(code, blade)))
    return out


def _mechanisms_only(case: str, code: Any, target: float) -> Column:
    head = Head(case, code.name, version_of(code)[0], "code", target)
    return Column(code.name, FULL, head, partial(_absent, head, "not applicable", "it takes mechanisms, not blades"))


def _code(head: Head, name: str, code: Code, blade: Blade, timeout: float) -> Column:
    try:
        why = code.unsupported(blade)
    except Exception as error:  # whatever a foreign code raises costs its own cells only
        return _raised(head, f"unsupported(): {type(error).__name__}: {one_line(error)}")
    if why:
        return Column(code.name, FULL, head, partial(_absent, head, "not applicable", why))
    if not head.version:
        return Column(code.name, FULL, head, partial(_absent, head, "not run", f"not installed: {code.hint}"))
    model = felt(code.model, blade)
    if code.shares == "discretisation":
        head = replace(head, role="same discretisation", target=SAME)
        return Column(
            code.name,
            model,
            head,
            partial(_same, head, name, blade, code.levels[-1], code.model, timeout),
        )
    refining = Refining(tuple(code.levels), code.order, cap(code), bracket=brackets(code))
    return Column(code.name, model, head, partial(_refined, head, name, blade, refining, timeout))


def _origin(code: Any, blade: Blade) -> Independence | None:
    """What a code declares; frames that core gives it are no matter where the sections' axes are those of the blade."""
    declared = independence(code)
    plain = straight(blade) and not (blade.twist.any() or blade.precone or blade.pitch)
    return replace(declared, sections="blade") if declared and declared.theory != CORE and plain else declared


def _raised(head: Head, what: str) -> Column:
    return Column(head.code, FULL, head, partial(_absent, head, "fail", f"the adapter raised an exception: {what}"))


def _absent(head: Head, verdict: Verdict, reason: str, core: References) -> Rows:
    return [empty(head, omega, verdict, reason) for omega, _ in core], []


def _refined(head: Head, name: str, blade: Blade, refining: Refining, timeout: float, core: References) -> Rows:
    def ask(runs: Sequence[Asked]) -> list[Answer]:
        return answers(name, blade, runs, timeout)

    count = max(r.core.count for _, r in core)
    studies = solve(ask, [omega for omega, _ in core], refining, count, _wanted(core))
    return _join(
        refined(head, omega, r, s, refining.order, refining.bracket)
        for (omega, r), s in zip(core, studies, strict=True)
    )


def _source(head: Head, blade: Blade, source: Discretisation, core: References) -> Rows:
    def ask(runs: Sequence[Asked]) -> list[Answer]:
        return core_solver.answers(blade, runs, source.mass, source.stiffness, source.model)

    refining = core_solver.as_given(source)
    count = max(r.core.count for _, r in core)
    studies = solve(ask, [omega for omega, _ in core], refining, count, _wanted(core))
    return _join(
        given(head, omega, r, s, refining.order, source.what) for (omega, r), s in zip(core, studies, strict=True)
    )


def _same(head: Head, name: str, blade: Blade, elements: int, model: Model, timeout: float, core: References) -> Rows:
    runs = [(omega, elements, r.core.count) for omega, r in core]
    theirs = answers(name, blade, runs, timeout)
    scaled = (core_solver.rescaled(blade, factor) for factor in (3.0, 7.0))
    mine, *again = (core_solver.answers(b, runs, "half_end", "parent", model) for b in (blade, *scaled))
    noises = [rounding(a, others) for a, *others in zip(mine, *again, strict=True)]
    rows = zip(core, theirs, mine, noises, strict=True)
    return _join(same(head, omega, r, a, b, noise) for (omega, r), a, b, noise in rows)


def _other_method(head: Head, blade: Blade, core: References) -> Rows:
    """At the highest speed only: what differs at lower speeds differs there."""
    if not core:
        return [], []
    omega, reference = max(core, key=lambda pair: pair[0])
    for elements in ELEMENTS:
        run = (omega, elements, reference.core.count)
        (mine,) = core_solver.answers(blade, [run])
        (theirs,) = core_solver.answers(blade, [run], by=velocity_transformation.modes)
        if not (isinstance(mine, Failure) and isinstance(theirs, Failure)):
            break
    return same(head, omega, reference, theirs, mine)


def _wanted(core: References) -> Callable[[float, Sequence[Modes]], Wanted]:
    """What a solver is asked for: core's modes, whatever it answered."""
    by_speed = {omega: r.core.wanted for omega, r in core}
    return lambda omega, _: by_speed[omega]


def _join(parts: Iterable[Rows]) -> Rows:
    cells, levels = zip(*parts, strict=True)
    return [c for part in cells for c in part], [v for part in levels for v in part]
