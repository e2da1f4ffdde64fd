"""Output that a CI system does not interpret as commands."""

import sys
from collections.abc import Iterable
from typing import Any, TextIO


class LogSafe:
    """A stream that writes no line that a CI system would execute as a command.

    GitHub's runner executes lines that begin with ``::``, after optional blanks, and ``##[`` anywhere (actions/runner,
    ActionCommand.cs).
    """

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream
        self.blank = True
        """Whether the current line has only blanks so far."""

    def write(self, text: str) -> int:
        """Write text; a blank is inserted into anything that would be a command."""
        for piece in text.splitlines(keepends=True):
            safe = piece.replace("##[", "## [")
            if self.blank and safe.lstrip().startswith("::"):
                safe = safe.replace("::", ": :", 1)
            ends_line = piece.splitlines()[0] != piece
            self.blank = ends_line or (self.blank and not piece.strip())
            self.stream.write(safe)
        return len(text)

    def writelines(self, lines: Iterable[str]) -> None:
        """Write each line."""
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)


def commands() -> TextIO:
    """Standard output for intended commands."""
    return sys.stdout.stream if isinstance(sys.stdout, LogSafe) else sys.stdout
