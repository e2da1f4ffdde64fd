"""The foreign side of the conversation: one request, and answers written as they come."""

import fcntl
import json
import os
import sys
from collections.abc import Iterator
from typing import Any, TextIO

from .process import raised

Reply = dict[str, Any]

HIGH = 200
"""Least file descriptor of the answers' pipe, out of the way of codes that write to 3."""


def serve(answer: Any) -> None:
    """Write what ``answer(request)`` yields, a line each, as soon as it is there."""
    request = json.loads(sys.stdin.buffer.readline())
    with answers_pipe() as pipe:
        pipe.write("\n")  # ready: the clock of the first answer starts
        pipe.flush()
        replies: Iterator[Reply] = answer(request)
        for number, reply in enumerate(replies):
            pipe.write(_line({"run": number, **reply}) + "\n")
            pipe.flush()


def answers_pipe() -> TextIO:
    """Standard output for answers alone: what a foreign code prints goes to standard error, and it has nothing to read."""
    pipe = os.fdopen(fcntl.fcntl(1, fcntl.F_DUPFD_CLOEXEC, HIGH), "w", encoding="utf-8")
    os.dup2(2, 1)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    return pipe


def failed(kind: str, reason: str) -> Reply:
    """A reply without an answer."""
    return {"kind": kind, "reason": reason}


def blunder(error: BaseException, where: str = "") -> Reply:
    """The reply of a code that raised what no code may raise, even an exit."""
    return failed("nonsense", f"{where}: {raised(error)}" if where else raised(error))


def _line(reply: Reply) -> str:
    try:
        return json.dumps(reply)
    except Exception as error:  # whatever a code puts into its answer
        return json.dumps({"run": reply["run"], **blunder(error, "its answer")})
