"""From Python the solver runs on one thread, as in the commands, and leaves the caller's limits as they were."""

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from southwell.core import solve
from southwell.core.spectrum import mesh_solver

from ..support.beams import PARK


def threads() -> set[int]:
    """Numbers of threads of the linear algebra libraries."""
    return {pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"}


@pytest.mark.parametrize(
    "solved",
    [
        lambda: solve.modes(PARK, 1.0, count=2, accuracy=1e-3),
        lambda: solve.sweep(PARK, [1.0, 2.0], count=2, accuracy=1e-3),
        lambda: solve.mesh_sweep(PARK, [1.0, 2.0], 10, 2),
    ],
    ids=["modes", "sweep", "mesh_sweep"],
)
def test_the_solver_takes_one_thread(solved, monkeypatch: pytest.MonkeyPatch) -> None:
    inside: list[set[int]] = []
    balance = mesh_solver.balance

    def watched(*arguments):
        inside.append(threads())
        return balance(*arguments)

    monkeypatch.setattr(mesh_solver, "balance", watched)
    with threadpool_limits(2, user_api="blas"):
        np.linalg.eigh(np.eye(3))
        results = solved()
        for _ in [results] if isinstance(results, solve.Modes) else results:
            assert threads() == {2}
    assert inside
    assert all(numbers == {1} for numbers in inside)
