"""An executor that takes answers from earlier runs instead of computing them.

The user's store has answers that every later run may take: those of tasks whose digest determines them. A code of another
package or of unknown version may call what no digest covers, so that its answers are not there. Nor are answers with a failure,
for which a limit of time or memory may be the reason. The file of an unfinished run has all its answers, these included.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from contextlib import suppress
from typing import Any

from ...references.protocol import store
from ...references.protocol.process import Failure
from ...references.protocol.store import Store
from ..judge.results import Cell, Control
from ..run.executors import Serial
from .codec import decode, encode
from .digest import digest
from .unfinished import Unfinished


class Stored(Executor):
    """Tasks whose answers are looked up, and stored before their futures complete.

    Args:
        executor: computes what is not stored.
        users: the user's store, if it may be used.
        unfinished: the file of the run, if there is one.
        also: what all answers depend on besides the question.

    Attributes:
        taken: times at which the answers from the user's store were computed, s since 1970.
        asked: number of tasks submitted, without columns that solve nothing.
    """

    def __init__(
        self, executor: Executor, users: Store | None, unfinished: Unfinished | None = None, also: Sequence[str] = ()
    ) -> None:
        self.executor, self.users, self.unfinished, self.also = executor, users, unfinished, tuple(also)
        self.taken: list[float] = []
        self.asked = 0

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """See ``Executor``. The future fails with ``OSError`` if the answer cannot be written to the run's file.

        A column that solves nothing is filled at once: starting a process would take seconds.
        """
        solves = getattr(fn, "solves", True)
        self.asked += solves
        shared = self.users if solves and storable(fn) else None
        executor = self.executor if solves else Serial()
        if shared is None and self.unfinished is None:
            return executor.submit(fn, *args, **kwargs)
        key = question(fn, args, kwargs, *self.also)
        with suppress(KeyError, ValueError):  # missing or damaged
            return _done(self._get(key, shared))
        return _Kept(executor.submit(fn, *args, **kwargs), lambda value: self._put(key, shared, _label(fn), value))

    def _get(self, key: str, shared: Store | None) -> Any:
        """A stored answer.

        Raises:
            KeyError: if it is missing.
            ValueError: if it is damaged.
        """
        if self.unfinished:
            with suppress(KeyError):
                return decode(self.unfinished.get(key))
        if shared is None:
            raise KeyError(key)
        content, computed = shared.get(key)
        value = decode(content)
        if self.unfinished:
            self.unfinished.put(key, _is_rows(value), content)
        self.taken.append(computed)
        return value

    def _put(self, key: str, shared: Store | None, label: str, value: Any) -> None:
        if self.unfinished:
            self.unfinished.put(key, _is_rows(value), encode(value))
        if shared and not _failing(value):
            with suppress(OSError):  # the run does not depend on it
                shared.put(key, label, encode(value))


def remembering(executor: Executor) -> Executor:
    """The executor, with the user's store if it may be used."""
    users = store.opened()
    return Stored(executor, users) if users else executor


def question(fn: Callable[..., Any], *arguments: Any) -> str:
    """The key of an answer."""
    return store.key(digest(fn, *arguments))


def storable(fn: Callable[..., Any]) -> bool:
    """Whether a task's digest determines its answer. A task may say so itself, with an attribute ``storable``."""
    return bool(getattr(fn, "storable", True))


def _label(fn: Callable[..., Any]) -> str:
    """A name for the list of the store's contents: of a code, or of the module of a task."""
    return getattr(fn, "code", "") or str(getattr(getattr(fn, "func", fn), "__module__", "")).rpartition(".")[2]


def _is_rows(value: Any) -> bool:
    """Whether an answer is that of a column: cells and levels."""
    return isinstance(value, tuple) and len(value) == 2 and all(isinstance(rows, list) for rows in value)


def _failing(value: Any) -> bool:
    """Whether an answer contains a failure, a miss, or a fault that was not detected."""
    if isinstance(value, Failure):
        return True
    if isinstance(value, Control):
        return not value.detected_by
    if isinstance(value, Cell):
        return value.verdict == "fail" or (value.value is None and value.verdict != "not applicable")
    if isinstance(value, dict):
        return any(map(_failing, value.values()))
    return isinstance(value, list | tuple) and any(map(_failing, value))


def _done(value: Any) -> Future[Any]:
    future: Future[Any] = Future()
    future.set_result(value)
    return future


class _Kept(Future[Any]):
    """Future of a task that completes when its answer is stored."""

    def __init__(self, future: Future[Any], keep: Callable[[Any], None]) -> None:
        super().__init__()
        self.inner, self.keep = future, keep
        future.add_done_callback(self._finish)

    def running(self) -> bool:
        return self.inner.running()

    def cancel(self) -> bool:
        return self.inner.cancel()

    def _finish(self, future: Future[Any]) -> None:
        if future.cancelled():
            super().cancel()
            self.set_running_or_notify_cancel()
            return
        error = future.exception()
        if error is None:
            try:
                self.keep(future.result())
            except Exception as failed:  # no space left, or an answer of unknown type
                error = failed
        if error is None:
            self.set_result(future.result())
        else:
            self.set_exception(error)
