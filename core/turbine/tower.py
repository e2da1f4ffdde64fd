"""A tower on its foundation: a beam that stands, with a body at its top, springs at its base and along it, and its weight.

Axes are the ground's: x up, z downwind, y = z × x. The base moves on joints along and about them. Springs add to the stiffness
of the link at whose end they act, in the ground's axes, about the state of rest: the weight does not displace the base, as a
floater is in balance where its stiffness is stated, and the force that carries the weight stays vertical.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..blade import Blade
from ..effects import ALL_EFFECTS
from ..element.branches import attached, hub
from ..element.discretize import discretize, divide
from ..element.mesh import Mesh
from ..spectrum.mesh_solver import balance
from ..steady.blade_state import Steady
from ..tree.mode_shapes import sampling_matrix
from ..tree.pencil import TreePencil, linearize

Array = NDArray[np.float64]

POINTS = 4
"""Gauss points of the soil's stiffness in each part of an element."""

MIN_SPACING = 1e-9
"""Heights closer than this fraction of the length coincide."""


@dataclass(frozen=True)
class Support:
    """Springs that hold a tower; the default is rigid ground at its base.

    Attributes:
        base: (6, 6) symmetric stiffness at the base over displacements along x, y, z and rotations about them, N/m, N, N m;
            positive definite apart from directions with ``inf`` on the diagonal, which are clamped. None clamps all.
        springs: heights above the base, m, and the (6, 6) stiffness that acts there, such as that of guy wires.
        soil: (n, 2) heights, m, ascending, and the stiffness against lateral motion per length, N/m²; linear in between.
        mass: (6, 6) inertia that moves with the base, in the same order, kg, kg m, kg m²: a foundation, or a floater with the
            added mass of the water. It has no weight, which is part of ``base``: buoyancy and moorings carry it.
    """

    base: Array | None = None
    springs: tuple[tuple[float, Array], ...] = ()
    soil: Array | None = None
    mass: Array | None = None

    @property
    def rigid(self) -> bool:
        """Whether there is only rigid ground at the base."""
        return self.base is None and not self.springs and self.soil is None

    @property
    def free(self) -> NDArray[np.intp]:
        """The directions in which the base moves."""
        no_directions = np.zeros(0, dtype=np.intp)
        return no_directions if self.base is None else np.flatnonzero(np.isfinite(np.diagonal(self.base)))

    @property
    def finite(self) -> Array:
        """(6, 6) the stiffness of the base, 0 in directions that are clamped."""
        return np.zeros((6, 6)) if self.base is None else np.where(np.isfinite(self.base), self.base, 0.0)


@dataclass(frozen=True)
class Tower:
    """A tower.

    Attributes:
        beam: from the base along x, upwards; its ``tip_mass`` is the body at the top.
        support: what holds it.
        gravity: m/s²; the weight compresses the tower and tips over what is above.
    """

    beam: Blade
    support: Support = Support()
    gravity: float = 0.0


def check_tower(length: float, support: Support) -> None:
    """Check a support of a tower of this length, m.

    Raises:
        ValueError: a stiffness is not symmetric or not positive, or a spring is not on the tower.
    """
    if support.base is not None:
        checked("base", support.base, True)
    if support.mass is not None:
        checked("mass", support.mass, False)
        if not len(support.free):
            raise ValueError("mass: the base does not move: give its stiffness too")
    heights = np.array([height for height, _ in support.springs])
    for _, stiffness in support.springs:
        checked("spring", stiffness, False)
    soil = np.zeros((0, 2)) if support.soil is None else support.soil
    for label, positions in (("springs", heights), ("soil", soil[:, 0])):
        if len(positions) and not (
            -MIN_SPACING * length <= positions.min() <= positions.max() <= (1 + MIN_SPACING) * length
        ):
            raise ValueError(
                f"{label}: heights from {positions.min():g} to {positions.max():g} m: the tower is {length:g} m high"
            )
    if len(soil) and (len(soil) < 2 or (np.diff(soil[:, 0]) <= 0).any() or (soil[:, 1] < 0).any()):
        raise ValueError("soil: give two heights or more that ascend, and no negative stiffness")


def tower_mesh(beam: Blade, support: Support, elements: int, at: Array | None = None) -> Mesh:
    """The tower's elements on the joints of its base, without springs; ``at``: heights of sample points, see ``discretize``.

    Raises:
        ValueError: a stiffness is not symmetric or not positive, or a spring is not on the tower.
    """
    check_tower(beam.length, support)
    mesh = discretize(beam, _ends(beam, support, elements), at=at)
    if support.base is None:
        return mesh
    checked("base", support.base, True)
    stiffness = np.where(np.isfinite(np.diagonal(support.base)), 0.0, np.inf)
    return attached(hub(mesh, np.eye(4)), 0, mesh, np.eye(4), stiffness=stiffness)


def standing(mesh: Mesh, tower: Tower, elements: int) -> Steady:
    """The tower under the weight of all that is on its mesh, held by its support, which the weight does not displace.

    Raises:
        SteadyStateError: the tower does not carry the weight.
    """
    fall, foot = np.array([-tower.gravity, 0.0, 0.0]), len(tower.support.free)
    fixed = tuple(replace(joint, screw=np.zeros(6)) for joint in mesh.joints[:foot])
    state = balance(replace(mesh, joints=(*fixed, *mesh.joints[foot:])), 0.0, fall, ALL_EFFECTS)
    if foot:
        state = replace(state, pencil=linearize(mesh, state.shape, 0.0, fall))
    return _held(tower.beam, tower.support, elements, state)


