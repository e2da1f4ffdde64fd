"""Run one module in a separate process and leave no process behind. Uses only the standard library, so it starts fast.

``python -P supervisor.py MODULE BYTES`` forks. The child leads a new session, has at most BYTES of address space, and
calls ``MODULE.main()``. The parent is the subreaper of all processes that the child starts (Linux), including
double-forked ones. When the child ends, or the other end of standard input is closed, the parent kills all of them and
ends with the child's status.
"""

import ctypes
import importlib
import os
import select
import signal
import sys
import time
from contextlib import suppress

SET_PARENT_DEATH_SIGNAL, SET_CHILD_SUBREAPER = 1, 36
"""Of ``prctl`` (linux/prctl.h)."""


def main() -> None:
    """Fork, wait, kill the remaining processes, and end with the child's status."""
    module, space = sys.argv[1], int(sys.argv[2])
    _limit("RLIMIT_CORE", 0)  # no core file after a crash
    _prctl(SET_CHILD_SUBREAPER, 1)
    ended, bell = os.pipe()
    os.set_blocking(bell, False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.set_wakeup_fd(bell, warn_on_full_buffer=False)
    child = os.fork()
    if not child:
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        os.close(ended)
        os.close(bell)
        _work(module, space)
    status = _wait(child, ended)
    _sweep(child)
    _end(status)


def _work(module: str, space: int) -> None:
    os.setsid()
    _prctl(SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)
    _limit("RLIMIT_AS", space)
    importlib.import_module(module).main()
    os._exit(0)


def _wait(child: int, ended: int) -> int:
    """The child's wait status, after it has ended, or was killed because standard input closed."""
    poll = select.poll()
    poll.register(ended, select.POLLIN)
    poll.register(0, 0)  # hang-up only: the child reads the data
    while True:
        for number, _ in poll.poll():
            if number == ended:
                os.read(ended, 4096)
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


def _end(status: int) -> None:
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        with suppress(OSError, ValueError):  # SIGKILL has no handler to reset
            signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)
    os._exit(os.waitstatus_to_exitcode(status) if os.WIFEXITED(status) else 255)


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
