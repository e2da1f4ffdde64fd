"""Tasks of a run, and other results, that are taken from the store of answers.

The key of a task is the digest of its question (``identity.digest``: blade, speeds, core's references, code and version, and
all the sources on which its answer depends) and of the platform. Answers of a code that is not part of this package are not
stored: its source may call code that no digest covers. Answers with a failure are not stored either: a limit of time or memory
may be the reason. Only the types listed in ``stored`` are rebuilt.
"""

from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any

import msgspec

from ...references.protocol.process import Failure
from ...references.protocol.store import Store, machine, opened
from ..judge.results import Cell, Control
from ..run.executors import Serial
from . import stored
from .columns import Column
from .identity import digest


class Cached(Executor):
    """An executor that reuses stored answers and stores new ones.

    Attributes:
        also: what all answers depend on besides the question.
        taken: times at which the answers taken from the store were computed, s since 1970.
        asked: number of tasks submitted, without columns that solve nothing.
    """

    def __init__(self, executor: Executor, store: Store, also: tuple[str, ...] = ()) -> None:
        self.executor, self.store, self.also = executor, store, also
        self.taken: list[float] = []
        self.asked = 0

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """See ``Executor``. A column that solves nothing is filled at once: starting a process would take seconds."""
        if isinstance(fn, Column) and not fn.solves:
            return Serial().submit(fn, *args, **kwargs)
        self.asked += 1
        if not storable(fn):
            return self.executor.submit(fn, *args, **kwargs)
        key = question(fn, args, kwargs, *self.also)
        if (known := self._get(key)) is None:
            future = self.executor.submit(fn, *args, **kwargs)
            future.add_done_callback(lambda done: self._keep(key, fn, done))
            return future
        value, computed = known
        self.taken.append(computed)
        found: Future[Any] = Future()
        found.set_result(value)
        return found

    def _get(self, key: str) -> tuple[Any, float] | None:
        """A stored answer and its time; None if it is missing or damaged."""
        try:
            text, computed = self.store.get(key)
        except KeyError:
            return None
        try:
            return stored.decode(msgspec.json.decode(text)), computed
        except (msgspec.DecodeError, ValueError):
            self.store.remove(key)
            return None

    def _keep(self, key: str, fn: Callable[..., Any], done: Future[Any]) -> None:
        if not done.cancelled() and done.exception() is None and not _failing(value := done.result()):
            self.store.put(key, _label(fn), msgspec.json.encode(stored.encode(value)))


def remembering(executor: Executor) -> Executor:
    """The executor, with the store of answers if there is one."""
    kept = opened()
    return Cached(executor, kept) if kept else executor


def question(fn: Callable[..., Any], *arguments: Any) -> str:
    """The key of an answer: digest of its question and of the platform, as rounding depends on the platform."""
    return digest(fn, *arguments, machine())


def storable(fn: Callable[..., Any]) -> bool:
    """Whether a task's digest determines its answer: not for an external code or a code of unknown version."""
    return not isinstance(fn, Column) or (fn.bundled and bool(fn.head.version or fn.head.role == "table"))


def _label(fn: Callable[..., Any]) -> str:
    if isinstance(fn, Column):
        return fn.head.code
    return str(getattr(getattr(fn, "func", fn), "__module__", "")).rpartition(".")[2]


def _failing(value: Any) -> bool:
    """Whether an answer contains a failure, a miss, or a fault that was not detected."""
    if isinstance(value, Failure):
        return True
    if isinstance(value, Control):
        return not value.detected_by
    if isinstance(value, Cell):
        return value.verdict == "fail" or (value.frequency is None and value.verdict != "not applicable")
    if isinstance(value, dict):
        return any(map(_failing, value.values()))
    return isinstance(value, list | tuple) and any(map(_failing, value))
