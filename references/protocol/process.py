"""Run an untrusted process with limits on time, memory and output, and kill all its descendants.

The process runs a module of the package under ``supervisor.py``. It reads one request, a line of JSON, and writes one line
per answer as soon as it is ready. Closing its standard input ends it and all processes it has started.
"""

import os
import selectors
import signal
import time
from dataclasses import dataclass
from typing import IO, Literal

from . import launch, portable

STDERR_BYTES = 8_192
"""Number of last bytes of standard error that are kept."""

LONGEST_LINE = 16 * 2**20
"""Largest size of one answer, bytes; a hundred modes take a third of a megabyte."""

LONGEST_REASON = 400
"""Largest length of a reason, characters."""

ADDRESS_SPACE = 8
"""Ratio of the address space limit to the memory limit: libraries reserve far more than they use."""

START = 120.0
"""Time limit until the process is ready, s; no foreign code has run by then."""

POLL_INTERVAL = 0.1
"""Interval at which the process is polled, s."""

GRACE = 5.0
"""Time that the supervisor has to end its processes, s."""

Kind = Literal[
    "crashed", "timed out", "nonsense", "refused", "not installed", "unsupported", "unknown", "internal", "no reference"
]


@dataclass(frozen=True)
class Limits:
    """Limits of one solution.

    Attributes:
        seconds: wall time, s; the first solution includes the import of the code.
        memory: resident memory of the process and all processes it has started, bytes (Linux). On every platform, the
            address space of each is limited to eight times this value.
        reuse: whether an earlier answer to the same question may be taken from the store.
    """

    seconds: float = 300.0
    memory: int = 4 * 2**30
    reuse: bool = False


@dataclass(frozen=True)
class Failure:
    """The reason why there is no answer.

    Attributes:
        kind: ``crashed``, ``timed out``, ``nonsense`` (an invalid answer), ``refused`` (the code reports that it
            could not solve the problem), ``not installed``, ``unsupported`` (the code declines the blade or mechanism),
            ``unknown`` (no such code), ``internal`` (an error of this program, not of the code), ``no reference`` (core has
            no answer for comparison).
        reason: one line, for tables.
    """

    kind: Kind
    reason: str


def converse(module: str, request: bytes, expected: int, limits: Limits) -> tuple[list[bytes], Failure]:
    """Send a request to a module in a separate process; return its lines, at most ``expected``, and why there are no more.

    Args:
        module: has ``main()``, which writes an empty line when it is ready and then its answers. Its process, and all
            processes it has started, end with this call.
        request: one line.
        expected: number of answers.
        limits: for each answer.
    """
    if not portable.forks():
        return _spawned(module, request, expected, limits)
    child = launch.start(module, ADDRESS_SPACE * limits.memory)
    try:
        lines, stopped, stderr = _listen(child, request, expected, limits)
    finally:
        _end(child)
    return lines, stopped or _crash(child.returncode or 0, stderr.decode("utf-8", "replace"))


def _spawned(module: str, request: bytes, expected: int, limits: Limits) -> tuple[list[bytes], Failure]:
    """``converse`` where processes cannot be forked."""
    output = portable.spawned(
        module,
        request,
        expected + 1,  # the first line says that it is ready
        time_limit=lambda lines: limits.seconds if lines else START,
        stop_reason=lambda pid: _too_large(portable.resident([pid, *portable.descendants(pid)]), limits),
        longest_line=LONGEST_LINE,
        error_bytes=STDERR_BYTES,
        poll_interval=POLL_INTERVAL,
    )
    if not output.stopped:
        return output.lines[1:], _crash(output.code, output.stderr.decode("utf-8", "replace"))
    kinds: dict[str, Kind] = {"no answer within": "timed out", "an answer of more than": "nonsense"}
    for start, kind in kinds.items():
        if output.stopped.startswith(start):
            return output.lines[1:], Failure(kind, output.stopped)
    return output.lines[1:], Failure("crashed", output.stopped)


def _too_large(used: int, limits: Limits) -> str:
    """The reason to stop a process that uses more memory than its limit; empty if it does not."""
    if used <= limits.memory:
        return ""
    return f"stopped: {used / 2**30:.3g} GiB of memory: the limit is {limits.memory / 2**30:g} GiB"


