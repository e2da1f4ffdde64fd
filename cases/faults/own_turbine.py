"""Seeded faults on the turbine that is verified: of core's assembly, of a code's answers, and of reading its file.

A fault of core must let a code *fail* that agrees without it and shares no part of core, or give core's turbine another mass,
mass centre or inertia than the second reading has. A fault of answers alters those of the code, which core must contradict.
A mistake of reading must differ from the second reading of the file.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...core.blade import BEND_Y, BEND_Z
from ...core.turbine.turbine import Turbine
from ...references.protocol.description import Description, describe
from ...references.protocol.process import Limits
from ..input import readers
from ..judge.results import Cell, Control
from ..plan.column import Column
from ..plan.turbine import TurbineSubject
from ..plan.user_results import UserResults
from ..run.executors import Serial
from ..solve import turbine as solving
from ..solve import turbine_weights
from ..solve.turbine_reading import read_again
from ..verify import matrix
from . import own, own_reading
from .seeding import Seam, seeded
from .table import BY_NAME, FAST
from .turbines import FAULTS, other_tilt, plain_ratio, shaft_of, with_shaft

NAMES = tuple(fault.name for fault in FAULTS)

NO_WITNESS = "an independent code that agrees on this turbine"


@dataclass(frozen=True)
class _Witnessed(TurbineSubject):
    """A turbine with the columns of independent codes only."""

    def columns(
        self, codes: Sequence[Description], limits: Limits, user_results: Sequence[UserResults]
    ) -> list[Column]:
        """See ``Subject``."""
        columns = super().columns(codes, limits, user_results)
        return [column for column in columns if column.head.role == "code" and column.head.shares == "nothing"]


def chosen(names: Sequence[str]) -> tuple[str, ...]:
    """All of ``NAMES`` if ``names`` has all that every run seeds; else those that are in both."""
    return NAMES if set(FAST) <= set(names) else tuple(name for name in names if name in NAMES)


def run(subject: TurbineSubject, codes: Sequence[str], names: Sequence[str], reuse: bool = False) -> list[Control]:
    """Run faults on a turbine at its highest speed, against the first of ``codes``; a task for any process."""
    fastest = _Witnessed(**{**vars(subject), "points": (max(subject.points),)})
    descriptions = describe(codes[:1], [])

    def solve() -> tuple[Cell, ...]:
        return matrix.run([fastest], descriptions, Serial(), reuse=reuse, parts=False).cells

    weigh = _weighing(subject) if codes else list
    out = []
    with seeded((_remembered(),)):
        correct_cells = solve() if codes else ()
        for fault in (BY_NAME[name] for name in names):
            control = fault.control(subject.name, max(subject.points))
            if not codes:
                out.append(replace(control, needs=NO_WITNESS))
                continue
            with seeded(fault.seams):
                control_result, weight_failures = own.judged(control, correct_cells, solve()), tuple(weigh())
            out.append(
                control_result
                if control_result.detected_by or not weight_failures
                else replace(control, detected_by=weight_failures)
            )
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


def _other_side(turbine: Turbine) -> Turbine:
    """The nacelle's mass centre on the other side of the yaw axis."""
    mirror = np.diag([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
    return replace(turbine, nacelle=mirror @ turbine.nacelle @ mirror)


def _exchanged(turbine: Turbine) -> Turbine:
    """Fore-aft and side-to-side stiffness of the tower exchanged."""
    stiffness = turbine.tower.stiffness.copy()
    pair, exchange = [BEND_Y, BEND_Z], [BEND_Z, BEND_Y]
    stiffness[:, pair, pair] = stiffness[:, exchange, exchange]
    return replace(turbine, tower=replace(turbine.tower, stiffness=stiffness))


def _downwind(turbine: Turbine) -> Turbine:
    height, overhang, tilt = shaft_of(turbine)
    return with_shaft(turbine, height, -overhang, tilt)


READER: tuple[tuple[str, str, Callable[[Turbine], Turbine]], ...] = (
    ("reader: tilt's sign", "the tilt of the shaft has the other sign", other_tilt),
    ("reader: overhang's sign", "the rotor is on the other side of the tower", _downwind),
    ("reader: nacelle", "the nacelle's mass centre is on the other side of the yaw axis", _other_side),
    ("reader: gear ratio", "the generator's inertia is multiplied by the ratio instead of its square", plain_ratio),
    ("reader: tower", "fore-aft and side-to-side stiffness of the tower are exchanged", _exchanged),
)
"""Mistakes of reading a turbine: name, what, and from the right turbine to the wrong one."""


def reading(subject: TurbineSubject) -> list[Control]:
    """Run mistakes of reading on a turbine's files (.fst, .htc) and on its blade's; empty for other files."""
    path = subject.deck
    if path is None:
        return []
    blade = readers.reading(path, subject.mount)
    file = readers.BladeFile(path, blade.blade, blade.source, subject.mount)
    fastest = max(subject.points)
    out = own_reading.of_file(subject.name, fastest, file)
    correct_rows = read_again(subject.name, subject.turbine, path, subject.mount)
    failing_before = {row.part for row in correct_rows if row.verdict != "pass"}
    for name, description, alter in READER:
        control = Control(name, "reader", description, "", subject.name, fastest, ())
        if reasons := [row.reason for row in correct_rows if row.verdict == "not run"]:
            out.append(replace(control, needs=reasons[0]))
            continue
        rows = read_again(subject.name, alter(subject.turbine), path, subject.mount)
        parts = [row.part for row in rows if row.verdict == "fail" and row.part not in failing_before]
        detected = tuple(f"{subject.name}, second reading, {part}: fail" for part in parts)
        unchanged = not detected and _alike(subject.turbine, alter(subject.turbine))
        effect = "changes no property of this turbine" if unchanged else ""
        out.append(replace(control, detected_by=detected, without_effect=effect))
    return out


def _alike(a: Turbine, b: Turbine) -> bool:
    return (
        np.allclose(a.nacelle, b.nacelle, rtol=1e-9)
        and np.allclose(a.shaft, b.shaft, atol=1e-12)
        and np.array_equal(a.tower.stiffness, b.tower.stiffness)
        and a.drivetrain == b.drivetrain
    )
