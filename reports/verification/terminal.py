"""Tables for the terminal: a run's matrix, its seeded faults, and the frequencies of a blade."""

import re
from collections.abc import Iterator, Sequence

from rich import box
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from ...cases.campbell.tracked import TrackedMode
from ...cases.judge.results import Cell, Run, Verdict
from ..shared import summary
from ..shared.certain import certain, relative
from ..shared.summary import SYMBOL, columns, table_column
from ..shared.table_columns import BETWEEN, fitting
from ..shared.units import Units
from . import controls as faults
from . import witnesses

COLOUR: dict[Verdict, str] = {
    "pass": "green",
    "known difference": "cyan",
    "coarse": "dim",
    "estimate": "dim",
    "measured": "magenta",
    "inconclusive": "yellow",
    "fail": "bold red",
    "not applicable": "dim",
    "not run": "dim",
}
"""Colour of each verdict, in addition to sign and number."""

NARROW = 10
"""Smallest width of a code's column in the matrix, characters; a longer word makes it wider."""


def matrix(run: Run, width: int) -> Iterator[Table]:
    """The matrix, case × code: the worst verdict of all modes and speeds, and the largest difference.

    The columns are split into several tables if they exceed ``width`` characters.
    """
    cases = [case.replace("/", "/\n ") for case in summary.cases(run)]
    first = max((len(line) for case in (*cases, "shares with Southwell") for line in case.split("\n")), default=0)
    heads = {
        name: re.sub(r"[- ](?=\w{4})", lambda m: m[0].strip() + "\n", name) for name in columns(run.cells, table_column)
    }
    shares = {name: witnesses.shared([c for c in run.cells if table_column(c) == name]) for name in heads}
    widths = {
        name: max(NARROW, *(len(word) for word in f"{head} {shares[name]}".split())) for name, head in heads.items()
    }
    for numbers in fitting([own + BETWEEN for own in widths.values()], width - first - BETWEEN):
        part = [list(heads)[k] for k in numbers]
        out = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
        out.add_column("case", no_wrap=True)
        for name in part:
            out.add_column(escape(heads[name]), overflow="fold", min_width=widths[name])
        for case, label in zip(summary.cases(run), cases, strict=True):
            cells = [c for c in run.cells if c.case == case]
            out.add_row(escape(label), *[_field([c for c in cells if table_column(c) == name]) for name in part])
        if any(c.shares for c in run.cells):
            out.add_section()
            texts = [escape(shares[name]).replace(" ", "\n") for name in part]
            out.add_row("shares with Southwell", *texts, style="dim")
        yield out


WIDE = 100
"""Characters of a terminal that shows, for each seeded fault, the cell that detected it; the report has it always."""


def legend() -> str:
    """The legend of ``matrix``."""
    signs = ", ".join(f"{sign} {verdict}" for verdict, sign in SYMBOL.items())
    return f"largest difference from Southwell's own solver in % (2e-14: relative; 1.4 of 2: target of 2 %); {signs}"


def controls(run: Run, width: int) -> Table:
    """The table of seeded faults, one row for each; what detected it, if ``width`` characters are enough."""
    out = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    for head in ("seeded fault", "in", "outcome", "largest difference", "detected by")[: 5 if width >= WIDE else 4]:
        out.add_column(head, overflow="fold")
    for control, row in zip(run.controls, faults.overview(run), strict=True):
        first = control.detected_by[0] if control.detected_by else ""
        cells = (row["fault"], row["in"], row["outcome"], row["largest difference"], first)
        out.add_row(*map(escape, cells[: len(out.columns)]), style="bold red" if control.missed else "")
    return out


def _field(cells: Sequence[Cell]) -> str:
    if not cells:
        return ""
    verdict, worst = summary.worst_verdict(cells), summary.worst(cells)
    size = summary.size(worst) if worst else None
    number = f" {_short(size, worst.target)}{_wide(worst)}" if worst and size is not None else ""
    return f"[{COLOUR[verdict]}]{SYMBOL[verdict]}{number}[/]"


def _wide(cell: Cell) -> str:
    """The target if it is wider than usual, else an empty string."""
    return f" of {100 * cell.target:g}" if summary.wide(cell) else ""


def _short(size: float, target: float) -> str:
    """A relative number in short: in percent, or as a plain number if the target is tiny."""
    value = abs(size) if target < summary.TINY else 100 * abs(size)
    if 0 < value < 1e-4 and target >= summary.TINY:
        return "<1e-4"
    text = f"{value:.0f}" if value >= 100 else f"{value:.2g}" if value >= 0.001 else f"{value:.0e}"
    return text.replace("e-0", "e-")


RELATIVE = "± relative"
"""Heading of the column of uncertainties."""

DIGITS = 7
"""Largest number of digits of a frequency."""


def frequencies(modes: Sequence[TrackedMode], title: str, units: Units, width: int) -> Iterator[Table]:
    """Tables modes × speeds with each mode's largest uncertainty; rows in the order of the first speed.

    The speeds are split into several tables if they exceed ``width`` characters.
    """
    speeds = sorted({at.omega for mode in modes for at in mode.at})
    first = max(len(name) for name in (units.frequency_label, *(mode.label for mode in modes)))
    column = 3 + max(DIGITS + 2, *(len(units.at(omega)) for omega in speeds))
    count = max(1, (width - first - len(RELATIVE) - 8) // column)
    for k in range(0, len(speeds), count):
        yield _frequencies(modes, "" if k else title, units, speeds[k : k + count])


def _frequencies(modes: Sequence[TrackedMode], title: str, units: Units, speeds: Sequence[float]) -> Table:
    heading = Text(title, style="bold", no_wrap=True, overflow="ignore")
    out = Table(box=box.SIMPLE_HEAD, title=heading if title else None, title_justify="left")
    out.add_column(units.frequency_label, no_wrap=True)
    for omega in speeds:
        out.add_column(units.at(omega), justify="right", no_wrap=True)
    out.add_column(RELATIVE, justify="right", no_wrap=True)
    for mode in modes:
        by_speed = {at.omega: at for at in mode.at if at.omega in speeds}
        if by_speed:
            fields = {o: certain(at.frequency * units.frequencies, at.uncertainty) for o, at in by_speed.items()}
            largest = max(at.uncertainty for at in by_speed.values())
            out.add_row(mode.label, *[fields.get(omega, "") for omega in speeds], relative(largest))
    return out
