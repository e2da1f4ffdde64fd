"""Where compiled code is kept: in folders that nobody else can write to, in files that say whether they are whole.

What is in these files is executed as it is loaded. Another user's file must not be, and one that was cut short by a full disk
or a killed process must be compiled and written anew.
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
    """The folder ``name`` in ``place``, made if it is not there; None if it cannot be used or trusted."""
    out = place / name
    try:
        place.mkdir(parents=True, exist_ok=True)
        with suppress(FileExistsError):
            out.mkdir(mode=0o700)
        return out if trusted(out) and os.access(out, os.W_OK) else None
    except OSError:
        return None


def trusted(folder: Path) -> bool:
    """Whether only this user (and the system's administrator) can put anything into a folder, or another in its place.

    It must be the user's own, no link, writable to nobody else; and so the folder it lies in, unless that keeps everybody
    from what is others' (the sticky bit, as of ``/tmp``).

    Raises:
        OSError: it cannot be looked at.
    """
    if os.name == "nt":  # folders of the user's profile; modes and owners say nothing there
        return True
    found, above = folder.lstat(), folder.parent.stat()
    others = stat.S_IWGRP | stat.S_IWOTH
    own = stat.S_ISDIR(found.st_mode) and found.st_uid == os.geteuid() and not found.st_mode & others
    safe = above.st_uid in (os.geteuid(), 0) and (not above.st_mode & others or bool(above.st_mode & stat.S_ISVTX))
    return own and safe


class CheckedFiles(IndexDataCacheFile):
    """Numba's files of one function, each beginning with the SHA-256 of the rest; a damaged one is as a missing one."""

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
        OSError: it is not there, or damaged.
    """
    content = path.read_bytes()
    if hashlib.sha256(content[32:]).digest() != content[:32]:
        raise OSError(f"{path}: damaged")
    return content[32:]


def check(function: Any) -> None:
    """Have the files of a function that numba caches checked."""
    cache = function._cache
    found = cache._impl
    cache._cache_file = CheckedFiles(cache._cache_path, found.filename_base, found.locator.get_source_stamp())
