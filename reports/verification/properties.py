"""The second reading of a blade's file and the mass and inertia of the codes' models, in words and tables."""

from collections.abc import Iterable

from ...cases.judge.results import PropertyCheck, Run, Verdict
from ...cases.judge.verdict import percent
from ..shared.summary import SYMBOL

STATED: tuple[Verdict, ...] = ("fail", "inconclusive")
"""Verdicts that are stated with their reason, the worse first; an inconclusive one contradicts nothing."""


def contradictions(run: Run) -> list[str]:
    """What second readings and models contradict, in the words of the verdict; empty if nothing."""
    out = []
    readings = [c for c in run.property_checks if c.quantity == "reading" and c.verdict == "fail"]
    if readings:
        n = len(readings)
        out.append(
            f"{n} propert{'y' if n == 1 else 'ies'} of the blade differ{'s' * (n == 1)} in a second reading of its file"
        )
    models = _codes(c for c in run.property_checks if c.quantity == "fingerprint" and c.verdict == "fail")
    if models:
        out.append(f"the model of {', '.join(models)} differs from the stations of the blade")
    return out


def lines(run: Run) -> list[str]:
    """Lines on properties that fail or cannot be judged, and on what was read a second time or could not be."""
    out = [f"{_what(c)}: {c.reason} ({c.case})." for c in run.property_checks if c.verdict in STATED]
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
        what = blades[0] if len(blades) == 1 else f"properties of each of {len(blades)} blades"
        out.append(f"Second reading: {reader} reads the same {what}.")
    return out


def _what(check: PropertyCheck) -> str:
    return "Second reading" if check.quantity == "reading" else f"Model of {check.code}"


def readings(run: Run, case: str) -> list[dict[str, str]]:
    """One row for each property of the second reading."""
    return [
        {
            "property": f"{c.part} [{c.unit}]" if c.part else "",
            "largest difference": _size(c),
            "verdict": f"{SYMBOL[c.verdict]} {c.reason or c.verdict}",
        }
        for c in run.property_checks
        if c.case == case and c.quantity == "reading"
    ]


def models(run: Run, case: str) -> list[dict[str, str]]:
    """One row for each code's model: the differences of mass, first moments, inertia and tip flexibility."""
    out = []
    mine = [c for c in run.property_checks if c.case == case and c.quantity == "fingerprint"]
    for code in _codes(mine):
        checks = [c for c in mine if c.code == code]
        by = {c.part: c for c in checks}
        moments, bends = ([c for c in checks if c.part.startswith(what)] for what in ("first moment", "tip flex"))
        verdict: Verdict = min(
            (c.verdict for c in checks), key=lambda v: STATED.index(v) if v in STATED else len(STATED)
        )
        reason = next((c.reason for c in checks if c.verdict == verdict and c.reason), verdict)
        out.append(
            {
                "model of": code,
                "mass": _size(by.get("mass")),
                "first moments": _size(_largest(moments)),
                "inertia": _size(by.get("inertia about the rotor's axis")),
                "tip flexibility": _size(_largest(bends)),
                "verdict": f"{SYMBOL[verdict]} {reason}",
            }
        )
    return out


def _largest(checks: Iterable[PropertyCheck]) -> PropertyCheck | None:
    return max(checks, key=lambda c: abs(c.difference or 0.0), default=None)


def _codes(checks: Iterable[PropertyCheck]) -> list[str]:
    return list(dict.fromkeys(c.code for c in checks))


def _size(check: PropertyCheck | None) -> str:
    if check is None or not check.part:
        return ""
    if check.difference is None:
        return "rigid in one only"
    return percent(check.difference) if abs(check.difference) >= 1e-9 else "0"
