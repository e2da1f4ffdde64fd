"""A file to which each record is appended in one write, so that a killed process leaves at most one truncated record."""

from contextlib import suppress
from pathlib import Path


class JournalError(OSError):
    """An answer could not be written to disk; the run stops."""


class Appending:
    """A file open for appending, created if missing. Close it with ``close``."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.file = path.open("ab", buffering=0)
        self.size = path.stat().st_size

    def truncate(self, size: int) -> None:
        """Remove everything after ``size`` bytes."""
        self.file.truncate(size)
        self.size = size

    def append(self, record: bytes) -> None:
        """Append a record.

        Raises:
            JournalError: if it cannot be written completely; the file is then unchanged.
        """
        written = 0
        try:
            while written < len(record):
                written += self.file.write(record[written:])
        except OSError as error:
            with suppress(OSError):
                self.file.truncate(self.size)
            raise JournalError(error.errno, error.strerror, str(self.path)) from error
        self.size += len(record)

    def close(self) -> None:
        """Close the file."""
        self.file.close()
