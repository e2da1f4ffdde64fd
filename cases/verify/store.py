"""The store of answers: one SQLite file in the user's cache folder, from which a run reuses earlier answers.

The key of an answer is the digest of its question (``identity.digest``: blade, speeds, refinement, code and version,
the sources of this package, the versions of Python and the libraries) and of the platform. Answers of a code that is
not part of this package are not stored: its source may call code that no digest covers. Answers with a failure are not
stored either: a limit of time or memory may be the reason. No content of the file is executed, see ``stored``.
"""

import os
import platform
import sqlite3
import time
from collections.abc import Callable
from concurrent.futures import Executor, Future
from contextlib import suppress
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

import msgspec

from ...core import compiled_files
from ...references.protocol.cache import cache
from ...references.protocol.process import Failure
from ..judge.results import Cell
from . import stored
from .columns import Column
from .identity import digest

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
        if not compiled_files.folder(file.parent.parent, file.parent.name):
            raise OSError(f"{file.parent}: not a folder that only this user can write to")
        try:
            self.base = sqlite3.connect(file, timeout=WAITING, isolation_level=None, check_same_thread=False)
            os.chmod(file, 0o600)
            self.base.execute("pragma journal_mode = wal")
            self.base.execute("pragma synchronous = normal")
            self.base.execute(SCHEMA)
        except sqlite3.Error as error:
            raise OSError(f"{file}: {error}") from error

    def get(self, key: str) -> tuple[Any, float]:
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
        try:
            return _read(*row[:2]), float(row[2])
        except ValueError as error:
            with suppress(sqlite3.Error):
                self.base.execute("delete from answers where key = ?", (key,))
            raise KeyError(key) from error

    def put(self, key: str, label: str, value: Any) -> None:
        """Store an answer."""
        text = msgspec.json.encode(stored.encode(value))
        row = (key, label, time.time(), sha256(text).digest(), text)
        with suppress(sqlite3.Error):
            self.base.execute("insert or replace into answers values (?, ?, ?, ?, ?)", row)

    def kept(self) -> list[Kept]:
        """Contents of the store, by label."""
        query = "select label, count(*), sum(length(value)), min(computed), max(computed) from answers group by label"
        return [Kept(*row) for row in self.base.execute(f"{query} order by label")]

    def damaged(self) -> list[str]:
        """Keys of damaged answers."""
        bad = []
        for key, checksum, value in self.base.execute("select key, sum, value from answers"):
            try:
                _read(checksum, value)
            except ValueError:
                bad.append(key)
        return bad

    def prune(self, before: float) -> int:
        """Remove the answers computed before a time (s since 1970) and return their number."""
        count = self.base.execute("delete from answers where computed < ?", (before,)).rowcount
        self.base.execute("vacuum")
        return count

    def close(self) -> None:
        """Close the file."""
        self.base.close()


def _read(checksum: bytes, text: bytes) -> Any:
    if not isinstance(text, bytes) or sha256(text).digest() != checksum:
        raise ValueError("damaged")
    try:
        return stored.decode(msgspec.json.decode(text))
    except msgspec.DecodeError as error:
        raise ValueError(str(error)) from error


class Cached(Executor):
    """An executor that reuses stored answers and stores new ones.

    Attributes:
        taken: times at which the answers taken from the store were computed, s since 1970.
        asked: number of tasks submitted.
    """

    def __init__(self, executor: Executor, store: Store) -> None:
        self.executor, self.store = executor, store
        self.taken: list[float] = []
        self.asked = 0

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """See ``Executor``."""
        self.asked += 1
        if not storable(fn):
            return self.executor.submit(fn, *args, **kwargs)
        key = question(fn, args, kwargs)
        try:
            value, computed = self.store.get(key)
        except KeyError:
            future = self.executor.submit(fn, *args, **kwargs)
            future.add_done_callback(lambda done: self._keep(key, fn, done))
            return future
        self.taken.append(computed)
        found: Future[Any] = Future()
        found.set_result(value)
        return found

    def _keep(self, key: str, fn: Callable[..., Any], done: Future[Any]) -> None:
        if not done.cancelled() and done.exception() is None and not _failing(value := done.result()):
            self.store.put(key, _label(fn), value)


def question(fn: Callable[..., Any], *arguments: Any) -> str:
    """The key of an answer: digest of its question and of the platform, as rounding depends on the platform."""
    here = (platform.system(), platform.machine(), platform.processor(), os.environ.get("OPENBLAS_CORETYPE", ""))
    return digest(fn, *arguments, here)


def storable(fn: Callable[..., Any]) -> bool:
    """Whether a task's digest determines its answer: not for an external code or a code of unknown version."""
    return not isinstance(fn, Column) or (not fn.adapter and bool(fn.head.version or fn.head.role == "table"))


def _label(fn: Callable[..., Any]) -> str:
    if isinstance(fn, Column):
        return fn.head.code
    return str(getattr(getattr(fn, "func", fn), "__module__", "")).rpartition(".")[2]


def _failing(value: Any) -> bool:
    """Whether an answer contains a failure or a miss."""
    if isinstance(value, Failure):
        return True
    if isinstance(value, Cell):
        return value.verdict == "fail" or (value.frequency is None and value.verdict != "not applicable")
    if isinstance(value, dict):
        return any(map(_failing, value.values()))
    return isinstance(value, list | tuple) and any(map(_failing, value))
