"""What runs found, commit by commit: a file with one JSON object a line, kept beside the code or as a build's artifact.

A line is appended in one write, under a lock on the file itself (portalocker: the system's own lock, on Windows too, and no
lock file left behind), so that jobs that end together do not mix their lines. A line that was cut short, by a full disk or a
killed job, spoils no other: the next one starts anew, and ``read`` says which lines it left out.
"""

import os
import platform
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import msgspec
import portalocker

from ...core.regular_files import LARGEST_DATA, read_bytes
from ..judge import checks
from ..judge.results import Run, Verdict


class Point(msgspec.Struct, frozen=True, array_like=True):
    """One cell of one run; an array in the file, in this order. Fields as in ``results.Cell``: SI, differences relative."""

    case: str
    code: str
    omega: float
    mode: int
    family: str
    frequency: float | None
    difference: float | None
    uncertainty: float | None
    verdict: Verdict
    seconds: float | None
    target: float | None = None

    @property
    def key(self) -> "Key":
        """What makes it the same cell in another run."""
        return self.case, self.code, self.omega, self.mode


Key = tuple[str, str, float, int]
"""Case, code, rotor speed (rad/s), mode."""


class Caught(msgspec.Struct, frozen=True, array_like=True):
    """Who noticed one deliberate fault in core, in one case at one speed (rad/s); an array in the file."""

    control: str
    case: str
    omega: float
    caught: tuple[str, ...]


@dataclass(frozen=True)
class Entry:
    """One run.

    Attributes:
        commit: of the code that was run; anything that names a state of it.
        date: when the entry was made: ISO 8601, UTC.
        machine: in words, what its timings can be compared with.
        versions: package or code → version.
        cells: in the run's order.
        controls: likewise.
    """

    commit: str
    date: str
    machine: str
    versions: dict[str, str]
    cells: tuple[Point, ...]
    controls: tuple[Caught, ...] = ()


@dataclass(frozen=True)
class History:
    """Entries in the file's order, oldest first, and the numbers of lines that were cut short and are left out."""

    entries: tuple[Entry, ...]
    torn: tuple[int, ...] = ()


def entry(run: Run, commit: str, machine: str = "", date: datetime | None = None) -> Entry:
    """A run as one entry: by default made now, on this machine."""
    return Entry(
        commit=commit,
        date=(date or datetime.now(UTC)).astimezone(UTC).isoformat(timespec="seconds"),
        machine=machine or this_machine(),
        versions=run.versions,
        cells=tuple(
            Point(
                case=c.case,
                code=c.code,
                omega=c.omega,
                mode=c.mode,
                family=c.family,
                frequency=c.frequency,
                difference=c.difference,
                uncertainty=c.uncertainty,
                verdict=c.verdict,
                seconds=c.seconds,
                target=c.target,
            )
            for c in run.cells
        ),
        controls=tuple(Caught(c.control, c.case, c.omega, c.caught) for c in run.controls if not c.needs),
    )


def this_machine() -> str:
    """Kind of system and processor, and how many; not its name on the network, which is nobody's business."""
    return f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors"


def append(path: Path, new: Entry) -> None:
    """Add one line to a history, which is made if there is none.

    Raises:
        OSError: if the file cannot be written, or not wholly.
    """
    line = msgspec.json.encode(new) + b"\n"
    with path.open("a+b", buffering=0) as file:
        portalocker.lock(file, portalocker.LockFlags.EXCLUSIVE)
        try:
            if size := file.seek(0, os.SEEK_END):
                file.seek(size - 1)
                if file.read(1) != b"\n":  # the last line was cut short
                    line = b"\n" + line
            if file.write(line) != len(line):
                raise OSError(0, "the line was cut short: is the disk full?", str(path))
        finally:
            portalocker.unlock(file)


def read(path: Path) -> History:
    """A history; lines that were cut short are left out, and named.

    Raises:
        OSError: if the file cannot be read.
        ValueError: naming file and line, if a whole line is not what this version writes.
    """
    entries: list[Entry] = []
    torn: list[int] = []
    for number, line in enumerate(read_bytes(path, LARGEST_DATA).split(b"\n"), 1):
        try:
            if line:
                found = msgspec.json.decode(line, type=Entry)
                for point in found.cells:
                    checks.check(point)
                entries.append(found)
        except (msgspec.ValidationError, checks.RowError) as error:
            raise ValueError(
                f"{path}: line {number}: not a run ({error}): was it written by another version, or is it another file?"
            ) from error
        except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
            torn.append(number)
    if torn and not entries:
        raise ValueError(
            f"{path}: line {torn[0]}: not JSON, nor is any other: give a file that `southwell history` wrote"
        )
    return History(tuple(entries), tuple(torn))
