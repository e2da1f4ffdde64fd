"""Run codes that solve blades in separate processes. ``process`` enforces the limits, ``boundary`` validates the answers.

The process reads one request ::

    {"code": "module:attribute", "folder": …, "blade": {…}, "runs": [[omega, elements, count], …]}

imports the code, checks its version and ``unsupported``, and writes one line per run as soon as it is solved:
``{"run": 0, "modes": {…}}`` or ``{"run": 0, "kind": …, "reason": …}``. After a crash or a limit, finished runs are kept.
"""

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from math import nan
from typing import Any, TypeVar

from ...core.blade import Blade
from ...core.modes import Modes
from . import boundary, registry, sources, store
from .boundary import NonsenseError
from .child import Reply, failed, foreign_exception, serve
from .interface import BladeAdapter, CodeError
from .process import Failure, Limits, converse, one_line
from .wire import decode_blade, encode

T = TypeVar("T")

Run = tuple[float, int, int]
"""Rotor speed (rad/s), elements, number of modes."""

Answer = Modes | Failure


def answers(name: str, blade: Blade, runs: Sequence[Run], limits: Limits, version: str = "") -> list[Answer]:
    """A code's modes for each run, or a failure, in the order of ``runs``.

    Args:
        name: of the code, or its import path (see ``registry.locate``).
        blade: the blade to solve.
        runs: solved in this order; put the most important first.
        limits: for each run.
        version: of the code, as described; without it no answer is taken from the store.

    Raises:
        UnknownCodeError: if the name is unknown.
    """
    fixed = {**registry.address(name), "blade": encode(blade)}

    def request(numbers: Sequence[int]) -> bytes:
        return json.dumps({**fixed, "runs": [list(runs[k]) for k in numbers]}).encode()

    def modes(number: int, data: Any) -> Modes:
        omega, _, count = runs[number]
        return boundary.modes(data, omega, count)

    return exchange(__name__, request, len(runs), limits, modes, name, version)


def exchange(
    module: str,
    request: Callable[[Sequence[int]], bytes],
    count: int,
    limits: Limits,
    made: Callable[[int, Any], T],
    code: str,
    version: str,
) -> list[T | Failure]:
    """The answers to ``count`` questions, each validated by ``made(number, data)``, or failures in their place.

    Answers that are in the user's store are taken from it; the process of the code is asked for the others. Answers of codes
    that are not part of this package or of unknown version are not stored, as no digest covers them; nor are failures.

    Args:
        module: reads the request in the process of the code.
        request: the request with the questions of these numbers.
        count: number of questions.
        limits: for each of them.
        made: validates an answer.
        code: name or import path of the code.
        version: its version; empty if unknown.
    """
    kept = store.opened() if limits.reuse and version and sources.bundled(code) else None
    keys = [store.key(module, request([k]), code, version) for k in range(count)] if kept else []
    out: dict[int, T | Failure] = {}
    for k, key in enumerate(keys):
        if kept and (answer := _stored(kept, key, made, k)):
            out[k] = answer
    asked = [k for k in range(count) if k not in out]
    lines, ended = converse(module, request(asked), len(asked), limits) if asked else ([], NOTHING)
    for place, (k, line) in enumerate(zip(asked, lines, strict=False)):
        try:
            data = boundary.reply(line, place)
        except NonsenseError as error:
            ended = Failure("nonsense", str(error))
            break
        out[k] = answer = boundary.failure(data) or _validated(made, k, data.get("modes"))
        if kept and not isinstance(answer, Failure):
            with suppress(OSError):  # a full disk, or a damaged file
                kept.put(keys[k], f"{code}, answers", line)
    return [out.get(k, ended) for k in range(count)]


NOTHING = Failure("internal", "no question was asked")


def _stored(kept: store.Store, key: str, made: Callable[[int, Any], T], number: int) -> T | None:
    """The answer in the store, without the time that it took; None if there is none."""
    with suppress(KeyError, ValueError, TypeError, AttributeError):
        return replace(made(number, json.loads(kept.get(key)[0]).get("modes")), seconds=nan)  # type: ignore[type-var]
    return None


def _validated(made: Callable[[int, Any], T], number: int, data: Any) -> T | Failure:
    try:
        return made(number, data)
    except (ValueError, TypeError) as error:  # from the schema, or from the class it creates
        return Failure("nonsense", one_line(error))


def declined(code: Any, asked: str, question: object) -> Reply | None:
    """A reply if the code is not installed, declines the problem, or raises an exception; None otherwise.

    Args:
        code: any code.
        asked: name of its method that returns the reason for declining, e.g. ``unsupported``.
        question: a blade or a mechanism.
    """
    try:
        why = getattr(code, asked)(question)
    except BaseException as error:  # an exit, too
        return foreign_exception(error, f"{asked}()")
    if not (why is None or isinstance(why, str)):
        return failed("nonsense", f"{asked}(): {one_line(repr(why))}: neither a reason nor None")
    if why:
        return failed("unsupported", one_line(why))
    try:
        return failed("not installed", f"not installed: {one_line(code.hint)}") if code.version() is None else None
    except BaseException as error:
        return foreign_exception(error, "version()")


def _solve(code: BladeAdapter, blade: Blade, run: Run) -> Reply:
    omega, elements, count = run
    try:
        modes = code.solve(blade, omega, elements, count)
        if not isinstance(modes, Modes):
            return failed("nonsense", f"modes(): {type(modes).__name__}, not Modes")
        return {"modes": encode(modes)}
    except CodeError as error:
        return failed("refused", one_line(error))
    except BaseException as error:  # whatever the code raises affects this run only
        return foreign_exception(error)


def _answer(request: Any) -> Iterator[Reply]:
    runs, code = request["runs"], registry.loaded(request)
    if isinstance(code, Failure):
        yield from [failed(code.kind, code.reason)] * len(runs)
        return
    blade = decode_blade(request["blade"])
    if no := declined(code, "unsupported", blade):
        yield from [no] * len(runs)
        return
    for run in runs:
        yield _solve(code, blade, run)


def main() -> None:
    """Answer the one request on standard input."""
    serve(_answer)
