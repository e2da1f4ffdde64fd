"""Core's lumped discretisation as a chain of joints, for codes with kinematics, dynamics and their derivatives.

Core gives the nodes, the bodies at them and the elements' stiffness as numbers (``half_end`` masses, stiffness linear
in the parent body's frame: the discretisation of Park et al. 2010). Each body is joined to the previous one by a
translation followed by rotations about x, y, z, whose coordinates are the element's six strains. The other code
computes kinematics, dynamics and the derivatives of the inertial forces. Agreement to rounding shows that core solves
its model correctly, not that the model is right.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, cast

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from ...core import curve
from ...core.blade import Blade, clamped
from ...core.element.discretize import discretize, divide
from ...core.element.mesh import Mesh
from ...core.modes import STATIONS, Modes
from ...core.space import spatial as sp
from ...core.space.inertia import about_centre, transformed
from ...core.space.spatial import skew
from ..matrices.quadratic import gyroscopic_modes
from ..protocol.fingerprint import Fingerprint, of_matrix
from ..protocol.interface import CORE, BladeAdapter, CodeError, Independence

Array = NDArray[np.float64]

STEPS, SMALLEST_RAMP = 40, 2.0**-8
"""Largest number of Newton steps for the steady state; smallest load increment if Newton's method fails with the full load."""

EPS = float(np.finfo(float).eps)

STALL_FACTOR, CONVERGED_FACTOR = 10.0, 1e-4
"""Factors on a bound of the rounding energy: below the first, Newton's steps may stall; below the second, they have
converged."""

MIN_REDUCTION = 1e-2
"""Ratio of the energies of successive steps above which they have stalled."""

RIGID = 1e-9
"""Departure from a rigid body's inertia attributed to rounding, relative to its largest entry."""


class ChainModel(Protocol):
    """A chain in another code: a hub that rotates about z, then a body on six joints for every node except the clamped one.

    Coordinates q (n,) are all except the hub's: x, y, z, then about x, y, z, for each body in turn.
    """

    def inertial(self, q: Array, omega: float) -> tuple[Array, Array, Array]:
        """Generalised inertial force (n,) in steady rotation at ``omega`` (rad/s), and its derivatives (n, n) by q and by q̇.

        Raises:
            CodeError: the derivative by q is not symmetric, or that by q̇ not skew.
        """
        ...

    def mass(self, q: Array) -> Array:
        """Mass matrix (n, n)."""
        ...

    def inertia(self) -> Array:
        """(6, 6) of the undeformed chain as a rigid body: momentum and angular momentum about the hub's centre."""
        ...

    def jacobian(self, q: Array) -> Array:
        """(e, 4, n) by q̇: velocity of each body's origin and rate of rotation about x, in the hub's axes."""
        ...


def refusal(blade: Blade) -> str | None:
    """The reason if the root is not clamped, or an inertia is not exactly that of a rigid body, as with published data."""
    if not clamped(blade):
        return "the root is not clamped: the chain is clamped to the hub"
    for name, inertia in (("mass", blade.mass), ("tip_mass", blade.tip_mass[None])):
        if (deviation := _from_rigid(inertia)) > RIGID:
            return f"{name} is not a rigid body's to {deviation:.1e}: one mass in all directions, antisymmetric offset"
    return None


def from_core(engine: str) -> Independence:
    """The origins of a code that has only the equations of motion, everything else from core."""
    return Independence(engine, CORE, engine, sections=CORE)


