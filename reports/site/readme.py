"""The README's tables, written from a run by a command: ``python -m southwell.reports.site.readme [results.jsonl]``.

The few rows that the tables need, and what a measurement of cost beside the results found, are kept beside this module, so
that anyone can see that the tables say what they say.
"""

import shutil
import sys
from dataclasses import replace
from pathlib import Path

from ...cases.bench import cost as measure
from ...cases.input import atomic
from ...cases.judge import results
from ...cases.judge.results import Cell, Run
from ...cases.verify.lumping import CASE, OMEGA
from ..shared import summary
from ..shared.summary import broad, columns
from ..verification import bench
from ..verification.report import LEGEND, comparison, heat, unasked, units

ROWS = Path(__file__).with_name("readme.jsonl")
README = Path(__file__).parents[2] / "README.md"

COST = Path(__file__).with_name("readme-bench.json")

BEGIN, END = "<!-- {}: begin, written by `make readme` -->", "<!-- {}: end -->"
"""Round what is written: ``table`` and ``cost``."""


def condense(run: Run) -> Run:
    """The rows that ``block`` needs: of each case and column the worst cell, and all of the paper's Table 1."""
    cells: list[Cell] = []
    for case in summary.cases(run):
        mine = [c for c in run.cells if c.case == case]
        for name in columns(mine, broad):
            group = [c for c in mine if broad(c) == name]
            grave = summary.gravest(group)
            cells.append(summary.worst(group) or next(c for c in group if c.verdict == grave))
    cells += [c for c in run.cells if c.case == CASE and c.omega == OMEGA and c.mode]
    kept = dict.fromkeys(replace(c, seconds=None) for c in cells)
    return Run(tuple(kept), versions=run.versions, command=run.command, settings=run.settings)


def block(run: Run) -> str:
    """The README's part between its markers."""
    table1 = [c for c in run.cells if c.case == CASE and c.omega == OMEGA and c.mode]
    made = ", ".join(f"{name} {version}" for name, version in run.versions.items())
    none = unasked(run)
    return f"""{heat(run)}

In each field the gravest verdict of all modes and speeds, and the largest difference from core behind it (of a known
difference: from core with all effects). {LEGEND}.{f" No answer in this run: {none}." if none else ""}

`{CASE}` at {units(run, CASE).at(OMEGA)}, Table 1 of the paper:

{comparison(table1, units(run, CASE))}

From `{run.command}` with {made}.
"""


def put(text: str, new: str, what: str = "table") -> str:
    """``text`` with ``new`` between the markers of ``what``.

    Raises:
        ValueError: if the markers are not there.
    """
    first, last = BEGIN.format(what), END.format(what)
    head, begin, rest = text.partition(first)
    _, end, tail = rest.partition(last)
    if not (begin and end):
        raise ValueError(f"README: the markers {first} and {last} are missing: put them where the table shall stand")
    return f"{head}{first}\n\n{new}\n{last}{tail}"


def written(text: str) -> str:
    """The README with what the rows and the measurement kept here say."""
    text = put(text, block(results.read(ROWS)))
    return put(text, bench.render(measure.read(COST)), "cost")


def main() -> None:
    """Take the rows from a results file, if one is given, and the measurement beside it, and write the README's tables."""
    if sys.argv[1:]:
        path = Path(sys.argv[1])
        run = results.read(path)
        if run.unfinished:
            sys.exit(f"{path}: {run.unfinished}: the tables are those of a complete run")
        results.write(ROWS, condense(run))
        if (measured := path.with_name(bench.FILE)).exists():
            shutil.copyfile(measured, COST)
    atomic.write(README, written(README.read_text(encoding="utf-8")))


if __name__ == "__main__":
    main()
