"""The tests that a mark makes: its solver on the blades, speeds and modes of the cases that it or the command line names.

Other modules are imported only when a test has the mark.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from ...cases.input.schema import Case, Variant
    from ...cases.verify.user_solver import UserSolver

MARK, FIXTURE, PROPERTY = "southwell", "southwell_cell", "southwell"
"""Names of the mark, of its fixture, and of the property of a test that holds its rows for the report."""


@dataclass(frozen=True)
class Chosen:
    """One test: a solver, a blade, a speed (rad/s) and the number of a compared mode, from 1."""

    solver: "UserSolver"
    case: "Case"
    variant: "Variant"
    omega: float
    mode: int

    @property
    def name(self) -> str:
        """Identifier in the test's name, such as ``park-cantilever-10rad_s-mode1``."""
        return f"{self.variant.name}-{self.omega:.6g}rad_s-mode{self.mode}"


def tests_of(mark: pytest.Mark, config: pytest.Config, where: str) -> list[Chosen]:
    """The tests of a mark: one for each blade, speed and mode of the cases that it or the command line names.

    Raises:
        UsageError: naming ``where`` (the test function): wrong arguments of the mark, an unknown case, or a blade twice.
    """
    from ...cases.input.errors import CaseError
    from ...cases.input.library import select
    from ...cases.plan.blade import blades
    from ...cases.plan.names import unique
    from ...cases.verify.user_solver import UserSolver

    target = config.getoption("--southwell-target")
    try:
        solver = UserSolver(*mark.args, **{**mark.kwargs, **({"target": target} if target else {})})
        solver.effects  # noqa: B018  (checks the names of effects)
    except TypeError as error:
        raise pytest.UsageError(f"{where}: mark {MARK}: {error}") from error
    names = config.getoption("--southwell-cases")
    try:
        named_cases = [select(n) for n in names.split(",")] if names else None
        cases = [select(n) for n in solver.cases] or named_cases or _all()
        unique(blades(*cases), [], [])
        variants = {v.name for c in named_cases or cases for v in c.variants}
    except CaseError as error:
        raise pytest.UsageError(f"{where}: {error}") from error
    return [
        Chosen(solver, case, variant, omega, k)
        for case in cases
        for variant in case.variants
        if variant.name in variants
        for omega in variant.speeds.tolist()
        for k in range(1, case.text.compare.modes + 1)
    ]


def _all() -> "list[Case]":
    """Every case whose files are present."""
    from ...cases.input import library

    present, _ = library.load_all()
    return list(present.values())
