"""Exudyn's geometrically exact beam in a co-rotating frame: curved, twisted and tapered blades, independent of core.

The element has two nodes with a position r and a rotation R each. Its strains are constant: the screw motion from one
node's pose to the other's, less that of the reference configuration, over the length (V. Sonneville, A. Cardona,
O. Brüls, "Geometrically exact beam finite element formulated on the special Euclidean group SE(3)", Comput. Methods
Appl. Mech. Eng. 268, 2014). Exudyn takes diagonal section stiffness. The shear compliance of an element of
length h is ``1/GA + h²/(12 EI)``: the second term is the bending of a straight element beyond constant strain (R. H.
MacNeal, "A simple quadrilateral shell element", Comput. Struct. 8, 1978), so GA may be infinite.

Exudyn provides the elastic forces and their tangent. This module lumps the inertia at the nodes and finds the steady
state. The columns of R and r, together ``a``, are linear in the positions of a section's particles, so the inertia forces in
axes that turn with the hub are exactly, with the constant matrix ``m = ∫ Y Yᵀ dm``, Y = (y, 1), and B = e_z ×,

    (m ⊗ 1) ä + 2Ω (m ⊗ B) ȧ + Ω² (m ⊗ B²) a.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.interpolate import CubicSpline
from scipy.sparse.linalg import splu, spsolve
from scipy.spatial.transform import Rotation

from ...core.blade import AXIAL, BEND_Y, BEND_Z, COUPLING_ROUNDING, SHEAR_Y, SHEAR_Z, TORSION, Blade, clamped
from ...core.modes import STATIONS, Modes
from ...core.space.spatial import skew
from ..matrices.quadratic import gyroscopic_modes
from ..protocol.fingerprint import SPIN, Fingerprint, of_matrix, rigid_motions, tip_flexibility
from ..protocol.interface import REFERENCE_LINE, BladeAdapter, CodeError, Independence
from ..sampling import mass_at, points, stiffness_at
from ..theories.reference_line import JUMP, element_ends, line, moments
from . import system as ex

Array = NDArray[np.float64]

MAX_ITERATIONS = 30
"""Newton iterations for a steady state."""

MAX_TURN = np.pi
"""Rotation of a node in an iteration, rad, above which it diverges."""

CONVERGED = 1e-10
"""Largest last Newton step, in rad and relative to the length; the next one is rounding."""

RAMPS = (1, 4, 16)
"""Numbers of equal increments of the speed, tried in turn."""

INTERVALS = 12
"""A blade with more intervals between kinks has proportionally more elements."""


class ExudynGeometricallyExact(BladeAdapter):
    """See the module; curved, twisted, tapered, clamped blades with offset mass centres, shear, precone, pitch, tip mass."""

    name = "exudyn-beam"
    title = "Exudyn, geometrically exact beam"
    independence = Independence(
        "Exudyn",
        "geometrically exact beam on SE(3), masses lumped by the adapter",
        "exudyn-beam's adapter",
        REFERENCE_LINE,
    )
    levels = (12, 24, 48)
    order = 2
    hint = ex.HINT
    distribution = ex.DISTRIBUTION

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if sections couple strains or are rigid in any strain but shear, the curve has kinks or the root moves."""
        diagonal = np.diagonal(blade.stiffness, axis1=1, axis2=2)
        scale = np.sqrt(diagonal[:, :, None] * diagonal[:, None, :])
        coupling = np.argwhere((np.abs(blade.stiffness) > COUPLING_ROUNDING * scale) & ~np.eye(6, dtype=bool))
        if len(coupling):
            k, i, j = coupling[0]
            value = blade.stiffness[k, i, j]
            return f"stiffness[{k}][{i}][{j}] = {value:g}: Exudyn's beam refuses off-diagonal section stiffness"
        if np.isinf(diagonal[:, [AXIAL, TORSION, BEND_Y, BEND_Z]]).any():
            return "rigid in stretch, torsion or bending: Exudyn's beam needs finite EA, GJ, EI_y and EI_z"
        if blade.kinks:
            return f"a kink at {blade.kinks[0]:g} m: the two elements at a node share the section's axes"
        if not clamped(blade):
            return "a root joint: this beam is clamped"
        return None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.BladeAdapter``.

        Raises:
            CodeError: no stable steady state at this speed.
        """
        beam = assemble(blade, elements)
        state = beam.reference if not omega else steady_state(beam, omega)
        M, C, K = linearized(beam, state, omega)
        frequencies, vectors = gyroscopic_modes(M, C, K, count)
        motion = np.concatenate([np.zeros((1, 6, vectors.shape[1])), vectors.reshape(-1, 6, vectors.shape[1])])
        motion[:, 3:] = state.axes @ motion[:, 3:]
        shapes = CubicSpline(beam.ends, motion[:, :4])(STATIONS * blade.length)
        return Modes(omega, frequencies, shapes.transpose(2, 0, 1), len(beam.ends) - 1)

    def fingerprint(self, blade: Blade, elements: int) -> Fingerprint:
        """From the matrices of all nodes at rest; see ``interface.BladeAdapter``."""
        beam = assemble(blade, elements)
        state = beam.reference
        A = _affine(state.axes)
        turns = np.zeros((len(beam.ends), 3, 6))
        turns[:, :, 3:] = np.swapaxes(state.axes, 1, 2)
        q = A @ np.concatenate([rigid_motions(state.position), turns], axis=1)
        inertia = (np.swapaxes(q, 1, 2) @ np.kron(beam.mass, np.eye(3)) @ q).sum(axis=0)
        K = sparse.csc_array(elastic(beam, state)[1])[6:, 6:]
        loads = np.zeros((K.shape[0], 6))
        loads[-6:-3, :3], loads[-3:, 3:] = np.eye(3), state.axes[-1].T
        flexibility = tip_flexibility(loads.T @ splu(K).solve(loads))
        return replace(of_matrix(inertia, len(beam.ends) - 1), flexibility=flexibility)


@dataclass(frozen=True)
class Poses:
    """Positions ``position`` (n, 3), m, and rotations ``axes`` (n, 3, 3) of the nodes, in axes that turn with the hub."""

    position: Array
    axes: Array


@dataclass(frozen=True)
class Beam:
    """An assembled system of Exudyn.

    Attributes:
        exu, container, mbs: the module, its container, which must stay alive, and the system.
        ends: (n,) arc lengths of the nodes, m.
        reference: poses without load.
        mass: (n, 4, 4) the matrices m of the nodes (see the module).
    """

    exu: Any
    container: Any
    mbs: Any
    ends: Array
    reference: Poses
    mass: Array


def assemble(blade: Blade, elements: int) -> Beam:
    """The beam with at least ``elements`` elements; every kink of a property is the end of one."""
    exu, container, mbs = ex.system()
    items, ends = exu.itemInterface, element_ends(blade, elements, INTERVALS, step_elements=False)
    at = line(blade, ends[:, None])
    reference = Poses(at.position[:, 0], at.axes[:, 0])
    nodes = [
        mbs.AddNode(items.NodeRigidBodyEP(referenceCoordinates=q, addConstraintEquation=False))
        for q in _coordinates(reference)
    ]
    for k, stiffness in enumerate(_stiffness(blade, ends)):
        section = exu.BeamSection()
        section.stiffnessMatrix = np.diag(stiffness)
        mbs.AddObject(
            items.ObjectBeamGeometricallyExact(
                length=ends[k + 1] - ends[k], nodeNumbers=nodes[k : k + 2], sectionData=section
            )
        )
    mbs.Assemble()
    return Beam(exu, container, mbs, ends, reference, _masses(blade, ends))


def _stiffness(blade: Blade, ends: Array) -> Array:
    """(e, 6) diagonals: inverses of the elements' mean compliances.

    In elements far shorter than the others, which only a short soft part has, the rounding of positions times ``12 EI/h²``
    would matter: h is then the mean length, so that the error is still of second order.
    """
    s, weight = points(ends, 3)
    h = np.diff(ends)
    bending_length = np.where(h > JUMP * blade.length, h, blade.length / len(h))
    diagonal = np.diagonal(stiffness_at(blade, s.ravel()), axis1=1, axis2=2).reshape(*s.shape, 6)
    compliance = (weight[..., None] / diagonal).sum(1) / h[:, None]
    compliance[:, SHEAR_Y] += bending_length**2 / 12 * compliance[:, BEND_Z]
    compliance[:, SHEAR_Z] += bending_length**2 / 12 * compliance[:, BEND_Y]
    return 1 / compliance


def _masses(blade: Blade, ends: Array) -> Array:
    """(n, 4, 4) sections' and tip's mass, shared by the ends of each element as by a lever."""
    s, weight = points(ends, 3)
    section = moments(mass_at(blade, s.ravel())).reshape(*s.shape, 4, 4)
    right = (s - ends[:-1, None]) / np.diff(ends)[:, None]
    out = np.zeros((len(ends), 4, 4))
    out[:-1] += np.einsum("eq,eqij->eij", weight * (1 - right), section)
    out[1:] += np.einsum("eq,eqij->eij", weight * right, section)
    out[-1] += moments(blade.tip_mass)
    return out


def steady_state(beam: Beam, omega: float) -> Poses:
    """Poses in which elastic and centrifugal forces balance, with the speed raised in as few increments as suffice.

    Raises:
        CodeError: Newton's method did not converge, even with the smallest increments.
    """
    for increments in RAMPS:
        state: Poses | None = beam.reference
        for k in range(1, increments + 1):
            state = state and _balanced(beam, state, omega * k / increments)
        if state:
            return state
    raise CodeError(f"omega: {omega:g} rad/s: no steady state in {MAX_ITERATIONS} iterations; lower the speed")


def _balanced(beam: Beam, state: Poses, omega: float) -> Poses | None:
    """The steady state near ``state``, by Newton's method; None if it does not converge."""
    for _ in range(MAX_ITERATIONS):
        force, K = elastic(beam, state)
        inertia, softening = centrifugal(beam, state, omega)
        step = -spsolve(sparse.csc_array(K + softening)[6:, 6:], (force + inertia)[6:])
        move, rotation = np.split(np.append(np.zeros(6), step).reshape(-1, 6), 2, axis=1)
        if not np.abs(rotation).max() < MAX_TURN:
            return None
        state = moved(state, np.hstack([move, rotation]))
        if max(np.abs(move).max() / beam.ends[-1], np.abs(rotation).max()) < CONVERGED:
            return state
    return None


