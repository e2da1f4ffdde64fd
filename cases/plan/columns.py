"""The columns of the matrix: one for each code, for the discretisation of the source, and for each printed table.

The work of a column is a picklable function of the speeds and core's references; it returns the rows of the column.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version
from typing import Any, Literal

from ...core.blade import Blade, straight
from ...core.effects import ALL_EFFECTS, Effects
from ...core.element.measures import Measure
from ...core.modes import Modes
from ...references.protocol.description import Description
from ...references.protocol.interface import CORE, Independence
from ...references.protocol.process import Failure, Limits
from ...references.protocol.worker import Answer, answers
from ...references.protocol.worker import Run as Asked
from ..input.schema import Case, Discretisation, Variant
from ..judge.results import Cell, Level, Verdict
from ..solve import core_solver, paper
from ..solve.cells import Head, empty, failed, given, refined, rounding, same
from ..solve.copies import copied
from ..solve.published_tables import about, rows
from ..solve.reference import Reference, felt
from ..solve.refinement import Refining, Wanted, solve

SAME = 1e-8
"""Target for two codes with the same discretisation."""

PAPER = "paper's equations, literally"
"""The column of ``core.park2010``, which checks the solver's algebra."""

ELEMENTS = 20
"""Number of elements of that column, as of the paper's blade, unless a case gives the number of its source. Codes with core's
discretisation also have it if core is stable with it: refinement does not reduce rounding, which is compared."""

References = Sequence[tuple[float, Reference]]
"""Rotor speeds, rad/s, and core's references at these speeds."""

Rows = tuple[list[Cell], list[Level]]


@dataclass(frozen=True)
class Column:
    """A column of one blade.

    Attributes:
        name: as shown while it is being solved.
        effects: effects that its references keep.
        head: fields common to its cells.
        work: function that returns its rows from core's references.
        origin: declared origin of its answers; None if undeclared.
        due: where cells are required: at every speed for every mode, at the highest speed, or where it has numbers.
        adapter: digest of the source of the code; empty for a column of this package.
        bundled: whether the adapter of the code is part of this package.
        solves: whether there is anything to solve; not for a code that is absent, broken or declines the blade.
    """

    name: str
    effects: Effects
    head: Head
    work: Callable[[Any], Rows]
    origin: Independence | None = None
    due: Literal["everywhere", "highest speed", "somewhere"] = "everywhere"
    adapter: str = ""
    bundled: bool = True
    solves: bool = True

    @property
    def storable(self) -> bool:
        """Whether its digest determines its answer: not for a code of another package or of unknown version."""
        return self.bundled and bool(self.head.version or self.head.role == "table")

    @property
    def code(self) -> str:
        """Name of the code."""
        return self.head.code

    def __call__(self, speeds: Sequence[float], core: Sequence[Any]) -> Rows:
        """Rows at all speeds; where core has no reference, the reason. Nothing is solved there."""
        pairs = list(zip(speeds, core, strict=True))
        if not self.solves:
            return self.work(pairs)
        without = [without_reference(self.head, omega, r) for omega, r in pairs if isinstance(r, Failure)]
        solvable = [(omega, r) for omega, r in pairs if not isinstance(r, Failure)]
        cells, levels = self.work(solvable) if solvable else ([], [])
        return without + cells, levels


def without_reference(head: Head, omega: float, failure: Failure) -> Cell:
    """The cell of a column at a speed without a reference: it fails if core has no answer with all effects either."""
    if failure.kind == "no reference":
        return failed(head, omega, failure)
    return empty(head, omega, "inconclusive", f"core with the same effects: {failure.reason}")