@dataclass(frozen=True, kw_only=True)
class JointChain(BladeAdapter):
    """A code that solves core's lumped discretisation as a chain of joints; see ``interface.BladeAdapter``.

    It supports every blade that core can discretise, including coupled and curved ones, if the root is clamped.

    Attributes:
        name, title, hint: see ``interface.BladeAdapter``.
        independence: equations of motion from the code, everything else from core; see ``from_core``.
        distribution: the installed package that gives the version.
        max_elements: largest number of elements, limited by the code's time or memory.
        build: builds the chain in the code.
    """

    name: str
    title: str
    hint: str
    independence: Independence
    distribution: str
    max_elements: int
    build: Callable[[Mesh], ChainModel]
    levels: tuple[int, ...] = (10, 20, 30)
    order: int = 2

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if the root is not clamped or the inertias are not those of rigid bodies."""
        return refusal(blade)

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.BladeAdapter``.

        Raises:
            CodeError: more than ``max_elements`` elements, or no stable steady state at this speed.
        """
        self.limit(elements)
        chain = discretize(blade, elements, "half_end", "body_fixed")
        body = self.build(chain)
        elastic = cast(Array, block_diag(*chain.beams.stiffness))
        q, previous_stiffness = steady_coordinates(body, elastic, omega, chain)
        _, stiffness, gyroscopic = body.inertial(q, omega)
        mass = body.mass(q)
        frequencies, vectors = gyroscopic_modes(mass, gyroscopic, elastic + stiffness, count)
        error = rounding(mass, elastic, stiffness, previous_stiffness, frequencies, vectors)
        at_nodes = np.concatenate([np.zeros((1, 4, vectors.shape[1])), body.jacobian(q) @ vectors])
        shapes, _ = curve.at(divide(blade, elements), at_nodes, blade.kinks, STATIONS * blade.length)
        return Modes(omega, frequencies, shapes.transpose(2, 0, 1), chain.elements, rounding=error)

    def fingerprint(self, blade: Blade, elements: int) -> Fingerprint:
        """From the code's model, and the lump at the root, which core gives to the hub; see ``interface.BladeAdapter``."""
        self.limit(elements)
        chain = discretize(blade, elements, "half_end", "body_fixed")
        root = transformed(chain.lumps[:1], chain.nodes[:1])[0]
        return of_matrix(self.build(chain).inertia() + root, chain.elements)


def rounding(
    mass: Array,
    elastic: Array,
    stiffness: Array,
    previous_stiffness: Array,
    frequencies: Array,
    vectors: NDArray[np.complex128],
) -> Array:
    """(m,) relative error of the frequencies due to rounding of K and M: δω/ω = x*(δK − ω²δM)x / 2x*Kx.

    δK is bounded by the asymmetry of the code's derivative and by its change over a step of the size of rounding.
    """
    error = np.maximum(np.abs(stiffness - previous_stiffness), np.abs(stiffness - stiffness.T))
    error += EPS * (np.abs(elastic) + np.abs(stiffness))
    size = np.abs(vectors)
    energy = np.einsum("im,ij,jm->m", vectors.conj(), elastic + stiffness, vectors).real
    kinetic = EPS * frequencies**2 * np.einsum("im,ij,jm->m", size, np.abs(mass), size)
    return 0.5 * (np.einsum("im,ij,jm->m", size, error, size) + kinetic) / np.abs(energy)


def places(chain: Mesh) -> Array:
    """(e, 4, 4) undeformed pose of each body in the frame of the previous one, of the first in the hub's.

    A body's frame is that of the end of the element before it, and its joints are along its axes. At a kink the next
    element begins rotated relative to it.
    """
    ends_a = np.concatenate([chain.nodes[:1], sp.inverse(chain.corner[:-1])])
    return ends_a @ chain.beams.undeformed


def bodies(chain: Mesh) -> Array:
    """(e, 6, 6) inertia of each body, in the frame that ``places`` gives it."""
    return transformed(chain.lumps[1:], sp.inverse(chain.corner))


def _from_rigid(inertia: Array) -> float:
    """Deviation of inertias (k, 6, 6) from the form [[m, −m c×], [m c×, J]], relative to their largest entry."""
    linear, offset = inertia[:, :3, :3], inertia[:, :3, 3:]
    deviations = [
        linear - inertia[:, :1, :1] * np.eye(3),
        offset + np.swapaxes(offset, 1, 2),
        inertia - np.swapaxes(inertia, 1, 2),
    ]
    return max(float(np.abs(w).max()) for w in deviations) / max(float(np.abs(inertia).max()), np.finfo(float).tiny)


