"""Standard streams that do not end a command if they are closed, have no reader, or cannot encode a character."""

import io
import os
import sys
from contextlib import suppress
from typing import Any


class _Output(io.FileIO):
    """A standard stream that discards output once its reader has closed the pipe."""

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
    """Prepare standard output and standard error for any text; characters that cannot be encoded are written as ``?``.

    Closed streams are connected to the null device; otherwise the next file opened would get their number. Streams that
    the caller has replaced, such as in a test, are left unchanged.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # opens the lowest free number, which is this one
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
    """Flush the streams, and discard what cannot be written; otherwise Python would end with a status of its own."""
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError:
            _nowhere(stream.fileno())
            with suppress(OSError):
                stream.flush()
