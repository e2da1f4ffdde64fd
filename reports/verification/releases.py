"""Other releases of codes against the installed ones: one line each, a table, and the first release that moved a frequency."""

from ...cases.judge.releases import Bisection, Change, Comparison, comparisons
from ...cases.judge.results import Run
from ..shared.units import BY_KEY, RAD_S
from .evidence import where


def headline(run: Run) -> list[str]:
    """One sentence for each code with another release, and one for each first release that moves a frequency."""
    return [*map(_sentence, comparisons(run)), *found(run)]


def _sentence(one: Comparison) -> str:
    subject = f"{one.other} against {_version(one, other=False)}:"
    missing = f"; only one of the releases answers {_missing(one)}" if one.lost or one.gained else ""
    if not one.changes:
        return f"{subject} nothing compared{missing}."
    count = f"{len(one.changes)} {'frequency' if len(one.changes) == 1 else 'frequencies'} compared"
    moved = f"{len(one.moved)} moved beyond uncertainty" if one.moved else "none moved beyond its uncertainty"
    return f"{subject} {count}, {moved}; largest change {_size(one.largest)}{missing}."


def rows(run: Run) -> list[dict[str, str]]:
    """One row for each code with another release."""
    return [
        {
            "code": one.code,
            "installed": _version(one, other=False),
            "other": _version(one, other=True),
            "frequencies compared": str(len(one.changes)),
            "largest change": _size(one.largest),
            "where": where(run, one.largest.before) if one.largest else "",
            "beyond uncertainty": str(len(one.moved)),
            "answered by one only": _missing(one),
            "first release that moves it": next((b.first for b in run.bisections if b.other == one.other), ""),
        }
        for one in comparisons(run)
    ]


def found(run: Run) -> list[str]:
    """One sentence for each bisection: the first release that moves a frequency, and those that could not be tried."""
    return [_first(run, one) for one in run.bisections]


def _first(run: Run, one: Bisection) -> str:
    units = next((BY_KEY[s.unit] for s in run.settings if s.case == one.case), RAD_S)
    cells = [c for c in run.cells if (c.case, c.omega, c.mode, c.code) == (one.case, one.omega, one.mode, one.code)]
    place = where(run, cells[0]) if cells else f"{one.case}, {one.code}, mode {one.mode}, {units.at(one.omega)}"
    skipped = "; ".join(f"{release} ({why})" for release, why in one.skipped.items())
    return (
        f"First release of {one.distribution} that moves {one.code}: {one.first}, by {one.change:+.1e} ± "
        f"{one.uncertainty:.0e} from {one.older} ({place}); {one.before} does not"
        + (f"; skipped between them: {skipped}." if skipped else ".")
    )


def _size(change: Change | None) -> str:
    if change is None:
        return ""
    return f"{change.relative:+.1e} ± " + ("unknown" if change.uncertainty is None else f"{change.uncertainty:.0e}")


def _missing(one: Comparison) -> str:
    parts = ((one.lost, "installed"), (one.gained, "other"))
    return ", ".join(f"{count} ({which})" for count, which in parts if count)


def _version(one: Comparison, other: bool) -> str:
    cells = [change.after if other else change.before for change in one.changes]
    return cells[0].version if cells else (one.other.rpartition("@")[2] if other else "the installed release")
