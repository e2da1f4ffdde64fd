"""``southwell campbell``: a blade's Campbell diagram, its tables, mode shapes and figures, in one command."""

import os
import shlex
import sys
from collections.abc import Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from ...cases.campbell.diagram import Campbell, Wanted, campbell, solver
from ...cases.campbell.tracking import Solver
from ...cases.input.errors import CaseError
from ...cases.verify.pool import Pool
from ...core.blade import Blade
from ...core.modes import Modes
from ..campbell import page
from ..campbell import tables as tables
from ..shared import not_used
from ..shared.console import output
from ..shared.paths import file_name
from ..shared.units import Units
from . import campbell_options as options
from .arguments import Accuracy, Elements, Flag, Whole, Workers
from .mounting import Mounting
from .subjects import Subject
from .subjects import subjects as find_subjects


def command(
    blade: str,
    /,
    *,
    rpm: str | None = None,
    omega: str | None = None,
    out: Annotated[Path, Parameter(name=["--out", "-o"])] = Path("southwell-campbell"),
    modes: Whole = 6,
    per_rev: str = "1:6",
    operating: str | None = None,
    margin: str = "10%",
    elements: Elements | None = None,
    accuracy: Accuracy = 1e-6,
    allow_large_strain: Flag = False,
    azimuth: float | None = None,
    tilt: float = 0.0,
    load: Path | None = None,
    workers: Workers = 1,
    mounting: Mounting | None = None,
) -> int:
    """A blade's Campbell diagram: modes by name along rotor speed, where they meet n per revolution or each other.

    Prints tables; writes campbell.md, figures (SVG, PNG) of the diagram and of the mode shapes, and CSV. A step of speed
    is halved where modes come so near that it is not clear which is which.

    Parameters
    ----------
    blade
        A blade's file: ElastoDyn, BeamDyn, BModes, HAWC2, windIO, or Southwell's own TOML and CSV. Or a case by name
        (`southwell cases`), one of its blades as `case/blade`, or its TOML file.
    rpm
        Rotor speeds in revolutions per minute: `first:last:step` with both ends, or a list `0,5,10`; a case's own speeds by
        default.
    omega
        The same in rad/s.
    out
        Folder for figures and tables; of several blades, each has a folder in it.
    modes
        How many, from the lowest.
    per_rev
        Multiples of the rotor's speed that excite: `1:6`, or `1,2,3,6`.
    operating
        Speeds between which the rotor runs, as `6.9:12.1`, in the unit of the speeds; margins are judged over it.
    margin
        How far modes should keep from n per revolution over it, in parts of n per revolution: `10%`, `10` or `0.1`.
    elements
        Beam elements of equal length along the blade; by default, as many at each speed as --accuracy takes.
    accuracy
        Largest relative uncertainty of a frequency, without --elements.
    allow_large_strain
        Accept steady strains above 20 %.
    azimuth
        Degrees from the blade pointing up, in the direction of rotation: the blade under gravity there. Without: no gravity.
    tilt
        Degrees the rotor's axis points above the horizontal; with --azimuth.
    load
        A steady load that bends the blade before it vibrates: a CSV table of `fraction [-]`, `fx [N/m]`, `fy [N/m]`,
        `fz [N/m]`, in axes that turn with the hub (x outwards, y in the direction of motion, z along the rotor's axis).
    workers
        Processes that share the speeds; starting one costs about as much as twenty speeds.
    """
    given = options.speeds(rpm, omega)
    subjects = find_subjects(blade, (mounting or Mounting()).mount())
    for subject in subjects:
        if not (given or subject.speeds):
            raise CaseError(f"--rpm: missing: {blade} says no speeds: give them, as in 0:15:0.5")
        speeds, units = given or (subject.speeds, subject.units)
        wanted = Wanted(
            speeds=tuple(speeds),
            modes=modes,
            per_rev=options.per_rev(per_rev),
            operating=options.operating(operating, units, speeds) if operating else None,
            margin=options.margin(margin),
            elements=elements,
            accuracy=accuracy,
            allow_large_strain=allow_large_strain,
            gravity=options.gravity(azimuth, tilt),
            load=options.load(load, subject.blade),
        )
        folder = out / file_name(subject.blade.name.partition("/")[2]) if len(subjects) > 1 else out
        _check(out)
        diagram = solve(subject.blade, wanted, units, workers)
        _show(diagram, units, subject)
        try:
            line = shlex.join(["southwell", *sys.argv[1:]])
            written = page.write(diagram, folder, units, line, (*subject.about, *not_used.lines(subject.unused)))
        except OSError as error:
            raise _unwritable(out, error.strerror) from error
        names = ", ".join(path.name for path in written)
        output().print(f"{folder}: {names}", markup=False, soft_wrap=True)
    return 0


