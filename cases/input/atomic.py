"""Atomic file writes: a temporary file in the same folder is written, flushed to disk, and renamed onto the target.

A reader sees either the earlier or the new file, never a partial one; after a full disk or a kill the earlier file is
intact.
"""

import csv
import os
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from io import StringIO
from pathlib import Path
from typing import BinaryIO

PART = ".part"
"""Suffix of a file being written. It is fixed, so that the next attempt replaces the file."""


def write(path: Path, content: str | bytes | Iterable[bytes]) -> None:
    """Write ``content`` to ``path``; text as UTF-8, with line ends as they are.

    Raises:
        OSError: if ``path`` cannot be written; the message names it. An existing file is then unchanged.
    """
    parts = [content.encode() if isinstance(content, str) else content] if isinstance(content, str | bytes) else content
    through(path, lambda file: file.writelines(parts))


def write_csv(path: Path, head: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table as comma-separated values.

    Raises:
        OSError: as for ``write``.
    """
    text = StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    write(path, text.getvalue())


def through(path: Path, save: Callable[[BinaryIO], object]) -> None:
    """Write ``path`` with a function that accepts an open binary file, such as Matplotlib's ``savefig``.

    Raises:
        OSError: as for ``write``.
    """
    partial = path.with_name(f"{path.name}{PART}")
    try:
        with partial.open("wb") as file:
            save(file)
            file.flush()
            os.fsync(file.fileno())
        partial.replace(path)
    except BaseException as error:
        with suppress(OSError):
            partial.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise OSError(error.errno, error.strerror or str(error), str(path)) from error
        raise
