"""A blade's modes by the method of Park et al. (2010): bodies, joints, B, M*, Q*, partition, linearisation, eigenproblem.

The bodies and elements are those of ``solve``, which works with the bodies' own twists and never forms B. Here they form a
mechanism in relative coordinates with dense matrices: the same result by the paper's method, for some tens of elements.
"""

import time

import numpy as np
from numpy.typing import NDArray

from . import eigen
from .blade import Blade, without_rotary_inertia
from .chain import as_mechanism
from .chain.mode_shapes import mode_shapes
from .chain.pencil import Shape
from .chain.steady import SteadyStateError
from .effects import ALL_EFFECTS, Effects
from .element.discretize import Chain, Mass, discretize
from .element.measures import Measure
from .modes import Modes
from .multibody import equilibrium
from .multibody import linear as lz
from .multibody.mechanism import MechanismError
from .multibody.reduced import reduced
from .multibody.tree import compile_tree
from .space import spatial as sp

Array = NDArray[np.float64]

MAX_ELEMENTS = 200  # of dense matrices, 12 coordinates an element: gigabytes and minutes beyond
_BALANCED = 1e-8  # how far off the steady state may be, of the blade's length (or a radian)


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
    """The lowest modes of a blade turning steadily at ``omega``; arguments, units and answer as those of ``solve.modes``.

    Raises:
        ValueError: as ``solve.modes``; or effects without prestretch or geometric stiffness, which the steady state of a
            mechanism always has.
        SteadyStateError: no steady state at this speed.
        UnstableError: the steady state is not stable.
    """
    if count < 1:
        raise ValueError(f"count: {count}: ask for at least one mode")
    if not np.isfinite(omega):
        raise ValueError(f"omega: {omega}: give a finite rotor speed in rad/s")
    if elements > MAX_ELEMENTS:
        raise ValueError(
            f"elements: {elements}: the velocity transformation has dense matrices: at most {MAX_ELEMENTS}; "
            "use the chain solver"
        )
    if not (effects.prestretch and effects.geometric):
        raise ValueError(
            f"effects: no {', no '.join(effects.lacks())}: the velocity transformation keeps prestretch and geometric "
            "stiffness; use the chain solver"
        )
    begun = time.perf_counter()
    kept = blade if effects.rotary_inertia else without_rotary_inertia(blade)
    body = discretize(kept, elements, mass, stiffness, load)
    linear = about_steady_state(body, omega, np.zeros(3) if gravity is None else gravity)
    M, C, K = (0.5 * (linear.M + linear.M.T), 0.5 * (linear.C - linear.C.T), 0.5 * (linear.K + linear.K.T))
    try:
        found = eigen.gyroscopic(M, C if effects.coriolis else np.zeros_like(C), K, count)
    except eigen.UnstableError as error:
        loose = "; or nothing holds a free hinge (at rest; lead–lag without offset)" if body.clamped.size else ""
        raise eigen.UnstableError(f"omega: {omega:.6g} rad/s: {error}{loose}") from error
    _check_balance(linear, K, omega, body.scale)
    shapes = _shapes(body, linear, found.vectors)
    return Modes(omega, found.frequencies, shapes, body.elements, seconds=time.perf_counter() - begun)


def about_steady_state(body: Chain, omega: float, gravity: Array) -> lz.Linearization:
    """M̂, Ĉ, K̂ of a chain as a mechanism, about its steady state at ``omega`` (rad/s).

    Raises:
        SteadyStateError: no steady state at this speed.
    """
    x, y, z = gravity.tolist()
    tree = compile_tree(as_mechanism.mechanism(body, omega, (x, y, z)))
    try:
        return lz.about(tree, equilibrium.steady(tree))
    except MechanismError as error:
        raise SteadyStateError(f"omega: no steady state at {omega:.6g} rad/s: {error}") from error


def _check_balance(linear: lz.Linearization, K: Array, omega: float, length: float) -> None:
    """Where Q̂ is not zero, K̂⁻¹ Q̂ is how far off the steady state is."""
    Q_hat = reduced(linear.tree, linear.state.q, np.zeros(len(K)), linear.names).Q_hat
    off = np.abs(np.linalg.solve(K, Q_hat)).max(initial=0.0) / max(length, 1.0)
    if off > _BALANCED:
        raise SteadyStateError(
            f"omega: {omega:.6g} rad/s: the state found is {off:.1e} of the blade's length off balance"
        )


def _shapes(body: Chain, linear: lz.Linearization, vectors: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """(m, 21, 4) mode shapes at the common stations from vectors (i, m) over the independent coordinates."""
    k, n = linear.state.kinematics, len(body.nodes)
    dq = np.zeros((len(k.q), vectors.shape[1]), complex)
    dq[linear.partition.free] = linear.partition.R @ vectors  # δq = R δq_I
    nodes = k.poses[1 : n + 1]  # behind the hub, whose axes are the ground's now
    twists = sp.adjoint(sp.inverse(nodes)) @ (k.B[1 : n + 1] @ dq)  # δZ = B δq, in the nodes' own axes
    inner = linear.tree.inner[:, None] + np.arange(6)  # β of each element; none where the mass is lumped
    beta = np.zeros((n - 1, body.beams.inner))
    dbeta = np.zeros((*beta.shape, vectors.shape[1]), complex)
    if len(inner):  # not of a joint at the root
        beta[-len(inner) :], dbeta[-len(inner) :] = k.q[inner], dq[inner]
    own = np.concatenate([dbeta, twists[1:]], axis=1).reshape(-1, vectors.shape[1])
    return mode_shapes(body, Shape(nodes, beta, sp.inverse(nodes[:-1]) @ nodes[1:]), own)