def _check(out: Path) -> None:
    """Before minutes of work: whether a folder is there, or can be made."""
    there = next((path for path in (out, *out.parents) if os.path.exists(path)), Path())
    if not os.path.isdir(there):
        raise _unwritable(out, f"{there} is a file")
    if not os.access(there, os.W_OK):
        raise _unwritable(out, f"no permission in {there}")


def _unwritable(out: Path, why: str | None) -> CaseError:
    return CaseError(f"--out {out}: cannot be written ({why}): give another folder")


def solve(blade: Blade, wanted: Wanted, units: Units, workers: int = 1) -> Campbell:
    """The diagram with progress; ``workers`` processes share the speeds asked for.

    Raises:
        CaseError: what ``campbell`` raises.
    """
    told = Told(blade.name, wanted.speeds, units)
    with ExitStack() as stack:
        stack.enter_context(told.bar)
        here = solver(blade, wanted, told, units.at)
        if workers == 1:
            return campbell(blade, wanted, here)
        pool = Pool(min(workers, len(wanted.speeds)))
        stack.callback(pool.stop)
        return campbell(blade, wanted, _shared(blade, wanted, pool, here, told, units))


class Told:
    """A bar on standard error over the speeds asked for; speeds between, where modes meet, are named as they come."""

    def __init__(self, name: str, speeds: Sequence[float], units: Units) -> None:
        console = Console(stderr=True, highlight=False)
        self.asked, self.units = set(speeds), units
        self.bar = Progress(
            SpinnerColumn(),
            TextColumn("{task.fields[name]}", markup=False),
            BarColumn(bar_width=30),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TextColumn("{task.description}", markup=False),
            console=console,
            transient=True,
            disable=not console.is_terminal,
        )
        self.task = self.bar.add_task("", total=len(speeds), name=name)

    def __call__(self, omega: float) -> None:
        """Hear that a speed is done."""
        if omega in self.asked:
            self.bar.update(self.task, advance=1, description=self.units.at(omega))
        else:
            self.bar.update(self.task, description=f"modes meet: looking closer at {self.units.at(omega)}")


def _shared(blade: Blade, wanted: Wanted, executor: Executor, here: Solver, told: Told, units: Units) -> Solver:
    """A solver that has the speeds asked for solved by ``executor`` from the start, and others ``here`` as they come."""
    ahead = {omega: executor.submit(_one, blade, wanted, omega, units) for omega in wanted.speeds}

    def answer(omega: float) -> Modes:
        if omega not in ahead:
            return here(omega)
        found = ahead[omega].result()
        told(omega)
        return found

    return answer


def _one(blade: Blade, wanted: Wanted, omega: float, units: Units) -> Modes:
    return solver(blade, wanted, at=units.at)(omega)


def _show(diagram: Campbell, units: Units, subject: Subject) -> None:
    console = output()
    for line in subject.about:
        console.print(line, style="dim", markup=False)
    not_used.show(subject.unused, console)
    console.print()
    for sheet in tables.sheets(diagram, units):
        console.print(tables.terminal(sheet))
        console.print()
    for line in tables.notes(diagram, units):
        console.print(line, style="yellow", markup=False, soft_wrap=True)
    line = tables.verdict(diagram, units)
    console.print(line, style="bold red" if line.startswith(tables.TOO_NEAR) else "bold", markup=False)
