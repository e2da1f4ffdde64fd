"""Seeded faults on the turbine that is verified: of core's assembly, and of a code's answers.

A fault of core must let a code *fail* that agrees without it and shares no part of core, or give core's turbine another mass,
mass centre or inertia than the second reading has. A fault of answers alters those of the code, which core must contradict.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from ...core.turbine.turbine import Turbine
from ...references.protocol.description import describe
from ..judge.results import Cell, Control
from ..plan.turbine import TurbineSubject
from ..run.executors import Serial
from ..solve import turbine as solving
from ..solve import turbine_weights
from ..verify import matrix
from . import own
from .seeding import Seam, seeded
from .table import BY_NAME
from .turbines import FAULTS

NAMES = tuple(fault.name for fault in FAULTS)

NO_WITNESS = "an independent code that agrees on this turbine"


def run(subject: TurbineSubject, codes: Sequence[str], names: Sequence[str], reuse: bool = False) -> list[Control]:
    """Run faults on a turbine at its highest speed, against the first of ``codes``; a task for any process."""
    fastest = replace(subject, points=(max(subject.points),))
    faults = [(fault, fault.control(subject.name, *fastest.points)) for fault in (BY_NAME[name] for name in names)]
    if not codes:
        return [replace(control, needs=NO_WITNESS) for _, control in faults]
    descriptions = describe(codes[:1], [])

    def solve() -> tuple[Cell, ...]:
        return matrix.run([fastest], descriptions, Serial(), reuse=reuse, parts=False).cells

    weigh = _weighing(subject)
    out = []
    with seeded((_remembered(),)):
        correct_cells = solve()
        for fault, control in faults:
            with seeded(fault.seams):
                result, weight_failures = own.judged(control, correct_cells, solve()), tuple(weigh())
            by_weight_alone = weight_failures and not result.detected_by
            out.append(replace(control, detected_by=weight_failures) if by_weight_alone else result)
    return out


def _weighing(subject: TurbineSubject) -> Callable[[], list[str]]:
    """A function that returns what core's turbine differs in from the second reading, and did not without faults."""
    weighed = subject.second_reading(subject.deck)[1] if subject.deck else None
    if weighed is None:
        return list

    def failing() -> list[str]:
        rows = turbine_weights.of_solver(subject.name, subject.turbine, weighed)
        return [f"{subject.name}, Southwell's own model, {row.part}: fail" for row in rows if row.verdict == "fail"]

    failing_before_fault = failing()
    return lambda: [line for line in failing() if line not in failing_before_fault]


def _remembered() -> Seam:
    """Each question is put to a code once: what core assembles does not change its answer."""
    answers: dict[tuple[Any, ...], Any] = {}

    def make(original: Callable[..., Any]) -> Callable[..., Any]:
        def ask(name: str, turbine: Turbine, runs: Sequence[Any], *how: Any) -> list[Any]:
            new = [question for question in runs if (name, *question) not in answers]
            answers.update(
                zip([(name, *question) for question in new], original(name, turbine, new, *how), strict=True)
            )
            return [answers[name, *question] for question in runs]

        return ask

    return solving, "turbine_answers", make
