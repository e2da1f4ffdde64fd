"""Summary of a run: number of cells, the verdict on each code, and the worst difference and where it is.

Pure functions of a run, shared by terminal, Markdown and figures, so that all report the same.
"""

from collections import Counter
from collections.abc import Callable, Iterable

from ...cases.judge.results import Cell, Run, Setting, Verdict
from ...cases.judge.verdict import unsigned
from ...cases.judge.witnesses import under_confirmed
from .statuses import FAILED, INCOMPLETE, PASSED
from .units import BY_KEY, RAD_S, Units

SYMBOL: dict[Verdict, str] = {
    "pass": "✔",
    "fail": "✘",
    "inconclusive": "?",
    "known difference": "≈",
    "coarse": "□",
    "estimate": "~",
    "measured": "◇",
    "not applicable": "–",
    "not run": "○",
}
"""Sign of each verdict, always shown in addition to another distinction."""

WORST_FIRST: tuple[Verdict, ...] = (
    "fail",
    "inconclusive",
    "known difference",
    "pass",
    "coarse",
    "estimate",
    "measured",
    "not run",
    "not applicable",
)

PAPER = 1e-3
"""The usual target, relative, as in the paper. A wider target is shown next to every number it applies to."""

TINY = 1e-6
"""Targets below this are those of codes with the same discretisation; such differences are not shown in percent."""

LARGEST_KNOWN = 0.05
"""Largest known difference, relative, of an answer that still counts as compared with core."""

BAD: frozenset[Verdict] = frozenset({"fail", "inconclusive"})
"""Verdicts that make a run end with status 1."""


def compared(cells: Iterable[Cell]) -> bool:
    """Whether an external result was compared with core: a judged number, or a required answer that is missing.

    A known difference above ``LARGEST_KNOWN`` does not count: what the code leaves out decides its answer.
    """
    foreign = [c for c in cells if c.role != "discretisation" and c.shares != "everything"]
    explained = (c for c in foreign if c.verdict == "known difference")
    return any(c.verdict in (*BAD, "pass") for c in foreign) or any(
        abs(size(c) or 0.0) <= LARGEST_KNOWN for c in explained
    )


def incomplete(run: Run) -> str:
    """A note on an incomplete run; empty if the run is complete."""
    return f"Incomplete: {run.unfinished}." if run.unfinished else ""


def status(run: Run) -> int:
    """Exit status of a run, see ``statuses``.

    A run passes if something was compared, nothing fails or is inconclusive, every blade is confirmed by as many groups
    as required, no second reading and no code's model contradicts the blade, and every seeded fault is detected.
    """
    if run.unfinished:
        return INCOMPLETE
    blind = any(control.missed for control in run.controls)
    has_failed = any(c.verdict in BAD for c in run.cells) or any(c.verdict == "fail" for c in run.property_checks)
    return FAILED if not compared(run.cells) or blind or has_failed or under_confirmed(run) else PASSED


def worst_verdict(cells: Iterable[Cell]) -> Verdict:
    """The worst verdict of the cells."""
    return next(iter(counts(cells)))


def size(cell: Cell) -> float | None:
    """The relative difference of a cell from the answer.

    If a code agrees with core without the same effects, its known difference is that from core with all effects.
    """
    agrees = cell.difference is not None and abs(cell.difference) <= cell.target
    if cell.verdict == "known difference" and agrees and cell.value is not None and cell.full is not None:
        return cell.value / cell.full - 1.0
    return cell.difference


def largest(cells: Iterable[Cell]) -> Cell | None:
    """The cell with the largest difference; None if no cell has one."""
    return max((c for c in cells if size(c) is not None), key=lambda c: abs(size(c) or 0.0), default=None)


def worst(cells: Iterable[Cell]) -> Cell | None:
    """The cell with the largest difference among those with the worst verdict; None if none has a number."""
    cells = list(cells)
    grave = worst_verdict(cells) if cells else None
    return largest(c for c in cells if c.verdict == grave)


def counts(cells: Iterable[Cell]) -> Counter[Verdict]:
    """Number of cells by verdict, the worst first."""
    by_verdict = Counter(c.verdict for c in cells)
    return Counter[Verdict]({v: by_verdict[v] for v in WORST_FIRST if v in by_verdict})


def tally(cells: Iterable[Cell]) -> str:
    """Number of cells by verdict, with the verdicts' signs."""
    return ", ".join(f"{n} {SYMBOL[verdict]}" for verdict, n in counts(cells).items())


def setting(run: Run, case: str) -> Setting | None:
    """The setting of a case; None if the run does not state it."""
    return next((s for s in run.settings if s.case == case), None)


def units(run: Run, case: str) -> Units:
    """The units of a case; rad/s if the run does not state them."""
    case_setting = setting(run, case)
    return BY_KEY[case_setting.unit] if case_setting else RAD_S


def cases(run: Run) -> list[str]:
    """Names of the cases' blades, in the run's order."""
    return list(dict.fromkeys(c.case for c in run.cells))


def column(cell: Cell) -> str:
    """The column of a cell."""
    return "source's discretisation" if cell.role == "discretisation" else cell.code


def table_column(cell: Cell) -> str:
    """The column of a cell in a table of several cases, with all printed tables in one column."""
    return "printed tables" if cell.role == "table" else column(cell)


def columns(cells: Iterable[Cell], of: Callable[[Cell], str] = column) -> list[str]:
    """Names of columns: the source's discretisation, printed tables, then codes in the run's order."""
    first = ("discretisation", "table")
    by_role = sorted(cells, key=lambda c: first.index(c.role) if c.role in first else len(first))
    return list(dict.fromkeys(of(c) for c in by_role))


def amount(value: float, target: float) -> str:
    """The size of a relative number as short text: in percent, or as a plain number if the target is tiny."""
    if target < TINY:
        return f"{abs(value):.0e}" if value else "0"
    size = 100 * abs(value)
    if 0 < size < 5e-5:
        return "<0.0001 %"
    return (
        f"{size:.4f} %"
        if size < 0.1
        else f"{size:.3f} %"
        if size < 1
        else f"{size:.2f} %"
        if size < 10
        else f"{size:.0f} %"
    )


def allowed(target: float) -> str:
    """A target in percent, or as a plain number if it is tiny."""
    return f"{target:.0e}" if target < TINY else unsigned(target)


def wide(cell: Cell) -> str:
    """`` (target 2.00 %)`` if the cell's target is wider than usual; otherwise empty."""
    return f" (target {allowed(cell.target)})" if cell.target > PAPER and cell.role != "measured" else ""


def plus_minus(cell: Cell) -> str:
    """A difference and its uncertainty, such as ``+0.0021 % ± 0.0004 %``; the uncertainty may be unknown."""
    value = size(cell)
    if value is None:
        return ""
    text = amount(value, cell.target)
    sign = "" if text.startswith("<") else "−" if value < 0 else "+"
    return f"{sign}{text} ± {'unknown' if cell.uncertainty is None else amount(cell.uncertainty, cell.target)}"