def rigid(lump: Array) -> tuple[float, Array, Array]:
    """Mass, centre (3,) and moments of inertia about the node (3, 3) of a rigid body's inertia (6, 6)."""
    mass, centre, _ = about_centre(lump)
    return float(mass), centre, lump[3:, 3:]


def about_hub(mass: float, centre: Array, moments: Array) -> Array:
    """(6, 6) inertia about the hub's centre from mass, centre (3,) and moments of inertia about the hub's centre (3, 3)."""
    offset = mass * skew(centre)
    return np.block([[mass * np.eye(3), -offset], [offset, moments]])


def require_symmetries(stiffness: Array, gyroscopic: Array, rounding: float, code: str) -> None:
    """Check the symmetry of a code's derivatives by q (symmetric) and by q̇ (skew), to the relative error ``rounding``.

    Raises:
        CodeError: a derivative does not have its symmetry.
    """
    for name, matrix, sign in (("dtau_dq", stiffness, 1), ("dtau_dv", gyroscopic, -1)):
        deviation = np.abs(matrix - sign * matrix.T).max()
        if not deviation <= rounding * np.abs(matrix).max():
            kind = "symmetric" if sign == 1 else "skew"
            raise CodeError(
                f"{name}: {deviation:.1e} from {kind}: {code}'s derivatives are wrong for some joint of the chain"
            )


def steady_coordinates(model: ChainModel, elastic: Array, omega: float, chain: Mesh) -> tuple[Array, Array]:
    """Coordinates (n,) at which the elements' forces ``elastic @ q`` balance the steady inertial forces.

    The load, Ω², is raised in steps only if Newton's method fails with the full load.

    Returns:
        The coordinates, and the derivative (n, n) of the inertial forces one step, of the size of rounding, earlier.

    Raises:
        CodeError: no steady state near the undeformed chain.
    """
    q, reached, step = np.zeros(len(elastic)), 0.0, 1.0
    stiffness = np.zeros_like(elastic)
    while reached < 1.0:
        load = min(1.0, reached + step)
        balanced = _newton(model, elastic, omega * load**0.5, q, chain)
        if balanced is not None:
            (q, stiffness), reached = balanced, load
        elif step > SMALLEST_RAMP:
            step /= 2
        else:
            raise CodeError(f"omega: {omega:g} rad/s: no steady state above {reached:.0%} of Ω²; lower the speed")
    return q, stiffness


def _newton(model: ChainModel, elastic: Array, omega: float, q: Array, chain: Mesh) -> tuple[Array, Array] | None:
    """Newton's method until the energy of its step, the square of the error in the energy norm, is at rounding; None if
    it fails.

    The inertial forces are sums over all bodies further out, so their rounding error is that of the largest, at the
    radius of the tip.
    """
    size = np.tile(np.repeat([chain.scale, 1.0], 3), len(q) // 6)
    lever = np.tile(np.repeat([1.0, float(np.linalg.norm(chain.nodes[-1, :3, 3]))], 3), len(q) // 6)
    last_energy = np.inf
    for _ in range(STEPS):
        force, stiffness, _ = model.inertial(q, omega)
        residual = force + elastic @ q
        try:
            step = np.linalg.solve(elastic + stiffness, -residual)
        except np.linalg.LinAlgError:
            return None
        if not np.abs(step / size).max() < 1.0:
            return None
        q = q + step
        unsure = EPS * (np.abs(force / lever).max() * lever + np.abs(elastic) @ np.abs(q))
        energy, rounding = abs(float(step @ residual)), float(np.sum(unsure**2 / np.diagonal(elastic)))
        stalled = energy > MIN_REDUCTION * last_energy  # else the bound is not reached yet: rounding may be much less
        if energy <= CONVERGED_FACTOR * rounding or (stalled and energy <= STALL_FACTOR * rounding):
            return q, stiffness
        last_energy = energy
    return None
