"""The equations of a turbine at a speed: tower, nacelle, drivetrain and rotor, linearised in the ground's frame."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..effects import ALL_EFFECTS
from ..element.mesh import Mesh
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

    The n coordinates are t motions of the tower, the shaft's angles, and r motions of the blades for each multi-blade
    coordinate.

    Attributes:
        omega: rad/s.
        M, C, K: (n, n).
        tower: its component.
        blade: that of one blade.
        shaft: indices of the angles of hub and generator, if there are any.
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
    blades: NDArray[np.intp]
    hub: Array
    meshes: tuple[Mesh, Mesh]
    shapes: tuple[Shape, Shape]
    tower_links: Links
    blade_links: Links


def assemble(made: Machine, omega: float) -> Assembled:
    """The turbine's equations at a speed, rad/s.

    Raises:
        PeriodicError: they vary with the azimuth.
        SteadyStateError: the blades have no steady state.
    """
    turbine = made.turbine
    with one_thread():
        state = balance(made.blade_mesh, omega, np.zeros(3), ALL_EFFECTS)
        if made.blade_motions is None:
            blade = component.reduced_component(made.blade_mesh, state, made.resolution.blade_modes)
        else:
            blade = component.restricted(made.blade_mesh, state, made.blade_motions)
    coupled = rotor(turbine, blade, omega, 0.0)
    check_constant(coupled, rotor(turbine, blade, omega, 0.7), abs(omega) + float(blade.frequencies[0]))
    t, r, n = made.tower.size, blade.size, turbine.blades
    drive = turbine.drivetrain
    rigid = np.isinf(drive.stiffness)
    angles = (0 if rigid else 1) + (1 if drive.free else 0)  # of the hub, and of the generator
    blades = t + angles + np.arange(n * r).reshape(n, r)
    size = t + angles + n * r
    # twist of the hub, without and with the shaft's angle, and rotation of the generator
    nacelle = np.zeros((6, size))
    nacelle[:, :t] = sp.adjoint(sp.inverse(turbine.shaft)) @ made.tower.tip
    hub_twist, generator = nacelle.copy(), nacelle[5] / drive.gear_ratio
    if angles:
        hub_twist[:, t] += RZ
    if drive.free:
        generator[t + angles - 1] += 1.0
    J = np.zeros((n * r + 6, size))
    J[np.arange(n * r), blades.ravel()] = 1.0
    J[n * r :] = hub_twist
    M, C, K = (J.T @ part @ J for part in coupled)
    for total, part in zip((M, C, K), (made.tower.M, made.tower.C, made.tower.K), strict=True):
        total[:t, :t] += part
    M += drive.generator * drive.gear_ratio**2 * np.outer(generator, generator)
    if not rigid:
        twist = np.zeros(size)
        twist[t] = 1.0
        if drive.free:
            twist[t + 1] = -1.0
        K += drive.stiffness * np.outer(twist, twist)
    return Assembled(
        omega=omega,
        M=0.5 * (M + M.T),
        C=C,
        K=K,
        tower=made.tower,
        blade=blade,
        shaft=tuple(range(t, t + angles)),
        blades=blades,
        hub=hub_twist,
        meshes=(made.tower_mesh, made.blade_mesh),
        shapes=(made.tower_state.shape, state.shape),
        tower_links=made.tower_state.pencil.links,
        blade_links=state.pencil.links,
    )
