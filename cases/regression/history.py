"""History of results by commit: a file with one JSON object per line, kept with the code or as a build artifact.

A line is appended in one write, under a lock on the file itself (portalocker: the system's lock, also on Windows,
without a lock file), so that concurrent jobs do not mix their lines. A truncated line, after a full disk or a killed
job, does not affect the others: the next one starts on a new line, and ``read`` reports the lines it skipped.
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
from ..judge.results import Key, Run, Verdict
from . import properties
from .properties import Property


class Point(msgspec.Struct, frozen=True, array_like=True):
    """One cell of one run; an array in the file, in this order. Fields as in ``results.Cell``: SI, differences relative."""

    case: str
    code: str
    omega: float
    mode: int
    family: str
    value: float | None
    difference: float | None
    uncertainty: float | None
    verdict: Verdict
    target: float | None = None
    quantity: str = "frequency"
    where: str = ""

    @property
    def key(self) -> Key:
        """What identifies the cell in another run."""
        return self.case, self.code, self.omega, self.mode, self.quantity, self.where


class Detection(msgspec.Struct, frozen=True, array_like=True):
    """Detections of one seeded fault in one case at one speed (rad/s); an array in the file."""

    control: str
    case: str
    omega: float
    detected_by: tuple[str, ...]


@dataclass(frozen=True)
class Entry:
    """One run.

    Attributes:
        commit: commit of the code that was run, or any other name of its state.
        date: time of the entry: ISO 8601, UTC.
        machine: description of the machine, on which rounding depends.
        versions: package or code → version.
        cells: in the run's order.
        controls: in the run's order.
        properties: in the run's order.
    """

    commit: str
    date: str
    machine: str
    versions: dict[str, str]
    cells: tuple[Point, ...]
    controls: tuple[Detection, ...] = ()
    properties: tuple[Property, ...] = ()


@dataclass(frozen=True)
class History:
    """Entries in the file's order, oldest first, and the numbers of truncated lines that were skipped."""

    entries: tuple[Entry, ...]
    truncated: tuple[int, ...] = ()


def entry(run: Run, commit: str, machine: str = "", date: datetime | None = None) -> Entry:
    """Convert a run to an entry; by default dated now, on this machine."""
    return Entry(
        commit=commit,
        date=(date or datetime.now(UTC)).astimezone(UTC).isoformat(timespec="seconds"),
        machine=machine or this_machine(),
        versions=run.versions,
        cells=tuple(Point(*(getattr(cell, name) for name in Point.__struct_fields__)) for cell in run.cells),
        controls=tuple(
            Detection(c.control, c.case, c.omega, c.detected_by) for c in run.controls if c.detected_by or c.missed
        ),
        properties=properties.entries(run.property_checks),
    )


def this_machine() -> str:
    """System, processor type and number of processors; without the host name, for privacy."""
    return f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors"


def append(path: Path, new: Entry) -> None:
    """Append one line to a history; create the file if it does not exist.

    Raises:
        OSError: if the line cannot be written completely.
    """
    line = msgspec.json.encode(new) + b"\n"
    with path.open("a+b", buffering=0) as file:
        portalocker.lock(file, portalocker.LockFlags.EXCLUSIVE)
        try:
            if size := file.seek(0, os.SEEK_END):
                file.seek(size - 1)
                if file.read(1) != b"\n":  # the last line is truncated
                    line = b"\n" + line
            if file.write(line) != len(line):
                raise OSError(0, "the line was cut short: check that the disk is not full", str(path))
        finally:
            portalocker.unlock(file)


def read(path: Path) -> History:
    """Read a history; truncated lines are skipped and listed.

    Raises:
        OSError: if the file cannot be read.
        ValueError: if a complete line is not in the format of this version; the message names file and line.
    """
    entries: list[Entry] = []
    truncated: list[int] = []
    for number, line in enumerate(read_bytes(path, LARGEST_DATA).split(b"\n"), 1):
        try:
            if line:
                decoded = msgspec.json.decode(line, type=Entry)
                for point in decoded.cells:
                    checks.check(point)
                entries.append(decoded)
        except (msgspec.ValidationError, checks.RowError) as error:
            raise ValueError(
                f"{path}: line {number}: not a run ({error}): check that it is a history of this version"
            ) from error
        except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
            truncated.append(number)
    if truncated and not entries:
        raise ValueError(
            f"{path}: line {truncated[0]}: not JSON, nor is any other: give a file that `southwell history` wrote"
        )
    return History(tuple(entries), tuple(truncated))
