"""Faults in counting independent confirmations, and the canaries that must detect them: witnesses with known groups."""

from typing import Any

from southwell.cases.faults.seeding import Seam
from southwell.cases.judge import witnesses
from southwell.cases.judge.results import Cell, Origin, Run, Setting
from southwell.cases.judge.witnesses import groups, under_confirmed
from southwell.references.protocol.interface import CORE

CASE = "canary"

STANDINGS = ("agrees", "coarse", "known difference", "estimate", "open", "disagrees")


def _cell(code: str, **changes: Any) -> Cell:
    values: dict[str, Any] = {
        "case": CASE, "omega": 10.0, "mode": 1, "family": "flapwise", "code": code, "version": "1", "role": "code",
        "value": 10.0, "reference": 10.0, "difference": 1e-5, "uncertainty": 1e-6, "target": 1e-3, "verdict": "pass",
        "shares": "nothing",
    }  # fmt: skip
    return Cell(**{**values, **changes})


def _origin(code: str, engine: str = "", theory: str = "", rotation: str = "", sections: str = "blade") -> Origin:
    own = f"of {code}"
    return Origin(CASE, code, engine or own, theory or own, rotation or own, sections, own)


def _run(*parts: tuple[Cell, Origin | None], required: int = 0) -> Run:
    setting = Setting(CASE, "", "", "", "rad_s", groups=required, target=1e-3)
    origins = tuple(origin for _, origin in parts if origin)
    return Run(tuple(cell for cell, _ in parts), settings=(setting,), origins=origins)


ONE = (_cell("robin"), _origin("robin"))
TWO = (_cell("wren"), _origin("wren"))

COUNTS: dict[str, tuple[Run, int]] = {
    "two of different origin": (_run(ONE, TWO), 2),
    "two of one engine": (_run(ONE, (_cell("wren"), _origin("wren", engine="of robin"))), 1),
    "two of one theory": (_run(ONE, (_cell("wren"), _origin("wren", theory="of robin"))), 1),
    "two with the same rotation terms": (_run(ONE, (_cell("wren"), _origin("wren", rotation="of robin"))), 1),
    "one on core's discretisation": (_run(ONE, (_cell("wren", shares="discretisation"), _origin("wren"))), 1),
    "one with core's frames": (_run(ONE, (_cell("wren"), _origin("wren", sections=CORE))), 1),
    "one that declares nothing": (_run(ONE, (_cell("wren"), None)), 1),
    "one that disagrees in one mode": (
        _run(ONE, TWO, (_cell("wren", mode=2, difference=2e-3, verdict="fail"), None)), 1),
    "one with a known difference": (
        _run(ONE, (_cell("wren", difference=0.1, verdict="known difference"), _origin("wren"))), 1),
    "an inconclusive one": (
        _run(ONE, (_cell("wren", difference=0.1, uncertainty=0.5, verdict="estimate"), _origin("wren"))), 1),
    "a table with a wider target": (
        _run(ONE, (_cell("wren", role="table", target=2e-2, difference=1e-2), _origin("wren"))), 1),
}  # fmt: skip


def canaries() -> list[str]:
    """Wrong counts of the canaries; empty if all are correct."""
    altered = []
    for kind, (run, expected) in COUNTS.items():
        result = len(groups(witnesses.witnesses(run, CASE)))
        if result != expected:
            altered.append(f"groups: {kind}: {result} counted, not {expected}")
    alone = under_confirmed(_run(ONE, required=2))
    if [(s.groups, s.required) for s in alone] != [(1, 2)] or under_confirmed(_run(ONE, TWO, required=2)):
        altered.append("groups: one of two required is not reported as too few")
    return altered


def _without(field: str) -> Any:
    return lambda original: tuple(name for name in original if name != field)


FAULTS: dict[str, Seam] = {
    "codes that share an engine or a theory count twice": (witnesses, "_linked", lambda right: lambda a, b: False),
    "shared rotation terms are ignored": (witnesses, "INDEPENDENCE_FIELDS", _without("rotation")),
    "codes with core's discretisation or frames count": (
        witnesses,
        "_kind",
        lambda right: lambda cell, origin: "code",
    ),
    "every witness agrees": (witnesses, "_worst", lambda right: lambda standings: "agrees"),
    "agreement in one mode is enough": (
        witnesses,
        "_worst",
        lambda right: lambda standings: min(standings, key=STANDINGS.index, default="agrees"),
    ),
    "no number of groups is required": (witnesses, "groups", lambda right: lambda groups: [tuple(groups)] * 9),
}
"""What a wrong program does, and the seam of the fault."""
