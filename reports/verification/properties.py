"""The second reading of a blade's file, the codes' models and other descriptions of the blade, in words and tables."""

from collections.abc import Iterable, Sequence

from ...cases.judge.results import PropertyCheck, Run, Verdict
from ...cases.judge.verdict import percent, unsigned
from ...cases.solve.properties import CORE
from ..shared.summary import SYMBOL

STATED: tuple[Verdict, ...] = ("fail", "inconclusive")
"""Verdicts that are stated with their reason, the worse first; an inconclusive one contradicts nothing."""


def contradictions(run: Run) -> list[str]:
    """What second readings, models and other descriptions contradict, in the words of the verdict; empty if nothing."""
    out = []
    readings = [c for c in run.property_checks if c.quantity == "reading" and c.verdict == "fail"]
    if readings:
        n = len(readings)
        out.append(
            f"{n} propert{'y' if n == 1 else 'ies'} of the blade differ{'s' * (n == 1)} in a second reading of its file"
        )
    models = _codes(c for c in run.property_checks if c.quantity == "fingerprint" and c.verdict == "fail")
    if models:
        out.append(f"the model of {', '.join(map(_solver, models))} differs from the stations of the blade")
    variant_failures = [c for c in run.property_checks if c.quantity == "invariance" and c.verdict == "fail"]
    if variant_failures:
        n = len(variant_failures)
        out.append(f"frequencies change in {n} other description{'s' * (n != 1)} of the same blade")
    return out


def lines(run: Run) -> list[str]:
    """Lines on properties that fail or cannot be judged, and on what was read a second time or could not be."""
    unsure = [c for c in run.property_checks if c.quantity == "fingerprint" and c.verdict == "inconclusive"]
    out = [
        f"{subject(c)}: {c.reason} ({c.case})." for c in run.property_checks if c.verdict in STATED and c not in unsure
    ]
    out += [_undecided(code, [c for c in unsure if c.code == code]) for code in _codes(unsure)]
    agreeing: dict[str, list[str]] = {}  # reader → properties of blades
    readings = [c for c in run.property_checks if c.quantity == "reading"]
    for case in dict.fromkeys(c.case for c in readings):
        checks = [c for c in readings if c.case == case]
        if all(c.verdict == "pass" for c in checks):
            agreeing.setdefault(f"{checks[0].code} {checks[0].version}", []).append(
                f"{len(checks)} properties of {case}"
            )
        elif checks[0].verdict == "not run":
            out.append(f"Second reading: none: {checks[0].reason} ({case}).")
    for reader, blades in agreeing.items():
        scope = blades[0] if len(blades) == 1 else f"properties of each of {len(blades)} blades"
        out.append(f"Second reading: {reader} reads the same {scope}.")
    return out + _unchanged(run)


def _undecided(code: str, checks: Sequence[PropertyCheck]) -> str:
    """One line on the properties of a code's model that refinement still changes by what they differ; reasons are per case."""
    if len(checks) == 1:
        return f"{subject(checks[0])}: {checks[0].reason} ({checks[0].case})."
    cases = ", ".join(dict.fromkeys(c.case for c in checks))
    return (
        f"Model of {_solver(code)}: {len(checks)} properties need more elements to be judged; the largest differs by "
        f"{size(_largest(checks))} ({cases})."
    )


def _unchanged(run: Run) -> list[str]:
    """One line on the other descriptions of blades whose frequencies are all the same; empty if there are none."""
    checks = [c for c in run.property_checks if c.quantity == "invariance"]
    solved = [c for c in checks if c.verdict == "pass"]
    if not solved or any(c.verdict in STATED for c in checks):
        return []
    largest = max(abs(c.difference or 0.0) for c in solved)
    blades = len({c.case for c in checks})
    of = solved[0].case if blades == 1 else f"{blades} blades"
    return [f"Invariances: frequencies of {of} are equal in {len(solved)} other descriptions, to {unsigned(largest)}."]


def subject(check: PropertyCheck) -> str:
    """What is checked, in words: ``Second reading``, ``Model of pinocchio``, ``Invariance``."""
    return {"reading": "Second reading", "fingerprint": f"Model of {_solver(check.code)}", "invariance": "Invariance"}[
        check.quantity
    ]


def _solver(code: str) -> str:
    return "Southwell's own solver" if code == CORE else code


def readings(run: Run, case: str) -> list[dict[str, str]]:
    """One row for each property of the second reading."""
    return [
        {
            "property": f"{c.part} [{c.unit}]" if c.part else "",
            "largest difference": size(c),
            "verdict": f"{SYMBOL[c.verdict]} {c.reason or c.verdict}",
        }
        for c in run.property_checks
        if c.case == case and c.quantity == "reading"
    ]


def invariances(run: Run, case: str) -> list[dict[str, str]]:
    """One row for each other description of the blade: the largest change of a frequency, and its uncertainty."""
    return [
        {
            "description": c.part,
            "largest change of a frequency": "" if c.difference is None else f"{size(c)} ± {unsigned(c.target)}",
            "verdict": f"{SYMBOL[c.verdict]} {c.reason or c.verdict}",
        }
        for c in run.property_checks
        if c.case == case and c.quantity == "invariance"
    ]


def models(run: Run, case: str) -> list[dict[str, str]]:
    """One row for each code's model: the differences of mass, first moments, inertia and tip flexibility."""
    out = []
    fingerprints = [c for c in run.property_checks if c.case == case and c.quantity == "fingerprint"]
    for code in _codes(fingerprints):
        checks = [c for c in fingerprints if c.code == code]
        by = {c.part: c for c in checks}
        moments, bends = ([c for c in checks if c.part.startswith(kind)] for kind in ("first moment", "tip flex"))
        verdict: Verdict = min(
            (c.verdict for c in checks), key=lambda v: STATED.index(v) if v in STATED else len(STATED)
        )
        reason = next((c.reason for c in checks if c.verdict == verdict and c.reason), verdict)
        out.append(
            {
                "model of": _solver(code),
                "mass": size(by.get("mass")),
                "first moments": size(_largest(moments)),
                "inertia": size(_largest(c for c in checks if "inertia" in c.part)),
                "tip flexibility": size(_largest(bends)),
                "verdict": f"{SYMBOL[verdict]} {reason}",
            }
        )
    return out


def _largest(checks: Iterable[PropertyCheck]) -> PropertyCheck | None:
    return max(checks, key=lambda c: abs(c.difference or 0.0), default=None)


def _codes(checks: Iterable[PropertyCheck]) -> list[str]:
    return list(dict.fromkeys(c.code for c in checks))


def size(check: PropertyCheck | None) -> str:
    """The difference of a property in percent; empty if nothing is compared."""
    if check is None or not check.part:
        return ""
    if check.difference is None:
        return "rigid in one only"
    return percent(check.difference) if abs(check.difference) >= 1e-9 else "0"
