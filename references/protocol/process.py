"""A conversation with a process that may do anything: limits of time, memory and output, and nothing left running.

The process is ``supervisor.py`` with a module of the package. It reads one request, a line of JSON, and writes a line for each
answer as soon as it has it. Closing its standard input ends it and all that it has started.
"""

import os
import selectors
import signal
import subprocess
import sys
import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Literal

SUPERVISOR = Path(__file__).with_name("supervisor.py")

KEPT = 8_192
"""Bytes of standard error that are kept: the last ones."""

LONGEST_LINE = 16 * 2**20
"""Bytes of one answer at most; a hundred modes are a third of a megabyte."""

LONGEST_REASON = 400
"""Characters of a reason."""

ADDRESS_SPACE = 8
"""Limit of the address space over the limit of memory: libraries reserve far more than they use."""

START = 120.0
"""Seconds until the process is ready; no foreign code has run by then."""

LOOK = 0.1
"""Seconds between two looks at the process."""

GRACE = 5.0
"""Seconds that the supervisor has to kill what it watches."""

Kind = Literal["crashed", "timed out", "nonsense", "refused", "not installed", "unsupported", "unknown", "internal"]


@dataclass(frozen=True)
class Limits:
    """What one solution may take.

    Attributes:
        seconds: wall time of one solution; the first has the import of the code in it.
        memory: bytes resident, of the process and all that it has started, together (Linux). The address space of each is
            limited to eight times as much on every platform.
    """

    seconds: float = 300.0
    memory: int = 4 * 2**30


@dataclass(frozen=True)
class Failure:
    """Why there is no answer.

    Attributes:
        kind: ``crashed``, ``timed out``, ``nonsense`` (an answer that cannot be one), ``refused`` (the code says it
            could not answer), ``not installed``, ``unsupported`` (the code declines the question), ``unknown`` (there is no
            such code), ``internal`` (an error of this program, not of the code).
        reason: one line for a table.
    """

    kind: Kind
    reason: str


