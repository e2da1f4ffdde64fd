"""The solution of a blade's Campbell diagram, with a progress bar, by one or several processes, and its confirmation."""

import os
from collections.abc import Sequence
from concurrent.futures import Executor
from contextlib import ExitStack

from rich.progress import TextColumn

from ....cases.campbell import confirmation
from ....cases.campbell.confirmation import Confirmed
from ....cases.campbell.diagram import Campbell, CampbellRequest, campbell, solver
from ....cases.campbell.tracking import Solver
from ....cases.input.default_case import default_case
from ....cases.plan.request import Execution, Request
from ....cases.run.executors import Processes
from ....cases.verify import pipeline
from ....core.blade import Blade
from ....core.modes import Modes
from ...shared.console import Display
from ...shared.units import RPM, Units
from ..verify_output import Progressing
from .subjects import Subject


def solve(blade: Blade, request: CampbellRequest, units: Units, workers: int = 1) -> Campbell:
    """Compute the diagram and show progress; ``workers`` processes share the requested speeds.

    Raises:
        CaseError: as ``campbell``.
    """
    progress = SpeedProgress(blade.name, request.speeds, units)
    with ExitStack() as stack:
        stack.enter_context(progress)
        local_solver = solver(blade, request, progress, units.at)
        if workers == 1:
            return campbell(blade, request, local_solver)
        pool = Processes(min(workers, len(request.speeds)))
        stack.callback(pool.stop)
        return campbell(blade, request, _shared(blade, request, pool, local_solver, progress, units))


class SpeedProgress(Display):
    """A progress bar on standard error over the requested speeds; others are shown as they are solved."""

    def __init__(self, name: str, speeds: Sequence[float], units: Units) -> None:
        super().__init__(
            TextColumn("{task.fields[name]}", markup=False), TextColumn("{task.description}", markup=False)
        )
        self.asked, self.units = set(speeds), units
        self.task = self.bar.add_task("", total=len(speeds), name=name)

    def __call__(self, omega: float) -> None:
        """Record that a speed is solved."""
        if omega in self.asked:
            self.bar.update(self.task, advance=1, description=self.units.at(omega))
        else:
            self.bar.update(self.task, description=f"inserting {self.units.at(omega)}")


def _shared(
    blade: Blade,
    request: CampbellRequest,
    executor: Executor,
    local_solver: Solver,
    progress: SpeedProgress,
    units: Units,
) -> Solver:
    """A solver: ``executor`` starts on the requested speeds at once; ``local_solver`` solves other speeds on demand."""
    futures = {omega: executor.submit(_one, blade, request, omega, units) for omega in request.speeds}

    def answer(omega: float) -> Modes:
        if omega not in futures:
            return local_solver(omega)
        modes = futures[omega].result()
        progress(omega)
        return modes

    return answer


def _one(blade: Blade, request: CampbellRequest, omega: float, units: Units) -> Modes:
    return solver(blade, request, at=units.at)(omega)


def confirmed_by(diagram: Campbell, subject: Subject, units: Units) -> tuple[Confirmed, ...]:
    """Run all codes; return the codes that confirm each line."""
    case = default_case(
        subject.blade,
        confirmation.speeds(diagram),
        rpm=units is RPM,
        source="; ".join(subject.about),
        modes=diagram.request.modes,
    )
    request = Request((case,), faults="none", execution=Execution(workers=os.cpu_count() or 1))
    run = pipeline.verify(request, Progressing())
    return confirmation.confirmations(diagram, run)
