"""Reading of user files: regular files only, up to a given size.

A path in an input deck may lead to a device that never ends, a pipe that blocks, or a file that does not fit into memory.
"""

import errno
import os
import stat
from pathlib import Path

MEGABYTE = 1 << 20

LARGEST_TEXT = 16 * MEGABYTE
"""Limit for files that a person edits (a deck, a case, a table), bytes; the largest public one (windIO) has 2 MB."""

LARGEST_DATA = 256 * MEGABYTE
"""Limit for files that a program writes (exported matrices, results, a history), bytes."""


class FileRefusedError(OSError):
    """Not a regular file, or too large; ``strerror`` says which."""

    def __init__(self, path: Path, why: str) -> None:
        super().__init__(errno.EINVAL, why, str(path))


def read_bytes(path: Path, largest: int = LARGEST_TEXT) -> bytes:
    """Read a regular file of at most ``largest`` bytes.

    Raises:
        FileRefusedError: a folder, device, pipe or socket, a larger file, or an impossible name.
        OSError: the file cannot be opened or read.
    """
    try:
        # without O_NONBLOCK, opening a pipe waits for a writer
        number = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    except ValueError as error:  # a zero byte, or a surrogate that the system's encoding lacks
        raise FileRefusedError(path, f"impossible name: {error}") from error
    status = os.fstat(number)
    if not stat.S_ISREG(status.st_mode):
        os.close(number)
        raise FileRefusedError(path, f"{_kind(status.st_mode)}, not a file")
    with os.fdopen(number, "rb") as file:
        if status.st_size <= largest:  # 0 for some files, such as those in /proc
            content = file.read(largest + 1)
            if len(content) <= largest:
                return content
    raise FileRefusedError(path, f"larger than {largest // MEGABYTE} MB")


def _kind(mode: int) -> str:
    kinds = {stat.S_IFDIR: "a folder", stat.S_IFIFO: "a pipe", stat.S_IFSOCK: "a socket"}
    return kinds.get(stat.S_IFMT(mode), "a device")
