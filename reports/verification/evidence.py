"""The evidence of a run by kind: number of answers, the worst difference of each kind, and where it is."""

from collections.abc import Callable, Iterable

from ...cases.judge.measured import least, visible
from ...cases.judge.results import Cell, Run, Verdict
from ...cases.judge.witnesses import INDEPENDENT, witnesses
from ..shared import summary
from ..shared.summary import SYMBOL
from ..shared.units import BY_KEY, RAD_S, Units

KINDS: dict[str, Callable[[Cell], bool]] = {
    "measured data (neither confirm nor contradict)": lambda c: c.role == "measured",
    "codes and closed forms that share nothing with core": lambda c: c.role != "table" and c.shares == "nothing",
    "printed tables": lambda c: c.role == "table",
    "codes on core's own model or discretisation": lambda c: bool(c.shares) and c.shares != "nothing",
    "the source's own discretisation": lambda c: c.role == "discretisation",
    "mechanisms: codes and closed forms with the same equations": lambda c: c.role == "same discretisation",
    "other": lambda c: True,
}
"""Kinds of evidence; a cell counts as the first that matches.

The third and fourth kinds check the answer, the fifth only the implementation.
"""

URGENT: dict[Verdict, str] = {"fail": "Worst failure", "inconclusive": "Largest inconclusive difference"}
"""Verdicts reported first, worst first."""

SAME: tuple[Verdict, ...] = ("fail", "inconclusive", "pass", "coarse")
"""Verdicts on a difference from core with the same effects, worst first."""


def verdict(run: Run) -> str:
    """The verdict on the run in one sentence."""
    counts = summary.counts(run.cells)
    if not summary.compared(run.cells):
        return "Nothing was compared."
    missing = sum(_mute(c) for c in run.cells)
    if wrong := counts["fail"] - missing:
        also = f", and {missing} {'is' if missing == 1 else 'are'} missing" if missing else ""
        return (
            f"No: {wrong} answer contradicts core{also}."
            if wrong == 1
            else f"No: {wrong} answers contradict core{also}."
        )
    if missing:
        return f"No: {missing} answer is missing." if missing == 1 else f"No: {missing} answers are missing."
    if counts["inconclusive"]:
        return f"Nothing contradicts core; inconclusive answers: {counts['inconclusive']}."
    return "Nothing contradicts core."


def answer(run: Run) -> str:
    """The verdict and the number of cells by verdict."""
    counted = ", ".join(f"{n} {SYMBOL[v]} {v}" for v, n in summary.counts(run.cells).items() if n)
    return f"{verdict(run)} {len(run.cells)} cell{'s' * (len(run.cells) != 1)}: {counted}."


def _mute(cell: Cell) -> bool:
    """Whether a code failed without a frequency to compare."""
    return cell.verdict == "fail" and cell.difference is None


def urgent(run: Run) -> list[str]:
    """Lines on the worst failure, on failures without a number, and on the largest inconclusive difference."""
    found = {what: summary.largest(c for c in run.cells if c.verdict == v) for v, what in URGENT.items()}
    sentences = [f"{what}: {summary.plus_minus(cell)} ({where(run, cell)})." for what, cell in found.items() if cell]
    mute = {(c.code, c.case): c.reason.rstrip(".") for c in run.cells if _mute(c)}
    return [*sentences, *(f"Failed without a frequency: {code} ({case}): {why}." for (code, case), why in mute.items())]


def first(run: Run) -> list[str]:
    """The summary of a run: the answer, and the failures and inconclusive differences.

    If there are none, the second line is the independent answer that is farthest from core relative to its target.
    """
    independent = {(case, w.name) for case in summary.cases(run) for w in witnesses(run, case) if w.kind in INDEPENDENT}
    far = farthest(c for c in run.cells if (c.case, c.code) in independent)
    data = [line for line in (measured(run),) if line]
    if not far or any(c.verdict in summary.BAD for c in run.cells):
        return [answer(run), *urgent(run), *data]
    return [answer(run), f"Worst independent answer, relative to its target: {_shown(run, far)}.", *data]


def measured(run: Run) -> str:
    """One sentence on the model errors that measured data show; empty without measured data."""
    cells = [c for c in run.cells if c.verdict == "measured"]
    if not cells:
        return ""
    seen = [c for c in cells if visible(c)]
    most = max(seen, key=visible, default=None)
    visibly = f"model error visible in {len(seen)}"
    if most:
        visibly += f", at least {least(visible(most))} ({where(run, most)})"
    n = len(cells)
    return f"Measured: {n} {'frequency' if n == 1 else 'frequencies'}, no evidence: {visibly}; not visible in {n - len(seen)}."


def _statement(cell: Cell) -> str:
    return cell.reason.partition(":")[0]


def _measured(cells: Iterable[Cell]) -> Cell | None:
    """The measured point with the largest visible model error, or otherwise the largest difference."""
    mine = [c for c in cells if c.verdict == "measured"]
    return max(mine, key=lambda c: (visible(c), abs(c.difference or 0.0)), default=None)


def rows(run: Run) -> list[dict[str, str]]:
    """One row per kind of evidence.

    A row has the cells by verdict, the worst difference from core with the same effects, and the largest known
    difference.
    """
    out = []
    kinds: dict[str, list[Cell]] = {kind: [] for kind in KINDS}
    for cell in run.cells:
        if summary.size(cell) is not None or cell.verdict in summary.BAD:
            kinds[next(kind for kind, takes in KINDS.items() if takes(cell))].append(cell)
    for kind, cells in kinds.items():
        if cells:
            same, known = farthest(cells), summary.largest(c for c in cells if c.verdict == "known difference")
            out.append(
                {
                    "evidence": kind,
                    "answers": ", ".join(f"{n} {SYMBOL[v]}" for v, n in summary.counts(cells).items() if n),
                    "worst, relative to target": _shown(run, same or _measured(cells)),
                    "largest known difference": _shown(run, known),
                }
            )
    return out


def farthest(cells: Iterable[Cell]) -> Cell | None:
    """The cell of the worst verdict in ``SAME`` whose difference is the largest relative to its target."""
    cells = list(cells)
    for verdict in SAME:
        if there := [c for c in cells if c.verdict == verdict]:
            return max(there, key=lambda c: abs(c.difference or 0.0) / c.target)
    return None


def _shown(run: Run, cell: Cell | None) -> str:
    if cell is None:
        return ""
    if cell.difference is None:
        units = _units(run, cell)
        return f"{SYMBOL[cell.verdict]} {cell.case}, {summary.column(cell)}, {units.at(cell.omega)}: no answer: {cell.reason}"
    cause = f"cause: {cell.reason.partition(';')[0]}"
    more = f"target {summary.allowed(cell.target)}" if cell.verdict in SAME else cause
    if cell.verdict == "measured":
        more = _statement(cell)
    return f"{SYMBOL[cell.verdict]} {summary.plus_minus(cell)}: {where(run, cell)}; {more}"


def where(run: Run, cell: Cell) -> str:
    """Case, code, mode and speed of a cell as text."""
    return f"{cell.case}, {summary.column(cell)}, {cell.name}, {_units(run, cell).at(cell.omega)}"


def _units(run: Run, cell: Cell) -> Units:
    return next((BY_KEY[s.unit] for s in run.settings if s.case == cell.case), RAD_S)
