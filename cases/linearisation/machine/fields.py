"""Displacements by which modes of a linearisation and of core's turbine are compared: at points of tower, shaft and blades.

A field holds, for each coordinate, the displacements of all points, weighted by the root of their masses, so that the scalar
product of two shapes is one of masses. Blades are in multi-blade coordinates; a single blade counts as collective.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from ....core.blade import Blade
from ....core.element.mesh import Mesh
from ....core.sampling import mass_at
from ....core.space import spatial as sp
from ....core.tree.links import Links, twists
from ....core.turbine.assembly import Assembled
from ....core.turbine.assumed import Field
from ...diagnosis.elastodyn_blade import field_of
from ..sets import AzimuthSet
from ..states import State
from .deck import Deck

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

POINTS = 20
"""Points of tower and of each blade."""

MIN_MAC = 0.5
"""Smallest MAC of a pair of modes."""


@dataclass(frozen=True)
class Points:
    """Points of the tower and of a blade: distances from the root, m, and roots of their masses."""

    tower: Array
    tower_weight: Array
    blade: Array
    blade_weight: Array

    @property
    def size(self) -> int:
        """Length of a field: y and z of the tower, the shaft's angle, y and z of three multi-blade coordinates."""
        return 2 * len(self.tower) + 1 + 6 * len(self.blade)


@dataclass(frozen=True)
class Shapes:
    """Eigenvalues (m,) of modes, rad/s, and their fields (m, f)."""

    values: Complex
    fields: Complex


def points(deck: Deck) -> Points:
    """The points of a deck's tower and blades, in the middle of equal parts."""
    out: list[Array] = []
    for beam in (deck.turbine.tower, deck.turbine.blade):
        s = (np.arange(POINTS) + 0.5) * beam.length / POINTS
        out += [s, np.sqrt(mass_at(beam, s)[:, 0, 0] * beam.length / POINTS)]
    top = float(deck.turbine.nacelle[0, 0] + deck.turbine.hub[0, 0])
    out[0], out[1] = np.append(out[0], deck.turbine.tower.length), np.append(out[1], np.sqrt(top))
    return Points(*out)


def of_states(deck: Deck, at: Points, azimuth_set: AzimuthSet) -> Array:
    """(s, f) field of each state of a set in the fixed frame; zero of rates and of states without a displacement here."""
    rate_of = dict(azimuth_set.pairs)
    out = np.zeros((len(azimuth_set.states), at.size))
    component = {k: n for group in azimuth_set.groups for n, k in enumerate(group.members)}
    for k, state in enumerate(azimuth_set.states):
        if k in rate_of:
            _add(deck, at, state, component.get(k, 0), out[k])
    return out


def _add(deck: Deck, at: Points, state: State, component: int, row: Array) -> None:
    t, b = len(at.tower), len(at.blade)
    if state.family in deck.tower_shapes:
        shape = {state.family: deck.tower_shapes[state.family]}
        displacements, _ = field_of(deck.turbine.tower, shape)(at.tower)
        row[: 2 * t] = (displacements[0, :, 1:] * at.tower_weight[:, None]).ravel()
    elif state.family in ("generator", "drivetrain", "yaw"):
        row[2 * t] = _shaft_weight(deck) if state.family != "yaw" else 0.0
    elif state.blade:
        _blade(row, t, b, component, bent(deck, state, at.blade)[:, 1:] * at.blade_weight[:, None])


def bent(deck: Deck, state: State, s: Array) -> Array:
    """(n, 3) displacements of a blade at arc lengths, in its axes without twist, by a unit of a state."""
    blade = deck.turbine.blade
    if state.module == "ED" and state.family in deck.blade_shapes:
        return field_of(blade, {state.family: deck.blade_shapes[state.family]})(s)[0][0]
    node, order = state.direction, state.element_order
    if node and order and node[0] == "translational" and 2 <= node[2] <= order + 1:
        # BeamDyn: x downwind, y to the trailing edge, z along the blade; here z, −y, x
        axis, sign = ((2, 1.0), (1, -1.0), (0, 1.0))[node[1]]
        return sign * element(blade.length, order)(s)[0][3 * (node[2] - 2) + axis]
    return np.zeros((len(s), 3))


def _blade(row: Array, t: int, b: int, component: int, displacements: Array) -> None:
    weight = 1.0 if component == 0 else np.sqrt(0.5)
    start = 2 * t + 1 + component * 2 * b
    row[start : start + 2 * b] += weight * displacements.ravel()


