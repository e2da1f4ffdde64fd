"""Independent confirmation of a case's answers, counted by groups of independent origin.

A witness is a column with answers: a code, a closed form or a printed series. It counts if it agrees with core in every
mode and at every speed that it answers. A witness with a known difference, with a target too wide to be evidence, or with an
error bound of its own that is too wide does not count; neither does a measurement.

Witnesses with the same engine, theory or rotation terms may share an error, so they form one *group*, even if only a
third witness links them. A code with core's discretisation or frames confirms that core solves its model, not that the
model is right, and belongs to no group. The same applies to a code that declares no origin
(``references.protocol.interface.Independence``), to another release of a code, and to a table that supports only a
wider target than the case's.

Independent witnesses have two targets: that of the case (0.1 %, the paper's), and ``FINE`` for the extrapolated values
of their refinements.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from ...references.protocol.interface import ADAPTERS, CORE
from .results import Cell, Origin, Run
from .verdict import AGREES, judge

FINE = 1e-4
"""Relative difference within which independent models should agree after extrapolation."""

Kind = Literal["code", "closed form", "printed source", "coarse source", "Southwell's model", "undeclared"]
Standing = Literal["agrees", "coarse", "known difference", "estimate", "open", "disagrees"]

INDEPENDENT: tuple[Kind, ...] = ("code", "closed form", "printed source")
"""Kinds that count."""

INDEPENDENCE_FIELDS = ("engine", "theory", "rotation")
"""Two origins that are the same in any of these fields count once."""


@dataclass(frozen=True)
class Witness:
    """One witness of one blade's frequencies.

    Attributes:
        name: name of the code or the printed series.
        kind: a foreign code, a closed form of this package, a printed series (``coarse`` if its target is wider than
            the case's), a code that shares something with core, one that does not declare what it shares, or another
            release of a code.
        standing: at the case's target.
        fine: at ``FINE``; None if not applicable (Southwell's model, too few printed digits).
        answers: number of frequencies it gave.
        largest: largest |difference| from core with the same effects, relative.
        target: largest target of its numbers, relative.
        origin: as declared; None if undeclared.
    """

    name: str
    kind: Kind
    standing: Standing
    fine: Standing | None
    answers: int
    largest: float
    target: float
    origin: Origin | None = None


def witnesses(run: Run, case: str) -> list[Witness]:
    """All witnesses for a blade, in the order of the run, without core's own discretisation."""
    origins = {o.code: o for o in run.origins if o.case == case}
    columns: dict[str, list[Cell]] = {}
    for cell in run.cells:
        is_judged = cell.difference is not None or cell.verdict in ("fail", "inconclusive")
        if cell.case == case and is_judged and cell.shares and cell.role != "measured":
            columns.setdefault(cell.code, []).append(cell)
    target = next((s.target for s in run.settings if s.case == case), None)
    return [_witness(code, cells, origins.get(code), target) for code, cells in columns.items()]


def _witness(name: str, cells: list[Cell], origin: Origin | None, target: float | None) -> Witness:
    kind = _kind(cells[0], origin)
    if target and kind == "printed source" and max(c.target for c in cells) > target:
        kind = "coarse source"
    return Witness(
        name=name,
        kind=kind,
        standing=_worst(_standing(c, c.target) for c in cells),
        fine=_worst(_standing(c, FINE) for c in cells) if kind in ("code", "closed form", "undeclared") else None,
        answers=sum(c.difference is not None for c in cells),
        largest=max(abs(c.difference or 0.0) for c in cells),
        target=max(c.target for c in cells),
        origin=origin,
    )


def _kind(cell: Cell, origin: Origin | None) -> Kind:
    if cell.shares not in ("nothing", "undeclared") or (origin and CORE in (*_key(origin), origin.sections)):
        return "Southwell's model"
    if not origin:
        return "undeclared"
    if cell.role == "table":
        return "printed source"
    return "closed form" if cell.version.startswith("southwell ") else "code"


def _key(origin: Origin) -> tuple[str, ...]:
    return tuple(getattr(origin, field) for field in INDEPENDENCE_FIELDS)


def _standing(cell: Cell, target: float) -> Standing:
    """Standing of one cell against core with the same effects; a missing answer where one is due is a disagreement."""
    if cell.difference is None:
        return "disagrees" if cell.verdict == "fail" else "open"
    verdict, _ = judge(cell.difference, cell.uncertainty, target)
    if verdict in AGREES:
        return "agrees" if verdict == "pass" else "coarse"
    if cell.verdict in ("known difference", "estimate"):
        return cell.verdict
    return "disagrees" if verdict == "fail" else "open"


def _worst(standings: Iterable[Standing]) -> Standing:
    occurring = list(standings)
    order: tuple[Standing, ...] = ("disagrees", "open", "estimate", "known difference", "coarse", "agrees")
    return next(s for s in order if s in occurring)


def groups(all_witnesses: Iterable[Witness]) -> list[tuple[Witness, ...]]:
    """Witnesses that agree and share nothing with core, grouped by common origin; each group counts once."""
    agreeing = [w for w in all_witnesses if w.kind in INDEPENDENT and w.standing == "agrees"]
    out: list[list[Witness]] = []
    for witness in agreeing:
        linked = [group for group in out if any(_linked(witness, member) for member in group)]
        out = [group for group in out if group not in linked]
        out.append([*(member for group in linked for member in group), witness])
    return [tuple(sorted(group, key=agreeing.index)) for group in out]


def _linked(a: Witness, b: Witness) -> bool:
    return bool(a.origin and b.origin and any(x == y for x, y in zip(_key(a.origin), _key(b.origin), strict=True)))


def foreign_theory(group: Sequence[Witness]) -> bool:
    """Whether the theory of a member is not made by an adapter of this package (``Independence.theory``)."""
    return any(w.origin and ADAPTERS not in w.origin.theory for w in group)


@dataclass(frozen=True)
class UnderConfirmed:
    """A blade with fewer independent groups than its case requires."""

    case: str
    groups: int
    required: int


def under_confirmed(run: Run) -> list[UnderConfirmed]:
    """Blades confirmed by fewer groups than required."""
    group_counts = [(s, len(groups(witnesses(run, s.case)))) for s in run.settings if s.groups]
    return [
        UnderConfirmed(s.case, confirmed_by, s.groups) for s, confirmed_by in group_counts if confirmed_by < s.groups
    ]


def engines(group: Sequence[Witness]) -> str:
    """Name of a group: its engines."""
    return ", ".join(dict.fromkeys(w.origin.engine for w in group if w.origin))
