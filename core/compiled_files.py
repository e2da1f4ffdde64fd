"""Storage of compiled code: in folders that nobody else can write to, in files with a checksum.

The content of these files is executed when it is loaded. A file of another user must not be loaded, and a file truncated by
a full disk or a killed process must be compiled and written again.
"""

import hashlib
import os
import pickle
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import BytesIO
from pathlib import Path
from typing import Any

from numba.core.caching import IndexDataCacheFile


def folder(place: Path, name: str) -> Path | None:
    """The folder ``name`` in ``place``, created if missing; None if it cannot be used or trusted."""
    out = place / name
    try:
        place.mkdir(parents=True, exist_ok=True)
        with suppress(FileExistsError):
            out.mkdir(mode=0o700)
        return out if trusted(out) and os.access(out, os.W_OK) else None
    except OSError:
        return None


def trusted(folder: Path) -> bool:
    """Whether only this user (and the system's administrator) can write into a folder or replace it.

    The folder must belong to the user, be writable by nobody else, and not be a link. Its parent must belong to the user or
    the administrator, and be writable by nobody else unless it has the sticky bit (as ``/tmp`` has).

    Raises:
        OSError: the folder or its parent cannot be examined.
    """
    if os.name == "nt":  # folders of the user's profile; modes and owners have no meaning there
        return True
    found, above = folder.lstat(), folder.parent.stat()
    others = stat.S_IWGRP | stat.S_IWOTH
    private = stat.S_ISDIR(found.st_mode) and found.st_uid == os.geteuid() and not found.st_mode & others
    safe = above.st_uid in (os.geteuid(), 0) and (not above.st_mode & others or bool(above.st_mode & stat.S_ISVTX))
    return private and safe


class CheckedFiles(IndexDataCacheFile):
    """Numba's cache files of one function, each with the SHA-256 of its content first; a damaged one counts as missing."""

    @contextmanager
    def _open_for_write(self, filepath: str) -> Iterator[BytesIO]:
        content = BytesIO()
        yield content
        with super()._open_for_write(filepath) as file:
            file.write(hashlib.sha256(content.getvalue()).digest() + content.getvalue())

    def _load_index(self) -> dict[Any, str]:
        try:
            with BytesIO(_checked(Path(self._index_path))) as content:
                if pickle.load(content) != self._version:
                    return {}
                stamp, overloads = pickle.load(content)
        except OSError:
            return {}
        return overloads if stamp == self._source_stamp else {}

    def _load_data(self, name: str) -> Any:
        return pickle.loads(_checked(Path(self._data_path(name))))


def _checked(path: Path) -> bytes:
    """The content of a file after its digest.

    Raises:
        OSError: the file is missing or damaged.
    """
    content = path.read_bytes()
    if hashlib.sha256(content[32:]).digest() != content[:32]:
        raise OSError(f"{path}: damaged")
    return content[32:]


def check(function: Any) -> None:
    """Verify the cache files of a function compiled by numba: use ``CheckedFiles`` for them."""
    cache = function._cache
    found = cache._impl
    cache._cache_file = CheckedFiles(cache._cache_path, found.filename_base, found.locator.get_source_stamp())