def _listen(
    child: launch.Child, request: bytes, expected: int, limits: Limits
) -> tuple[list[bytes], Failure | None, bytes]:
    stdin, answers, errors = child.stdin, child.stdout, child.stderr
    lines: list[bytes] = []
    line, stderr, unsent = bytearray(), b"", memoryview(request + b"\n")
    deadline, next_check = time.monotonic() + START, 0.0
    with selectors.DefaultSelector() as ready:
        ready.register(answers, selectors.EVENT_READ)
        ready.register(errors, selectors.EVENT_READ)
        ready.register(stdin, selectors.EVENT_WRITE)
        while len(lines) <= expected:
            now, has_ended = time.monotonic(), child.poll() is not None
            if now >= next_check:
                next_check = now + POLL_INTERVAL
                if why := _too_large(_resident(child.pid), limits):
                    return lines[1:], Failure("crashed", why), stderr
            if now >= deadline:
                within = limits.seconds if lines else START
                return lines[1:], Failure("timed out", f"no answer within {within:g} s"), stderr
            events = ready.select(0.0 if has_ended else min(POLL_INTERVAL, deadline - now))
            if has_ended and not any(key.fileobj is not stdin for key, _ in events):
                break  # nothing is left in its pipes
            for key, _ in events:
                if key.fileobj is stdin:
                    unsent = _send(stdin, unsent)
                    if not unsent:
                        ready.unregister(stdin)
                    continue
                try:
                    received = os.read(key.fd, 65_536)
                except BlockingIOError:
                    continue
                if not received:
                    ready.unregister(key.fileobj)
                elif key.fileobj is errors:
                    stderr = (stderr + received)[-STDERR_BYTES:]
                else:
                    *complete, last = received.split(b"\n")
                    for part in complete:
                        lines.append(bytes(line) + part)
                        line.clear()
                        deadline = time.monotonic() + limits.seconds
                    line += last
                    if len(line) > LONGEST_LINE:
                        return (
                            lines[1:],
                            Failure("nonsense", f"an answer of more than {LONGEST_LINE >> 20} MiB"),
                            stderr,
                        )
    return lines[1 : expected + 1], None, stderr


def _send(to: IO[bytes], unsent: memoryview) -> memoryview:
    try:
        return unsent[os.write(to.fileno(), unsent) :]
    except BlockingIOError:
        return unsent
    except BrokenPipeError:
        return unsent[:0]


def _end(child: launch.Child) -> None:
    """End the process and all processes it has started."""
    try:
        child.stdin.close()
        if not child.wait(GRACE):  # its supervisor does not respond
            child.kill()
    except BaseException:  # this process is interrupted
        child.kill()
        raise
    finally:
        child.wait(GRACE)
        child.close()


def _resident(pid: int | None) -> int:
    """Resident memory of all descendants of a process, if it has started, bytes."""
    return portable.resident(portable.descendants(pid) if pid else [])


def _crash(status: int, stderr: str) -> Failure:
    last = (stderr.strip().splitlines() or [""])[-1].strip()
    how = f"signal {_signal(-status)}" if status < 0 else f"exit status {status}"
    return Failure("crashed", one_line(f"the code's process ended with {how}" + (f": {last}" if last else "")))


def _signal(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:  # a real-time signal
        return str(number)


def one_line(text: object) -> str:
    """A message as one line of printable text, at most ``LONGEST_REASON`` characters."""
    try:
        words = str(text)
    except BaseException as error:  # ``__str__`` of a foreign exception may raise
        words = f"its message raised {type(error).__name__}"
    words = words[: 4 * LONGEST_REASON].encode("utf-8", "replace").decode("utf-8")
    words = "".join(c if c.isprintable() else "?" for c in " ".join(words.split()))
    return words if len(words) <= LONGEST_REASON else f"{words[: LONGEST_REASON - 1]}…"


def raised(error: BaseException) -> str:
    """An exception in one line: its type and message."""
    return f"{type(error).__name__}: {one_line(error)}".rstrip(": ")