def converse(module: str, request: bytes, expected: int, limits: Limits) -> tuple[list[bytes], Failure]:
    """The lines, at most ``expected``, that a module writes in answer to a request, and why there are no more.

    Args:
        module: has ``main()``, which writes an empty line when it is ready and then its answers; runs in a process that ends
            with this call, and all that it has started with it.
        request: one line.
        expected: how many answers are asked for.
        limits: of each answer.
    """
    alone = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    child = subprocess.Popen(
        [sys.executable, "-P", str(SUPERVISOR), module, str(ADDRESS_SPACE * limits.memory)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        bufsize=0,
        env={**os.environ, **alone},
        start_new_session=True,
    )
    try:
        lines, stopped, said = _listen(child, request, expected, limits)
    finally:
        _end(child)
    return lines, stopped or _crash(child.returncode, said.decode("utf-8", "replace"))


def _listen(
    child: subprocess.Popen[bytes], request: bytes, expected: int, limits: Limits
) -> tuple[list[bytes], Failure | None, bytes]:
    to, answers, errors = _pipes(child)
    lines: list[bytes] = []
    line, said, rest = bytearray(), b"", memoryview(request + b"\n")
    deadline, look = time.monotonic() + START, 0.0
    for stream in (to, answers, errors):
        os.set_blocking(stream.fileno(), False)
    with selectors.DefaultSelector() as ready:
        ready.register(answers, selectors.EVENT_READ)
        ready.register(errors, selectors.EVENT_READ)
        ready.register(to, selectors.EVENT_WRITE)
        while len(lines) <= expected:
            now, gone = time.monotonic(), child.poll() is not None
            if now >= deadline:
                within = limits.seconds if lines else START
                return lines[1:], Failure("timed out", f"no answer within {within:g} s"), said
            if now >= look:
                look = now + LOOK
                if (used := _resident(child.pid)) > limits.memory:
                    most = f"its limit is {limits.memory / 2**30:g} GiB"
                    return lines[1:], Failure("crashed", f"stopped: {used / 2**30:.3g} GiB of memory: {most}"), said
            events = ready.select(0.0 if gone else min(LOOK, deadline - now))
            if gone and not any(key.fileobj is not to for key, _ in events):
                break  # nothing is left in its pipes
            for key, _ in events:
                if key.fileobj is to:
                    rest = _send(to, rest)
                    if not rest:
                        ready.unregister(to)
                    continue
                try:
                    got = os.read(key.fd, 65_536)
                except BlockingIOError:
                    continue
                if not got:
                    ready.unregister(key.fileobj)
                elif key.fileobj is errors:
                    said = (said + got)[-KEPT:]
                else:
                    *whole, last = got.split(b"\n")
                    for part in whole:
                        lines.append(bytes(line) + part)
                        line.clear()
                        deadline = time.monotonic() + limits.seconds
                    line += last
                    if len(line) > LONGEST_LINE:
                        return lines[1:], Failure("nonsense", f"an answer of more than {LONGEST_LINE >> 20} MiB"), said
    return lines[1 : expected + 1], None, said


def _send(to: IO[bytes], rest: memoryview) -> memoryview:
    try:
        return rest[os.write(to.fileno(), rest) :]
    except BlockingIOError:
        return rest
    except BrokenPipeError:
        return rest[:0]


def _end(child: subprocess.Popen[bytes]) -> None:
    """End the process and all that it has started."""
    to, *others = _pipes(child)
    try:
        to.close()
        child.wait(GRACE)
    except BaseException as error:  # its supervisor does not answer, or this process is told to stop
        for pid in (*_below(child.pid), child.pid):
            with suppress(ProcessLookupError, PermissionError):
                os.kill(pid, signal.SIGKILL)
        child.wait()
        if not isinstance(error, subprocess.TimeoutExpired):
            raise
    finally:
        for pipe in others:
            pipe.close()


def _pipes(child: subprocess.Popen[bytes]) -> tuple[IO[bytes], IO[bytes], IO[bytes]]:
    if child.stdin is None or child.stdout is None or child.stderr is None:
        raise ValueError("not started with pipes")
    return child.stdin, child.stdout, child.stderr


def _below(pid: int) -> list[int]:
    """All processes that a process has started, and those that they have; none where the kernel does not tell."""
    found, todo = [], deque([pid])
    while todo:
        one = todo.popleft()
        with suppress(OSError):
            text = Path(f"/proc/{one}/task/{one}/children").read_text(encoding="ascii")
            todo += (new := [int(child) for child in text.split()])
            found += new
    return found


def _resident(pid: int) -> int:
    """Bytes of memory that are resident, of all that a process has started."""
    pages = 0
    for one in _below(pid):
        with suppress(OSError, IndexError, ValueError):
            pages += int(Path(f"/proc/{one}/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def _crash(status: int, said: str) -> Failure:
    last = (said.strip().splitlines() or [""])[-1].strip()
    how = f"signal {_signal(-status)}" if status < 0 else f"exit status {status}"
    return Failure("crashed", one_line(f"the code's process ended with {how}" + (f": {last}" if last else "")))


def _signal(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:  # a real-time signal
        return str(number)


def one_line(text: object) -> str:
    """A message as one line of printable text, not too long."""
    try:
        words = str(text)
    except BaseException as error:  # the message of an exception is code of whoever raised it
        words = f"its message raised {type(error).__name__}"
    words = words[: 4 * LONGEST_REASON].encode("utf-8", "replace").decode("utf-8")
    words = "".join(c if c.isprintable() else "?" for c in " ".join(words.split()))
    return words if len(words) <= LONGEST_REASON else f"{words[: LONGEST_REASON - 1]}…"


def raised(error: BaseException) -> str:
    """An exception in one line: what it is, and what it says."""
    return f"{type(error).__name__}: {one_line(error)}".rstrip(": ")