def columns(case: Case, variant: Variant, codes: Sequence[Description], limits: Limits) -> list[Column]:
    """All columns of one blade; ``limits`` apply to each solution by a foreign code.

    ``refused`` of each code is its answer to this blade; a code that has not been asked yet is asked before it solves
    the blade. Codes that accept only mechanisms have no column, unless there are no other codes.
    """
    target, blade, source = case.text.compare.target, variant.blade, case.text.discretisation
    out = []
    if source:
        head = Head(variant.name, "core", version("southwell"), "discretisation", target)
        out.append(
            Column("core, as in the source", felt(source.effects, blade), head, partial(_source, head, blade, source))
        )
    head = Head(variant.name, PAPER, version("southwell"), "same discretisation", SAME, "everything")
    work = partial(_paper, head, blade, source.elements if source else ELEMENTS)
    out.append(Column(PAPER, ALL_EFFECTS, head, work, due="highest speed"))
    for table in about(blade, case.text.compare.tables):
        head = Head(variant.name, table.name, "", "table", target, "nothing")
        computed = source if source and table.name in source.tables else None
        work = partial(rows, head, table, blade, computed)
        theory = CORE if computed else table.series.theory or table.source
        origin = Independence(table.source, theory, theory, sections=table.source, eigensolver=table.source)
        out.append(Column(table.name, felt(table.series.effects, blade), head, work, origin, due="somewhere"))
    takers = [code for code in codes if code.blades]
    if not takers:
        out += [_mechanisms_only(variant.name, code, target) for code in codes]
    for code in takers:
        head = Head(variant.name, code.name, code.version or "", "code", target, code.shares, code.motions)
        out.append(replace(_code(head, code, blade, limits), origin=_origin(code, blade)))
    return out


def _mechanisms_only(case: str, code: Description, target: float) -> Column:
    head = Head(case, code.name, code.version or "", "code", target)
    absent = partial(_absent, head, "not applicable", "the code takes mechanisms, not blades")
    return Column(code.name, ALL_EFFECTS, head, absent, solves=False)


def _code(head: Head, code: Description, blade: Blade, limits: Limits) -> Column:
    if code.failure:
        return Column(code.name, ALL_EFFECTS, head, failing_work(head, code.failure), solves=False)
    if code.refused and code.refused[0]:
        refused = partial(_absent, head, "not applicable", code.refused[0])
        return Column(code.name, ALL_EFFECTS, head, refused, solves=False)
    if code.version is None:
        return Column(code.name, ALL_EFFECTS, head, failing_work(head, not_installed(code)), solves=False)
    name, effects = code.asked, felt(code.effects, blade)
    if code.shares == "discretisation":
        head = replace(head, role="same discretisation", target=SAME)
        return Column(
            code.name,
            effects,
            head,
            partial(_same, head, name, blade, code.levels[-1], code.effects, limits),
        )
    refining = Refining(code.levels, code.order, code.finest or 8 * code.levels[-1], bracket=code.bracket)
    return Column(code.name, effects, head, partial(_refined, head, name, blade, effects, refining, limits))


def _origin(code: Description, blade: Blade) -> Independence | None:
    """The declared independence of a code; frames from core do not count if the section axes are those of the blade."""
    declared = code.independence
    plain = straight(blade) and not (blade.twist.any() or blade.precone or blade.pitch)
    return replace(declared, sections="blade") if declared and declared.theory != CORE and plain else declared


def not_installed(code: Description) -> Failure:
    """The failure of a code that is not installed."""
    return Failure("not installed", f"not installed: {code.hint}")


def failing(head: Head, failure: Failure, speeds: Iterable[float]) -> Rows:
    """A cell at every speed for a code, or a column of this package, without any answer."""
    return [failed(head, omega, failure) for omega in speeds], []


def failing_work(head: Head, failure: Failure) -> Callable[[Any], Rows]:
    """The work of a code that failed before its first question."""
    return partial(_failing, head, failure)


def _failing(head: Head, failure: Failure, core: References) -> Rows:
    return failing(head, failure, [omega for omega, _ in core])


def _absent(head: Head, verdict: Verdict, reason: str, core: References) -> Rows:
    return [empty(head, omega, verdict, reason) for omega, _ in core], []


