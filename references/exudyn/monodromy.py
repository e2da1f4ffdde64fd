"""Floquet's exponents of a rotor from Exudyn's own integration in time: an independent route for periodic systems.

The full equations of motion are integrated over one revolution from small disturbances of every coordinate and rate, of both
signs, by Exudyn's explicit Runge-Kutta method of order 7 (J. Verner). Half the differences of the final states are the columns
of the monodromy matrix. The speed is kept by a flywheel that is ``FLYWHEEL`` times as heavy as the machine: explicit methods
take no constraints.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core.mechanism.description import Mechanism
from ...core.tree.spanning import compile_tree
from ..protocol.interface import CodeError
from .closure import system, velocity

Array = NDArray[np.float64]

FLYWHEEL = 1e10
"""Inertia of the flywheel over that of the machine about its axis."""

DISTURBANCE = 1e-4
"""m or rad, and the same fraction of a rate at the rotor speed; the error of the differences is its square."""


def multipliers(
    mechanism: Mechanism, spin: str, rotor: str, inertia: float, steps: int = 150
) -> NDArray[np.complex128]:
    """Floquet's multipliers (2n,) of a mechanism about the state in which only the rotor turns and all coordinates are zero.

    Args:
        mechanism: without loops.
        spin: coordinate that turns at a constant rate.
        rotor: body that turns with it.
        inertia: moment of inertia of the machine about the axis, kg m².
        steps: time steps in one revolution.

    Raises:
        CodeError: loops.
    """
    wheel = np.zeros((6, 6))
    wheel[3:, 3:] = FLYWHEEL * inertia * np.eye(3)
    bodies = tuple(replace(b, inertia=b.inertia + wheel) if b.name == rotor else b for b in mechanism.bodies)
    tree = compile_tree(replace(mechanism, bodies=bodies))
    if tree.welds:
        raise CodeError("loops: the integration takes no constraints")
    made, rates = system(tree), velocity(tree)
    turning = tree.coordinate(spin)
    omega = float(rates[turning])
    free = np.delete(np.arange(len(rates)), turning)
    columns = []
    for place in range(2 * len(free)):
        ends = []
        for sign in (1.0, -1.0):
            q, v = np.zeros(len(rates)), rates.copy()
            target = q if place < len(free) else v
            target[free[place % len(free)]] += sign * DISTURBANCE * (1.0 if place < len(free) else abs(omega))
            ends.append(np.concatenate([part[free] for part in made.integrated(q, v, 2.0 * np.pi / abs(omega), steps)]))
        columns.append((ends[0] - ends[1]) / (2.0 * DISTURBANCE * (1.0 if place < len(free) else abs(omega))))
    return np.asarray(np.linalg.eigvals(np.array(columns).T), np.complex128)
