"""A turbine with what does not depend on the speed: meshes, and its tower under the weight that it carries."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..effects import ALL_EFFECTS
from ..element.branches import CLAMPED, attached, hub
from ..element.discretize import discretize
from ..element.mesh import Mesh
from ..space.inertia import transformed
from ..spectrum.mesh_solver import balance
from ..steady.blade_state import Steady
from ..threads import one_thread
from . import component
from .assumed import Assumed, motions
from .component import Component
from .rotor import turned_axes
from .tower import Tower, standing, tower_mesh
from .tower_modes import base_energy
from .turbine import Turbine

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Resolution:
    """How finely a turbine is modelled: elements and modes of tower and blade, and motions of two blades on a tower.

    Floquet's method uses as many of the latter as modes are computed, and ``periodic_motions`` more.
    """

    tower_elements: int = 12
    blade_elements: int = 24
    tower_modes: int = 8
    blade_modes: int = 12
    periodic_motions: int = 6


FINER = Resolution(24, 48, 14, 20, 12)
"""The resolution with which the default one is compared."""


@dataclass(frozen=True)
class Machine:
    """A turbine with what does not depend on the speed.

    Attributes:
        turbine, resolution: of which it is made.
        tower, tower_mesh, tower_state: the tower under the weight that it carries.
        blade_mesh: the elements of one blade.
        blade_motions: (k, dn) rates of strains to which the blades are restricted; None if they are free.
    """

    turbine: Turbine
    resolution: Resolution
    tower: Component
    tower_mesh: Mesh
    tower_state: Steady
    blade_mesh: Mesh
    blade_motions: Array | None = None

    def yaw_energy(self, motion: NDArray[np.complex128]) -> Array:
        """(m,) twice the energy of the yaw bearing in motions (t, m) of the tower; 0 if it is locked."""
        if np.isinf(self.turbine.yaw):
            return np.zeros(motion.shape[1])
        link = self.tower_mesh.joints[-1].link
        n = len(self.tower_mesh.parent)
        rotation = self.tower.vectors.reshape(self.tower.size, n, self.tower.vectors.shape[1] // n)[:, link, 3]
        return self.turbine.yaw * np.abs(rotation @ motion) ** 2

    def base_energy(self, motion: NDArray[np.complex128]) -> Array:
        """(6, m) twice the energy of the base's stiffness in motions (t, m) of the tower, by direction; 0 if it is clamped."""
        return base_energy(self.turbine.support, self.tower_state, self.tower.vectors, motion)


def machine(turbine: Turbine, resolution: Resolution | None = None, assumed: Assumed | None = None) -> Machine:
    """Mesh a turbine, and solve its tower under the weight of all that it carries.

    Args:
        turbine: the turbine.
        resolution: elements and modes.
        assumed: shapes to which tower and blades are restricted.

    Raises:
        ValueError: fewer than two blades, or a hinge of another number than two.
        SteadyStateError, UnstableError: the tower does not carry the weight.
    """
    if turbine.blades < 2:
        raise ValueError(f"{turbine.name}: {turbine.blades} blade: a turbine here has two or more equal blades")
    if turbine.teeter and turbine.blades != 2:
        raise ValueError(f"{turbine.name}: teeter: {turbine.blades} blades: only a hub of two blades teeters")
    how = resolution or Resolution()
    with one_thread():
        blade_mesh = discretize(turbine.blade, how.blade_elements)
        rotor = np.ascontiguousarray(transformed(rigid_rotor(turbine, blade_mesh), turbine.shaft))
        mesh = _tower(turbine, how, turbine.nacelle + rotor)
        state = standing(mesh, Tower(turbine.tower, turbine.support, turbine.gravity), how.tower_elements)
        tower_motions, blade_motions = motions(assumed, (turbine.tower, mesh), (turbine.blade, blade_mesh))
        if tower_motions is None:
            tower = component.reduced_component(mesh, state, how.tower_modes, by_tip=True)
        else:
            tower = component.restricted(mesh, state, tower_motions)
    r = tower.size
    M = tower.M[:r, :r] - tower.tip.T @ rotor @ tower.tip  # the rotor is added with its blades
    without_rotor = replace(tower, M=M, C=tower.C[:r, :r], K=tower.K[:r, :r])
    return Machine(turbine, how, without_rotor, mesh, state, blade_mesh, blade_motions)


def rigid_rotor(turbine: Turbine, mesh: Mesh) -> Array:
    """(6, 6) inertia of hub and undeformed blades at the hub's centre, in the shaft's axes."""
    state = balance(mesh, 0.0, np.zeros(3), ALL_EFFECTS)
    inertia = component.reduced_component(mesh, state, 1).M[-6:, -6:]
    out = turbine.hub.copy()
    for k in range(turbine.blades):
        A = turned_axes(2.0 * np.pi * k / turbine.blades)[0]
        out += A.T @ inertia @ A
    return out


def _tower(turbine: Turbine, how: Resolution, carried: Array) -> Mesh:
    """The tower with the yaw bearing and the inertia that it carries, at the last node."""
    mesh = tower_mesh(turbine.tower, turbine.support, how.tower_elements)
    top = component.with_inertia(hub(mesh, np.eye(4)), 0, carried)
    stiffness = CLAMPED.copy()
    stiffness[3] = turbine.yaw
    return attached(mesh, len(mesh.nodes) - 1, top, np.eye(4), stiffness=stiffness)
