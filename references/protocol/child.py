"""The worker process's side of the protocol: read one request and write each answer as soon as it is ready."""

import fcntl
import json
import os
import sys
from collections.abc import Iterator
from typing import Any, TextIO

from .process import raised

Reply = dict[str, Any]

HIGH = 200
"""Lowest file descriptor of the pipe for answers; some codes write to descriptor 3."""


def serve(answer: Any) -> None:
    """Write each reply that ``answer(request)`` yields as one line, immediately."""
    request = json.loads(sys.stdin.buffer.readline())
    with answers_pipe() as pipe:
        pipe.write("\n")  # ready: the time limit of the first answer starts
        pipe.flush()
        replies: Iterator[Reply] = answer(request)
        for number, reply in enumerate(replies):
            pipe.write(_line({"run": number, **reply}) + "\n")
            pipe.flush()


def answers_pipe() -> TextIO:
    """Reserve standard output for answers: redirect prints of the code to standard error, and its input to the null device."""
    pipe = os.fdopen(fcntl.fcntl(1, fcntl.F_DUPFD_CLOEXEC, HIGH), "w", encoding="utf-8")
    os.dup2(2, 1)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    return pipe


def failed(kind: str, reason: str) -> Reply:
    """A reply that gives a reason instead of an answer."""
    return {"kind": kind, "reason": reason}


def foreign_exception(error: BaseException, where: str = "") -> Reply:
    """The reply for an exception that a code must not raise, including ``SystemExit``."""
    return failed("nonsense", f"{where}: {raised(error)}" if where else raised(error))


def _line(reply: Reply) -> str:
    try:
        return json.dumps(reply)
    except Exception as error:  # whatever a code puts into its answer
        return json.dumps({"run": reply["run"], **foreign_exception(error, "its answer")})
