"""Who bears a case out, counted honestly: an answer is a witness by what it shares with core, and once for each model.

A code with its own mechanical model, and a printed source, is a witness of the answer. Codes given core's mechanical model
or its discretisation are, all together, one witness of the implementation: they can say that core solves its model rightly,
not that the model is right. A witness counts if it agrees in every mode and at every speed it answers; one whose difference
is only explained (a bracket, a coarse discretisation) is no witness.

Independent witnesses have two targets: the case's own (0.1 %, the paper's), and ``FINE`` for what their refinements
extrapolate to.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from .results import Cell
from .verdict import judge

FINE = 1e-4
"""Relative: what independent models should agree to after extrapolation."""

Kind = Literal["code", "closed form", "printed source", "core's model"]
Standing = Literal["agrees", "explained", "open", "disagrees"]


@dataclass(frozen=True)
class Witness:
    """One witness of one blade's frequencies.

    Attributes:
        name: the code's, the source's; of those with core's model, all names.
        kind: a foreign code with its own model, a closed form of this package, a printed source, or whoever has core's model.
        standing: at the case's target.
        fine: at ``FINE``; None where that is no question (core's model, printed digits too few to tell).
        answers: how many numbers it gave.
        largest: largest |difference| from core with the same effects, relative.
    """

    name: str
    kind: Kind
    standing: Standing
    fine: Standing | None
    answers: int
    largest: float


def witnesses(cells: Iterable[Cell]) -> list[Witness]:
    """All that took part in one blade, in the order of the run; core's own discretisation is none."""
    groups: dict[tuple[str, Kind], list[Cell]] = {}
    for cell in cells:
        asked = cell.difference is not None or cell.verdict in ("fail", "inconclusive")
        if asked and (who := _who(cell)):
            groups.setdefault(who, []).append(cell)
    return [_witness(*who, group) for who, group in groups.items()]


def _who(cell: Cell) -> tuple[str, Kind] | None:
    if cell.shares in ("mechanical model", "discretisation"):
        return "", "core's model"
    if cell.shares != "nothing":
        return None
    if cell.role == "table":
        return cell.code.partition("/")[0], "printed source"
    return cell.code, "closed form" if cell.version.startswith("southwell ") else "code"


def _witness(name: str, kind: Kind, cells: list[Cell]) -> Witness:
    return Witness(
        name=name or ", ".join(dict.fromkeys(c.code for c in cells)),
        kind=kind,
        standing=_gravest(_standing(c, c.target) for c in cells),
        fine=_gravest(_standing(c, FINE) for c in cells) if kind in ("code", "closed form") else None,
        answers=sum(c.difference is not None for c in cells),
        largest=max(abs(c.difference or 0.0) for c in cells),
    )


def _standing(cell: Cell, target: float) -> Standing:
    """Like with like: a code that lacks effects is held to core without them. No answer where one was due is no agreement."""
    if cell.difference is None:
        return "disagrees" if cell.verdict == "fail" else "open"
    verdict, _ = judge(cell.difference, cell.uncertainty, target)
    if verdict == "pass":
        return "agrees"
    if cell.verdict == "known difference":
        return "explained"
    return "disagrees" if verdict == "fail" else "open"


def _gravest(standings: Iterable[Standing]) -> Standing:
    found = list(standings)
    order: tuple[Standing, ...] = ("disagrees", "open", "explained", "agrees")
    return next(s for s in order if s in found)


def independent(found: Iterable[Witness]) -> list[Witness]:
    """Those that agree and share nothing with core: what a summary may count."""
    return [w for w in found if w.kind != "core's model" and w.standing == "agrees"]
