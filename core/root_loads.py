"""Steady loads at a blade's root: the force and the moment with which the turning blade acts on its hub.

In a steady state the residual of the virtual work vanishes for every motion of the blade (Park et al. 2010, eq. 10). For a
motion of the root itself it does not: what remains is the sum Bᵀ of all inertial forces, weights and given loads, and the hub
must balance it.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .blade import Blade
from .compiled import kernels
from .element.measures import LARGEST_STRAIN
from .element.mesh import Mesh
from .element.sections import root
from .space import spatial as sp
from .spectrum.mesh_solver import Options, free_root
from .spectrum.refinement import MAX_ELEMENTS, Key, Meshes
from .steady.blade_state import LargeStrainError, Steady, SteadyStateError, carried_over, largest_strain, steady_state
from .threads import one_thread
from .tree.links import Links, gathered
from .tree.pencil import has_free_motion, linearize, undeformed

Array = NDArray[np.float64]

_COARSE_FAILURES = 2  # meshes that may be too coarse for a steady state
_ROUNDING = 1e-13  # relative


@dataclass(frozen=True)
class RootLoads:
    """Steady loads of a blade on its hub at one rotor speed.

    Attributes:
        omega: rotor speed, rad/s.
        force: (3,) N, in the hub's axes: x outwards along the blade's azimuth, z along the rotor's axis, y = z × x.
        moment: (3,) N m about the root, in the hub's axes.
        root: (4, 4) pose of the root in the hub's axes, coned and pitched.
        uncertainty: of the force, N, and of the moment, N m; each of its largest component, from refinement.
        elements: number of elements of the finest mesh.
    """

    omega: float
    force: Array
    moment: Array
    root: Array
    uncertainty: tuple[float, float]
    elements: int

    @property
    def in_blade_axes(self) -> tuple[Array, Array]:
        """Force (3,), N, and moment (3,) about the root, N m, in the axes that are coned and pitched with the blade."""
        axes = self.root[:3, :3].T
        return axes @ self.force, axes @ self.moment

    @property
    def moment_about_hub(self) -> Array:
        """(3,) moment about the hub's centre, N m, in the hub's axes; z is the torque about the rotor's axis."""
        return self.moment + np.cross(self.root[:3, 3], self.force)


def root_loads(
    blade: Blade,
    omega: float,
    *,
    accuracy: float = 1e-6,
    gravity: Array | None = None,
    load: Array | None = None,
    allow_large_strain: bool = False,
) -> RootLoads:
    """The steady loads at the root, on meshes that are halved until they change by less than ``accuracy``.

    Args:
        blade: the blade.
        omega: rotor speed, rad/s.
        accuracy: largest uncertainty, relative to the magnitude of the force, and of the moment.
        gravity: (3,) m/s², in the hub's axes at the azimuth of interest; none by default.
        load: (n, 3) steady force per length at the blade's stations, N/m, in the rotating axes of the hub.
        allow_large_strain: accept steady strains above ``LARGEST_STRAIN``.

    Raises:
        ValueError: omega not finite, or a load of the wrong shape.
        SteadyStateError: no steady state at this speed.
        UnstableError: a free direction of the root has no stiffness at this speed.
        LargeStrainError: steady strains above ``LARGEST_STRAIN``.
    """
    if not np.isfinite(omega):
        raise ValueError(f"omega: {omega}: give a finite rotor speed in rad/s")
    with one_thread():
        return _refined(blade, omega, accuracy, np.zeros(3) if gravity is None else gravity, load, allow_large_strain)


def _refined(
    blade: Blade, omega: float, accuracy: float, gravity: Array, load: Array | None, allow_large_strain: bool
) -> RootLoads:
    meshes = Meshes(blade, Options(1, gravity=gravity), load=load, grading_speed=abs(omega))
    at, previous, halvings = root(blade), None, -1
    while True:
        halvings += 1
        mesh = meshes.mesh(Key(halvings=halvings))
        initial_shape = carried_over(previous[0], previous[1].shape, mesh) if previous else None
        try:
            state = steady_state(mesh, omega, gravity, initial_shape)
        except SteadyStateError as error:
            if has_free_motion(linearize(mesh, undeformed(mesh), omega, gravity)):
                raise free_root(omega, mesh) from error
            if previous or halvings >= _COARSE_FAILURES:
                raise
            continue
        wrench = on_hub(mesh, state, omega, gravity, at[:3, 3])
        if previous:
            change = np.abs(wrench - previous[2]).reshape(2, 3).max(1)
            size = np.linalg.norm(wrench.reshape(2, 3), axis=1)
            uncertainty = change + _ROUNDING * np.array([size[0], size[1] + blade.length * size[0]])
            scale = np.array([size[0], max(size[1], 1e-6 * blade.length * size[0])])
            if (uncertainty <= accuracy * scale).all() or 2 * mesh.elements > MAX_ELEMENTS:
                break
        previous = mesh, state, wrench
    if (strain := largest_strain(mesh, state.shape)) > LARGEST_STRAIN and not allow_large_strain:
        raise LargeStrainError(
            f"omega: {omega:.6g} rad/s: steady strain {strain:.0%}: too large for linear elastic sections: the speed is too "
            "high or the blade too soft; check units, or allow large strains"
        )
    return RootLoads(omega, wrench[:3], wrench[3:], at, (float(uncertainty[0]), float(uncertainty[1])), mesh.elements)


def on_hub(mesh: Mesh, state: Steady, omega: float, gravity: Array, point: Array) -> Array:
    """(6,) force and moment of a mesh on its hub in a steady state, about a point (3,), in the hub's axes.

    The residual on the root is that on the first links apart from the work of their forces on ρ, and that on node 0.
    """
    nodes, relative, corner, beta, lumps, force, fall = (
        np.ascontiguousarray(a)
        for a in (
            state.shape.nodes,
            state.shape.relative,
            mesh.corner,
            state.shape.beta,
            mesh.lumps,
            mesh.force,
            gravity,
        )
    )
    f, _, _, _, _, g, _, _ = kernels.tree_parts(
        mesh.beams.arrays, nodes, relative, corner, beta, lumps, force, mesh.parent, omega, fall, True
    )
    for joint in mesh.joints:
        f[joint.link] = 0.0
    carried = gathered(Links(mesh.parent, sp.adjoint(sp.inverse(relative)), np.zeros((0, 6, 6))), f, g)
    first = mesh.parent == 0
    wrench = g[0] + (f[first, :6] + carried[first, :6] - f[first, 6:12]).sum(
        0
    )  # what the hub applies, in node 0's axes
    return -sp.adjoint(sp.inverse(nodes[0]) @ sp.pose(np.eye(3), point)).T @ wrench
