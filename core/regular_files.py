"""The one way in which any file of a user is opened and read: regular files only, within a stated size.

A name in a deck may lead to a device that never ends, a pipe that blocks, or a file that does not fit into memory.
"""

import errno
import os
import stat
from pathlib import Path

MEGABYTE = 1 << 20

LARGEST_TEXT = 16 * MEGABYTE
"""Of a file that a person edits: a deck, a case, a table; the largest public one (a windIO turbine) has 2 MB."""

LARGEST_DATA = 256 * MEGABYTE
"""Of a file that a program writes: exported matrices, results, a history."""


class FileRefusedError(OSError):
    """Not a regular file, or too large; ``strerror`` says which."""

    def __init__(self, path: Path, why: str) -> None:
        super().__init__(errno.EINVAL, why, str(path))


def read_bytes(path: Path, largest: int = LARGEST_TEXT) -> bytes:
    """The content of a regular file of at most ``largest`` bytes.

    Raises:
        FileRefusedError: a folder, device, pipe or socket, or a larger file.
        OSError: it cannot be opened or read; also where the name itself is impossible.
    """
    try:
        # without O_NONBLOCK, opening a pipe waits for somebody to write into it
        number = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    except ValueError as error:  # a zero byte, or a surrogate that the system's encoding lacks
        raise FileRefusedError(path, f"impossible name: {error}") from error
    found = os.fstat(number)
    if not stat.S_ISREG(found.st_mode):
        os.close(number)
        raise FileRefusedError(path, f"{_kind(found.st_mode)}, not a file")
    with os.fdopen(number, "rb") as file:
        if found.st_size <= largest:  # of some, as those in /proc, the system says 0
            content = file.read(largest + 1)
            if len(content) <= largest:
                return content
    raise FileRefusedError(path, f"larger than {largest // MEGABYTE} MB")


def _kind(mode: int) -> str:
    kinds = {stat.S_IFDIR: "a folder", stat.S_IFIFO: "a pipe", stat.S_IFSOCK: "a socket"}
    return kinds.get(stat.S_IFMT(mode), "a device")
