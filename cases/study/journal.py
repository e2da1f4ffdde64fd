"""The file of a study in JSON Lines: a header, then the rows of every finished task, appended in one write per task.

A stopped study leaves whole tasks and at most one truncated one, which is removed when the file is opened again. Rows are
in the order in which tasks ended. Files are read line by line, so that memory does not grow with the number of rows.
"""

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

import msgspec
import portalocker

from ..input.errors import CaseError
from .plan import Header
from .rows import Row

_header, _row = msgspec.json.Decoder(Header), msgspec.json.Decoder(Row)

OTHER = "give another --out, or remove the file"


class JournalError(OSError):
    """Rows could not be written to disk; the study stops."""


class StudyJournal:
    """The file of a study, open for appending; other processes cannot append meanwhile.

    Args:
        path: the file; created if missing.
        header: of the study.

    Raises:
        CaseError: if the file is not one of this study, is damaged, or another process writes to it.
        OSError: if it cannot be opened.

    Attributes:
        done: (tasks,) 1 for each task whose rows are in the file.
    """

    def __init__(self, path: Path, header: Header) -> None:
        if path.exists() and not path.is_file():
            raise CaseError(f"--out {path}: not a regular file: give another file")
        self.path, self.header, self.done = path, header, bytearray(header.tasks)
        self.file = path.open("ab", buffering=0)
        try:
            try:
                portalocker.lock(self.file, portalocker.LockFlags.EXCLUSIVE | portalocker.LockFlags.NON_BLOCKING)
            except portalocker.LockException as error:
                raise CaseError(
                    f"--out {path}: another study is writing to it: wait for it to end, or give another file"
                ) from error
            first = msgspec.json.encode(header) + b"\n"
            with path.open("rb") as file:
                first_line = file.readline(len(first) + MOST_HEADER)
                if first_line.endswith(b"\n"):
                    _check(first_line, header, path)
                    self.size = _scan(file, len(first_line), self)
                    self.file.truncate(self.size)
                elif first.startswith(first_line):  # empty, or stopped while the header was written
                    self.size = 0
                    self.file.truncate(0)
                    self._append(first)
                else:
                    raise _foreign(path)
        except BaseException:
            self.file.close()
            raise

    def put(self, number: int, lines: bytes) -> None:
        """Append the rows of a task.

        Raises:
            JournalError: if they cannot be written completely; the file is then unchanged.
        """
        if self.done[number]:
            raise AssertionError(f"task {number}: its rows are in the file already")
        self._append(lines)
        self.done[number] = 1

    def _append(self, record: bytes) -> None:
        size_written = 0
        try:
            while size_written < len(record):
                size_written += self.file.write(record[size_written:])
        except OSError as error:
            with suppress(OSError):
                self.file.truncate(self.size)
            raise JournalError(error.errno, error.strerror, str(self.path)) from error
        self.size += len(record)

    def __enter__(self) -> "StudyJournal":
        return self

    def __exit__(self, *_: object) -> None:
        self.file.close()


MOST_HEADER = 2**20
"""Largest difference between the lengths of two headers, bytes; a longer first line is not a header."""


def _foreign(path: Path) -> CaseError:
    return CaseError(f"--out {path}: not the file of a study: {OTHER}")


def _check(line: bytes, expected: Header, path: Path) -> None:
    try:
        existing = _header.decode(line)
    except (msgspec.DecodeError, UnicodeDecodeError):
        raise _foreign(path) from None
    if existing.package != expected.package:
        difference = (
            f"{existing.version}, here {expected.version}"
            if existing.version != expected.version
            else "changed sources"
        )
        raise CaseError(
            f"--out {path}: written by another version of Southwell or its libraries ({difference}): "
            f"answers are not mixed: {OTHER}"
        )
    if existing != expected:
        raise CaseError(f"--out {path}: of another study: the study file or a blade has changed: {OTHER}")


def _scan(file: BinaryIO, start: int, journal: StudyJournal) -> int:
    """Mark the tasks in a file as done, from the line after its header; return the end of the last whole task."""
    end = at = start
    task: Row | None = None
    for k, line in enumerate(file, 2):
        at += len(line)
        if not line.endswith(b"\n"):
            break
        try:
            row = _row.decode(line)
            number = journal.header.number(row.blade, row.sample)
        except (ValueError, msgspec.DecodeError) as error:
            raise CaseError(
                f"{journal.path}: line {k}: not a row of this study ({error}): it may be damaged: {OTHER}"
            ) from None
        follows = task is None or (task.blade, task.sample, task.rows_left - 1) == (
            row.blade,
            row.sample,
            row.rows_left,
        )
        if not follows or journal.done[number]:
            raise CaseError(
                f"{journal.path}: line {k}: sample {row.sample} of {row.blade} twice or with a gap: {OTHER}"
            )
        task = row
        if not row.rows_left:
            journal.done[number] = 1
            end, task = at, None
    return end


def read(path: Path) -> Iterator[Row]:
    """The rows of a study's file, one by one.

    Raises:
        msgspec.DecodeError: if a line is not a row.
        OSError: if the file cannot be read.
    """
    with path.open("rb") as file:
        file.readline()
        for line in file:
            yield _row.decode(line)
