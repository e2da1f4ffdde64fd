"""Foreign codes that take blades, each in a process of its own: ``process`` for the limits, ``boundary`` for what comes back.

The process reads one request ::

    {"code": "module:attribute", "folder": …, "blade": {…}, "runs": [[omega, elements, count], …]}

imports the code, asks for its version and whether it takes the blade, and writes one line for each run as soon as it is solved:
``{"run": 0, "modes": {…}}`` or ``{"run": 0, "kind": …, "reason": …}``. A crash or a limit loses only what was not finished.
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
    """What a code answers to each of ``runs``, in their order.

    Args:
        name: of the code, or its import path (see ``registry.locate``).
        blade: the blade to solve.
        runs: what to solve, in this order; put first what matters most.
        limits: of each run.

    Raises:
        UnknownCodeError: if there is no such code.
    """
    request = {**registry.address(name), "blade": encode(blade), "runs": [list(run) for run in runs]}

    def modes(number: int, data: Any) -> Modes:
        omega, _, count = runs[number]
        return boundary.modes(data, omega, count)

    return exchange(__name__, json.dumps(request).encode(), len(runs), limits, modes)


def exchange(
    module: str, request: bytes, count: int, limits: Limits, made: Callable[[int, Any], T]
) -> list[T | Failure]:
    """The answers to ``count`` questions, each validated by ``made(number, data)``; a failure for each that has none."""
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
        except (ValueError, TypeError) as error:  # of the schema, or of the class that is made of it
            out.append(Failure("nonsense", one_line(error)))
    return out + [ended] * (count - len(out))


def declined(code: Any, asked: str, question: object) -> Reply | None:
    """Why a code does not get as far as solving, if it does not: not installed, not supported, or what it raised.

    Args:
        code: any.
        asked: its method that says whether it takes the question: ``unsupported``.
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
    except BaseException as error:  # whatever a foreign code raises is its answer to this run, and no other's
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
