"""Output that a CI system cannot take for commands."""

import sys
from collections.abc import Iterable
from typing import Any, TextIO


class LogSafe:
    """A stream of which no line is a command to a CI system, whatever a label or a message says.

    GitHub's runner obeys lines that begin with ``::``, after blanks, and ``##[`` anywhere (actions/runner, ActionCommand.cs).
    """

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream
        self.blank = True
        """Whether nothing but blanks is on the line so far."""

    def write(self, text: str) -> int:
        """Write, with a blank inside what would be a command."""
        for piece in text.splitlines(keepends=True):
            safe = piece.replace("##[", "## [")
            if self.blank and safe.lstrip().startswith("::"):
                safe = safe.replace("::", ": :", 1)
            ended = piece.splitlines()[0] != piece
            self.blank = ended or (self.blank and not piece.strip())
            self.stream.write(safe)
        return len(text)

    def writelines(self, lines: Iterable[str]) -> None:
        """Write each."""
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)


def commands() -> TextIO:
    """Standard output for commands that are meant as such."""
    return sys.stdout.stream if isinstance(sys.stdout, LogSafe) else sys.stdout
