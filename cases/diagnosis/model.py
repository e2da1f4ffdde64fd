"""What the solver is given under a hypothesis: a blade, effects and a discretisation, each possibly wrong on purpose."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade, without_rotary_inertia
from ...core.effects import ALL_EFFECTS, Effects
from ...core.element.discretize import Mass, discretize
from ...core.element.mesh import Mesh
from ...core.modes import Modes
from ...core.spectrum import mesh_solver
from ...core.spectrum.eigen import Eigen, EigenError, UnstableError, damped, gyroscopic
from ...core.spectrum.lanczos import lanczos
from ...core.spectrum.mesh_solver import Options
from ...core.steady.blade_state import SteadyStateError
from ...core.threads import one_thread
from ...core.tree import pencil
from ...core.tree.links import product, twists
from ...core.tree.mode_shapes import mode_shapes
from ...core.tree.pencil import Shape, TreePencil
from ...core.turbine.assumed import restricted_motions
from .elastodyn_blade import AssumedShapes, OperatingPoint, blade_equations, field_of, nodes_of
from .scaled_terms import softened, stiffened

Array = NDArray[np.float64]

ELEMENTS = 20
"""Elements of a solution with and without a hypothesis: the discretisation errors cancel in its effect."""

FOLLOWED = 24
"""Modes at rest that span the motion of a model whose centrifugal force follows the sections."""

SLOW = 0.05
"""Speed at which Southwell's coefficient is taken, as a fraction of the lowest frequency at rest."""

NO_ANSWER = (SteadyStateError, UnstableError, EigenError, ArithmeticError, ValueError, np.linalg.LinAlgError)
"""A wrong model may have no steady state, be unstable or singular, or give numbers that are not finite."""


@dataclass(frozen=True)
class Model:
    """A blade and how it is solved.

    Attributes:
        blade: the blade.
        effects: physical effects included.
        speed: factor on the rotor speed.
        softening: factor on spin softening.
        geometric: factor on geometric stiffness.
        following: part of the centrifugal force that turns with the section that it acts on; 2 reverses the sign of T′w′ in
            the equation of a beam, −T w″ − T′ w′ with the tension T.
        gravity: (3,) m/s², in the hub's axes.
        mass: scheme of the inertia of elements.
        whole_tip: whether the lumped mass at the tip is that of a whole element instead of a half.
        elements: number of elements if a coarse mesh is the hypothesis; 0 otherwise.
        basis: number of the blade's own lowest modes at rest that span all motion; 0: not truncated.
        two_node: whether elements have no inner coordinates: their shapes are those of static loads at their ends, which are
            linear in torsion and cubic in bending.
        assumed: ElastoDyn's shapes and number of nodes, if its equations are solved in place of the mesh's.
        slow: whether ω² = ω₀² + φ Ω² is extrapolated from a low speed (Southwell 1921).
    """

    blade: Blade
    effects: Effects = ALL_EFFECTS
    speed: float = 1.0
    softening: float = 1.0
    geometric: float = 1.0
    following: float = 0.0
    gravity: Array = field(default_factory=lambda: np.zeros(3))
    mass: Mass = "consistent"
    whole_tip: bool = False
    elements: int = 0
    basis: int = 0
    two_node: bool = False
    assumed: AssumedShapes | None = None
    slow: bool = False


def solve(model: Model, speeds: Sequence[float], count: int, elements: int = ELEMENTS) -> list[Modes | None]:
    """The lowest ``count`` modes at each speed (rad/s); None at a speed without an answer.

    ``elements`` is the number of elements of a model that does not state one.
    """
    blade = model.blade if model.effects.rotary_inertia else without_rotary_inertia(model.blade)
    try:
        mesh = discretize(blade, model.elements or elements, model.mass)
    except NO_ANSWER:
        return [None] * len(speeds)
    if model.whole_tip:
        lumps = mesh.lumps.copy()
        lumps[-1] += lumps[-1] - blade.tip_mass
        mesh = replace(mesh, lumps=lumps)
    rotor_speeds = [model.speed * omega for omega in speeds]
    with one_thread(), np.errstate(all="ignore"):
        if model.slow:
            return _extrapolated(mesh, model, rotor_speeds, count)
        if model.assumed:
            return _assumed(mesh, model, model.assumed, rotor_speeds)
        if model.basis or model.two_node or model.following:
            return _restricted(mesh, model, rotor_speeds, count)
        return list(_swept(mesh, model, rotor_speeds, count))


def _swept(mesh: Mesh, model: Model, speeds: Sequence[float], count: int) -> Iterator[Modes | None]:
    options = Options(count, model.effects, model.gravity)
    start = None
    for omega in speeds:
        try:
            if model.softening == model.geometric == 1.0:
                solved = mesh_solver.solve(mesh, omega, options, start)
                start = solved.start
                yield solved.modes
            else:
                state = mesh_solver.balance(mesh, omega, model.gravity, model.effects)
                altered = softened(mesh, state, omega, model.softening)
                if model.geometric != 1.0:
                    altered = stiffened(mesh, altered, state.shape, omega, model.geometric)
                yield _modes(mesh, state.shape, altered, lanczos(altered, count), omega)
        except NO_ANSWER:
            yield None


def _modes(mesh: Mesh, shape: Shape, p: TreePencil, lowest: Eigen, omega: float) -> Modes:
    shapes = mode_shapes(mesh, shape, pencil.on_nodes(p, lowest.vectors))
    return Modes(omega, lowest.frequencies, shapes, mesh.elements)


