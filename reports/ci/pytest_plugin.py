"""The verification matrix in pytest: a mark with a solver makes one test per blade, speed and mode.

Registered as a ``pytest11`` entry point and so active wherever the package is installed. Other modules are imported
only when a test has the mark.
"""

import fnmatch
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from .pytest_choice import FIXTURE, MARK, PROPERTY, Chosen, tests_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...cases.judge.results import Cell, Level, Setting

HELP = (
    f"{MARK}(solve, name, lacks, levels, order, unsupported, cases, target, known): test a solver on every blade, speed "
    f"and mode; the test uses the fixture {FIXTURE} and calls its check()"
)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the command line options."""
    group = parser.getgroup("southwell", "natural frequencies of rotating blades")
    group.addoption("--southwell-cases", metavar="A,B", help="only these cases (or case/blade) of those in the tests")
    group.addoption(
        "--southwell-target", metavar="X", type=float, help="largest relative difference, instead of the cases'"
    )
    group.addoption(
        "--southwell-report", metavar="DIR", type=Path, help="write report.md and results.jsonl into this folder"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Register the mark and, if a report is wanted, the plug-in that collects results."""
    config.addinivalue_line("markers", HELP)
    if folder := config.getoption("--southwell-report"):
        from .pytest_report import PlanSender, Report

        gathers = PlanSender() if hasattr(config, "workerinput") else Report(folder, config)
        config.pluginmanager.register(gathers, "southwell-report")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Generate a test for every blade, speed and mode."""
    if FIXTURE not in metafunc.fixturenames:
        return
    mark = metafunc.definition.get_closest_marker(MARK)
    if mark is None:
        raise pytest.UsageError(f"{metafunc.definition.nodeid}: uses {FIXTURE} but has no mark {MARK}(solve=…)")
    choices = tests_of(mark, metafunc.config, metafunc.definition.nodeid)
    metafunc.parametrize(FIXTURE, choices, ids=[c.name for c in choices], indirect=True)


@dataclass(frozen=True)
class CellUnderTest:
    """One mode of one blade at one speed, for a test to check."""

    chosen: Chosen
    request: pytest.FixtureRequest
    solved: dict[Any, Any]

    def check(self) -> None:
        """Fail unless the solver's frequency agrees with core and with every printed number that core agrees with.

        A known difference, due to effects that the solver lacks or listed in its mark, is an expected failure
        (``xfail``). A blade that the solver does not support is skipped.
        """
        __tracebackhide__ = True
        from ...cases.plan.column import ColumnError
        from ...cases.verify import user_solver

        choice = self.chosen
        try:
            run = self._once("run", lambda: user_solver.run(choice.solver, choice.case, choice.variant))
        except ColumnError as error:
            raise error.__cause__ or error from None
        cells = [c for c in run.cells if c.omega == choice.omega and c.mode in (0, choice.mode)]
        levels = [v for v in run.levels if v.omega == choice.omega and v.mode == choice.mode]
        self.request.node.user_properties.append((PROPERTY, _packed(cells, levels, run.settings)))
        explained: list[str] = []
        for cell in cells:
            match cell.verdict:
                case "not applicable":
                    pytest.skip(cell.reason)
                case "known difference":
                    explained.append(cell.reason)
                case "fail" | "inconclusive":
                    explained.append(self._stated_cause(cell) or pytest.fail(self._message(cell), pytrace=False))
        if explained:
            pytest.xfail("; ".join(dict.fromkeys(explained)))

    def _stated_cause(self, cell: "Cell") -> str:
        """The cause of a known difference, if the mark lists one that covers it; otherwise empty."""
        from ...cases.judge.verdict import percent, unsigned

        for pattern, (cause, limit) in self.chosen.solver.known.items():
            matches = fnmatch.fnmatchcase(self.chosen.name, pattern) or fnmatch.fnmatchcase(cell.case, pattern)
            if matches and cell.difference is not None and abs(cell.difference) <= limit:
                return f"known, up to {unsigned(limit)}: {cause}: {percent(cell.difference)}"
        return ""

    def _message(self, cell: "Cell") -> str:
        """The message of a failure: the numbers, the verdict, and the most similar fault."""
        from ...cases.verify import fault_effects
        from ...cases.verify.user_solver import alike

        where = f"{cell.case} at {cell.omega:.6g} rad/s, mode {cell.mode} ({cell.family})" if cell.mode else cell.case
        answer = "no answer" if cell.value is None else f"{cell.value:.7g} rad/s"
        expected = "" if cell.reference is None else f", not {cell.reference:.7g}"
        source = f" ({cell.code.partition(', ')[2]})" if cell.role == "table" else ""
        compare, variant = self.chosen.case.text.compare, self.chosen.variant
        similarity = (
            ""
            if cell.difference is None
            else alike(cell, self._once("faults", partial(fault_effects.solve, variant, compare)))
        )
        text = f"{where}: {self.chosen.solver.name}: {answer}{expected}{source}: {cell.verdict}: {cell.reason}"
        return f"{text}; {similarity}" if similarity else text

    def _once(self, label: str, make: Any) -> Any:
        """Compute what all tests of one blade share, once."""
        key = (label, id(self.chosen.solver), self.chosen.variant.name)
        if key not in self.solved:
            self.solved[key] = make()
        return self.solved[key]


@pytest.fixture(scope="session")
def southwell_solved() -> dict[Any, Any]:
    """Results of this session by blade and solver."""
    return {}


@pytest.fixture
def southwell_cell(request: pytest.FixtureRequest, southwell_solved: dict[Any, Any]) -> CellUnderTest:
    """One mode of one blade at one speed, to be checked."""
    return CellUnderTest(request.param, request, southwell_solved)


def _packed(cells: "Sequence[Cell]", levels: "Sequence[Level]", settings: "Sequence[Setting]") -> str:
    """Serialise one test's rows for the report; text can be sent from a worker process."""
    import msgspec

    return msgspec.json.encode({"cells": cells, "levels": levels, "settings": settings}).decode()
