"""Core's own lumped discretisation as a chain of joints, for any code that can move and differentiate one.

Core gives the nodes, the bodies at them and the elements' stiffness, all as plain numbers (``half_end`` masses, stiffness
linear in the parent body's frame: the discretisation of Park et al. 2010). Each body hangs on the one before by a
translation and then rotations about x, y, z, whose coordinates are the element's six strains; kinematics, dynamics and the
derivatives of the inertial forces are the other code's. Agreement to rounding shows that core solves its model, not that
the model is right.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib import metadata
from typing import Protocol, cast

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from ...core import curve
from ...core.blade import Blade, clamped
from ...core.effects import ALL_EFFECTS, Effects
from ...core.element.discretize import Chain, discretize, divide
from ...core.modes import STATIONS, Modes
from ...core.space import spatial as sp
from ...core.space.inertia import about_centre, transformed
from ..protocol.interface import CORE, CodeError, Independence, Shares
from ..protocol.quadratic import gyroscopic_modes

Array = NDArray[np.float64]

STEPS, SMALLEST_RAMP = 40, 2.0**-8
"""Of Newton's method for the steady state; of the load, where Newton fails with all of it at once."""

EPS = float(np.finfo(float).eps)

STALL_FACTOR, CONVERGED_FACTOR = 10.0, 1e-4
"""Times a bound of rounding's energy: Newton's steps may stop shrinking at the first, and go on to the second at most."""

MIN_REDUCTION = 1e-2
"""Least factor between the energies of steps that converge."""

RIGID = 1e-9
"""Departure from a rigid body's inertia that is taken for rounding, of its largest entry."""


class Plant(Protocol):
    """A chain in another code: a hub that turns about z, then a body on six joints for every node but the clamped one.

    Coordinates q (n,) are all but the hub's: x, y, z, then about x, y, z, of one body after the other.
    """

    def inertial(self, q: Array, omega: float) -> tuple[Array, Array, Array]:
        """Generalised inertial force (n,) of steady turning, and its derivatives (n, n) by q and by q̇.

        Raises:
            CodeError: by q they are not symmetric, or by q̇ not skew, as they must be.
        """
        ...

    def mass(self, q: Array) -> Array:
        """M (n, n)."""
        ...

    def jacobian(self, q: Array) -> Array:
        """(e, 4, n) by q̇: velocity of each body's origin and rate of turning about x, in the hub's axes."""
        ...


def refusal(blade: Blade) -> str | None:
    """Why a blade is not such a chain: its root moves, or an inertia is a rigid body's only roughly, as published ones are."""
    if not clamped(blade):
        return "the root is not clamped: the chain begins at the hub"
    for name, inertia in (("mass", blade.mass), ("tip_mass", blade.tip_mass[None])):
        if (far := _from_rigid(inertia)) > RIGID:
            return f"{name} is not a rigid body's to {far:.1e}: one mass in all directions, antisymmetric in its offset"
    return None


@dataclass(frozen=True)
class JointChain:
    """A code that solves core's lumped discretisation as a chain of joints; see ``interface.Code``.


    It takes every blade that core can discretise, coupled and curved ones too, if the root is clamped.

    Attributes:
        name, title, hint: see ``interface.Code``.
        engine: the code's name in its declaration of independence.
        distribution: the installed package whose version counts.
        max_elements: more take too much of the code's time or memory.
        plant: makes the chain in the code.
    """

    name: str
    title: str
    hint: str
    engine: str
    distribution: str
    max_elements: int
    plant: Callable[[Chain], Plant]
    shares: Shares = "discretisation"
    effects: Effects = ALL_EFFECTS
    levels: tuple[int, ...] = (10, 20, 40)
    order: int = 2

    @property
    def independence(self) -> Independence:
        """Equations of motion by the code, everything else by core."""
        return Independence(self.engine, CORE, self.engine, sections=CORE)

    def version(self) -> str | None:
        """Version of the code, without importing it."""
        try:
            return metadata.version(self.distribution)
        except metadata.PackageNotFoundError:
            return None

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if the root is not clamped or the inertias are not those of rigid bodies."""
        return refusal(blade)

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.Code``.

        Raises:
            CodeError: an unsupported blade, more than ``max_elements`` elements, or no stable steady state at this speed.
        """
        if reason := self.unsupported(blade):
            raise CodeError(f"{blade.name}: {reason}")
        if elements > self.max_elements:
            raise CodeError(
                f"elements: {elements}: the code's time or memory grows as their cube; at most {self.max_elements}"
            )
        begun = time.perf_counter()
        chain = discretize(blade, elements, "half_end", "body_fixed")
        body = self.plant(chain)
        elastic = cast(Array, block_diag(*chain.beams.stiffness))
        q, before = steady(body, elastic, omega, chain)
        _, stiffness, gyroscopic = body.inertial(q, omega)
        mass = body.mass(q)
        frequencies, vectors = gyroscopic_modes(mass, gyroscopic, elastic + stiffness, count)
        error = rounding(mass, elastic, stiffness, before, frequencies, vectors)
        at_nodes = np.concatenate([np.zeros((1, 4, vectors.shape[1])), body.jacobian(q) @ vectors])
        shapes, _ = curve.at(divide(blade, elements), at_nodes, blade.kinks, STATIONS * blade.length)
        seconds = time.perf_counter() - begun
        return Modes(omega, frequencies, shapes.transpose(2, 0, 1), chain.elements, rounding=error, seconds=seconds)