def _restricted(mesh: Mesh, model: Model, speeds: Sequence[float], count: int) -> list[Modes | None]:
    """Modes in a basis (Ritz): the lowest modes at rest, about the prestressed undeformed blade, or static shapes."""
    try:
        basis = _static(mesh) if model.two_node else _lowest(mesh, model.basis or FOLLOWED)
    except NO_ANSWER:
        return [None] * len(speeds)
    effects = model.effects if model.two_node else replace(model.effects, prestretch=False)
    out: list[Modes | None] = []
    for omega in speeds:
        try:
            state = mesh_solver.balance(mesh, omega, model.gravity, effects)
            p = state.pencil
            M, C, K = (basis @ product(a, sign, p.links, basis).T for a, sign in ((p.M, 1.0), (p.C, -1.0), (p.K, 1.0)))
            M, C, K = 0.5 * (M + M.T), 0.5 * (C - C.T), 0.5 * (K + K.T)
            if model.following:
                K = K - model.following * _turned_force(model, mesh, state.shape, twists(p.links, basis), omega)
                small = damped(M, C, K, count)
            else:
                small = gyroscopic(M, C, K, min(count, len(basis)))
            out.append(_modes(mesh, state.shape, p, Eigen(small.frequencies, basis.T @ small.vectors), omega))
        except NO_ANSWER:
            out.append(None)
    return out


def _turned_force(model: Model, mesh: Mesh, shape: Shape, motions: Array, omega: float) -> Array:
    """(k, k) work of the centrifugal forces on the nodes, turned by one motion (k, n, d), on another."""
    mass = discretize(model.blade, mesh.elements, "half_end").lumps[1:, 0, 0]
    force = mass[:, None] * omega**2 * shape.nodes[1:, :3, 3] * np.array([1.0, 1.0, 0.0])
    local = np.einsum("nba,nb->na", shape.nodes[1:, :3, :3], force)
    return np.einsum("ina,kna->ik", motions[..., :3], np.cross(motions[..., 3:6], local))


def _lowest(mesh: Mesh, count: int) -> Array:
    """(count, n) the lowest modes at rest.

    The coordinates are differences of twists along the blade, so that the basis includes the shortening of a bent blade.
    """
    at_rest = mesh_solver.solve(mesh, 0.0, Options(count))
    phase = np.exp(-1j * np.angle(at_rest.vectors[np.abs(at_rest.vectors).argmax(0), range(at_rest.vectors.shape[1])]))
    basis = (at_rest.vectors * phase).real.T
    p = at_rest.state.pencil
    return basis / np.sqrt(np.einsum("mi,mi->m", basis, product(p.M, 1.0, p.links, basis)))[:, None]


def _static(mesh: Mesh) -> Array:
    """(6 n, n d) six relative motions of the ends of each element; inner coordinates have the least elastic energy."""
    K = pencil.linearize(mesh, pencil.undeformed(mesh), 0.0, np.zeros(3), ALL_EFFECTS).K
    n, d = len(K), K.shape[1] - 6
    motions = np.tile(np.eye(6, d), (n, 1, 1))
    motions[..., 6:] = -np.linalg.solve(K[:, 12:, 12:], K[:, 12:, 6:12]).swapaxes(1, 2)
    basis = np.zeros((n, 6, n, d))
    basis[np.arange(n), :, np.arange(n)] = motions
    return basis.reshape(6 * n, n * d)


def _assumed(mesh: Mesh, model: Model, assumed: AssumedShapes, speeds: Sequence[float]) -> list[Modes | None]:
    """Modes by ElastoDyn's equations about the undeformed blade, as many as there are shapes."""
    shape = pencil.undeformed(mesh)
    try:
        basis = restricted_motions(model.blade, mesh, field_of(model.blade, assumed.shapes))
        nodes = nodes_of(model.blade, assumed.shapes, assumed.nodes)
        p = pencil.linearize(mesh, shape, 0.0, np.zeros(3), ALL_EFFECTS)
    except NO_ANSWER:
        return [None] * len(speeds)
    r = len(assumed.shapes)
    at = OperatingPoint(*np.zeros((3, r)))
    out: list[Modes | None] = []
    for omega in speeds:
        try:
            M, C, K = (part[:r, :r] for part in blade_equations(nodes, model.blade, omega, -model.gravity, at))
            small = gyroscopic(M, C - nodes.damping, K, r)
            out.append(_modes(mesh, shape, p, Eigen(small.frequencies, basis[:r].T @ small.vectors), omega))
        except NO_ANSWER:
            out.append(None)
    return out


def _extrapolated(mesh: Mesh, model: Model, speeds: Sequence[float], count: int) -> list[Modes | None]:
    """Southwell's equation with the coefficients at a low speed, in the order of the frequencies."""
    try:
        at_rest, *_ = _swept(mesh, replace(model, softening=1.0), [0.0], count)
        if at_rest is None:
            return [None] * len(speeds)
        low = SLOW * float(at_rest.frequencies[0])
        (at_low_speed,) = _swept(mesh, model, [low], count)
    except NO_ANSWER:
        return [None] * len(speeds)
    if at_low_speed is None:
        return [None] * len(speeds)
    slope = (at_low_speed.frequencies**2 - at_rest.frequencies**2) / low**2
    out: list[Modes | None] = []
    for omega in speeds:
        square = at_rest.frequencies**2 + slope * omega**2
        order = np.argsort(square)
        lowest = np.sqrt(np.maximum(square[order], 0.0))
        out.append(Modes(omega, lowest, at_low_speed.shapes[order], mesh.elements))
    return out