def moved(poses: Poses, step: Array) -> Poses:
    """Poses after displacements and local rotation vectors ``step`` (n, 6)."""
    rotation = Rotation.from_rotvec(step[:, 3:]).as_matrix()
    return Poses(poses.position + step[:, :3], poses.axes @ rotation)


def linearized(beam: Beam, state: Poses, omega: float) -> tuple[Any, Any, Any]:
    """M, C, K (6e, 6e) sparse, by the displacement and local rotation of every node but the root, about a steady state."""
    A = _affine(state.axes)
    M = np.swapaxes(A, 1, 2) @ np.kron(beam.mass, np.eye(3)) @ A
    C = 2 * omega * np.swapaxes(A, 1, 2) @ np.kron(beam.mass, SPIN) @ A
    K = elastic(beam, state)[1] + centrifugal(beam, state, omega)[1]
    blocks = (sparse.block_diag(list(M[1:]), format="csc"), sparse.block_diag(list(C[1:]), format="csc"))
    return *blocks, sparse.csc_array(K)[6:, 6:]


def _affine(axes: Array) -> Array:
    """(n, 12, 6) derivative of (R e_x, R e_y, R e_z, r) by displacement and local rotation: δ(R e) = −R ẽ δθ."""
    out = np.zeros((len(axes), 12, 6))
    for j, e in enumerate(np.eye(3)):
        out[:, 3 * j : 3 * j + 3, 3:] = -axes @ skew(e)
    out[:, 9:, :3] = np.eye(3)
    return out


