"""Checks of a foreign code in a separate process; a check that ends the process fails, a new process runs the rest."""

import json
from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Literal

from msgspec import Meta, Struct

from ...references.protocol import boundary, registry
from ...references.protocol.boundary import NonsenseError
from ...references.protocol.process import Failure, Limits, converse, one_line
from ...references.protocol.wire import Reply, foreign_exception, serve
from .suite import CHECKS, EVERY, Check, Outcome, judge

LIMITS = Limits(seconds=600.0)
"""Limits of one check, which runs several solutions."""


class _Judged(Struct, frozen=True, forbid_unknown_fields=True):
    verdict: Literal["pass", "fail", "not applicable", "not run"]
    reason: Annotated[str, Meta(max_length=100_000)]


def outcomes(name: str, checks: Sequence[Check] = CHECKS, limits: Limits = LIMITS) -> list[Outcome]:
    """Run checks on a code and return the results in the same order.

    Args:
        name: name of the code, or its import path.
        checks: checks to run, from ``suite.EVERY``.
        limits: limits of each check.

    Raises:
        UnknownCodeError: if the code is unknown.
    """
    outcomes: list[Outcome] = []
    where = registry.address(name)
    while len(outcomes) < len(checks):
        pending = [EVERY.index(check) for check in checks[len(outcomes) :]]
        request = json.dumps({**where, "checks": pending}).encode()
        lines, failure = converse(__name__, request, len(pending), limits)
        for number, line in enumerate(lines):
            try:
                data = boundary.reply(line, number)
                judgement = boundary.failure(data) or boundary.convert(data, _Judged)
            except NonsenseError as error:
                failure = Failure("nonsense", one_line(error))
                break
            verdict, reason = (
                ("fail", judgement.reason) if isinstance(judgement, Failure) else (judgement.verdict, judgement.reason)
            )
            outcomes.append(Outcome(checks[len(outcomes)], verdict, one_line(reason)))
        else:
            if len(lines) == len(pending):
                break
        outcomes.append(Outcome(checks[len(outcomes)], "fail", failure.reason))
    return outcomes


def _answer(request: Any) -> Iterator[Reply]:
    code = registry.loaded(request)
    for number in request["checks"]:
        if isinstance(code, Failure):
            yield {"kind": code.kind, "reason": code.reason}
            continue
        try:
            outcome = judge(code, EVERY[number])
            yield {"verdict": outcome.verdict, "reason": outcome.reason}
        except BaseException as error:  # also SystemExit
            yield foreign_exception(error)


def main() -> None:
    """Answer the one request on standard input."""
    serve(_answer)
