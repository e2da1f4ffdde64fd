"""Standard streams that never end a command: closed, read by nobody any more, or without a way to write a character."""

import io
import os
import sys
from contextlib import suppress
from typing import Any


class _Output(io.FileIO):
    """A stream's file. A reader of a pipe that has seen enough is no error: what is written from then on is dropped."""

    def write(self, data: Any) -> int | None:
        try:
            return super().write(data)
        except BrokenPipeError:
            _nowhere(self.fileno())
            return super().write(data)


def _nowhere(number: int) -> None:
    with open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), number)


def prepare() -> None:
    """Make standard output and standard error take any text: signs that an encoding has not are written as ``?``.

    Streams that were closed lead nowhere; without that, the next file that is opened would take their place. Streams that a
    caller has replaced, as a test does, are left alone.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number, which is this one
    for name, number in (("stdout", 1), ("stderr", 2)):
        stream = getattr(sys, name)
        if stream is None or stream is getattr(sys, f"__{name}__"):
            setattr(sys, name, _open(number, stream))


def _open(number: int, stream: io.TextIOWrapper | None) -> io.TextIOWrapper:
    if stream is not None:
        stream.flush()
    raw = _Output(number, "wb", closefd=False)
    return io.TextIOWrapper(
        io.BufferedWriter(raw),
        encoding=stream.encoding if stream else "utf-8",
        errors="replace",
        line_buffering=number == 2 or raw.isatty(),
    )


def finish() -> None:
    """Write what is left, or drop it where that fails: Python would end with a status of its own."""
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError:
            _nowhere(stream.fileno())
            with suppress(OSError):
                stream.flush()
