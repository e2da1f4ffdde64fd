"""All checks asked of a foreign code in a process of its own; a check that ends it fails, and the others go on in a new one."""

import json
from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Literal

from msgspec import Meta, Struct

from ...references.protocol import boundary, registry
from ...references.protocol.boundary import NonsenseError
from ...references.protocol.child import Reply, blunder, serve
from ...references.protocol.process import Failure, Limits, converse, one_line
from .suite import CHECKS, EVERY, Check, Outcome, judge

LIMITS = Limits(seconds=600.0)
"""Of one check, which is several solutions."""


class _Judged(Struct, frozen=True, forbid_unknown_fields=True):
    verdict: Literal["pass", "fail", "not applicable", "not run"]
    reason: Annotated[str, Meta(max_length=100_000)]


def outcomes(name: str, checks: Sequence[Check] = CHECKS, limits: Limits = LIMITS) -> list[Outcome]:
    """What came of checks, in their order.

    Args:
        name: of the code, or its import path.
        checks: those of ``suite.EVERY`` that are asked.
        limits: of each check.

    Raises:
        UnknownCodeError: if there is no such code.
    """
    done: list[Outcome] = []
    where = registry.address(name)
    while len(done) < len(checks):
        asked = [EVERY.index(check) for check in checks[len(done) :]]
        request = json.dumps({**where, "checks": asked}).encode()
        lines, ended = converse(__name__, request, len(asked), limits)
        for number, line in enumerate(lines):
            try:
                data = boundary.reply(line, number)
                said = boundary.failure(data) or boundary.convert(data, _Judged)
            except NonsenseError as error:
                ended = Failure("nonsense", one_line(error))
                break
            verdict, reason = ("fail", said.reason) if isinstance(said, Failure) else (said.verdict, said.reason)
            done.append(Outcome(checks[len(done)], verdict, one_line(reason)))
        else:
            if len(lines) == len(asked):
                break
        done.append(Outcome(checks[len(done)], "fail", ended.reason))
    return done


def _answer(request: Any) -> Iterator[Reply]:
    code = registry.loaded(request)
    for number in request["checks"]:
        if isinstance(code, Failure):
            yield {"kind": code.kind, "reason": code.reason}
            continue
        try:
            outcome = judge(code, EVERY[number])
            yield {"verdict": outcome.verdict, "reason": outcome.reason}
        except BaseException as error:  # an exit, too
            yield blunder(error)


def main() -> None:
    """Answer the one request on standard input."""
    serve(_answer)
