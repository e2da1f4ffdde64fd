"""Exudyn integrates a rotor with an unequal blade over one revolution: Floquet's multipliers, independent of core's.

The full equations of motion are integrated over one revolution from small disturbances of every coordinate and rate, of both
signs, by Exudyn's explicit Runge-Kutta method of order 7 (J. Verner). Half the differences of the final states are the columns
of the monodromy matrix. The speed is kept by a flywheel that is ``FLYWHEEL`` times as heavy as the machine: explicit methods
take no constraints.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from southwell.core.mechanism.description import Mechanism
from southwell.core.rotor.comparison import compared
from southwell.core.rotor.floquet import distance
from southwell.core.rotor.orbit import linearize
from southwell.core.tree.spanning import compile_tree
from southwell.references.exudyn.closure import System, system, velocity
from southwell.tests.support.rotors import coleman_feingold

Array = NDArray[np.float64]

OMEGA = 1.6
INERTIA = 3 * 500.0 * 30.0**2

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
    """
    wheel = np.zeros((6, 6))
    wheel[3:, 3:] = FLYWHEEL * inertia * np.eye(3)
    bodies = tuple(replace(b, inertia=b.inertia + wheel) if b.name == rotor else b for b in mechanism.bodies)
    tree = compile_tree(replace(mechanism, bodies=bodies))
    made, rates = system(tree), velocity(tree)
    turning = tree.coordinate(spin)
    omega = float(rates[turning])
    free = np.delete(np.arange(len(rates)), turning)
    columns = []
    for column in range(2 * len(free)):
        ends = []
        for sign in (1.0, -1.0):
            q, v = np.zeros(len(rates)), rates.copy()
            target = q if column < len(free) else v
            target[free[column % len(free)]] += sign * DISTURBANCE * (1.0 if column < len(free) else abs(omega))
            ends.append(
                np.concatenate([part[free] for part in integrated(made, q, v, 2.0 * np.pi / abs(omega), steps)])
            )
        columns.append((ends[0] - ends[1]) / (2.0 * DISTURBANCE * (1.0 if column < len(free) else abs(omega))))
    return np.asarray(np.linalg.eigvals(np.array(columns).T), np.complex128)


def integrated(made: System, q: Array, v: Array, time: float, steps: int) -> tuple[Array, Array]:
    """Coordinates and rates (n,) after a time, s, from q and v, by the explicit method of order 7; no constraints."""
    exu, data, settings = made._exu, made._mbs.systemData, made._exu.SimulationSettings()
    initial, current = exu.ConfigurationType.Initial, exu.ConfigurationType.Current
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = time
    data.SetODE2Coordinates(q, configuration=initial)
    data.SetODE2Coordinates_t(v, configuration=initial)
    made._mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK67)
    return np.array(data.GetODE2Coordinates(current)), np.array(data.GetODE2Coordinates_t(current))


def test_coleman_and_feingold_with_one_stiffer_blade() -> None:
    machine = coleman_feingold(OMEGA, stiffer=1.05)
    by_time = multipliers(machine, "shaft.rz", "rotor", INERTIA)
    strip = np.sort(np.abs(np.angle(by_time)) * OMEGA / (2 * np.pi) ** 2)[::2]
    np.testing.assert_allclose(strip, [0.03740962, 0.04310606, 0.05847881, 0.06171777, 0.09916926], atol=6e-9)
    np.testing.assert_allclose(np.abs(by_time), 1.0, atol=1e-6)
    comparison = compared(linearize(machine, "shaft.rz")[0])
    for exponents in (comparison.floquet, comparison.hill):
        assert distance(exponents.multipliers, by_time).max() < 1e-6
