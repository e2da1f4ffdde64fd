"""A blade's modes by the method of Park et al. (2010): bodies, joints, B, M*, Q*, partition, linearisation, eigenproblem.

The bodies and elements are those of ``solve``, which works with the twists of the bodies and never forms B. Here they form a
mechanism in relative coordinates with a dense stiffness: the same result by the paper's method, for some tens of elements.
"""

import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from math import prod

import numpy as np
from numpy.typing import NDArray

from .blade import Blade, without_rotary_inertia
from .effects import ALL_EFFECTS, Effects
from .element.discretize import Mass, discretize
from .element.measures import Measure
from .element.mesh import Chain
from .mechanism.description import MechanismError, at_rate
from .modes import Modes
from .space import spatial as sp
from .spectrum import eigen
from .spectrum.lowest import lowest
from .spectrum.rotating import Rotating, rotating
from .steady import equilibrium
from .steady.blade_state import SteadyStateError
from .tree import as_mechanism
from .tree.dynamics import unbalanced
from .tree.mode_shapes import mode_shapes
from .tree.pencil import Shape
from .tree.scales import coordinate_units, length_at
from .tree.spanning import compile_tree
from .tree.state import State, state_at
from .tree.strained import out_of_range
from .tree.topology import Tree

Array = NDArray[np.float64]

MAX_ELEMENTS = 200  # the time grows with their cube
_ORDER = 4  # of the extrapolation over speeds
_CONVERGED = 1e-13  # largest last correction of a steady state, rad, or a fraction of the blade's length (at least 1 m)
_BALANCED = 1e-8  # largest distance from the steady state, in the same unit


def modes(
    blade: Blade,
    omega: float,
    elements: int = 50,
    count: int = 10,
    *,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    effects: Effects = ALL_EFFECTS,
    gravity: Array | None = None,
    load: Array | None = None,
) -> Modes:
    """The lowest modes of a blade in steady rotation at ``omega``; arguments and units as for ``solve.modes``.

    The result has no uncertainties.

    Raises:
        ValueError: as ``solve.modes``; more than ``MAX_ELEMENTS`` elements; effects without prestretch or geometric
            stiffness, which the steady state of a mechanism always has.
        SteadyStateError: no steady state at this speed.
        UnstableError: the steady state is not stable.
    """
    one = sweep(
        blade, [omega], elements, count, mass=mass, stiffness=stiffness, effects=effects, gravity=gravity, load=load
    )
    return next(one)


def sweep(
    blade: Blade,
    omegas: Iterable[float],
    elements: int = 50,
    count: int = 10,
    *,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    effects: Effects = ALL_EFFECTS,
    gravity: Array | None = None,
    load: Array | None = None,
) -> Iterator[Modes]:
    """The modes at one speed after another; arguments and errors as for ``modes``.

    The mechanism is built once. Newton's method starts from an extrapolation of the previous steady states.
    """
    if count < 1:
        raise ValueError(f"count: {count}: ask for at least one mode")
    if elements > MAX_ELEMENTS:
        raise ValueError(
            f"elements: {elements}: the velocity transformation uses dense matrices: at most {MAX_ELEMENTS}; "
            "use the chain solver"
        )
    if not (effects.prestretch and effects.geometric):
        raise ValueError(
            f"effects: no {', no '.join(effects.lacks())}: the velocity transformation cannot omit prestretch or geometric "
            "stiffness; use the chain solver"
        )
    given = blade if effects.rotary_inertia else without_rotary_inertia(blade)
    body = discretize(given, elements, mass, stiffness, load)
    x, y, z = np.zeros(3).tolist() if gravity is None else gravity.tolist()
    tree = compile_tree(as_mechanism.mechanism(body, 0.0, (x, y, z)))
    known: dict[float, Array] = {}  # coordinates at Ω² of the last few speeds
    found: eigen.Eigen | None = None
    for omega in omegas:
        if not np.isfinite(omega):
            raise ValueError(f"omega: {omega}: give a finite rotor speed in rad/s")
        begun = time.perf_counter()
        linear = _about_steady_state(tree, body, omega, effects, known)
        found = lowest(linear.pencil, count, found)
        known = dict([*known.items(), (omega**2, linear.corrected)][-_ORDER - 1 :])
        shapes = _shapes(body, linear, found.vectors)
        yield Modes(omega, found.frequencies, shapes, body.elements, seconds=time.perf_counter() - begun)