def _shaft_weight(deck: Deck) -> float:
    """Root of the inertia of hub and generator about the shaft."""
    drive = deck.turbine.drivetrain
    return float(np.sqrt(deck.turbine.hub[5, 5] + drive.generator * drive.gear_ratio**2))


def element(length: float, order: int) -> Field:
    """The field of BeamDyn's finite element of an order: displacements and rotations of its nodes beyond the root.

    The nodes are Gauss, Lobatto and Legendre's; Lagrange's polynomials are between them.
    """
    ends = np.polynomial.Legendre.basis(order).deriv().roots()
    nodes = 0.5 * (1.0 + np.concatenate([[-1.0], np.sort(ends.real), [1.0]])) * length

    def at(s: Array) -> tuple[Array, Array]:
        others = [(node, np.delete(nodes, k)) for k, node in enumerate(nodes)][1:]
        rows = np.array([np.prod((s[:, None] - other) / (node - other), axis=1) for node, other in others])
        displacements = np.einsum("kn,ab->kanb", rows, np.eye(3)).reshape(-1, len(s), 3)
        zeros = np.zeros_like(displacements)
        return np.concatenate([displacements, zeros]), np.concatenate([zeros, displacements])

    return at


def of_core(deck: Deck, at: Points, a: Assembled) -> Array:
    """(n, f) field of each coordinate of core's equations."""
    t, b = len(at.tower), len(at.blade)
    out = np.zeros((len(a.M), at.size))
    if a.tower.size:
        displacements = _along(a.meshes[0], a.tower_links, a.tower.vectors, deck.turbine.tower, at.tower)
        out[: a.tower.size, : 2 * t] = (displacements * at.tower_weight[:, None]).reshape(a.tower.size, -1)
    if a.shaft:
        out[a.shaft[0], 2 * t] = _shaft_weight(deck)
    displacements = of_blade(deck, at, a.meshes[1], a.blade_links, a.blade.vectors)
    for component, rows in enumerate(a.blades):
        for row, shape in zip(rows, displacements, strict=True):
            _blade(out[row], t, b, component, shape)
    return out


def of_blade(deck: Deck, at: Points, mesh: Mesh, links: Links, vectors: Array) -> Array:
    """(k, b, 2) weighted displacements y, z of a blade in motions (k, dn)."""
    return _along(mesh, links, vectors, deck.turbine.blade, at.blade) * at.blade_weight[:, None]


def _along(mesh: Mesh, links: Links, vectors: Array, beam: Blade, s: Array) -> Array:
    """(k, len(s), 2) displacements y, z of a beam at arc lengths, in its axes without twist and pitch."""
    base = mesh.nodes[0, :3, :3] @ sp.rotation(0, np.array(float(beam.twist[0]))).T
    places = ((mesh.nodes[:, :3, 3] - mesh.nodes[0, :3, 3]) @ base)[:, 0]
    local = twists(links, vectors)[..., :3]
    displacements = np.concatenate(
        [np.zeros((len(local), 1, 3)), np.einsum("ia,nij,knj->kna", base, mesh.nodes[1:, :3, :3], local)], axis=1
    )
    order = np.argsort(places, kind="stable")
    return np.array([[np.interp(s, places[order], row[order, j]) for j in (1, 2)] for row in displacements]).swapaxes(
        1, 2
    )


def paired(first: Shapes, second: Shapes) -> tuple[NDArray[np.intp], Array]:
    """For each mode of the first the index of its partner in the second, −1 without one, and the MAC (m,)."""
    x, y = first.fields, second.fields
    sizes = np.outer((np.abs(x) ** 2).sum(1), (np.abs(y) ** 2).sum(1))
    mac = np.abs(x.conj() @ y.T) ** 2 / np.where(sizes > 0, sizes, np.inf)
    ratio = np.abs(np.log(np.abs(first.values)[:, None] / np.abs(second.values)[None, :]))
    rows, columns = linear_sum_assignment(-mac + 0.2 * np.minimum(ratio, 1.0))
    partner, quality = np.full(len(x), -1, dtype=np.intp), np.zeros(len(x))
    for i, j in zip(rows, columns, strict=True):
        quality[i] = mac[i, j]
        if mac[i, j] >= MIN_MAC:
            partner[i] = j
    return partner, quality


def chosen(shapes: Shapes, index: Sequence[int]) -> Shapes:
    """Some of the modes."""
    k = np.asarray(index, dtype=np.intp)
    return Shapes(shapes.values[k], shapes.fields[k])
