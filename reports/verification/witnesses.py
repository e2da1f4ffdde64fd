"""Independent confirmation of each case: groups of witnesses, their origins, and what each column shares with core."""

from collections.abc import Sequence

from ...cases.judge.results import Cell, Run
from ...cases.judge.verdict import unsigned
from ...cases.judge.witnesses import FINE, Witness, engines, foreign_theory, groups, under_confirmed, witnesses
from ..shared import summary


def shared(cells: Sequence[Cell]) -> str:
    """What a column shares with core: ``nothing``, ``mechanical model``, ``discretisation``; empty for core."""
    return ", ".join(dict.fromkeys(c.shares for c in cells if c.shares))


def table(run: Run) -> list[dict[str, str]]:
    """One row per blade: groups that agree and are required, their members, and witnesses that do not count."""
    rows = []
    for case in summary.cases(run):
        testimony = witnesses(run, case)
        agreeing = groups(testimony)
        setting = summary.setting(run, case)
        counted_witnesses = [w for group in agreeing for w in group]
        others = [w for w in testimony if w not in counted_witnesses]
        rows.append(
            {
                "case": case,
                "independent groups": str(len(agreeing)),
                "required": _required(setting.groups, setting.lacking) if setting else "",
                "who agrees, group by group": "; ".join(f"({_names(group)})" for group in agreeing),
                f"also within {unsigned(FINE)}": _names([w for w in counted_witnesses if w.fine == "agrees"]),
                "confirms the implementation only": _names(
                    [w for w in others if w.kind == "Southwell's model" and w.standing == "agrees"]
                ),
                "not counted": ", ".join(
                    f"{w.name} ({w.standing if w.standing != 'agrees' else w.kind}, to {unsigned(w.target)})"
                    for w in others
                    if w.standing != "agrees" or w.kind in ("undeclared", "coarse source")
                ),
            }
        )
    return rows if any(c.shares for c in run.cells) else []


def _required(groups: int, reason: str) -> str:
    return f"{groups}: {reason}" if reason else str(groups)


def _names(group: Sequence[Witness]) -> str:
    """The names, with the target if it is wider than the paper's."""
    return ", ".join(w.name + (f" (to {unsigned(w.target)})" if w.target > summary.PAPER else "") for w in group)


def origins(run: Run) -> list[dict[str, str]]:
    """One row per column with its declared engine, theory, rotation terms, sections and eigensolver."""
    rows: dict[str, dict[str, str]] = {}
    for o in run.origins:
        rows[o.code] = {
            "code": o.code,
            "engine": o.engine,
            "theory": o.theory,
            "rotation terms": o.rotation,
            "sections": o.sections,
            "eigensolver": o.eigensolver,
        }
    return list(rows.values())


def headline(run: Run) -> str:
    """The smallest number of independent groups that confirm a blade; empty without declared origins."""
    groups_of_case = {
        case: groups(witnesses(run, case))
        for case in summary.cases(run)
        if any(c.shares for c in run.cells if c.case == case)
    }
    if not groups_of_case or not run.origins:
        return ""
    fewest_case = min(groups_of_case, key=lambda case: len(groups_of_case[case]))
    low, most = len(groups_of_case[fewest_case]), max(len(agreeing) for agreeing in groups_of_case.values())
    fewest_engines = "; ".join(engines(group) for group in groups_of_case[fewest_case])
    span = f"{low} ({fewest_case}{f': {fewest_engines}' if fewest_engines else ''})" + (
        f" to {most}" if most > low else ""
    )
    own = [case for case, agreeing in groups_of_case.items() if agreeing and not any(map(foreign_theory, agreeing))]
    warning = (
        f" No foreign theory agrees for {', '.join(own)}: the codes solve models that Southwell's adapters define."
        if own
        else ""
    )
    return f"Independent groups that agree, for each blade: {span}; codes that share an engine or a theory count once.{warning}"


def missing(run: Run) -> list[str]:
    """One line per blade that fewer groups confirm than its case requires."""
    return [
        f"{s.case}: {s.groups} of {s.required} required independent groups agree: install or add codes, or lower --witnesses"
        for s in under_confirmed(run)
    ]
