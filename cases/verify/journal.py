"""The journal of a run, ``results.partial.jsonl``: the plan, and every answer as soon as it is computed.

A killed run leaves its journal. The next run in the same folder reuses every answer to a question with the same
``identity.digest`` and computes only the rest. The journal is removed when the run's results and report are written: a
folder with a journal contains no finished run. Each line is one JSON object, appended in one write; a truncated line is
removed.
"""

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from threading import Lock
from typing import Any

import msgspec
import portalocker

from ..input.errors import CaseError
from ..judge.results import Cell, Level, Planned, Run, Setting, gaps
from . import stored
from .appending import Appending
from .identity import digest

NAME = "results.partial.jsonl"

WORDS = {"run": {"plan", "settings", "versions", "command"}, "answer": {"key", "value"}, "kept": {"key"}}
"""Fields of each kind of line: a started run, an answer, an earlier answer reused by the latest run."""


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Context manager that prevents other runs from writing to the folder.

    It uses the system's lock on the folder itself, which leaves no file behind and is released when the process ends.

    Raises:
        CaseError: if another process has the lock.
        OSError: if the folder cannot be opened.
    """
    handle = os.open(folder, os.O_RDONLY)
    try:
        try:
            portalocker.lock(handle, portalocker.LockFlags.EXCLUSIVE | portalocker.LockFlags.NON_BLOCKING)
        except portalocker.LockException as error:
            raise CaseError(
                f"--out {folder}: another run is writing in this folder: wait for it to end, or give another folder"
            ) from error
        yield
    finally:
        os.close(handle)


class Journal:
    """An open journal. Every method that writes raises ``JournalError`` if the complete line cannot be written."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / NAME
        self.file = Appending(self.path)
        self.lines, size = _lines(self.path)
        self.file.truncate(size)  # remove a truncated line
        self.answers: dict[str, Any] = {line["key"]: line["value"] for line in self.lines if line["kind"] == "answer"}
        self.current: set[str] = set()
        self.lock = Lock()

    def begin(self, run: Run) -> None:
        """Write plan, settings, versions and command of a run. Later answers belong to this run."""
        started = _about(run)
        before = [line for line in self.lines if line["kind"] == "run"]
        if before and msgspec.json.encode(before[-1]) == msgspec.json.encode(started):
            self.current = set(_current(self.lines))
        else:
            self._append(started)

    def get(self, key: str) -> Any:
        """Return a stored answer.

        Raises:
            KeyError: if it is not stored.
            ValueError: if it cannot be read.
        """
        found = stored.decode(self.answers[key])
        if key not in self.current:
            self._append({"kind": "kept", "key": key})
            self.current.add(key)
        return found

    def put(self, key: str, value: Any) -> None:
        """Store an answer."""
        self._append({"kind": "answer", "key": key, "value": stored.encode(value)})
        self.current.add(key)

    def _append(self, line: dict[str, Any]) -> None:
        with self.lock:
            self.file.append(msgspec.json.encode(line) + b"\n")

    def __enter__(self) -> "Journal":
        return self

    def __exit__(self, *_: object) -> None:
        self.file.close()

    def remove(self) -> None:
        """Remove the journal, after the run's results and report are written."""
        self.path.unlink()


def _lines(path: Path) -> tuple[list[dict[str, Any]], int]:
    """The readable lines of a journal, and the offset of the end of the last complete line."""
    content = path.read_bytes()
    size = content.rfind(b"\n") + 1
    found = []
    for text in content[:size].split(b"\n")[:-1]:
        with suppress(msgspec.DecodeError, UnicodeDecodeError):
            line = msgspec.json.decode(text, type=dict[str, Any])
            if WORDS.get(str(line.get("kind")), {""}) <= set(line):
                found.append(line)
    return found, size


def _about(run: Run) -> dict[str, Any]:
    run_facts = {"plan": run.plan, "settings": run.settings, "versions": run.versions, "command": run.command}
    return {"kind": "run", **msgspec.to_builtins(run_facts)}


def _current(lines: list[dict[str, Any]]) -> list[str]:
    """Keys of the answers that belong to the latest run, in the journal's order."""
    keys: list[str] = []
    for line in lines:
        if line["kind"] == "run":
            keys = []
        else:
            keys.append(line["key"])
    return list(dict.fromkeys(keys))


def read(path: Path) -> Run:
    """Read the unfinished run in a journal: the rows available so far, in the order of the plan.

    Raises:
        OSError: if the file cannot be read.
        ValueError: if it is not a journal of this version; the message names the file.
    """
    lines, _ = _lines(path)
    try:
        rows_of = {line["key"]: line["value"] for line in lines if line["kind"] == "answer"}
        begun = [line for line in lines if line["kind"] == "run"]
        about = begun[-1] if begun else _about(Run(()))
        plan = msgspec.convert(about["plan"], tuple[Planned, ...])
        settings = msgspec.convert(about["settings"], tuple[Setting, ...])
        found = [stored.decode(rows_of[key]) for key in _current(lines) if _pair(rows_of.get(key))]
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{path}: not the journal of a run ({error}): was it written by another version?") from error
    place = {(p.case, p.code): k for k, p in enumerate(plan)}
    cells = [c for cells, _ in found for c in cells if isinstance(c, Cell)]
    levels = [v for _, levels in found for v in levels if isinstance(v, Level)]
    run = Run(
        cells=tuple(sorted(cells, key=lambda c: place.get((c.case, c.code), len(place)))),
        levels=tuple(sorted(levels, key=lambda v: place.get((v.case, v.code), len(place)))),
        versions=about["versions"],
        command=about["command"],
        settings=settings,
        plan=plan,
    )
    return replace(run, unfinished=gaps(run) or "the run was stopped before its results were written")


def _pair(value: Any) -> bool:
    """Whether a stored answer belongs to a column: two lists, of cells and of levels."""
    return isinstance(value, list) and value[:1] == ["tuple"] and [v[:1] for v in value[1:]] == [["list"], ["list"]]


class Remembering(Executor):
    """An executor that looks up each task in a journal, and stores a result before its future completes."""

    def __init__(self, executor: Executor, journal: Journal) -> None:
        self.executor, self.journal = executor, journal

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """See ``Executor``. The future fails with ``JournalError`` if the answer cannot be stored."""
        key = digest(fn, args, kwargs)
        try:
            found: Future[Any] = Future()
            found.set_result(self.journal.get(key))
            return found
        except (KeyError, ValueError):  # missing or damaged
            return _Outer(self.executor.submit(fn, *args, **kwargs), lambda value: self.journal.put(key, value))


class _Outer(Future[Any]):
    """Future of a task that completes when its result is stored."""

    def __init__(self, inner: Future[Any], store: Callable[[Any], None]) -> None:
        super().__init__()
        self.inner, self.store = inner, store
        inner.add_done_callback(self._finish)

    def running(self) -> bool:
        return self.inner.running()

    def cancel(self) -> bool:
        return self.inner.cancel()

    def _finish(self, inner: Future[Any]) -> None:
        if inner.cancelled():
            super().cancel()
            self.set_running_or_notify_cancel()
            return
        error = inner.exception()
        if error is None:
            try:
                self.store(inner.result())
            except Exception as failed:  # no space left, or an answer of unknown type
                error = failed
        if error is None:
            self.set_result(inner.result())
        else:
            self.set_exception(error)
