"""Who bears each case out: a table of witnesses, and what each column of the matrix shares with core."""

from collections.abc import Sequence

from ...cases.judge.results import Cell, Run
from ...cases.judge.verdict import unsigned
from ...cases.judge.witnesses import FINE, Kind, Witness, independent, witnesses
from ..shared import summary

KINDS: dict[Kind, str] = {
    "code": "codes with their own model",
    "closed form": "closed forms",
    "printed source": "printed sources",
}


def shared(cells: Sequence[Cell]) -> str:
    """What a column shares with core: ``nothing``, ``mechanical model``, ``discretisation``; empty where it is core itself."""
    return ", ".join(dict.fromkeys(c.shares for c in cells if c.shares))


def table(run: Run) -> list[dict[str, str]]:
    """A row a blade: independent witnesses that agree, by kind, counted; those within ``FINE``; those with core's model."""
    rows = []
    for case in summary.cases(run):
        found = witnesses(c for c in run.cells if c.case == case)
        agreeing = independent(found)
        ours = [w.name for w in found if w.kind == "core's model" and w.standing == "agrees"]
        rows.append(
            {
                "case": case,
                "independent witnesses": str(len(agreeing)),
                **{title: _names([w for w in agreeing if w.kind == kind]) for kind, title in KINDS.items()},
                f"within {unsigned(FINE)} too": _names([w for w in agreeing if w.fine == "agrees"]),
                "same model as core (one witness, of the implementation)": ", ".join(ours),
                "no witness": _names([w for w in found if w.standing != "agrees"], with_standing=True),
            }
        )
    return rows if any(c.shares for c in run.cells) else []


def _names(found: Sequence[Witness], with_standing: bool = False) -> str:
    return ", ".join(f"{w.name} ({w.standing})" if with_standing else w.name for w in found)


def headline(run: Run) -> str:
    """The least number of independent witnesses that any blade has; empty where no row says what is shared."""
    counted = {
        case: len(independent(witnesses(c for c in run.cells if c.case == case)))
        for case in summary.cases(run)
        if any(c.shares == "nothing" for c in run.cells if c.case == case)
    }
    if not counted:
        return ""
    least = min(counted, key=lambda case: counted[case])
    many = max(counted.values())
    span = f"{counted[least]} ({least})" if counted[least] == many else f"{counted[least]} ({least}) to {many}"
    return (
        f"Independent witnesses that agree, for each blade: {span}; codes that share core's model are not among them."
    )
