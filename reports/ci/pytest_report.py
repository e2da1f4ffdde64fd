"""The report of a pytest session: results.jsonl and report.md of all tests with the mark.

Other modules are imported only when there is something to report.
"""

import shlex
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from .pytest_choice import FIXTURE, PROPERTY, Chosen

if TYPE_CHECKING:
    from ...cases.judge.results import Planned, Run
    from ...cases.store.unfinished import Unfinished


def _planned(session: pytest.Session) -> list[list[Any]]:
    """Case, solver, speed and mode of every selected test.

    Raises:
        UsageError: if two tests have solvers of the same name, whose rows a report could not distinguish.
    """
    planned, owners = [], {}
    for item in session.items:
        choice = getattr(item, "callspec", None) and item.callspec.params.get(FIXTURE)  # type: ignore[attr-defined]
        if isinstance(choice, Chosen):
            owner = item.nodeid.partition("[")[0]
            first = owners.setdefault((choice.variant.name, choice.solver.name), owner)
            if first != owner:
                raise pytest.UsageError(
                    f"{first} and {owner}: both solvers are named {choice.solver.name!r}: give name=…"
                )
            planned.append([choice.variant.name, choice.solver.name, choice.omega, choice.mode])
    return planned


class PlanSender:
    """Sends the selected tests from a worker process of pytest-xdist to the process that writes the report."""

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """Attach the selected tests to the worker's output."""
        session.config.workeroutput[PROPERTY] = _planned(session)  # type: ignore[attr-defined]


class Report:
    """Collects the results of tests and writes the report at the end of the session.

    Until then the folder has the file of an unfinished run, as with ``southwell verify``.
    """

    def __init__(self, folder: Path, config: pytest.Config) -> None:
        self.folder, self.config = folder, config
        self.parts: list[str] = []
        self.planned: list[list[Any]] = []
        self.unfinished = ""
        self.open = ExitStack()
        self.file: Unfinished | None = None

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """Record the selected tests, if this process runs them."""
        self.planned += _planned(session)
        if self.planned:
            self._begin()

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any) -> None:
        """Record the selected tests of a worker process; each worker has the whole list."""
        self.planned = self.planned or getattr(node, "workeroutput", {}).get(PROPERTY, [])

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Keep the result of one test."""
        parts = [str(value) for name, value in report.user_properties if name == PROPERTY]
        if report.when == "call" and parts:
            self._begin()
            self.parts += parts

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self) -> None:
        """Write results.jsonl and report.md.

        A stopped run keeps its file instead of results.jsonl; its report does not replace that of a complete run.
        """
        if self.file is None:
            return
        from ...cases.store import codec, results_file
        from ..verification import report as matrix_report

        run = self._run()
        self.unfinished = run.unfinished
        path = self.folder / "results.jsonl"
        with self.open:
            try:
                if not run.unfinished:
                    results_file.write(path, run)
                if not run.unfinished or not path.exists():
                    matrix_report.write(run, self.folder)
                if not run.unfinished:
                    self.file.remove()
                else:
                    self.file.begin(run)
                    self.file.put("pytest", True, codec.encode((list(run.cells), list(run.levels))))
            except OSError as error:
                raise self._unwritable(error) from error

    def pytest_terminal_summary(self, terminalreporter: Any) -> None:
        """Print where the report is, and whether it is complete."""
        if self.unfinished:
            terminalreporter.write_line(f"southwell: {self.folder}: Incomplete: {self.unfinished}.")
        elif self.parts:
            terminalreporter.write_line(f"southwell: {self.folder / 'report.md'}")

    def _begin(self) -> None:
        """Lock the folder and begin the file of an unfinished run, which marks the run as unfinished."""
        if self.file is not None:
            return
        from ...cases.input.errors import CaseError
        from ...cases.judge.results import Run
        from ...cases.store import unfinished

        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self.open.enter_context(unfinished.locked(self.folder))
            self.file = self.open.enter_context(unfinished.Unfinished(self.folder))
            self.file.begin(Run((), command=self._command()))
        except CaseError as error:
            raise pytest.UsageError(f"--southwell-report: {error}") from error
        except OSError as error:
            raise self._unwritable(error) from error

    def _unwritable(self, error: OSError) -> pytest.UsageError:
        return pytest.UsageError(f"--southwell-report {self.folder}: cannot be written ({error.strerror})")

    def _command(self) -> str:
        return shlex.join(["pytest", *self.config.invocation_params.args])

    def _run(self) -> "Run":
        import msgspec

        from ...cases.judge.results import Cell, Level, Run, Setting
        from ...cases.verify import matrix

        decoded = [msgspec.json.decode(part) for part in self.parts]

        def rows(kind: str, row: Any) -> tuple[Any, ...]:
            """Unique rows: tests of one blade repeat its setting, and the cell of a speed without an answer."""
            distinct = {msgspec.json.encode(entry): entry for part in decoded for entry in part[kind]}
            return tuple(msgspec.convert(entry, row) for entry in distinct.values())

        cells = rows("cells", Cell)
        answered = {(c.case, c.code, c.omega, c.mode) for c in cells}
        missing = [t for t in self.planned if not {(*t[:3], t[3]), (*t[:3], 0)} & answered]
        problem = f"{len(missing)} of {len(self.planned)} tests gave no cell" if missing else ""
        return Run(
            cells=cells,
            levels=rows("levels", Level),
            versions=matrix.versions({}),
            command=self._command(),
            settings=rows("settings", Setting),
            plan=self._plan(),
            unfinished=problem if self.planned else "the plan of the run is unknown",
        )

    def _plan(self) -> "tuple[Planned, ...]":
        from ...cases.judge.results import Planned

        modes: dict[tuple[str, str], dict[float, int]] = {}
        for case, code, omega, _ in self.planned:
            of = modes.setdefault((case, code), {})
            of[omega] = of.get(omega, 0) + 1
        return tuple(Planned(case, code, len(of), min(of.values())) for (case, code), of in modes.items())
