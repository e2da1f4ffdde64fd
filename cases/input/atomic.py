"""Files that are there wholly or not at all: written beside their place, flushed to the disk, then renamed onto it.

A reader sees the earlier file or the new one, never half of either; after a full disk or a kill the earlier one is still there.
"""

import os
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

PART = ".part"
"""Ends the name of a file that is being written. The name is fixed, so that the next attempt takes its place."""


def write(path: Path, content: str | bytes | Iterable[bytes]) -> None:
    """Write ``content`` to ``path``; text as UTF-8, with line ends as they are.

    Raises:
        OSError: naming ``path``, if it cannot be written; what was there before is unchanged.
    """
    parts = [content.encode() if isinstance(content, str) else content] if isinstance(content, str | bytes) else content
    through(path, lambda file: file.writelines(parts))


def through(path: Path, save: Callable[[BinaryIO], object]) -> None:
    """Write ``path`` by a function that takes an open binary file, such as Matplotlib's ``savefig``.

    Raises:
        OSError: as for ``write``.
    """
    beside = path.with_name(f"{path.name}{PART}")
    try:
        with beside.open("wb") as file:
            save(file)
            file.flush()
            os.fsync(file.fileno())
        beside.replace(path)
    except BaseException as error:
        with suppress(OSError):
            beside.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise OSError(error.errno, error.strerror or str(error), str(path)) from error
        raise
