"""The evidence of a run by kind: number of answers, the worst difference of each kind, and where it is."""

from collections import Counter
from collections.abc import Callable, Iterable
from typing import Literal

from ...cases.judge.measured import least, visible
from ...cases.judge.results import Cell, Run, Verdict
from ...cases.judge.witnesses import INDEPENDENT, groups, under_confirmed, witnesses
from ..shared import summary
from ..shared.summary import SYMBOL
from . import properties

KINDS: dict[str, Callable[[Cell], bool]] = {
    "measured data (neither confirm nor contradict)": lambda c: c.role == "measured",
    "codes and closed forms that share nothing with Southwell's own solver": lambda c: (
        c.role != "table" and c.shares == "nothing"
    ),
    "printed tables": lambda c: c.role == "table",
    "codes on Southwell's own model or discretisation": lambda c: bool(c.shares) and c.shares != "nothing",
    "the source's own discretisation": lambda c: c.role == "discretisation",
    "mechanisms: codes and closed forms with the same equations": lambda c: c.role == "same discretisation",
    "other": lambda c: True,
}
"""Kinds of evidence; a cell counts as the first that matches.

The third and fourth kinds check the answer, the fifth only the implementation.
"""

URGENT: dict[Verdict, str] = {"fail": "Worst failure", "inconclusive": "Largest inconclusive difference"}
"""Verdicts reported first, worst first."""

OWN = "Southwell's own solver"
"""What reports call core."""

Answer = Literal["Yes", "No", "Open"]

VERDICT_OF: dict[Answer, Verdict] = {"Yes": "pass", "No": "fail", "Open": "inconclusive"}
"""The verdict whose colour an answer has."""

VISIBLE, CERTAIN = 1e-4, 3.0
"""Smallest difference of a pass that is stated apart, also as a multiple of its uncertainty."""

COMPARED: tuple[Verdict, ...] = ("fail", "inconclusive", "pass", "coarse")
"""Verdicts on a difference from core with the same effects, worst first."""


def verdict(run: Run) -> str:
    """The answer to the question of the report in one sentence, which begins with Yes, No or Open.

    No: an answer contradicts Southwell's own solver. Open: nothing does, but something is missing that a Yes requires.
    """
    counts = summary.counts(run.cells)
    missing = sum(_mute(c) for c in run.cells)
    missing_answers = f"{missing} answer{' is' if missing == 1 else 's are'} missing" if missing else ""
    failed = counts["fail"] - missing
    contradict = f"{failed} {'answer contradicts' if failed == 1 else 'answers contradict'} {OWN}" if failed else ""
    if contradictions := [*properties.contradictions(run), *([contradict] if failed else [])]:
        return f"No: {'; '.join([*contradictions, *([missing_answers] if missing_answers else [])])}."
    unsure = counts["inconclusive"]
    undetected = sum(control.missed for control in run.controls)
    unconfirmed = _unconfirmed(run)
    reasons = (
        "the run was stopped before its end" if run.unfinished else "",
        "" if summary.compared(run.cells) else "nothing was compared",
        missing_answers,
        f"{unsure} answer{' is' if unsure == 1 else 's are'} inconclusive" if unsure else "",
        f"{undetected} seeded fault{' is' if undetected == 1 else 's are'} not detected" if undetected else "",
        f"too few independent groups confirm {', '.join(unconfirmed)}" if unconfirmed else "",
    )
    if any(reasons):
        return f"Open: {'; '.join(reason for reason in reasons if reason)}."
    return f"Yes: nothing contradicts {OWN}."


def word(run: Run) -> Answer:
    """The first word of the verdict."""
    return next(answer for answer in VERDICT_OF if verdict(run).startswith(f"{answer}:"))


def _unconfirmed(run: Run) -> list[str]:
    """Blades with fewer independent groups than required, or with none although codes declare their origin."""
    origins = {o.case for o in run.origins}
    bare = [case for case in summary.cases(run) if case in origins and not groups(witnesses(run, case))]
    return list(dict.fromkeys([*(s.case for s in under_confirmed(run)), *bare]))


def answer(run: Run) -> str:
    """The verdict and the number of cells by verdict."""
    tally = ", ".join(f"{n} {SYMBOL[v]} {v}" for v, n in summary.counts(run.cells).items())
    return f"{verdict(run)} {len(run.cells)} cell{'s' * (len(run.cells) != 1)}: {tally}."


def _mute(cell: Cell) -> bool:
    """Whether a code failed without a frequency to compare."""
    return cell.verdict == "fail" and cell.difference is None


def urgent(run: Run) -> list[str]:
    """Lines on the worst failure, on failures without a number, and on the largest inconclusive difference."""
    largest = {heading: summary.largest(c for c in run.cells if c.verdict == v) for v, heading in URGENT.items()}
    sentences = [
        f"{heading}: {summary.plus_minus(cell)} ({where(run, cell)})." for heading, cell in largest.items() if cell
    ]
    mute = {(c.code, c.case): c.reason.rstrip(".") for c in run.cells if _mute(c)}
    return [*sentences, *(f"Failed without a frequency: {code} ({case}): {why}." for (code, case), why in mute.items())]