def _held(beam: Blade, support: Support, elements: int, state: Steady) -> Steady:
    """The steady state of a tower with springs along it in its stiffness and the base's inertia in its mass, see ``links``."""
    if support.rigid:
        return state
    p = state.pencil
    M, K = p.M.copy(), p.K.copy()
    if support.soil is not None:
        heights, weights = _gauss(_ends(beam, support, elements), support.soil)
        mesh = tower_mesh(beam, support, elements, heights)
        sampled = sampling_matrix(mesh, state.shape)[:, 1:3]
        for link, k, sample in zip(mesh.samples.element.tolist(), weights.tolist(), sampled, strict=True):
            J = _of_link(p, link, sample)
            K[link] += k * J.T @ J
    offset = 0 if support.base is None else len(support.free) or 1
    ends = _ends(beam, support, elements)
    for height, stiffness in support.springs:
        link = int(np.abs(ends - height).argmin()) + offset - 1
        if link < 0:
            continue  # at a clamped base
        J = _of_end(p, state, link)
        K[link] += J.T @ checked("spring", stiffness, False) @ J
    if support.base is not None and len(support.free):
        J = _of_end(p, state, offset - 1)
        K[offset - 1] += J.T @ support.finite @ J
        if support.mass is not None:
            M[offset - 1] += J.T @ checked("mass", support.mass, False) @ J
    return replace(state, pencil=TreePencil(p.residual, M, p.C, K, p.links))


def _of_end(p: TreePencil, state: Steady, link: int) -> Array:
    """The motion (6, d) of a link's end, in the ground's axes."""
    selection = np.zeros((6, 12))
    selection[:3, 6:9] = selection[3:, 9:] = state.shape.nodes[link + 1, :3, :3]
    return _of_link(p, link, selection)


def _of_link(p: TreePencil, link: int, selection: Array) -> Array:
    """A motion over (ξ_a, ξ_b, β) of a link's ends, from (ξ_a, ρ, β)."""
    at_b = selection[:, 6:12] @ p.links.to_child[link]
    out = np.zeros((len(selection), p.K.shape[1]))
    out[:, :6], out[:, 6:12] = selection[:, :6] + at_b, at_b
    internal = min(selection.shape[1], out.shape[1]) - 12
    out[:, 12 : 12 + internal] = selection[:, 12 : 12 + internal]
    return out


def _ends(beam: Blade, support: Support, elements: int) -> Array:
    """(n + 1,) heights of the nodes."""
    length = beam.length
    heights = np.array([height for height, _ in support.springs])
    ends = np.sort(np.concatenate([divide(beam, elements), heights]))
    return ends[np.append(True, np.diff(ends) > MIN_SPACING * length)]


def _gauss(ends: Array, soil: Array) -> tuple[Array, Array]:
    """Heights (q,) of Gauss points between nodes and the soil's points, and the stiffness (q,) of each, N/m."""
    low, high = np.clip(soil[[0, -1], 0], ends[0], ends[-1])
    grid = np.unique(np.concatenate([ends, soil[:, 0], [low, high]]))
    grid = grid[(grid >= low) & (grid <= high)]
    x, w = np.polynomial.legendre.leggauss(POINTS)
    half_length = 0.5 * np.diff(grid)[:, None]
    heights = 0.5 * (grid[1:] + grid[:-1])[:, None] + half_length * x
    return heights.ravel(), (half_length * w * np.interp(heights, soil[:, 0], soil[:, 1])).ravel()


def checked(name: str, stiffness: Array, positive: bool) -> Array:
    """A (6, 6) stiffness; its directions with ``inf`` must not be coupled.

    Raises:
        ValueError: it is not symmetric, or not positive (semi-)definite.
    """
    K = np.asarray(stiffness, float)
    if K.shape != (6, 6):
        raise ValueError(f"{name}: shape {K.shape}: give 6 rows of 6 numbers")
    free = np.isfinite(np.diagonal(K))
    part = K[np.ix_(free, free)]
    off = K.copy()
    np.fill_diagonal(off, 0.0)
    if off[~free].any() or off[:, ~free].any() or not np.isfinite(part).all():
        raise ValueError(f"{name}: a direction that is clamped (inf on the diagonal) cannot be coupled with others")
    d = np.sqrt(np.abs(np.diagonal(part)))
    unit = np.where(d > 0, d, 1.0)
    scaled = part / np.outer(unit, unit)
    if np.abs(scaled - scaled.T).max(initial=0.0) > 1e-6:
        raise ValueError(f"{name}: not symmetric: the stiffness of springs is; mirror one triangle")
    smallest = float(np.linalg.eigvalsh(0.5 * (scaled + scaled.T)).min(initial=1.0))
    if smallest < -1e-9 or (positive and smallest < 1e-9):
        free_motion = (
            "not positive in every direction: the tower moves freely" if positive else "negative in a direction"
        )
        raise ValueError(f"{name}: {free_motion}; check its signs")
    out = K.copy()
    out[np.ix_(free, free)] = 0.5 * (part + part.T)
    return out
