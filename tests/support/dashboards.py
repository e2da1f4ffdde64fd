"""Runs and histories for the dashboard's tests: the README's own rows, with names that would do harm if they were markup."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import cache
from pathlib import Path

from southwell.cases.judge.results import Level, Run
from southwell.cases.regression import history
from southwell.cases.store import results_file
from southwell.reports.site import readme

HOSTILE = "<img src=x onerror=alert(1)>"
WORSE = '</script><script>document.title="2"</script><!--'

CASES = ("articulated/flap", "curved-solid", "hinged-blade", "nrel-5mw", "park-cantilever", "rotating-cable", "tip-mass",
         "wright-flapwise", "yoo-shin-chordwise/delta-5")  # fmt: skip

ABSENT = "drake"  # in no answer of any run
LOST = "pinocchio"  # in none of the last


@cache
def run() -> Run:
    """The README's rows of some cases, of a machine without one of the codes; refinements, which they lack, of order 4 towards
    core."""
    everything = results_file.read(readme.ROWS)
    plain = replace(
        everything,
        cells=tuple(c for c in everything.cells if c.case in CASES),
        settings=tuple(s for s in everything.settings if s.case in CASES),
    )
    levels = tuple(
        Level(c.case, c.omega, c.mode, c.code, n, c.reference * (1 + n**-4.0))
        for c in plain.cells
        if c.case == "park-cantilever" and c.code in ("exudyn-ancf", "scikit-fem") and c.reference
        for n in (10, 20, 40)
    )
    silent = dict.fromkeys(("value", "reference", "full", "difference", "uncertainty", "elements", "order", "mac"))
    message = {"mode": 0, "family": "", "ordinal": 0, "version": "", "verdict": "not run", "reason": "not installed"}
    absent = {(c.case, c.omega): replace(c, **message, **silent) for c in plain.cells if c.code == ABSENT}
    return replace(plain, cells=(*(c for c in plain.cells if c.code != ABSENT), *absent.values()), levels=levels)


@cache
def hostile() -> Run:
    """One case and one code of theirs under other names."""
    plain, name = run(), run().cells[0].case
    cells = (replace(c, code=WORSE if c.code == "pybmodes" else c.code) for c in plain.cells)
    return replace(
        plain,
        cells=tuple(replace(c, case=HOSTILE, reason=WORSE) if c.case == name else c for c in cells),
        settings=tuple(
            replace(s, case=HOSTILE, title=WORSE, facts={HOSTILE: WORSE}) if s.case == name else s
            for s in plain.settings
        ),
        versions={**plain.versions, WORSE: HOSTILE},
    )


def kept(file: Path) -> Path:
    """Seven runs: at the fifth scikit-fem moves by 1e-6 in one case, at the sixth core does in another, the seventh lacks a
    code; the last line is truncated."""
    first = run()
    for k in range(7):
        cells = []
        for c in first.cells:
            if c.value and (d := c.difference) is not None:
                if k >= 4 and (c.case, c.code) == ("tip-mass", "scikit-fem"):
                    new = (1 + d) * (1 + 1e-6) - 1
                    c = replace(c, value=c.value * (1 + 1e-6), difference=new)
                if k >= 5 and c.case == "wright-flapwise":
                    c = replace(c, difference=(1 + d) / (1 + 1e-5) - 1)
            if not (k == 6 and c.code == LOST):
                cells.append(c)
        versions = {**first.versions, "scikit-fem": "12" if k < 4 else "13"}
        entry = history.entry(
            replace(first, cells=tuple(cells), versions=versions),
            f"commit{k}",
            machine=HOSTILE,
            date=datetime(2026, 11, 1, tzinfo=UTC) + timedelta(days=k),
        )
        history.append(file, entry)
    with file.open("ab") as out:
        out.write(b'{"commit":"to')
    return file
