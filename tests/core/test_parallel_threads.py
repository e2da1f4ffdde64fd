"""Kernels release the interpreter's lock: another thread runs Python while they compute.

The lock is not taken from a thread by time here, so that the count of the other thread moves between two statements only if a
kernel lets it go. Nothing is timed: a kernel is called again until the other thread was scheduled meanwhile.
"""

import sys
import threading
import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from southwell.core.blade import uniform_blade
from southwell.core.compiled import kernels
from southwell.core.element.discretize import discretize
from southwell.core.tree import pencil

CALLS = 500

BLADE = uniform_blade("blade", 10.0, 1.0, EA=1e9, GJ=1e6, EI_y=1e6, EI_z=4e6, mass=10.0, I_y=0.1, I_z=0.3)
MESH = discretize(BLADE, 2000)
P = pencil.linearize(MESH, pencil.undeformed(MESH), 8.0, np.zeros(3))
VECTORS = np.ones((8, len(P.residual)))

CALLED: dict[str, Callable[[], object]] = {
    "product": lambda: kernels.product(P.K, 1.0, P.links.arrays, VECTORS),
    "factor": lambda: kernels.factor(P.K, P.links.arrays),
    "negative_pivots": lambda: kernels.negative_pivots(P.K, P.C, P.M, P.links.arrays, 1.0),
}


@pytest.fixture
def counted() -> Iterator[Callable[[], int]]:
    """The count of a thread that gives the lock away after each step."""
    count, stopped = [0], threading.Event()

    def step() -> None:
        while not stopped.is_set():
            count[0] += 1
            time.sleep(0)

    interval = sys.getswitchinterval()
    thread = threading.Thread(target=step, daemon=True)
    sys.setswitchinterval(1e3)  # before the thread waits for the lock
    thread.start()
    yield lambda: count[0]
    sys.setswitchinterval(interval)
    stopped.set()
    thread.join()


def moved(called: Callable[[], object], counted: Callable[[], int]) -> bool:
    """Whether the other thread ran during a call."""
    before = counted()
    called()
    return counted() > before


@pytest.mark.parametrize("name", CALLED)
def test_another_thread_runs_meanwhile(name: str, counted: Callable[[], int]) -> None:
    assert any(moved(CALLED[name], counted) for _ in range(CALLS))


def test_a_call_that_keeps_the_lock_is_noticed(counted: Callable[[], int]) -> None:
    """Sorting integers is one that does."""
    assert not any(moved(lambda: sorted(range(100_000, 0, -1)), counted) for _ in range(20))
