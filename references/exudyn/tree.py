"""Exudyn's kinematic tree: a blade as rigid segments on elastic hinges, in relative coordinates.

The model is that of ``hinged_segments``. Exudyn's recursive equations of motion (R. Featherstone, *Rigid Body Dynamics
Algorithms*, 2008) include large motions, hence the stiffening by steady tension, and all inertia forces.

If the blade has no moments of inertia, the segments have none about their axis, and there are no torsional modes. M is
then semi-definite, which the eigensolver allows.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.interpolate import CubicSpline

from ...core.blade import BEND_Y, BEND_Z, Blade, clamped
from ...core.effects import ALL_EFFECTS
from ...core.modes import STATIONS, Modes
from ...core.space.spatial import rotation
from ..matrices.quadratic import gyroscopic_modes
from ..protocol.fingerprint import Fingerprint, of_matrix, tip_flexibility
from ..protocol.interface import REFERENCE_LINE, BladeAdapter, CodeError, Independence
from ..theories.reference_line import steps
from . import system as ex
from .hinged_segments import SEGMENTS, SLIDE, TURN, HingedSegments, hinge_segments

Array = NDArray[np.float64]

JOINT = ("PrismaticX", "PrismaticY", "PrismaticZ", "RevoluteX", "RevoluteY", "RevoluteZ")
"""Exudyn's joint for each strain; also axis 0, 1, 2, 0, 1, 2."""


RAMPS = (1, 4, 16)
"""Numbers of equal increments of the squared speed, tried in turn."""


class ExudynTree(BladeAdapter):
    """See the module; coupled, curved, twisted, tapered blades with shear, precone, pitch, tip mass and root joint."""

    name = "exudyn-tree"
    title = "Exudyn, kinematic tree"
    independence = Independence("Exudyn", SEGMENTS, "Exudyn", sections=REFERENCE_LINE)
    effects = ALL_EFFECTS
    levels = (12, 24, 36)
    order = 2
    finest = 768  # the matrices are dense
    hint = ex.HINT
    distribution = ex.DISTRIBUTION

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if the curve has kinks or the blade is rigid in bending."""
        if blade.kinks:
            return f"a kink at {blade.kinks[0]:g} m: all sections of an element use the axes of its hinge"
        if np.isinf(blade.stiffness[:, [BEND_Y, BEND_Z], [BEND_Y, BEND_Z]]).any():
            return "rigid in bending: a hinge needs finite EI_y and EI_z"
        return None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.BladeAdapter``.

        Raises:
            CodeError: no stable steady state at this speed.
        """
        tree = hinge_segments(blade, elements, omega)
        M, C, K, q = linearize(tree, omega)
        frequencies, vectors = gyroscopic_modes(M, C, K, count)
        shapes = _shapes(blade, tree, q, vectors)
        refinement = len(tree.ends) - 1 - steps(blade)
        return Modes(omega, frequencies, shapes, refinement)

    def fingerprint(self, blade: Blade, elements: int) -> Fingerprint:
        """From Exudyn's mass matrix of a tree with a free hub; see ``interface.BladeAdapter``."""
        tree = hinge_segments(blade, elements)
        exu, _container, mbs = _system(tree, 0.0, FREE_HUB)
        M, _, _ = ex.linearized(exu, mbs, at_rest=True, full=True)
        weighed = of_matrix(M[:6, :6], len(tree.ends) - 1 - steps(blade), tree.start)
        if not clamped(blade):
            return weighed
        _, _, K, q = linearize(tree, 0.0)
        tip = jacobian(tree, q, tree.reach)[-1]
        return replace(weighed, flexibility=tip_flexibility(tip @ np.linalg.solve(K, tip.T)))


ROTATING_HUB = (BEND_Z,)
"""Joint of a hub that turns about the rotor's axis."""

FREE_HUB = (0, 1, 2, 3, 4, 5)
"""Joints of a hub that moves along, and turns about, every axis."""


def _system(tree: HingedSegments, omega: float, hub: tuple[int, ...]) -> tuple[Any, Any, Any]:
    """Exudyn, a container, and the assembled system with joints ``hub`` before the tree."""
    exu, container, mbs = ex.system()
    items, n, first = exu.itemInterface, len(tree.strain) + len(hub), len(hub)
    mass, centre, inertia = np.zeros(n), np.zeros((n, 3)), np.zeros((n, 3, 3))
    carrier = tree.segment + first
    mass[carrier], centre[carrier], inertia[carrier] = tree.mass, tree.centre, tree.inertia
    rates = np.zeros(n)
    rates[first - 1] = omega
    links = ex.Links(
        joints=[JOINT[strain] for strain in (*hub, *tree.strain)],
        parents=np.arange(-1, n - 1),
        axes=np.concatenate([np.tile(np.eye(3), (first, 1, 1)), tree.rotation]),
        offset=np.concatenate([np.zeros((first, 3)), tree.offset]),
        mass=mass,
        centre=centre,
        moments=inertia,
        springs=np.concatenate([np.zeros(first), tree.stiffness]),
    )
    node, _ = ex.add_tree(exu, mbs, links, np.zeros(n), rates)
    if tree.coupling.nnz:
        coupling = ex.sparse_matrix(exu, sparse.block_diag([np.zeros((first, first)), tree.coupling]))
        mbs.AddObject(items.ObjectGenericODE2(nodeNumbers=[node], stiffnessMatrix=coupling))
    if hub == ROTATING_HUB:
        ex.hold(exu, mbs, node, [0])
    mbs.Assemble()
    return exu, container, mbs


