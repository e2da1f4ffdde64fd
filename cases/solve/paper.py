"""The equations of Park et al. (2010), literally, as a code: the modes of a blade from rigid bodies and massless elements."""

import pickle
import time
from functools import lru_cache

import numpy as np

from ...core.blade import Blade
from ...core.element.discretize import discretize, divide
from ...core.element.measures import Measure
from ...core.mechanism.description import MechanismError
from ...core.modes import STATIONS, Modes
from ...core.park2010_input import tree
from ...core.park2010_modes import Linear, linearize, modes, steady_state
from ...core.spectrum.eigen import UnstableError
from ...core.steady.blade_state import SteadyStateError
from ...core.tree import as_mechanism
from ...references.protocol.process import Failure
from ...references.protocol.worker import Answer, Run
from ..input.errors import NO_STATE


def answer(blade: Blade, run: Run, stiffness: Measure = "body_fixed") -> Answer:
    """The modes asked for by ``run``; a speed without a stable steady state gives a failure."""
    try:
        return paper_modes(blade, *run, stiffness)
    except NO_STATE as error:
        return Failure("refused", str(error))


def paper_modes(blade: Blade, omega: float, elements: int, count: int, stiffness: Measure = "body_fixed") -> Modes:
    """The ``count`` lowest modes at ``omega`` (rad/s); half of each element's mass is at either of its ends.

    Args:
        blade: the blade.
        omega: rotor speed, rad/s.
        elements: number of elements.
        count: number of modes.
        stiffness: ``body_fixed``, the paper's: linear in axes fixed in the body at an element's first end; or
            ``corotational``.

    Raises:
        SteadyStateError: Newton's method finds no steady state from the undeformed blade.
        UnstableError: the steady state is not stable.
    """
    start_time = time.perf_counter()
    chain = discretize(blade, elements, "half_end", stiffness)
    try:
        linear = _linear(pickle.dumps(as_mechanism.mechanism(chain, omega)))
    except MechanismError as error:
        raise SteadyStateError(f"omega: no steady state at {omega:.6g} rad/s: {error}") from error
    t = linear.tree
    try:
        np.linalg.cholesky(0.5 * (linear.K + linear.K.T))
    except np.linalg.LinAlgError:
        raise UnstableError(f"omega: {omega:.6g} rad/s: the stiffness K̂ is not positive definite") from None
    values, vectors = (a[..., :count] for a in modes(linear))
    s = divide(blade, elements) / blade.length
    nodes = slice(len(t.inertia) - len(s), len(t.inertia))
    twists = (linear.at.B @ linear.at.R @ vectors).reshape(-1, 6, len(values))[nodes]  # twists at the ground's origin
    position = linear.at.X[:-1, :3, 3, None][nodes]
    at_nodes = np.concatenate([twists[:, :3] + np.cross(twists[:, 3:], position, axis=1), twists[:, 3:4]], axis=1)
    shapes = np.array([[np.interp(STATIONS, s, part) for part in mode.T] for mode in at_nodes.transpose(2, 0, 1)])
    seconds = time.perf_counter() - start_time
    return Modes(omega, np.abs(values), shapes.transpose(0, 2, 1), chain.elements, seconds=seconds)


@lru_cache(maxsize=2)
def _linear(mechanism: bytes) -> Linear:
    """The linear equations of a pickled mechanism. Faults seeded in the solver ask for the same ones again.

    Raises:
        MechanismError: no convergence.
    """
    t = tree(pickle.loads(mechanism))
    return linearize(t, steady_state(t))
