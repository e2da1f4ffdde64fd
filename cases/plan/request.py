"""What a run is asked, and the command line that asks it again."""

import shlex
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import degrees, pi, radians
from pathlib import Path

from ...references.protocol.process import Limits
from ..input.errors import CaseError
from ..input.readers import Mount
from ..input.schema import Case, speed_range
from .subject import Subject

RPM_PER_RAD_S = 30.0 / pi
"""Revolutions per minute in 1 rad/s."""


@dataclass(frozen=True)
class Execution:
    """Where and how a run is executed, which its results do not depend on.

    Attributes:
        workers: number of processes, or of Slurm's workers; None for the workers of a running scheduler; 0 to run
            everything in this thread.
        scheduler: see ``cases.run.executors``.
        threads: run in threads of this process; seeded faults then follow, in this thread.
        out: folder for results and, until they are complete, for the answers of the run; None: none are kept.
        fresh: compute every answer again.
    """

    workers: int | None = 1
    scheduler: str | None = None
    threads: bool = False
    out: Path | None = None
    fresh: bool = False


@dataclass(frozen=True)
class Request:
    """Everything that a run is asked.

    Attributes:
        subjects: cases and mechanisms by name, files of these or of blades, or as read; all cases if empty.
        codes: names or import paths of codes; None for all.
        rpm, omega: rotor speeds of blade files as text, in rpm or rad/s.
        mount: mounting of blade files.
        blade_only: whether a turbine's file stands for one of its blades, clamped at the hub.
        changes: changes of every blade's properties, as text: ``EI_flap=*1.1``.
        add: results of other programs and measurements: ``NAME=FILE.csv``.
        data_uncertainty, input_uncertainty: of measured rows without one, as text: ``1%``.
        faults: seeded faults: ``fast``, ``all``, ``none``, or names separated by commas.
        witnesses: number of groups that must confirm each blade; None: as the case says, or none with ``codes``.
        time_limit: for one solution, s; None: as the case says.
        memory_limit: for one solution, GiB.
        execution: where and how the run is executed.
    """

    subjects: tuple[str | Case | Subject, ...] = ()
    codes: tuple[str, ...] | None = None
    rpm: str | None = None
    omega: str | None = None
    mount: Mount = field(default_factory=Mount)
    blade_only: bool = False
    changes: tuple[str, ...] = ()
    add: tuple[str, ...] = ()
    data_uncertainty: str | None = None
    input_uncertainty: str | None = None
    faults: str = "fast"
    witnesses: int | None = None
    time_limit: float | None = None
    memory_limit: float = Limits.memory / 2**30
    execution: Execution = field(default_factory=Execution)


def speeds(rpm: str | None, omega: str | None) -> tuple[tuple[float, ...], bool] | None:
    """Rotor speeds (rad/s), and whether they are given in rpm; None if neither is given.

    Raises:
        CaseError: naming the option.
    """
    if rpm is not None and omega is not None:
        raise CaseError(f"--rpm {rpm} and --omega {omega}: the speed is given twice: give one of them")
    if rpm is None and omega is None:
        return None
    option, text, factor = ("--rpm", rpm or "", RPM_PER_RAD_S) if omega is None else ("--omega", omega, 1.0)
    try:
        return tuple((speed_range(text) / factor).tolist()), omega is None
    except ValueError as error:
        raise CaseError(f"{option}: {error}") from error


def command_line(request: Request) -> str:
    """The command that asks the same: parsing it gives the request, with the default execution.

    A case that was not read from a file cannot be named: the line is then empty.
    """
    if not all(isinstance(subject, str) for subject in request.subjects):
        return ""
    return shlex.join(["southwell", "verify", *map(str, request.subjects), *_options(request)])


def _options(request: Request) -> Iterator[str]:
    mount, default = request.mount, Request()
    if request.codes is not None:
        yield from ("--codes", ",".join(request.codes))
    for option, value in (
        ("--rpm", request.rpm),
        ("--omega", request.omega),
        ("--main", mount.main),
        ("--length", mount.length),
        ("--hub-radius", mount.hub_radius),
        ("--precone", _degrees(mount.precone)),
        ("--pitch", _degrees(mount.pitch)),
        ("--subset", mount.subset and ":".join(map(str, mount.subset))),
        ("--multipliers", mount.multipliers and ",".join(map(repr, mount.multipliers))),
    ):
        if value is not None:
            yield f"{option}={value}"  # a value may begin with a minus sign
    if mount.offsets is not None:
        yield "--offsets" if mount.offsets else "--no-offsets"
    if request.blade_only:
        yield "--blade-only"
    yield from (word for change in request.changes for word in ("--set", change))
    yield from (word for text in request.add for word in ("--add", text))
    for option, value, usual in (
        ("--data-uncertainty", request.data_uncertainty, None),
        ("--input-uncertainty", request.input_uncertainty, None),
        ("--faults", request.faults, default.faults),
        ("--witnesses", request.witnesses, None),
        ("--time-limit", request.time_limit, None),
        ("--memory-limit", request.memory_limit, default.memory_limit),
    ):
        if value != usual:
            yield from (option, str(value))


def _degrees(angle: float | None) -> str | None:
    """The shortest number of degrees that is this angle (rad) exactly."""
    if angle is None:
        return None
    texts = (f"{degrees(angle):.{digits}g}" for digits in range(1, 18))
    return next((text for text in texts if radians(float(text)) == angle), repr(degrees(angle)))