def rounding(
    mass: Array, elastic: Array, stiffness: Array, before: Array, frequencies: Array, vectors: NDArray[np.complex128]
) -> Array:
    """(m,) relative error of the frequencies that the rounding of K and M brings: δω/ω = x*(δK − ω²δM)x / 2x*Kx.

    δK is bounded by what breaks the symmetry of the code's derivative and by what a step of rounding changes in it.
    """
    error = np.maximum(np.abs(stiffness - before), np.abs(stiffness - stiffness.T))
    error += EPS * (np.abs(elastic) + np.abs(stiffness))
    size = np.abs(vectors)
    energy = np.einsum("im,ij,jm->m", vectors.conj(), elastic + stiffness, vectors).real
    kinetic = EPS * frequencies**2 * np.einsum("im,ij,jm->m", size, np.abs(mass), size)
    return 0.5 * (np.einsum("im,ij,jm->m", size, error, size) + kinetic) / np.abs(energy)


def places(chain: Chain) -> Array:
    """(e, 4, 4) undeformed pose of each body in the frame of the one before, the first's in the hub's.

    A body's frame is that of the end of the element before it, along which its joints lie; at a kink the next element
    begins turned from it.
    """
    before = np.concatenate([chain.nodes[:1], sp.inverse(chain.corner[:-1])])
    return before @ chain.beams.undeformed


def bodies(chain: Chain) -> Array:
    """(e, 6, 6) inertia of each body, in the frame that ``places`` gives it."""
    return transformed(chain.lumps[1:], sp.inverse(chain.corner))


def _from_rigid(inertia: Array) -> float:
    """How far inertias (k, 6, 6) are from the form [[m, −m c×], [m c×, J]], of their largest entry."""
    linear, offset = inertia[:, :3, :3], inertia[:, :3, 3:]
    wrong = [
        linear - inertia[:, :1, :1] * np.eye(3),
        offset + np.swapaxes(offset, 1, 2),
        inertia - np.swapaxes(inertia, 1, 2),
    ]
    return max(float(np.abs(w).max()) for w in wrong) / max(float(np.abs(inertia).max()), np.finfo(float).tiny)


def rigid(lump: Array) -> tuple[float, Array, Array]:
    """Mass, centre (3,) and moments of inertia about the node (3, 3) of a rigid body's inertia (6, 6)."""
    mass, centre, _ = about_centre(lump)
    return float(mass), centre, lump[3:, 3:]


def check(stiffness: Array, gyroscopic: Array, rounding: float, code: str) -> None:
    """Hold a code's derivatives by q and by q̇ to the symmetry they must have, relative ``rounding`` aside.

    Raises:
        CodeError: they have not.
    """
    for name, matrix, sign in (("dtau_dq", stiffness, 1), ("dtau_dv", gyroscopic, -1)):
        wrong = np.abs(matrix - sign * matrix.T).max()
        if not wrong <= rounding * np.abs(matrix).max():
            kind = "symmetric" if sign == 1 else "skew"
            raise CodeError(
                f"{name}: {wrong:.1e} from {kind}: {code}'s derivatives are wrong for some joint of the chain"
            )


def steady(plant: Plant, elastic: Array, omega: float, chain: Chain) -> tuple[Array, Array]:
    """Coordinates (n,) at which the elements' forces ``elastic @ q`` balance the steady inertial ones.

    The load, Ω², is raised in steps only if all of it at once is too much for Newton's method.

    Returns:
        The coordinates, and the derivative (n, n) of the inertial forces one step of rounding before.

    Raises:
        CodeError: no steady state near the undeformed chain.
    """
    q, done, step = np.zeros(len(elastic)), 0.0, 1.0
    stiffness = np.zeros_like(elastic)
    while done < 1.0:
        load = min(1.0, done + step)
        found = _newton(plant, elastic, omega * load**0.5, q, chain)
        if found is not None:
            (q, stiffness), done = found, load
        elif step > SMALLEST_RAMP:
            step /= 2
        else:
            raise CodeError(f"omega: {omega:g} rad/s: no steady state past {done:.0%} of Ω²; lower the speed")
    return q, stiffness


def _newton(plant: Plant, elastic: Array, omega: float, q: Array, chain: Chain) -> tuple[Array, Array] | None:
    """Newton's method until the energy of its step, the square of the error in the energy norm, is that of rounding.

    The inertial forces are sums over all bodies further out, so they are known to the rounding of the largest, at the
    radius of the tip.
    """
    size = np.tile(np.repeat([chain.scale, 1.0], 3), len(q) // 6)
    lever = np.tile(np.repeat([1.0, float(np.linalg.norm(chain.nodes[-1, :3, 3]))], 3), len(q) // 6)
    before = np.inf
    for _ in range(STEPS):
        force, stiffness, _ = plant.inertial(q, omega)
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
        stalled = energy > MIN_REDUCTION * before  # else the bound is not reached yet: rounding may be much less
        if energy <= CONVERGED_FACTOR * rounding or (stalled and energy <= STALL_FACTOR * rounding):
            return q, stiffness
        before = energy
    return None