def centrifugal(beam: Beam, state: Poses, omega: float) -> tuple[Array, Any]:
    """Inertia force Ω² Aᵀ (m ⊗ B²) a (6n,) of a steady state, and its derivative (6n, 6n)."""
    A = _affine(state.axes)
    a = np.concatenate([np.swapaxes(state.axes, 1, 2), state.position[:, None]], axis=1)  # (n, 4, 3)
    force = omega**2 * beam.mass @ a @ (SPIN @ SPIN).T
    K = omega**2 * np.swapaxes(A, 1, 2) @ np.kron(beam.mass, SPIN @ SPIN) @ A
    # second order of a rotation: ½ θ̃² e = ½ (θ θ·e − e θ·θ)
    U = np.swapaxes(force[:, :3] @ state.axes, 1, 2)
    K[:, 3:, 3:] += (U + np.swapaxes(U, 1, 2)) / 2 - np.trace(U, axis1=1, axis2=2)[:, None, None] * np.eye(3)
    return (np.swapaxes(A, 1, 2) @ force.reshape(-1, 12, 1)).ravel(), sparse.block_diag(list(K), format="csr")


def elastic(beam: Beam, state: Poses) -> tuple[Array, Any]:
    """Exudyn's elastic force (6n,) at poses, and its derivative (6n, 6n)."""
    p = _coordinates(state)
    shifted = (p - _coordinates(beam.reference)).ravel()
    beam.mbs.systemData.SetODE2Coordinates(shifted, configuration=beam.exu.ConfigurationType.Initial)
    force, K = ex.forces(beam.exu, beam.mbs)
    basis = sparse.block_diag([_basis(q[3:]) for q in p], format="csr")
    return basis.T @ force, basis.T @ sparse.csr_array(K) @ basis


def _coordinates(poses: Poses) -> Array:
    """(n, 7) positions and Euler parameters, Exudyn's coordinates of a rigid body."""
    return np.hstack([poses.position, Rotation.from_matrix(poses.axes).as_quat(scalar_first=True)])


def _basis(p: Array) -> Array:
    """(7, 6) derivative of a node's coordinates by displacement and local rotation: δp = ½ p ∘ (0, δθ)."""
    out = np.zeros((7, 6))
    out[:3, :3] = np.eye(3)
    out[3, 3:] = -p[1:] / 2
    out[4:, 3:] = (p[0] * np.eye(3) + skew(p[1:])) / 2
    return out


CODE = ExudynGeometricallyExact()
