"""Start supervised processes: each is forked by one process of ``supervisor.py``, which is kept for the next ones.

A matrix starts hundreds of processes. A forked one takes an eighth of the time of one that the interpreter starts anew (0.7
against 5.4 s on a busy machine, Exudyn's cable with ten elements), because imports are shared. Where processes cannot be
forked, ``portable`` starts them anew; it cannot be the only way.
"""

import json
import os
import select
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

from . import portable
from .supervisor import REQUEST

SUPERVISOR = Path(__file__).with_name("supervisor.py")

WARM_IMPORTS = ("southwell.references.warm_imports",)
"""What the process that forks imports."""

_starting = threading.Lock()
_kept: "_Forker | None" = None


@dataclass(frozen=True)
class _Forker:
    """The process that forks, and the socket for its requests; it ends when the socket is closed.

    ``surroundings`` are the environment variables and the current folder that it has inherited.
    """

    process: subprocess.Popen[bytes]
    link: socket.socket
    surroundings: tuple[dict[str, str], str]

    def close(self) -> None:
        self.link.close()
        self.process.wait()


@dataclass
class Child:
    """A supervisor.

    Attributes:
        stdin, stdout, stderr: of the process that it supervises; it ends soon after ``stdin`` is closed.
        returncode: exit code of that process, the signal negative; None while it, or anything it has started, is running.
    """

    stdin: IO[bytes]
    stdout: IO[bytes]
    stderr: IO[bytes]
    _status: int
    _forker: _Forker
    _said: bytearray = field(default_factory=bytearray)
    returncode: int | None = None

    @property
    def pid(self) -> int | None:
        """Process ID of the supervisor; None before it is forked."""
        self.poll()
        first, ended, _ = self._said.partition(b"\n")
        return int(first) if ended else None

    def poll(self) -> int | None:
        """Return the exit code; None while the process is running."""
        while self.returncode is None:
            try:
                received = os.read(self._status, 64)
            except BlockingIOError:
                break
            self._said += received
            if not received:
                codes = self._said.split(b"\n")[1:-1]
                self.returncode = int(codes[0]) if codes else -signal.SIGKILL  # the supervisor was killed
        return self.returncode

    def wait(self, seconds: float) -> bool:
        """Wait for the process to end; return False if it has not ended in time."""
        deadline, poller = time.monotonic() + seconds, select.poll()
        poller.register(self._status, select.POLLIN)
        while self.poll() is None:
            if (remaining := deadline - time.monotonic()) <= 0.0:
                return False
            poller.poll(1000.0 * remaining)
        return True

    def kill(self) -> None:
        """Kill the supervisor and all its descendants; before it is forked, the process that would fork it."""
        for pid in (*portable.descendants(self.pid), self.pid) if self.pid else (self._forker.process.pid,):
            with suppress(ProcessLookupError, PermissionError):
                os.kill(pid, signal.SIGKILL)

    def close(self) -> None:
        """Close the streams."""
        for stream in (self.stdin, self.stdout, self.stderr):
            stream.close()
        os.close(self._status)


def warm_up() -> None:
    """Start the process that forks, where processes are forked."""
    if portable.forks():
        prepare()


def prepare() -> _Forker:
    """Start the process that forks, unless it is running: it imports while the first request is prepared.

    It is replaced if it was killed, or if the environment or the current folder has changed, where it looks for modules.
    """
    global _kept
    with _starting:  # one for all threads
        surroundings = _surroundings()
        if _kept and (_kept.process.poll() is not None or _kept.surroundings != surroundings):
            _kept.close()
            _kept = None
        if _kept is None:
            _kept = _forker(surroundings)
        return _kept


def start(module: str, space: int) -> Child:
    """Start a process that calls ``main()`` of a module and has at most ``space`` bytes of address space."""
    forker = prepare()
    pipes = [os.pipe() for _ in range(4)]
    child_ends = [pipes[0][0], *(pipe[1] for pipe in pipes[1:])]
    own_ends = [pipes[0][1], *(pipe[0] for pipe in pipes[1:])]
    try:
        with suppress(BrokenPipeError, ConnectionResetError):  # it was killed; then nobody holds the other ends
            socket.send_fds(forker.link, [json.dumps([module, space]).encode().ljust(REQUEST)], child_ends)
    finally:
        for number in child_ends:
            os.close(number)
    for number in own_ends:
        os.set_blocking(number, False)
    stdin, stdout, stderr = (os.fdopen(n, m, buffering=0) for n, m in zip(own_ends, ("wb", "rb", "rb"), strict=False))
    return Child(stdin, stdout, stderr, own_ends[3], forker)


def _surroundings() -> tuple[dict[str, str], str]:
    return dict(os.environ), os.getcwd()


def _forker(surroundings: tuple[dict[str, str], str]) -> _Forker:
    own_end, child_end = socket.socketpair()
    one_thread = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    null = subprocess.DEVNULL
    with child_end:
        process = subprocess.Popen(
            [sys.executable, "-P", str(SUPERVISOR), str(child_end.fileno()), *WARM_IMPORTS],
            stdin=null,
            stdout=null,
            stderr=null,
            pass_fds=[child_end.fileno()],
            env={**surroundings[0], **one_thread},
            start_new_session=True,
        )
    return _Forker(process, own_end, surroundings)
