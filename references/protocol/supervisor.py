"""Run modules in separate processes and leave no process behind.

``python -P supervisor.py SOCKET MODULE…`` imports the modules, on Linux, and then forks a supervisor for each request, with
four file descriptors: the standard streams of the process to run, and a pipe for its status. It ends when the other end of the
socket is closed. Importing takes most of a second, so the process that forks is kept where many requests follow. It never
imports a code. On macOS a process that has loaded system libraries cannot be forked, so nothing is imported before.

A supervisor writes its process ID and forks again. The child leads a new session, has at most the requested address space, and
calls ``main()`` of the requested module. The supervisor is the subreaper of all processes that the child starts (Linux),
including double-forked ones. When the child ends, or the other end of standard input is closed, it kills all of them and
writes the child's exit code.
"""

import ctypes
import gc
import importlib
import json
import os
import select
import signal
import socket
import sys
import time
from contextlib import suppress

SET_PARENT_DEATH_SIGNAL, SET_CHILD_SUBREAPER = 1, 36
"""Of ``prctl`` (linux/prctl.h)."""

REQUEST = 256
"""Bytes of a request: JSON ``[module, address space in bytes]``, filled up with blanks."""

OBJECTS = 100_000
"""New objects after which a process looks for cycles to free; after 700, Python's default, it takes 5 % of a run."""


def main() -> None:
    """Fork a supervisor for each request until the socket is closed."""
    link = socket.socket(fileno=int(sys.argv[1]))
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # the kernel removes ended supervisors
    for name in sys.argv[2:] if sys.platform == "linux" else ():
        with suppress(Exception):  # the child imports its module again and reports the error
            importlib.import_module(name)
    gc.set_threshold(OBJECTS)
    gc.freeze()  # else the collections of each child would copy all pages of what is imported
    while True:
        request, streams, _, _ = socket.recv_fds(link, REQUEST, 4)
        if not request:
            os._exit(0)
        if not os.fork():
            link.close()
            supervise(*json.loads(request), *streams)
        for stream in streams:
            os.close(stream)


def supervise(module: str, space: int, reads: int, writes: int, errors: int, status: int) -> None:
    """Fork, wait, kill the remaining processes, write the child's exit code, and end."""
    os.setsid()
    for number, stream in enumerate((reads, writes, errors)):
        os.dup2(stream, number)
        os.close(stream)
    os.write(status, b"%d\n" % os.getpid())
    _limit("RLIMIT_CORE", 0)  # no core file after a crash
    _prctl(SET_CHILD_SUBREAPER, 1)
    end_pipe, bell = os.pipe()
    os.set_blocking(bell, False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.set_wakeup_fd(bell, warn_on_full_buffer=False)
    child = os.fork()
    if not child:
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        for own in (end_pipe, bell, status):
            os.close(own)
        _work(module, space)
    code = _wait(child, end_pipe)
    _sweep(child)
    with suppress(BrokenPipeError):  # nobody is left to read it
        os.write(status, b"%d\n" % os.waitstatus_to_exitcode(code))
    os._exit(0)


def _work(module: str, space: int) -> None:
    os.setsid()
    _prctl(SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)
    _limit("RLIMIT_AS", space)
    importlib.import_module(module).main()
    os._exit(0)


def _wait(child: int, end_pipe: int) -> int:
    """The child's wait status, after it has ended, or was killed because standard input closed."""
    poll = select.poll()
    poll.register(end_pipe, select.POLLIN)
    poll.register(0, 0)  # hang-up only: the child reads the data
    while True:
        for number, _ in poll.poll():
            if number == end_pipe:
                os.read(end_pipe, 4096)
            else:
                poll.unregister(0)
                _kill(child)
        pid, status = os.waitpid(child, os.WNOHANG)
        if pid:
            return status


def _kill(child: int) -> None:
    for kill, pid in ((os.killpg, child), (os.kill, child)):
        with suppress(ProcessLookupError, PermissionError):
            kill(pid, signal.SIGKILL)


def _sweep(child: int) -> None:
    """Kill the processes that the child left running; orphans become children of this process."""
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(child, signal.SIGKILL)
    while True:
        for pid in _children():
            with suppress(ProcessLookupError, PermissionError):
                os.kill(pid, signal.SIGKILL)
        try:
            pid, _ = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return
        if not pid:
            time.sleep(0.002)


def _children() -> list[int]:
    """Children of this process; empty if the kernel does not list them."""
    try:
        with open(f"/proc/self/task/{os.getpid()}/children", encoding="ascii") as file:
            return [int(pid) for pid in file.read().split()]
    except OSError:
        return []


def _prctl(option: int, value: int) -> None:
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):  # another C library
            ctypes.CDLL(None).prctl(option, value, 0, 0, 0)


def _limit(name: str, value: int) -> None:
    import resource

    number = getattr(resource, name)
    _, hard = resource.getrlimit(number)
    value = value if hard == resource.RLIM_INFINITY else min(value, hard)
    with suppress(OSError, ValueError):  # macOS refuses to limit the address space
        resource.setrlimit(number, (value, value))


if __name__ == "__main__":
    main()
