"""The store of answers: one SQLite file in the user's cache folder, from which a run reuses earlier answers.

The key of an answer is a digest of everything that determines it, see ``stored_answers`` for the answers of codes and
``cases.verify.cached`` for the tasks of a run. Each answer has the SHA-256 of its content; no content is executed.
"""

import os
import platform
import sqlite3
import time
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from pathlib import Path

from .cache import cache
from .private_folder import folder

NAME = "answers.sqlite"

WAITING = 20.0
"""Seconds to wait for another process that is writing."""

SCHEMA = """create table if not exists answers
(key text primary key, label text not null, computed real not null, sum blob not null, value blob not null)"""


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


class Store:
    """An open store; several processes may open it. An answer that cannot be read or written counts as missing."""

    def __init__(self, file: Path) -> None:
        """Open a store; create it if it does not exist.

        Raises:
            OSError: if the folder is not writable, or other users can write to it, or the file is not a store.
        """
        if not folder(file.parent.parent, file.parent.name):
            raise OSError(f"{file.parent}: not a folder that only this user can write to")
        try:
            self.base = sqlite3.connect(file, timeout=WAITING, isolation_level=None, check_same_thread=False)
            os.chmod(file, 0o600)
            _prepare(self.base)
        except sqlite3.Error as error:
            raise OSError(f"{file}: {error}") from error

    def get(self, key: str) -> tuple[bytes, float]:
        """Return an answer and the time it was computed (s since 1970).

        Raises:
            KeyError: if it is not stored; a damaged answer is removed.
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
        """Store an answer."""
        row = (key, label, time.time(), sha256(value).digest(), value)
        with suppress(sqlite3.Error):
            self.base.execute("insert or replace into answers values (?, ?, ?, ?, ?)", row)

    def remove(self, key: str) -> None:
        """Remove an answer."""
        with suppress(sqlite3.Error):
            self.base.execute("delete from answers where key = ?", (key,))

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
    latest = time.monotonic() + WAITING
    while True:
        try:
            base.execute("pragma journal_mode = wal")
            base.execute("pragma synchronous = normal")
            base.execute(SCHEMA)
            return
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode & 0xFF != sqlite3.SQLITE_BUSY or time.monotonic() > latest:
                raise
            time.sleep(0.01)


def _intact(checksum: bytes, value: bytes) -> bool:
    return isinstance(value, bytes) and sha256(value).digest() == checksum


FRESH = "SOUTHWELL_FRESH"
"""Environment variable that, if not empty, keeps a run from using the store."""


def opened() -> Store | None:
    """The store, opened once in each process; None if it is not wanted or cannot be used."""
    return None if os.environ.get(FRESH) else _opened(path())


@lru_cache
def _opened(file: Path) -> Store | None:
    try:
        return Store(file)
    except OSError:
        return None


def machine() -> tuple[str, ...]:
    """The platform and the kernel asked of OpenBLAS, on which rounding depends."""
    return platform.system(), platform.machine(), platform.processor(), os.environ.get("OPENBLAS_CORETYPE", "")
