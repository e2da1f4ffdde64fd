"""All checks asked of a foreign code in a process of its own; a check that ends it fails, and the others go on in a new one."""

import json
from collections.abc import Iterator
from typing import Annotated, Any, Literal

from msgspec import Meta, Struct

from ...references.protocol import boundary, registry
from ...references.protocol.boundary import NonsenseError
from ...references.protocol.child import Reply, blunder, serve
from ...references.protocol.process import Failure, Limits, converse, one_line
from .suite import CHECKS, Outcome, judge


class _Judged(Struct, frozen=True, forbid_unknown_fields=True):
    verdict: Literal["pass", "fail", "not applicable", "not run"]
    reason: Annotated[str, Meta(max_length=100_000)]


def outcomes(name: str, limits: Limits = Limits()) -> list[Outcome]:  # noqa: B008
    """What came of every check of ``suite.CHECKS``, in their order.

    Args:
        name: of the code, or its import path.
        limits: of each check.

    Raises:
        UnknownCodeError: if there is no such code.
    """
    done: list[Outcome] = []
    where = registry.address(name)
    while len(done) < len(CHECKS):
        asked = list(range(len(done), len(CHECKS)))
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
            done.append(Outcome(CHECKS[len(done)], verdict, one_line(reason)))
        else:
            if len(lines) == len(asked):
                break
        done.append(Outcome(CHECKS[len(done)], "fail", ended.reason))
    return done


def _answer(request: Any) -> Iterator[Reply]:
    code = registry.loaded(request)
    for number in request["checks"]:
        if isinstance(code, Failure):
            yield {"kind": code.kind, "reason": code.reason}
            continue
        try:
            outcome = judge(code, CHECKS[number])
            yield {"verdict": outcome.verdict, "reason": outcome.reason}
        except BaseException as error:  # an exit, too
            yield blunder(error)


def main() -> None:
    """Answer the one request on standard input."""
    serve(_answer)
