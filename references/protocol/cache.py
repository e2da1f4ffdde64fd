"""The cache folder: isolated environments and stored answers. Nobody else can write to it, since its files are trusted."""

import os
import stat
from contextlib import suppress
from pathlib import Path


def cache() -> Path:
    """Folder of everything this package keeps: ``SOUTHWELL_CACHE``, or ``southwell`` in the user's cache folder."""
    if own := os.environ.get("SOUTHWELL_CACHE"):
        return Path(own)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "southwell"


def private_folder(parent: Path, name: str) -> Path | None:
    """The folder ``name`` in ``parent``, created if missing; None if it cannot be used or trusted."""
    out = parent / name
    try:
        parent.mkdir(parents=True, exist_ok=True)
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
    status, parent = folder.lstat(), folder.parent.stat()
    by_others = stat.S_IWGRP | stat.S_IWOTH
    private = stat.S_ISDIR(status.st_mode) and status.st_uid == os.geteuid() and not status.st_mode & by_others
    safe = parent.st_uid in (os.geteuid(), 0) and (
        not parent.st_mode & by_others or bool(parent.st_mode & stat.S_ISVTX)
    )
    return private and safe