@dataclass(frozen=True)
class _Linear:
    """M, C, K about a state, and Newton's correction of the state, −K⁻¹ Q over the free coordinates."""

    state: State
    pencil: Rotating
    correction: Array

    @property
    def corrected(self) -> Array:
        """The coordinates (n,) after the correction."""
        q = self.state.q.copy()
        q[self.pencil.free] += self.correction
        return q


def _about_steady_state(tree: Tree, body: Chain, omega: float, effects: Effects, known: dict[float, Array]) -> _Linear:
    """The linearisation about the steady state at ``omega`` (rad/s).

    Newton's method starts from the known steady states or, without any, from the undeformed blade. Where it fails,
    ``equilibrium.steady`` finds the state.

    Raises:
        SteadyStateError: no steady state at this speed.
        UnstableError: the steady state is not stable.
    """
    here = replace(tree, mechanism=at_rate(tree.mechanism, "hub.rz", omega))
    try:
        found = _corrected(here, _extrapolated(known, omega, np.zeros(len(tree.coordinates))), effects)
    except (MechanismError, eigen.UnstableError):  # at a state that is no equilibrium
        found = None
    try:
        found = found or _linear(here, equilibrium.steady(here), effects)
    except MechanismError as error:
        raise SteadyStateError(f"omega: no steady state at {omega:.6g} rad/s: {error}") from error
    except eigen.UnstableError as error:
        hinge = "; or a free hinge has no stiffness (at rest; lead–lag without offset)" if body.joints else ""
        raise eigen.UnstableError(f"omega: {omega:.6g} rad/s: {error}{hinge}") from error
    off = np.abs(found.correction).max(initial=0.0) / max(body.scale, 1.0)
    if off > _BALANCED:
        raise SteadyStateError(
            f"omega: {omega:.6g} rad/s: the state found is {off:.1e} rad, or of the blade's length (at least 1 m), from "
            "equilibrium"
        )
    return found


def _extrapolated(known: dict[float, Array], omega: float, undeformed: Array) -> Array:
    """Coordinates (n,) by the polynomial in Ω² through the known ones; ``undeformed`` without any."""
    at = omega**2
    return sum((prod((at - y) / (x - y) for y in known if y != x) * q for x, q in known.items()), undeformed)


def _corrected(tree: Tree, q: Array, effects: Effects) -> _Linear | None:
    """Newton's method as long as each correction is at most half the previous one; else None."""
    last = np.inf
    while True:
        found = _linear(tree, state_at(tree, q), effects)
        k, free = found.state.kinematics, found.pencil.free
        unit = coordinate_units(tree, length_at(tree, k.poses))[free]
        size = float(np.abs(found.correction / unit).max(initial=0.0))
        if not size <= 0.5 * last or out_of_range(tree, k.poses):
            return None
        if size < _CONVERGED:
            return found
        q, last = found.corrected, size


def _linear(tree: Tree, state: State, effects: Effects) -> _Linear:
    pencil = rotating(state, effects.coriolis)
    left = unbalanced(tree, state.kinematics, state.cartesian, state.q, state.v)[pencil.free]
    return _Linear(state, pencil, -pencil.solve(left[:, None])[:, 0])


def _shapes(body: Chain, linear: _Linear, vectors: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """(m, 21, 4) mode shapes at the common stations from vectors (i, m) over the free coordinates."""
    k, n, m = linear.state.kinematics, len(body.nodes), vectors.shape[1]
    nodes = k.poses[1 : n + 1]  # after the hub, whose axes coincide with the ground's
    parts = linear.pencil.twists(np.stack([vectors.real, vectors.imag], axis=2).reshape(-1, 2 * m))
    ground, of_beta = np.split(parts.reshape(-1, 6, 2 * m), [len(k.poses)])  # δZ = B δq
    twists = sp.adjoint(sp.inverse(nodes[1:])) @ ground[2 : n + 1]  # in the nodes' axes
    beta = np.zeros((n - 1, body.beams.inner))
    dbeta = np.zeros((*beta.shape, 2 * m))  # β of each element; none where the mass is lumped
    if len(of_beta):  # a joint at the root has none
        beta[-len(of_beta) :], dbeta[-len(of_beta) :] = k.q[k.tree.joints :].reshape(-1, 6), of_beta
    moved = np.concatenate([twists, dbeta], axis=1).transpose(2, 0, 1)
    return mode_shapes(body, Shape(nodes, beta, sp.inverse(nodes[:-1]) @ nodes[1:]), moved)
