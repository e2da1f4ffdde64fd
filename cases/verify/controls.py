"""Negative controls: core made wrong on purpose must be caught by what judges core every day.

Each of ``mistakes.MISTAKES`` is solved for every blade of a run and put in core's place: the independent codes' answers and
the printed numbers, those that agree with core as it is, are judged against it by the same function and the same targets. A
mistake is caught where one of them fails. One that must show in a case of the run and is caught by nobody means that the
harness sees nothing: the run ends with status 1.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...core.blade import Blade
from ...core.chain.steady import SteadyStateError
from ...core.effects import FULL
from ...core.eigen import UnstableError
from ...core.modes import Modes
from ..input.schema import Compare, Variant
from ..judge.pairing import aligned, families, pair, weights
from ..judge.results import Cell, Control
from ..judge.verdict import judge
from .core_solver import START, qualifying
from .mistakes import MISTAKES, Mistake, Solve

ELEMENTS = START
"""With and without a mistake: their error is much the same, and all but cancels in what the mistake changes."""

NEAR = 5e-2
"""Relative distance within which core's converged answer and this coarser one are the same mode of a family: lumped mass is
2 % off, modes of a family are farther apart."""


@dataclass(frozen=True)
class Changed:
    """One mode with and without a mistake: its name, and frequencies in rad/s; ``wrong`` None where none is like it."""

    name: str
    right: float
    wrong: float | None

    @property
    def change(self) -> float | None:
        """Relative difference of wrong from right."""
        return None if self.wrong is None else self.wrong / self.right - 1.0


@dataclass(frozen=True)
class Wrong:
    """What one mistake does to a blade's compared modes at one speed; none if it leaves no steady state."""

    mistake: str
    omega: float
    modes: tuple[Changed, ...]


def solve(variant: Variant, compare: Compare) -> list[Wrong]:
    """Every mistake in one blade at every speed."""
    out = []
    for omega in variant.speeds.tolist():
        known: dict[Solve, Modes | None] = {}
        for m in MISTAKES:
            if omega or m.at_rest:
                if m.right not in known:
                    known[m.right] = _solved(m.right, variant.blade, omega, compare)
                right, wrong = known[m.right], _solved(m.wrong, variant.blade, omega, compare)
                modes = changed(right, wrong, variant.blade, compare) if right and wrong else ()
                out.append(Wrong(m.name, omega, modes))
    return out


def _solved(solve: Solve, blade: Blade, omega: float, compare: Compare) -> Modes | None:
    """None where there is no answer: what is wrong may have no steady state, be singular, or give no finite number."""
    try:
        with np.errstate(invalid="ignore"):
            return solve(blade, omega, ELEMENTS, 2 * compare.modes + 2, FULL)
    except (SteadyStateError, UnstableError, ArithmeticError, ValueError):
        return None


def changed(right: Modes, wrong: Modes, blade: Blade, compare: Compare) -> tuple[Changed, ...]:
    """The modes of ``right`` that a case compares, named, and those of ``wrong`` most like them."""
    weight = weights(blade)
    right, wrong = aligned(right, weight), aligned(wrong, weight)
    wanted, family = qualifying(right, weight, compare), families(right, weight)
    names = [f"{family[k]} {sum(family[j] == family[k] for j in wanted if j <= k)}" for k in wanted]
    partners = [p.mode for p in pair(right, wrong, wanted, weight)]
    return tuple(
        Changed(name, float(right.frequencies[k]), None if p is None else float(wrong.frequencies[p]))
        for name, k, p in zip(names, wanted, partners, strict=True)
    )


def judged(case: str, wrongs: Iterable[Wrong], cells: Iterable[Cell]) -> list[Control]:
    """A row for each mistake and speed: what it changes most, and which of one blade's ``cells`` fail against it."""
    witnesses: dict[float, list[Cell]] = {}
    for cell in cells:
        if _witness(cell):
            witnesses.setdefault(cell.omega, []).append(cell)
    rows = []
    for wrong in wrongs:
        worst = max(wrong.modes, key=lambda m: abs(m.change or 0.0), default=Changed("", 0.0, None))
        fails: dict[str, bool] = {}
        for cell in witnesses.get(wrong.omega, []):
            if (seen := _fails(cell, wrong)) is not None:
                fails[cell.code] = fails.get(cell.code, False) or seen
        rows.append(
            Control(
                control=wrong.mistake,
                case=case,
                omega=wrong.omega,
                mode=worst.name,
                right=worst.right or None,
                wrong=worst.wrong,
                caught=tuple(code for code, seen in fails.items() if seen),
                missed=tuple(code for code, seen in fails.items() if not seen),
            )
        )
    return rows


def _witness(cell: Cell) -> bool:
    """Whether a cell is independent of core and agrees, surely enough, with core as it is and all its effects."""
    if cell.shares != "nothing" or cell.frequency is None or cell.full is None:
        return False
    return judge(cell.frequency / cell.full - 1.0, cell.uncertainty, cell.target)[0] == "pass"


def _fails(cell: Cell, wrong: Wrong) -> bool | None:
    """Whether a witness' cell fails against core made wrong; None if there is no such mode to put against it."""
    if cell.frequency is None or cell.full is None:
        return None
    full = cell.full
    alike = [m for m in wrong.modes if m.name.split()[0] == cell.family and abs(m.right / full - 1.0) < NEAR]
    change = min(alike, key=lambda m: abs(m.right / full - 1.0)).change if alike else None
    if change is None:
        return None
    return judge(cell.frequency / (full * (1.0 + change)) - 1.0, cell.uncertainty, cell.target)[0] == "fail"


Status = Literal["caught", "needs a case", "needs a code", "missed"]


@dataclass(frozen=True)
class Outcome:
    """What became of one mistake in a run.

    Attributes:
        mistake: see ``mistakes``.
        status: ``missed`` is the harness' failure; ``needs a case`` and ``needs a code``: the run has none that could tell.
        cases: blade → its row with the largest change of those that were caught, else of all.
    """

    mistake: Mistake
    status: Status
    cases: dict[str, Control]


def outcomes(rows: Sequence[Control]) -> list[Outcome]:
    """What became of each mistake; none if there are no rows, as in a run of mechanisms only."""
    return [_outcome(m, [r for r in rows if r.control == m.name]) for m in MISTAKES] if rows else []


def _outcome(mistake: Mistake, rows: Sequence[Control]) -> Outcome:
    cases: dict[str, Control] = {}
    for row in rows:
        if row.case not in cases or _weight(row) > _weight(cases[row.case]):
            cases[row.case] = row
    telling = [r for r in rows if r.case in mistake.seen_in]
    status: Status = "missed"
    if any(r.caught for r in rows):
        status = "caught"
    elif not telling:
        status = "needs a case"
    elif not any(r.missed for r in telling):
        status = "needs a code"
    return Outcome(mistake, status, cases)


def _weight(row: Control) -> tuple[bool, float]:
    return bool(row.caught), abs(row.change or 0.0)
