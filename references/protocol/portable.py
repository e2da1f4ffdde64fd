"""What differs between operating systems: forking, file descriptors, interrupts; and separate processes without forking.

Where processes cannot be forked (Windows), or ``SOUTHWELL_SPAWN`` is set, each process of a code is started anew by the
interpreter and read by threads. Time and output are limited as elsewhere, and the process ends when this one does; its memory
is limited on Linux only, and processes that it starts are ended where the system lists them (Linux).
"""

import os
import signal
import socket
import subprocess
import sys
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread
from time import monotonic
from typing import IO

SPAWN = "SOUTHWELL_SPAWN"
"""Environment variable that, if not empty, starts processes without forking on every system."""

SPAWNED = "SOUTHWELL_SPAWNED"
"""Environment variable of a process that ends when its standard input is closed."""

START = "import importlib, sys; importlib.import_module(sys.argv[1]).main()"

HIGH = 200
"""Lowest number of a duplicate descriptor; some codes write to descriptor 3."""


def forks() -> bool:
    """Whether processes are forked: by default where the system can, and can send descriptors to another process."""
    return hasattr(os, "fork") and hasattr(socket, "send_fds") and not os.environ.get(SPAWN)


def duplicate(descriptor: int) -> int:
    """A duplicate of a file descriptor that child processes do not inherit."""
    if sys.platform == "win32":
        return os.dup(descriptor)  # not inherited (PEP 446)
    import fcntl

    return fcntl.fcntl(descriptor, fcntl.F_DUPFD_CLOEXEC, HIGH)


@contextmanager
def interrupts_blocked() -> Iterator[None]:
    """Context manager within which processes start without taking interrupts, where the system can block them."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def ignore_interrupts() -> None:
    """Ignore interrupts in this process, but not in those that it starts."""
    signal.signal(signal.SIGINT, lambda *_: None)  # unlike SIG_IGN, not inherited by foreign codes
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})


def end_with_input() -> None:
    """End this process when its standard input is closed, if it was spawned; call it when the request has been read."""
    if not os.environ.pop(SPAWNED, ""):
        return
    watched = duplicate(0)

    def watch() -> None:
        while os.read(watched, 1):
            pass
        os._exit(1)

    Thread(target=watch, daemon=True).start()


def descendants(pid: int) -> list[int]:
    """All descendants of a process; empty if the kernel does not list them."""
    pids, todo = [], deque([pid])
    while todo:
        parent = todo.popleft()
        with suppress(OSError):
            text = Path(f"/proc/{parent}/task/{parent}/children").read_text(encoding="ascii")
            todo += (new := [int(child) for child in text.split()])
            pids += new
    return pids


def resident(pids: list[int]) -> int:
    """Resident memory of processes, bytes; 0 where the system does not list it (Linux does)."""
    pages = 0
    for pid in pids:
        with suppress(OSError, IndexError, ValueError):
            pages += int(Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") if pages else 0


@dataclass(frozen=True)
class Output:
    """Output of a spawned process: its lines, the last bytes of standard error, its exit code, and why it was stopped."""

    lines: list[bytes]
    stderr: bytes
    code: int
    stopped: str


def spawned(
    module: str,
    request: bytes,
    expected: int,
    time_limit: Callable[[int], float],
    stop_reason: Callable[[int], str],
    longest_line: int,
    error_bytes: int,
    poll_interval: float,
) -> Output:
    """Start a process that calls ``main()`` of a module, send it a request, and read its lines.

    Args:
        module: its full name.
        request: one line.
        expected: number of lines after which it is ended.
        time_limit: number of lines so far → seconds until the next one.
        stop_reason: process ID → why it must be stopped; called every ``poll_interval`` seconds.
        longest_line: largest size of a line, bytes.
        error_bytes: number of last bytes of standard error that are returned.
        poll_interval: time between two calls of ``stop_reason``, s.
    """
    one_thread = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    child = subprocess.Popen(
        [sys.executable, "-P", "-c", START, module],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={**os.environ, **one_thread, SPAWNED: "1"},
    )
    assert child.stdin
    assert child.stdout
    assert child.stderr
    queue: SimpleQueue[bytes] = SimpleQueue()
    errors = bytearray()
    readers = [
        Thread(target=_lines, args=(child.stdout, queue, longest_line), daemon=True),
        Thread(target=_last, args=(child.stderr, errors, error_bytes), daemon=True),
    ]
    lines: list[bytes] = []
    stopped = ""
    try:
        for reader in readers:
            reader.start()
        with suppress(OSError):  # it has ended
            child.stdin.write(request + b"\n")
            child.stdin.flush()
        deadline = monotonic() + time_limit(0)
        while len(lines) < expected and not stopped:
            try:
                line = queue.get(timeout=max(min(poll_interval, deadline - monotonic()), 0.001))
            except Empty:
                stopped = stop_reason(child.pid)
                if not stopped and monotonic() >= deadline:
                    stopped = f"no answer within {time_limit(len(lines)):g} s"
                continue
            if not line.endswith(b"\n"):
                stopped = f"an answer of more than {longest_line >> 20} MiB" if line else ""
                break
            lines.append(line[:-1])
            deadline = monotonic() + time_limit(len(lines))
    finally:
        if len(lines) >= expected or stopped:
            _end(child)
        code = child.wait()
        readers[1].join(poll_interval)
        for stream in (child.stdin, child.stdout):
            with suppress(OSError):
                stream.close()
    return Output(lines, bytes(errors), code, stopped)


def _end(child: subprocess.Popen[bytes]) -> None:
    started = descendants(child.pid)
    child.kill()
    for pid in started:
        with suppress(OSError):
            os.kill(pid, signal.SIGTERM if sys.platform == "win32" else signal.SIGKILL)


def _lines(stream: IO[bytes], queue: "SimpleQueue[bytes]", longest: int) -> None:
    """Put each line into the queue, and at the end an empty one."""
    with suppress(OSError, ValueError):  # closed
        while line := stream.readline(longest):
            queue.put(line)
    queue.put(b"")


def _last(stream: IO[bytes], into: bytearray, count: int) -> None:
    with suppress(OSError, ValueError), stream:
        while received := stream.read1(65_536):  # pyright: ignore[reportAttributeAccessIssue]
            into += received
            del into[:-count]
