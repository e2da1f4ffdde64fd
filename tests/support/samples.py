"""A run made by hand: two cases, every role, every verdict; frequencies follow ``f² = f₀² + k Ω²``."""

import math

from southwell.cases.judge.results import Cell, Level, Run
from southwell.cases.judge.verdict import judge

BEAM = (("edgewise", 10.55, 0.26), ("flapwise", 10.55, 1.26), ("edgewise", 66.1, 6.0), ("flapwise", 66.1, 7.0))
"""Family, frequency at rest (rad/s), Southwell's coefficient."""

SPEEDS = (0.0, 10.0, 20.0, 30.0)

CODES = {
    "alpha": (3e-2, 2, "2.1", (8, 16, 32, 64)),
    "beta": (-8.0, 4, "0.9", (10, 20, 40)),
    "gamma": (2e-1, 2, "1.0", (10, 20, 40)),
}
"""Name → error constant, order, version, elements."""


def frequency(rest: float, coefficient: float, omega: float) -> float:
    return math.sqrt(rest**2 + coefficient * omega**2)


def cell(**changes: object) -> Cell:
    """A passing cell of case ``beam`` with some fields changed."""
    fields: dict[str, object] = {
        "case": "beam",
        "omega": 10.0,
        "mode": 1,
        "family": "edgewise",
        "ordinal": 1,
        "code": "alpha",
        "version": "2.1",
        "role": "code",
        "value": 11.70006,
        "reference": 11.7,
        "difference": 5.1e-6,
        "uncertainty": 2e-6,
        "target": 1e-3,
        "verdict": "pass",
        "full": 11.7,
        "elements": 64,
        "order": 2.0,
        "mac": 1.0,
    }
    return Cell(**{**fields, **changes})  # type: ignore[arg-type]


def empty(verdict: str, reason: str, **changes: object) -> Cell:
    """A cell without an answer."""
    blank = dict.fromkeys(("value", "reference", "difference", "uncertainty", "full", "elements", "order", "mac"))
    return cell(mode=0, family="", ordinal=0, verdict=verdict, reason=reason, **blank, **changes)


def run() -> Run:
    """A run with a code that passes, one with a known difference, one that fails, one absent, one that cannot."""
    cells, levels = [], []
    for omega in SPEEDS:
        for mode, (family, rest, coefficient) in enumerate(BEAM, 1):
            f = frequency(rest, coefficient, omega)
            for code, (constant, order, version, elements) in CODES.items():
                errors = [constant * mode * n**-order * (1 + 0.02 * omega) for n in elements]
                d = errors[-1] * 0.05
                u = abs(errors[-1]) * 0.1
                verdict, reason = judge(d, u, 1e-3)
                if code == "gamma" and mode == 3:
                    d, verdict, reason = (
                        2.5e-3,
                        "known difference",
                        "no rotary inertia: +0.25 % (core with and without)",
                    )
                cells.append(
                    cell(
                        omega=omega,
                        mode=mode,
                        family=family,
                        ordinal=(mode + 1) // 2,
                        code=code,
                        version=version,
                        value=f * (1 + d),
                        reference=f,
                        full=f,
                        difference=d,
                        uncertainty=u,
                        verdict=verdict,
                        reason=reason,
                        elements=elements[-1],
                        order=order * 1.01,
                    )
                )
                levels += [
                    Level("beam", omega, mode, code, n, f * (1 + e)) for n, e in zip(elements, errors, strict=True)
                ]
        cells.append(empty("not run", "not installed: pip install delta", omega=omega, code="delta", version=""))
    short = {"case": "blade/stiff", "full": 2.0, "reference": 2.0}
    cells += [
        cell(
            **short,
            code="alpha",
            value=2.01,
            difference=5e-3,
            uncertainty=1e-4,
            verdict="fail",
            reason="+0.5 % ± 0.01 % exceeds 0.1 %",
        ),
        cell(
            **short,
            code="beta",
            value=2.001,
            difference=5e-4,
            uncertainty=None,
            verdict="inconclusive",
            reason="unknown uncertainty",
        ),
        empty("not applicable", "gamma: one bending stiffness only", case="blade/stiff", code="gamma"),
    ]
    return Run(tuple(cells), tuple(levels), {"southwell": "0.1.0", "alpha": "2.1"}, "southwell verify beam")
