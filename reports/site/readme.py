"""The generated parts of the README and of the site's page of results.

``python -m southwell.reports.site.readme [results.jsonl]`` writes the README and its figure.
The rows of the tables are stored next to this module, so that the tables can be checked without a run.
"""

import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from ...cases.input import atomic
from ...cases.judge.results import Cell, Run
from ...cases.store import results_file
from ..shared import summary
from ..shared.markdown import plain, table
from ..shared.summary import columns, table_column
from ..verification.case_tables import comparison
from ..verification.report import LEGEND, heat, unasked

CASE, OMEGA = "park-cantilever", 10.0
"""Case and speed (rad/s) of Table 1 of the paper."""

ROWS = Path(__file__).with_name("readme.jsonl")
ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
FIGURE = ROOT / "docs" / "figures" / "campbell.svg"

COMMAND = (
    "southwell campbell examples/nrel-5mw-blade.dat --length 61.5 --hub-radius 1.5 "
    "--rpm 0:12.1:1.1 --operating 6.9:12.1 --modes 4"
)
"""The command in the README, to be run in a checkout."""

LINES = 12
"""Number of lines of its output in the README."""

SHOWN = {
    "park-cantilever": "uniform cantilever of Park et al. (2010)",
    "hodges-rutkowski": "tapered beam of Hodges and Rutkowski (1981)",
    "nrel-5mw": "NREL 5-MW blade",
    "park-blade/windpact": "WindPACT 3.0-MW blade",
    "tip-mass": "beam with a tip mass",
}
"""Rows of the README's table of results."""

BEGIN, END = "<!-- {}: begin, written by `make readme` -->", "<!-- {}: end -->"
"""Markers around the generated parts ``command`` and ``results``."""


ISOLATED = ("sharpy", "frame3dd", "calculix")
"""Codes left out of the rows, because `make verify` does not install them but uses them if present."""


def condense(run: Run) -> Run:
    """Reduce a run to the rows of the tables: the worst cell of each case and column, and the paper's Table 1."""
    cells: list[Cell] = []
    for case in summary.cases(run):
        own = [c for c in run.cells if c.case == case and c.code not in ISOLATED]
        for name in columns(own, table_column):
            group = [c for c in own if table_column(c) == name]
            grave = summary.worst_verdict(group)
            cells.append(summary.worst(group) or next(c for c in group if c.verdict == grave))
    table = [c for c in run.cells if c.case == CASE and c.omega == OMEGA and c.mode]
    cells += [c for c in table if c.code not in ISOLATED]
    kept = dict.fromkeys(cells)
    columns_kept = {(c.case, c.code) for c in kept}
    origins = tuple(o for o in run.origins if (o.case, o.code) in columns_kept)
    return Run(tuple(kept), versions=run.versions, command=run.command, settings=run.settings, origins=origins)


def five(run: Run) -> str:
    """The README's table of results, one row per case in ``SHOWN``.

    The columns are the independent codes of which all answers pass with their largest difference, the independent codes
    with any other verdict, and the worst difference of a published table.
    """
    rows = []
    for case, description in SHOWN.items():
        codes = [c for c in run.cells if c.case == case and c.shares == "nothing" and c.role == "code"]
        answers = [c for c in codes if c.verdict not in ("not run", "not applicable")]
        other_cells = [c for c in answers if c.verdict != "pass"]
        worst_verdicts = {
            code: summary.worst_verdict(c for c in other_cells if c.code == code)
            for code in dict.fromkeys(c.code for c in other_cells)
        }
        codes = [c for c in answers if c.code not in worst_verdicts]
        worst = max(codes, key=lambda c: abs(c.difference or 0.0))
        published_cell = summary.worst(c for c in run.cells if c.case == case and c.role == "table")
        rows.append(
            {
                "blade": description,
                "agree with Southwell": ", ".join(dict.fromkeys(plain(c.code) for c in codes)),
                "largest difference": summary.plus_minus(worst),
                "other verdicts": ", ".join(f"{plain(code)} ({verdict})" for code, verdict in worst_verdicts.items())
                or "–",
                "published table": _published(published_cell) if published_cell else "–",
            }
        )
    return f"{table(rows)}\n"


def _published(cell: Cell) -> str:
    return (
        f"{summary.SYMBOL[cell.verdict]} {summary.amount(summary.size(cell) or 0.0, cell.target)}{summary.wide(cell)}"
    )


def block(run: Run) -> str:
    """The site's tables of results: every case by every code, and Table 1 of the paper."""
    table1 = [c for c in run.cells if c.case == CASE and c.omega == OMEGA and c.mode]
    versions = ", ".join(f"{name} {version}" for name, version in run.versions.items())
    omitted = unasked(run)
    return f"""{heat(run)}

Each field shows the worst verdict of all modes and speeds, and the largest difference from Southwell's own solver with that
verdict (known differences are from the solver with all effects). {LEGEND}.{f" Omitted columns: {omitted}." if omitted else ""}

## {CASE} at {summary.units(run, CASE).at(OMEGA)}, Table 1 of Park et al. (2010)

{comparison(table1, summary.units(run, CASE))}

Written by `{run.command}` with {versions}.
"""


def results_page() -> str:
    """The site's page of results, from the stored rows."""
    return f"""# Results

This page shows the results of `make verify`. Each row is a blade, each column a code or a published table; [how to read a
verdict](reading-a-verdict.md) explains the signs. The column *paper's equations, literally* checks Southwell's fast
solver against the equations of Park et al. (2010), written out with dense matrices.

{block(results_file.read(ROWS))}"""


def example(folder: Path) -> str:
    """Run ``COMMAND`` with the output folder ``folder``; return its standard output."""
    words = [sys.executable, "-m", *shlex.split(COMMAND), "--out", str(folder)]
    return subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True).stdout


def console(output: str) -> str:
    """The README's console block: the command and the first lines of its output."""
    lines = [line.rstrip() for line in output.splitlines()[:LINES]]
    return "\n".join(["```console", f"$ {COMMAND}", *lines, "…", "```", ""])


def put(text: str, new: str, marker: str) -> str:
    """Replace the text between the markers of ``marker`` in ``text`` by ``new``.

    Raises:
        ValueError: if the markers are missing.
    """
    first, last = BEGIN.format(marker), END.format(marker)
    head, begin, after_begin = text.partition(first)
    _, end, tail = after_begin.partition(last)
    if not (begin and end):
        raise ValueError(f"README: the markers {first} and {last} are missing: put them where the part belongs")
    return f"{head}{first}\n\n{new}\n{last}{tail}"


def written(text: str) -> str:
    """The README with the table of results from the stored rows."""
    return put(text, five(results_file.read(ROWS)), "results")


def main() -> None:
    """Update the stored rows from a results file, if one is given; write the README and its figure."""
    if sys.argv[1:]:
        path = Path(sys.argv[1])
        run = results_file.read(path)
        if run.unfinished:
            sys.exit(f"{path}: {run.unfinished}: the tables are those of a complete run")
        results_file.write(ROWS, condense(run))
    with TemporaryDirectory() as folder:
        output = example(Path(folder))
        FIGURE.parent.mkdir(exist_ok=True)
        shutil.copyfile(Path(folder) / FIGURE.name, FIGURE)
    text = put(README.read_text(encoding="utf-8"), console(output), "command")
    atomic.write(README, written(text))


if __name__ == "__main__":
    main()
