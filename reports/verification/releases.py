"""Other releases of codes against the installed ones: one line each, a table, and the first release that moved a frequency."""

from ...cases.judge.releases import Bisection, Change, Comparison, comparisons
from ...cases.judge.results import Run
from .evidence import where


def headline(run: Run) -> list[str]:
    """One sentence for each code with another release, and one for each first release that moves a frequency."""
    return [*(_sentence(run, one) for one in comparisons(run)), *found(run)]


def _sentence(run: Run, one: Comparison) -> str:
    subject = f"{one.other} against {run.versions.get(one.code, 'the installed release')}:"
    missing = f"; answered by one release only: {_missing(one)}" if one.lost or one.gained else ""
    if not one.compared:
        return f"{subject} no frequency is given by both releases{missing}."
    count = f"{len(one.compared)} {'frequency' if len(one.compared) == 1 else 'frequencies'} compared"
    moved = f"{len(one.moved)} moved beyond uncertainty" if one.moved else "none moved beyond its uncertainty"
    return f"{subject} {count}, {moved}; largest change {_size(one.largest)}{missing}."


def rows(run: Run) -> list[dict[str, str]]:
    """One row for each code with another release."""
    first = {one.other: one.first for one in run.bisections}
    return [
        {
            "code": one.code,
            "installed": run.versions.get(one.code, ""),
            "other release": run.versions.get(one.other, ""),
            "frequencies compared": str(len(one.compared)),
            "largest change": _size(one.largest),
            "where": where(run, one.largest.cell) if one.largest else "",
            "beyond uncertainty": str(len(one.moved)),
            "answered by one only": _missing(one),
            "first release that differs": first.get(one.other, ""),
        }
        for one in comparisons(run)
    ]


def found(run: Run) -> list[str]:
    """One sentence for each bisection: the first release that differs, and those that could not be tried."""
    return [_first(run, one) for one in run.bisections]


def _first(run: Run, one: Bisection) -> str:
    columns = (one.code, one.other)
    mine = (c for c in run.cells if (c.case, c.omega, c.mode) == (one.case, one.omega, one.mode) and c.code in columns)
    place = next((where(run, cell) for cell in mine), one.case)
    if one.change is not None:
        size = f"{one.change:+.1e} ± {one.uncertainty or 0.0:.0e}"
        does, more, rest = "moves it", f", by {size} from {one.older}", f"{one.before} does not"
    elif one.answers:
        does, more, rest = "answers", "", f"{one.before} does not: {one.reason.rstrip('.')}"
    else:
        does, more, rest = "does not answer", f": {one.reason.rstrip('.')}", f"{one.before} does"
    skipped = "; ".join(f"{release} ({why})" for release, why in one.skipped.items())
    between = f"; skipped between them: {skipped}" if skipped else ""
    first = f"{one.code}: the first release of {one.distribution} that {does} is {one.first}{more} ({place})"
    return f"{first}; {rest}{between}."


def _size(change: Change | None) -> str:
    if change is None or change.relative is None:
        return ""
    return f"{change.relative:+.1e} ± " + ("unknown" if change.uncertainty is None else f"{change.uncertainty:.0e}")


def _missing(one: Comparison) -> str:
    parts = ((one.lost, "installed"), (one.gained, "other"))
    return ", ".join(f"{len(changes)} ({which})" for changes, which in parts if changes)