def first(run: Run) -> list[str]:
    """The summary of a run: the answer, failures and inconclusive differences, and what discretisation does not explain.

    If there are none, the second line is the independent answer that is farthest from core relative to its target.
    """
    independent = {(case, w.name) for case in summary.cases(run) for w in witnesses(run, case) if w.kind in INDEPENDENT}
    worst = farthest(c for c in run.cells if (c.case, c.code) in independent)
    data = [line for line in (beyond_uncertainty(run), partial(run), measured(run)) if line]
    if not worst or any(c.verdict in summary.BAD for c in run.cells):
        return [answer(run), *properties.lines(run), *urgent(run), *data]
    return [
        answer(run),
        *properties.lines(run),
        f"Worst independent answer, relative to its target: {_shown(run, worst)}.",
        *data,
    ]


def partial(run: Run) -> str:
    """Files of other programs with fewer frequencies than are compared; empty if there are none."""
    compared: dict[str, int] = {}
    for planned in run.plan:
        compared[planned.case] = max(compared.get(planned.case, 0), planned.speeds * planned.cells)
    files = {code for code, version in run.versions.items() if version.startswith("results in ")}
    given = Counter((c.code, c.case) for c in run.cells if c.code in files and c.value is not None)
    listed = "; ".join(
        f"{code} gives {count} of {compared[case]} frequencies ({case})"
        for (code, case), count in given.items()
        if count < compared.get(case, 0)
    )
    return f"Compared in part: {listed}." if listed else ""


def beyond_uncertainty(run: Run) -> str:
    """Codes that pass, but differ by more than ``VISIBLE`` and ``CERTAIN`` times the uncertainty; empty if there are none."""
    largest: dict[str, Cell] = {}
    for cell in run.cells:
        size, uncertain = abs(cell.difference or 0.0), cell.uncertainty
        if cell.verdict == "pass" and cell.role == "code" and uncertain is not None:
            largest_shown = max(
                abs(largest[cell.code].difference or 0.0) if cell.code in largest else VISIBLE, CERTAIN * uncertain
            )
            if size > largest_shown:
                largest[cell.code] = cell
    listed = "; ".join(f"{summary.plus_minus(cell)} ({where(run, cell)})" for cell in largest.values())
    return (
        f"Within the target, but larger than discretisation explains, so the model or the input differs: {listed}."
        if listed
        else ""
    )


def measured(run: Run) -> str:
    """One sentence on the model errors that measured data show; empty without measured data."""
    cells = [c for c in run.cells if c.verdict == "measured"]
    if not cells:
        return ""
    visible_cells = [c for c in cells if visible(c)]
    clearest = max(visible_cells, key=visible, default=None)
    visibly = f"model error visible in {len(visible_cells)}"
    if clearest:
        visibly += f", at least {least(visible(clearest))} ({where(run, clearest)})"
    n, not_visible = len(cells), len(cells) - len(visible_cells)
    return f"Measured: {n} {'frequency' if n == 1 else 'frequencies'}, no evidence: {visibly}; not visible in {not_visible}."


def _statement(cell: Cell) -> str:
    return cell.reason.partition(":")[0]


def _measured(cells: Iterable[Cell]) -> Cell | None:
    """The measured point with the largest visible model error, or otherwise the largest difference."""
    points = [c for c in cells if c.verdict == "measured"]
    return max(points, key=lambda c: (visible(c), abs(c.difference or 0.0)), default=None)


def rows(run: Run) -> list[dict[str, str]]:
    """One row per kind of evidence.

    A row has the cells by verdict and the worst difference from core with the same effects. Known differences, such as those
    of effects that a code declares to omit, are in the sections of the cases.
    """
    out = []
    kinds: dict[str, list[Cell]] = {kind: [] for kind in KINDS}
    for cell in run.cells:
        if summary.size(cell) is not None or cell.verdict in summary.BAD:
            kinds[next(kind for kind, takes in KINDS.items() if takes(cell))].append(cell)
    for kind, cells in kinds.items():
        if cells:
            out.append(
                {
                    "evidence": kind,
                    "answers": summary.tally(cells),
                    "worst, relative to target": _shown(run, farthest(cells) or _measured(cells)),
                }
            )
    return out


def farthest(cells: Iterable[Cell]) -> Cell | None:
    """The cell of the worst verdict in ``COMPARED`` whose difference is the largest relative to its target."""
    cells = list(cells)
    for verdict in COMPARED:
        if matches := [c for c in cells if c.verdict == verdict]:
            return max(matches, key=lambda c: abs(c.difference or 0.0) / c.target)
    return None


def _shown(run: Run, cell: Cell | None) -> str:
    if cell is None:
        return ""
    if cell.difference is None:
        units = summary.units(run, cell.case)
        return f"{SYMBOL[cell.verdict]} {cell.case}, {summary.column(cell)}, {units.at(cell.omega)}: no answer: {cell.reason}"
    cause = f"cause: {cell.reason.partition(';')[0]}"
    explanation = f"target {summary.allowed(cell.target)}" if cell.verdict in COMPARED else cause
    if cell.verdict == "measured":
        explanation = _statement(cell)
    return f"{SYMBOL[cell.verdict]} {summary.plus_minus(cell)}: {where(run, cell)}; {explanation}"


def where(run: Run, cell: Cell) -> str:
    """Case, code, mode and speed of a cell as text."""
    return f"{cell.case}, {summary.column(cell)}, {cell.name}, {summary.units(run, cell.case).at(cell.omega)}"