def _refined(
    head: Head, name: str, blade: Blade, effects: Effects, refining: Refining, limits: Limits, core: References
) -> Rows:
    def ask(runs: Sequence[Asked]) -> list[Answer]:
        return answers(name, blade, runs, limits, head.version)

    count = max(r.core.count for _, r in core)
    refinements = solve(ask, [omega for omega, _ in core], refining, count, _wanted(core))
    cells, levels = _join(
        refined(head, omega, r, s, refining.order, refining.bracket)
        for (omega, r), s in zip(core, refinements, strict=True)
    )
    first = [(omega, r, s.answers[0]) for (omega, r), s in zip(core, refinements, strict=True) if s.answers]
    if head.shares in ("nothing", "undeclared") and (copy := copied(blade, effects, first)):
        why = f"equals core's answers with {copy[0]} elements to {copy[1]:.0e}: core's discretisation, not independent"
        cells = [replace(c, shares="discretisation", reason="; ".join(filter(None, (why, c.reason)))) for c in cells]
    return cells, levels


def _source(head: Head, blade: Blade, source: Discretisation, core: References) -> Rows:
    def ask(runs: Sequence[Asked]) -> list[Answer]:
        return core_solver.answers(blade, runs, source.mass, source.stiffness, source.effects)

    refining = core_solver.as_given(source)
    count = max(r.core.count for _, r in core)
    refinements = solve(ask, [omega for omega, _ in core], refining, count, _wanted(core))
    return _join(
        given(head, omega, r, s, refining.order, source.what) for (omega, r), s in zip(core, refinements, strict=True)
    )


def _same(head: Head, name: str, blade: Blade, finest: int, effects: Effects, limits: Limits, core: References) -> Rows:
    def ask(elements: int, scale: float = 1.0) -> list[Answer]:
        scaled = core_solver.rescaled(blade, scale)
        return core_solver.answers(scaled, runs(elements), "half_end", "body_fixed", effects)

    def runs(elements: int) -> list[Asked]:
        return [(omega, elements, r.core.count) for omega, r in core]

    elements = min(ELEMENTS, finest)
    mine = ask(elements)
    if any(isinstance(answer, Failure) for answer in mine):
        elements = finest
        mine = ask(elements)
    again = [ask(elements, scale) for scale in (3.0, 7.0)]
    theirs = answers(name, blade, runs(elements), limits, head.version)
    noises = [rounding(a, others) for a, *others in zip(mine, *again, strict=True)]
    rows = zip(core, theirs, mine, noises, strict=True)
    return _join(same(head, omega, r, a, b, rounding_of_core) for (omega, r), a, b, rounding_of_core in rows)


def _paper(head: Head, blade: Blade, elements: int, core: References) -> Rows:
    """Rows of the paper's equations, at the highest speed only: a difference at lower speeds also appears there.

    Where core is not stable with the paper's elements, which have no geometric stiffness, there are half as many again;
    where it is not stable with these either, elements are corotational.
    """
    if not core:
        return [], []
    omega, reference = max(core, key=lambda pair: pair[0])
    meshes: list[tuple[int, Measure]] = [
        (elements, "body_fixed"),
        (3 * elements // 2, "body_fixed"),
        (elements, "corotational"),
    ]
    for number, stiffness in meshes:
        run = (omega, number, reference.core.count)
        (mine,) = core_solver.answers(blade, [run], "half_end", stiffness)
        if not isinstance(mine, Failure):
            break
    return same(head, omega, reference, paper.answer(blade, run, stiffness), mine)


def _wanted(core: References) -> Callable[[float, Sequence[Modes]], Wanted]:
    """The modes requested from a solver: core's modes, whatever the solver answered."""
    by_speed = {omega: r.core.wanted for omega, r in core}
    return lambda omega, _: by_speed[omega]


def _join(parts: Iterable[Rows]) -> Rows:
    cells, levels = zip(*parts, strict=True)
    return [c for part in cells for c in part], [v for part in levels for v in part]
