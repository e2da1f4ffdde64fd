"""The store of answers: one SQLite file in the user's cache folder, from which later runs take earlier answers.

The key of an answer is a digest of its question, of the versions of the codes, of this package (``sources``) and of the
platform. Each answer has the SHA-256 of its content; no content is executed. Several processes may write at the same time.

``diskcache`` has the same scheme and is not used: it has had no release since 2023, restores pickled objects whatever the
caller stores (CVE-2025-69872, without a fix), and keeps no checksum of the large answers that it writes to files of their own.
"""

import json
import os
import platform
import sqlite3
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import sources
from .cache import cache, private_folder

NAME = "answers.sqlite"

WAITING = 20.0
"""Seconds to wait for another process that is writing."""

MAX_BYTES = 2 * 2**30
"""Size of the file above which the older half of the answers is removed when it is opened."""

FRESH = "SOUTHWELL_FRESH"
"""Environment variable that, if not empty, keeps a run from using the store."""

SCHEMA = """create table if not exists answers
(key text primary key, label text not null, computed real not null, sum blob not null, value blob not null)"""


class StoreError(OSError):
    """An answer could not be written."""


@dataclass(frozen=True)
class Kept:
    """Contents of the store under one label: number of answers, bytes, times of the first and last answer (s)."""

    label: str
    count: int
    size: int
    first: float
    last: float


def path() -> Path:
    """Path of the store."""
    return cache() / NAME


def key(*question: object) -> str:
    """The key of the answer to a question, given as plain data or as objects that ``repr`` identifies.

    It depends on this package and on what rounding depends on: the platform, and the kernel asked of OpenBLAS.
    """
    machine = platform.system(), platform.machine(), platform.processor(), os.environ.get("OPENBLAS_CORETYPE", "")
    return sha256(repr((question, sources.package(), machine)).encode()).hexdigest()


class Store:
    """An open file of answers."""

    def __init__(self, file: Path) -> None:
        """Open a file; create it if it does not exist.

        Raises:
            OSError: if it cannot be opened, or is not a store.
        """
        self.file = file
        try:
            self.base = sqlite3.connect(file, timeout=WAITING, isolation_level=None, check_same_thread=False)
            os.chmod(file, 0o600)
            _prepare(self.base)
            if file.stat().st_size > MAX_BYTES:
                self.prune(*self.base.execute("select avg(computed) from answers").fetchone())
        except sqlite3.Error as error:
            raise OSError(f"{file}: {error}") from error

    def get(self, key: str) -> tuple[bytes, float]:
        """Return an answer and the time it was computed (s since 1970).

        Raises:
            KeyError: if it is not stored or cannot be read; a damaged answer is removed.
        """
        try:
            row = self.base.execute("select sum, value, computed from answers where key = ?", (key,)).fetchone()
        except sqlite3.Error as error:
            raise KeyError(key) from error
        if row is None:
            raise KeyError(key)
        if not _intact(*row[:2]):
            self.remove(key)
            raise KeyError(key)
        return row[1], float(row[2])

    def put(self, key: str, label: str, value: bytes) -> None:
        """Store an answer.

        Raises:
            StoreError: if it cannot be written; the file is then unchanged.
        """
        row = (key, label, time.time(), sha256(value).digest(), value)
        try:
            self.base.execute("insert or replace into answers values (?, ?, ?, ?, ?)", row)
        except sqlite3.Error as error:
            raise StoreError(0, str(error), str(self.file)) from error

    def touch(self, key: str) -> None:
        """Give an answer the present time."""
        with suppress(sqlite3.Error):
            self.base.execute("update answers set computed = ? where key = ?", (time.time(), key))

    def remove(self, key: str) -> None:
        """Remove an answer."""
        with suppress(sqlite3.Error):
            self.base.execute("delete from answers where key = ?", (key,))

    def values(self, label: str, since: float) -> Iterator[bytes]:
        """Intact answers under a label that were stored at a time (s since 1970) or later, in that order."""
        query = "select sum, value from answers where label = ? and computed >= ? order by computed"
        yield from (value for checksum, value in self.base.execute(query, (label, since)) if _intact(checksum, value))

    def kept(self) -> list[Kept]:
        """Contents of the store, by label."""
        query = "select label, count(*), sum(length(value)), min(computed), max(computed) from answers group by label"
        return [Kept(*row) for row in self.base.execute(f"{query} order by label")]

    def damaged(self) -> list[str]:
        """Keys of damaged answers."""
        return [key for key, *row in self.base.execute("select key, sum, value from answers") if not _intact(*row)]

    def prune(self, before: float) -> int:
        """Remove the answers computed before a time (s since 1970) and return their number."""
        count = self.base.execute("delete from answers where computed < ?", (before,)).rowcount
        self.base.execute("vacuum")
        return count

    def close(self) -> None:
        """Close the file."""
        self.base.close()


def _prepare(base: sqlite3.Connection) -> None:
    """Set the mode and make the table; SQLite does not wait by itself where two processes set the mode of a new file."""
    deadline = time.monotonic() + WAITING
    while True:
        try:
            base.execute("pragma journal_mode = wal")
            base.execute("pragma synchronous = normal")
            base.execute(SCHEMA)
            return
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode & 0xFF != sqlite3.SQLITE_BUSY or time.monotonic() > deadline:
                raise
            time.sleep(0.01)


def _intact(checksum: bytes, value: bytes) -> bool:
    return isinstance(value, bytes) and sha256(value).digest() == checksum


def users() -> Store:
    """Open the user's store.

    Raises:
        OSError: if its folder is not writable, or other users can write to it, or the file is not a store.
    """
    folder = cache()
    if not private_folder(folder.parent, folder.name):
        raise OSError(f"{folder}: not a folder that only this user can write to")
    return Store(path())


def opened() -> Store | None:
    """The user's store, opened once in each process; None if it is not wanted or cannot be used."""
    return None if os.environ.get(FRESH) else _opened(path())


@lru_cache
def _opened(_: Path) -> Store | None:
    try:
        return users()
    except OSError:
        return None


def array(label: str, question: tuple[object, ...], make: Callable[[], NDArray[np.float64]]) -> NDArray[np.float64]:
    """An array that codes need for many answers: taken from the user's store if it is there, made and stored otherwise.

    Args:
        label: for the list of the store's contents.
        question: what the array is made of, with the version of any other package that makes it; see ``key``.
        make: makes the array.
    """
    store = opened()
    if store is None:
        return make()
    name = key(label, question)
    with suppress(KeyError, ValueError):
        return np.array(json.loads(store.get(name)[0]))
    value = make()
    with suppress(OSError):
        store.put(name, label, json.dumps(value.tolist()).encode())
    return value
