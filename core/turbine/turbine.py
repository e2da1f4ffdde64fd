"""A turbine: tower, nacelle, drivetrain, hub and N equal blades, linearised in the ground's frame.

Axes as for a ``Blade``: the tower's x axis points up, z downwind and y = z × x; the shaft's z axis is the rotor's, along which
the wind blows. ξ_H is the twist of the non-rotating hub frame. Blade k sees it turned by −ψ_k, so that its motions are

    y_k = (q_k, ξ_k) = P(ψ_k) (q_0, q_c, q_s, …, ξ_H),

with the multi-blade coordinates of ``multiblade``. Summed over N ≥ 3 blades, Pᵀ(M P), Pᵀ(C P + 2Ω M P′) and
Pᵀ(K P + Ω C P′ + Ω² M P″) do not depend on ψ. They couple to the tower through ξ_H. The rotor's net wrench on the hub
vanishes: no gravity acts on the blades' own motions, only the rotor's weight on nacelle and tower.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ..blade import Blade
from ..effects import ALL_EFFECTS
from ..element.branches import CLAMPED, attached, hub
from ..element.discretize import discretize
from ..element.mesh import Mesh
from ..rotor import multiblade
from ..rotor.periodic import CONSTANT, PeriodicError
from ..space import spatial as sp
from ..space.inertia import transformed
from ..spectrum.mesh_solver import balance
from ..steady.blade_state import Steady
from ..threads import one_thread
from ..tree.links import Links, twists
from ..tree.pencil import Shape
from . import component
from .assumed import Assumed, motions
from .component import Component
from .tower import Support, Tower, standing, tower_mesh

Array = NDArray[np.float64]

G = 9.80665
"""m/s²."""

RZ = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Drivetrain:
    """The shaft between hub and generator; inertia and angles on the side of the rotor.

    Attributes:
        stiffness: torsional, N m/rad; ``inf`` is a rigid shaft.
        generator: moment of inertia of the generator about its own shaft, kg m².
        gear_ratio: speed of the generator over that of the rotor.
        free: whether the generator turns freely about its steady speed; otherwise it is locked.
    """

    stiffness: float = np.inf
    generator: float = 0.0
    gear_ratio: float = 1.0
    free: bool = False


@dataclass(frozen=True)
class Turbine:
    """A turbine; SI units.

    Attributes:
        name: for tables.
        tower: a beam along x, upwards; its ``tip_mass`` is the body at its top without nacelle and rotor.
        blade: one of the blades.
        blades: N ≥ 3.
        nacelle: (6, 6) inertia at the tower's top, in the tower's axes.
        hub: (6, 6) inertia of the hub at its centre, in the shaft's axes; it turns with the rotor.
        shaft: (4, 4) pose of the hub's centre, z along the rotor's axis and x in the vertical plane, from the tower's top.
        yaw: stiffness of the yaw bearing, N m/rad; ``inf`` is a locked one.
        drivetrain: the shaft and generator.
        gravity: m/s².
        support: springs that hold the tower; rigid ground by default.
    """

    name: str
    tower: Blade
    blade: Blade
    blades: int
    nacelle: Array
    hub: Array
    shaft: Array
    yaw: float = np.inf
    drivetrain: Drivetrain = field(default_factory=Drivetrain)
    gravity: float = G
    support: Support = field(default_factory=Support)


@dataclass(frozen=True)
class Resolution:
    """How finely a turbine is modelled: elements and modes of tower and blade."""

    tower_elements: int = 12
    blade_elements: int = 24
    tower_modes: int = 8
    blade_modes: int = 12


FINER = Resolution(24, 48, 14, 20)
"""The resolution with which the default one is compared."""


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


def shaft_pose(to_shaft: float, overhang: float, tilt: float) -> Array:
    """Pose (4, 4) of the hub's centre in the axes of the tower's top.

    Args:
        to_shaft: height of the shaft above the tower's top on the yaw axis, m.
        overhang: distance from there to the hub's centre along the shaft, positive downwind, m.
        tilt: rad, positive if the downwind end is higher: an upwind turbine has negative tilt and overhang.
    """
    c, s = np.cos(tilt), np.sin(tilt)
    axis = np.array([s, 0.0, c])
    rotation = np.stack([[c, 0.0, -s], [0.0, 1.0, 0.0], axis], axis=-1)
    return sp.pose(rotation, np.array([to_shaft, 0.0, 0.0]) + overhang * axis)


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
        support = self.turbine.support
        foot = len(support.free)
        if not foot:
            return np.zeros((6, motion.shape[1]))
        axes = self.tower_state.shape.nodes[foot, :3, :3]
        own = twists(self.tower_state.pencil.links, self.tower.vectors)[:, foot - 1, :6].reshape(-1, 2, 3)
        moved = (own @ axes.T).reshape(-1, 6).T @ motion
        K = support.finite
        total = np.einsum("im,ij,jm->m", moved.conj(), K, moved).real
        parts = np.diagonal(K)[:, None] * np.abs(moved) ** 2
        return parts * (total / np.maximum(parts.sum(0), np.finfo(float).tiny))


def machine(turbine: Turbine, resolution: Resolution | None = None, assumed: Assumed | None = None) -> Machine:
    """Mesh a turbine, and solve its tower under the weight of all that it carries.

    Args:
        turbine: the turbine.
        resolution: elements and modes.
        assumed: shapes to which tower and blades are restricted.

    Raises:
        ValueError: fewer than three blades.
        SteadyStateError, UnstableError: the tower does not carry the weight.
    """
    if turbine.blades < multiblade.MIN_BLADES:
        raise ValueError(
            f"{turbine.name}: {turbine.blades} blades: a turbine needs at least three equal blades here; build a mechanism "
            "for two, which has no constant modes"
        )
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
    alone = replace(tower, M=M, C=tower.C[:r, :r], K=tower.K[:r, :r])
    return Machine(turbine, how, alone, mesh, state, blade_mesh, blade_motions)


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
    _check_constant(coupled, rotor(turbine, blade, omega, 0.7), abs(omega) + float(blade.frequencies[0]))
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


def rotor(turbine: Turbine, blade: Component, omega: float, psi: float) -> tuple[Array, Array, Array]:
    """M, C, K (nr + 6, nr + 6) of hub and blades over (multi-blade coordinates, ξ_H) at the azimuth ψ of blade 0."""
    n, r = turbine.blades, blade.size
    T, R = multiblade.transformation(psi, n), multiblade.rate(n)
    out = [np.zeros((n * r + 6, n * r + 6)) for _ in range(3)]
    for k in range(n):
        turns = turned_axes(psi + 2.0 * np.pi * k / n)
        P = []
        for order, rotation in enumerate(turns):
            part = np.zeros((r + 6, n * r + 6))
            part[:r, : n * r] = np.kron((T @ np.linalg.matrix_power(R, order))[k], np.eye(r))
            part[r:, n * r :] = rotation
            P.append(part)
        for total, part in zip(out, in_ground_frame(blade, omega, P), strict=True):
            total += part
    spin = omega * RZ
    momentum = turbine.hub @ spin
    out[0][-6:, -6:] += turbine.hub
    # a symmetric body that spins about its axis: δg = M ξ̈ + (Y ×* M − M Y × + M Y ×̄*) ξ̇, in the frame that does not spin
    out[1][-6:, -6:] += -sp.coadjoint(momentum)
    return out[0], out[1], out[2]


def in_ground_frame(blade: Component, omega: float, P: Sequence[Array]) -> tuple[Array, Array, Array]:
    """M, C, K of one blade over coordinates z with y = P(ψ) z; ``P``: P, P′ and P″ at an azimuth."""
    M = P[0].T @ blade.M @ P[0]
    C = P[0].T @ (blade.C @ P[0] + 2.0 * omega * blade.M @ P[1])
    K = P[0].T @ (blade.K @ P[0] + omega * blade.C @ P[1] + omega**2 * blade.M @ P[2])
    return M, C, K


def turned_axes(psi: float) -> tuple[Array, Array, Array]:
    """A (6, 6), the twist ξ_H in axes turned by ψ about z, and its first and second derivatives."""
    c, s = np.cos(psi), np.sin(psi)
    parts = (
        np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]),
        np.array([[-s, c, 0.0], [-c, -s, 0.0], [0.0, 0.0, 0.0]]),
        np.array([[-c, -s, 0.0], [s, -c, 0.0], [0.0, 0.0, 0.0]]),
    )
    first, second, third = (np.asarray(np.kron(np.eye(2), part), float) for part in parts)
    return first, second, third


def _check_constant(first: tuple[Array, ...], second: tuple[Array, ...], rate: float) -> None:
    """Check that the rotor's equations are the same at two azimuths, for motions at ``rate``, rad/s; never averaged."""
    size = np.sqrt(sum(rate ** (2 - k) * np.abs(np.diagonal(part)) for k, part in enumerate(first)))
    for k, (a, b) in enumerate(zip(first, second, strict=True)):
        change = float((rate ** (2 - k) * np.abs(a - b) / np.outer(size, size)).max())
        if change > CONSTANT:
            raise PeriodicError(
                f"azimuth: the rotor's equations vary with it by {100 * change:.2g} %: the blades are not equal"
            )
