"""Run codes that solve blades in separate processes. ``process`` enforces the limits, ``boundary`` validates the answers.

The process reads one request ::

    {"code": "module:attribute", "folder": …, "overlay": …, "blade": {…}, "runs": [[omega, elements, count], …]}

imports the code, checks its version and ``unsupported``, and writes one line per run as soon as it is solved:
``{"run": 0, "modes": {…}}`` or ``{"run": 0, "kind": …, "reason": …}``. After a crash or a limit, finished runs are kept.
"""

import json
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

from ...core.blade import Blade
from ...core.modes import Modes
from . import boundary, registry
from .boundary import NonsenseError
from .child import Reply, blunder, failed, serve
from .interface import Code, CodeError
from .process import Failure, Limits, converse, one_line
from .wire import decode_blade, encode

T = TypeVar("T")

Run = tuple[float, int, int]
"""Rotor speed (rad/s), elements, number of modes."""

Answer = Modes | Failure


def answers(name: str, blade: Blade, runs: Sequence[Run], limits: Limits) -> list[Answer]:
    """A code's modes for each run, or a failure, in the order of ``runs``.

    Args:
        name: of the code, or its import path (see ``registry.locate``), or one of them at another release.
        blade: the blade to solve.
        runs: solved in this order; put the most important first.
        limits: for each run.

    Raises:
        UnknownCodeError: if the name is unknown.
    """
    request = {**registry.address(name), "blade": encode(blade), "runs": [list(run) for run in runs]}

    def modes(number: int, data: Any) -> Modes:
        omega, _, count = runs[number]
        return boundary.modes(data, omega, count)

    return exchange(__name__, json.dumps(request).encode(), len(runs), limits, modes)


def exchange(
    module: str, request: bytes, count: int, limits: Limits, made: Callable[[int, Any], T]
) -> list[T | Failure]:
    """Send a request; return ``count`` answers, each validated by ``made(number, data)``, or failures in their place."""
    lines, ended = converse(module, request, count, limits)
    out: list[T | Failure] = []
    for number, line in enumerate(lines):
        try:
            data = boundary.reply(line, number)
        except NonsenseError as error:
            ended = Failure("nonsense", str(error))
            break
        try:
            out.append(boundary.failure(data) or made(number, data.get("modes")))
        except (ValueError, TypeError) as error:  # from the schema, or from the class it creates
            out.append(Failure("nonsense", one_line(error)))
    return out + [ended] * (count - len(out))


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
        return blunder(error, f"{asked}()")
    if not (why is None or isinstance(why, str)):
        return failed("nonsense", f"{asked}(): {one_line(repr(why))}: neither a reason nor None")
    if why:
        return failed("unsupported", one_line(why))
    try:
        return failed("not installed", f"not installed: {one_line(code.hint)}") if code.version() is None else None
    except BaseException as error:
        return blunder(error, "version()")


def _solve(code: Code, blade: Blade, run: Run) -> Reply:
    omega, elements, count = run
    try:
        modes = code.solve(blade, omega, elements, count)
        if not isinstance(modes, Modes):
            return failed("nonsense", f"solve(): {type(modes).__name__}, not Modes")
        return {"modes": encode(modes)}
    except CodeError as error:
        return failed("refused", one_line(error))
    except BaseException as error:  # whatever the code raises affects this run only
        return blunder(error)


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