def linearize(tree: HingedSegments, omega: float) -> tuple[Array, Array, Array, Array]:
    """M, C, K (n, n) about the steady state at ``omega`` (rad/s), and the joints' coordinates (n,) there.

    The hub is a rotating link with fixed angle and given rate. Its motion is prescribed, so it has no row.
    """
    exu, _container, mbs = _system(tree, omega, ROTATING_HUB)
    if omega:
        _steady_state(exu, mbs, omega, len(tree.strain) + 1)
    M, C, K = (matrix[1:, 1:] for matrix in ex.linearized(exu, mbs, at_rest=not omega, full=True))
    return M, C, K, np.array(mbs.systemData.GetODE2Coordinates(configuration=exu.ConfigurationType.Initial))[1:]


def _steady_state(exu: Any, mbs: Any, omega: float, n: int) -> None:
    """Move the tree to its steady state, raising the speed from zero in as few increments as suffice.

    Exudyn's Newton method is undamped, and its load steps do not scale inertia forces: far from the steady state it diverges.

    Raises:
        CodeError: no steady state was found, even with the smallest increments.
    """
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    for increments in RAMPS:
        data.SetODE2Coordinates(np.zeros(n), configuration=initial)
        try:
            for k in range(1, increments + 1):
                rate = omega * np.sqrt(k / increments)
                data.SetODE2Coordinates_t(np.append(rate, np.zeros(n - 1)), configuration=initial)
                ex.settle(exu, mbs, omega, full=True)
            return
        except CodeError:
            if increments == RAMPS[-1]:
                raise


def jacobian(tree: HingedSegments, q: Array, point: Array) -> Array:
    """(e, 6, n): velocity of each segment's ``point`` (e, 3), m in its axes, and its angular velocity, per joint rate.

    The result is in the axes of the first link's parent, with the joints at ``q`` (n,).
    """
    n = len(q)
    to = np.repeat(point, np.diff(tree.segment, prepend=-1), axis=0)
    R, p = np.eye(3), np.zeros(3)
    axis, origin, where = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    for k, strain in enumerate(tree.strain):
        p = p + R @ tree.offset[k]
        R = R @ tree.rotation[k]
        axis[k], origin[k] = R[:, strain % 3], p
        if strain in SLIDE:
            p = p + axis[k] * q[k]
        else:
            R = R @ rotation(strain % 3, q[k])
        where[k] = p + R @ to[k]
    turns = np.isin(tree.strain, TURN)[:, None]
    out = np.zeros((len(tree.segment), 6, n))
    for row, k in zip(out, tree.segment, strict=True):
        moving = slice(0, k + 1)
        swept = np.where(turns[moving], np.cross(axis[moving], where[k] - origin[moving]), axis[moving])
        row[:3, moving], row[3:, moving] = swept.T, np.where(turns[moving], axis[moving], 0.0).T
    return out


def _shapes(blade: Blade, tree: HingedSegments, q: Array, vectors: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """(m, 21, 4) at the common stations: a spline through the elements' ends, with zero transverse slope at a clamped root."""
    motions = jacobian(tree, q, tree.reach)[:, :4] @ vectors
    cone = rotation(1, np.array(-blade.precone))
    motions[:, :3] = cone.T @ motions[:, :3]
    ends = np.concatenate([np.zeros((1, *motions.shape[1:])), motions]) if clamped(blade) else motions
    along = CubicSpline(tree.ends, ends[:, [0, 3]])(STATIONS * blade.length)
    level: Any = ((1, np.zeros_like(ends[0, 1:3])), "not-a-knot")
    across = CubicSpline(tree.ends, ends[:, 1:3], bc_type=level if clamped(blade) else "not-a-knot")(
        STATIONS * blade.length
    )
    shapes = np.stack([along[:, 0], across[:, 0], across[:, 1], along[:, 1]], axis=1)
    shapes[:, :3] = cone @ shapes[:, :3]
    return shapes.transpose(2, 0, 1)


CODE = ExudynTree()
