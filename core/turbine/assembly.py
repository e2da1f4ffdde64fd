"""The equations of a turbine at a speed: tower, nacelle, drivetrain and rotor, linearised in the ground's frame."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..effects import ALL_EFFECTS
from ..element.mesh import Mesh
from ..rotor import multiblade
from ..rotor.periodic import Matrices, Periodic, PeriodicError, sampled
from ..space import spatial as sp
from ..spectrum.mesh_solver import balance
from ..threads import one_thread
from ..tree.links import Links
from ..tree.pencil import Shape
from . import component
from .component import Component
from .machine import Machine
from .rotor import RZ, check_constant, rotor

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Assembled:
    """The turbine's equations at a speed, in the ground's frame and multi-blade coordinates.

    The n coordinates are t motions of the tower, the angles of the shaft and of the hub's hinge, and r motions of the blades
    for each multi-blade coordinate. The equations of two blades are those at the azimuth 0.

    Attributes:
        omega: rad/s.
        M, C, K: (n, n).
        tower: its component.
        blade: that of one blade.
        shaft: indices of the angles of hub and generator, if there are any.
        teeter: index of the angle of the hub's hinge, if there is one.
        blades: (N, r) indices of the blades' coordinates, by multi-blade coordinate.
        hub: (6, n) twist of the hub's non-rotating frame, in its axes.
        meshes, shapes: of tower and blade, in the steady state.
        tower_links, blade_links: their trees there.
    """

    omega: float
    M: Array
    C: Array
    K: Array
    tower: Component
    blade: Component
    shaft: tuple[int, ...]
    teeter: tuple[int, ...]
    blades: NDArray[np.intp]
    hub: Array
    meshes: tuple[Mesh, Mesh]
    shapes: tuple[Shape, Shape]
    tower_links: Links
    blade_links: Links


def assemble(machine: Machine, omega: float) -> Assembled:
    """The turbine's equations at a speed, rad/s.

    Raises:
        PeriodicError: they vary with the azimuth.
        SteadyStateError: the blades have no steady state.
    """
    a, _ = _built(machine, omega)
    if machine.turbine.blades < multiblade.MIN_BLADES:
        raise PeriodicError(
            f"blades: {machine.turbine.blades}: the equations of two blades vary with the azimuth and have no constant modes; "
            "`southwell campbell` solves them by Floquet's and Hill's methods"
        )
    first, second = (rotor(machine.turbine, a.blade, omega, psi) for psi in (0.0, 0.7))
    check_constant(first, second, abs(omega) + float(a.blade.frequencies[0]))
    return a


def periodic(machine: Machine, omega: float) -> tuple[Assembled, Periodic]:
    """The turbine's equations at a speed, rad/s, at the azimuth 0 and as periodic functions of it.

    Raises:
        SteadyStateError: the blades have no steady state.
    """
    a, at = _built(machine, omega)
    return a, sampled(at, omega, tuple(f"x{k}" for k in range(len(a.M))))


def _built(machine: Machine, omega: float) -> tuple[Assembled, Callable[[float], Matrices]]:
    """The equations at the azimuth 0, and at any."""
    turbine = machine.turbine
    with one_thread():
        state = balance(machine.blade_mesh, omega, np.zeros(3), ALL_EFFECTS)
        if machine.blade_motions is None:
            blade = component.reduced_component(machine.blade_mesh, state, machine.resolution.blade_modes)
        else:
            blade = component.restricted(machine.blade_mesh, state, machine.blade_motions)
    t, r, n, hinges = machine.tower.size, blade.size, turbine.blades, turbine.hinge.shape[1]
    drive = turbine.drivetrain
    rigid = np.isinf(drive.stiffness)
    angles = (0 if rigid else 1) + (1 if drive.free else 0)  # of the hub, and of the generator
    teeter = t + angles + np.arange(hinges)
    blades = t + angles + hinges + np.arange(n * r).reshape(n, r)
    size = t + angles + hinges + n * r
    # twist of the hub, without and with the shaft's angle, and rotation of the generator
    nacelle = np.zeros((6, size))
    nacelle[:, :t] = sp.adjoint(sp.inverse(turbine.shaft)) @ machine.tower.tip
    hub_twist, generator = nacelle.copy(), nacelle[5] / drive.gear_ratio
    if angles:
        hub_twist[:, t] += RZ
    if drive.free:
        generator[t + angles - 1] += 1.0
    J = np.zeros((n * r + 6 + hinges, size))
    J[np.arange(n * r), blades.ravel()] = 1.0
    J[n * r : n * r + 6] = hub_twist
    J[n * r + 6 + np.arange(hinges), teeter] = 1.0
    springs = np.zeros((size, size))
    if not rigid:
        twist = np.zeros(size)
        twist[t] = 1.0
        if drive.free:
            twist[t + 1] = -1.0
        springs += drive.stiffness * np.outer(twist, twist)
    if turbine.teeter:
        springs[teeter, teeter] += turbine.teeter.stiffness

    def at(psi: float) -> Matrices:
        M, C, K = (J.T @ part @ J for part in rotor(turbine, blade, omega, psi))
        for total, part in zip((M, C, K), (machine.tower.M, machine.tower.C, machine.tower.K), strict=True):
            total[:t, :t] += part
        M += drive.generator * drive.gear_ratio**2 * np.outer(generator, generator)
        return 0.5 * (M + M.T), C, K + springs

    M, C, K = at(0.0)
    assembled = Assembled(
        omega=omega,
        M=M,
        C=C,
        K=K,
        tower=machine.tower,
        blade=blade,
        shaft=tuple(range(t, t + angles)),
        teeter=tuple(teeter.tolist()),
        blades=blades,
        hub=hub_twist,
        meshes=(machine.tower_mesh, machine.blade_mesh),
        shapes=(machine.tower_state.shape, state.shape),
        tower_links=machine.tower_state.pencil.links,
        blade_links=state.pencil.links,
    )
    return assembled, at
