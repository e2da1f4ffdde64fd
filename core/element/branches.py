"""Meshes joined to a tree: a blade on its root joint, blades on a hub."""

from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray

from ..space import spatial as sp
from .beams import Beams, Points
from .measures import constant_strain, joined, part
from .mesh import JointLink, Mesh

Array = NDArray[np.float64]

CLAMPED: Array = np.full(6, np.inf)
"""Stiffness of a joint that connects rigidly."""


def hub(template: Mesh, pose: Array) -> Mesh:
    """A tree without links: node 0, fixed to the rotating hub at ``pose`` (4, 4); for branches of the kind of ``template``."""
    empty = slice(0, 0)
    b = template.beams
    beams = Beams(
        part(b.law, empty), b.stiffness[empty], _sliced(b.points), b.preload[empty], b.internal_preload[empty]
    )
    return Mesh(pose[None], np.zeros((1, 6, 6)), beams, _sliced(template.samples), 0.0, np.zeros((1, 3)))


def attached(
    tree: Mesh, node: int, branch: Mesh, at_a: Array, at_b: Array | None = None, stiffness: Array = CLAMPED
) -> Mesh:
    """A tree with a branch on a joint.

    Args:
        tree: nodes and elements.
        node: the tree's node that carries the joint.
        branch: nodes and elements; its node 0 becomes the joint's other end, with the inertia given there.
        at_a: (4, 4) pose of the joint's frame in the tree's node.
        at_b: (4, 4) the same in the branch's node 0; the identity by default.
        stiffness: (6,) of the joint's coordinates, displacements along x, y, z of its frame, then rotations about x, y, z in
            sequence, N/m and N m/rad: ``inf`` clamps one, 0 leaves it free; clamped by default. Every coordinate that is not
            clamped is a link. Or (6, 6), symmetric and positive definite apart from ``inf`` on the diagonal: see ``springs``.

    Raises:
        ValueError: elements of different strain measures, or with mass in one part and lumped in the other.
    """
    a, b = tree.beams, branch.beams
    if tree.elements and branch.elements and (a.law.measure, a.internal_count) != (b.law.measure, b.internal_count):
        raise ValueError("branch: its elements have another strain measure or mass than the tree's")
    screws, constants = springs(stiffness)
    if not len(constants):
        screws, constants = np.zeros((1, 6)), np.zeros(1)
    links, nodes, count = len(tree.parent), len(tree.nodes), len(constants)
    to_branch = np.eye(4) if at_b is None else sp.inverse(at_b)
    between = np.tile(np.eye(4), (count, 1, 1))  # of the joint's links
    between[0] = at_a
    between[-1] = between[-1] @ to_branch
    screws[0] = sp.adjoint(at_a) @ screws[0]
    frame = tree.nodes[node] @ at_a
    to_tree = frame @ to_branch @ sp.inverse(branch.nodes[0])
    zeros, inside = np.zeros((count, 6)), count - 1  # nodes between the joint's links, without mass
    beams = Beams(
        law=joined([a.law, constant_strain(b.law.measure, between), b.law]),
        stiffness=np.concatenate([a.stiffness, np.zeros((count, 6, 6)), b.stiffness]),
        points=_together(a.points, b.points, links + count),
        preload=np.concatenate([a.preload, zeros, b.preload]),
        internal_preload=np.concatenate([a.internal_preload, zeros, b.internal_preload]),
    )
    return Mesh(
        nodes=np.concatenate([tree.nodes, np.tile(frame, (inside, 1, 1)), to_tree @ branch.nodes]),
        lumps=np.concatenate([tree.lumps, np.zeros((inside, 6, 6)), branch.lumps]),
        beams=beams,
        samples=_together(tree.samples, branch.samples, links + count),
        scale=max(tree.scale, branch.scale),
        force=np.concatenate([tree.force, np.zeros((inside, 3)), branch.force @ to_tree[:3, :3].T]),
        corner=np.concatenate([tree.corner, np.tile(np.eye(4), (count, 1, 1)), branch.corner]),
        parent=np.concatenate([tree.parent, [node], nodes + np.arange(inside), branch.parent + nodes + inside]),
        joints=(
            *tree.joints,
            *(JointLink(links + k, screws[k], float(constants[k])) for k in range(count)),
            *(replace(j, link=j.link + links + count) for j in branch.joints),
        ),
    )


def springs(stiffness: Array) -> tuple[Array, Array]:
    """Screws (j, 6) and spring constants (j,) of joints in series that together have this stiffness.

    The compliances of joints in series add up: K⁻¹ = Σ s sᵀ/k. With K⁻¹ = L D Lᵀ, L lower triangular with ones on the
    diagonal, the screws are the columns of L and the constants 1/D.

    Args:
        stiffness: (6,) of single coordinates, or (6, 6).
    """
    diagonal = stiffness if stiffness.ndim == 1 else np.diagonal(stiffness)
    finite = np.flatnonzero(np.isfinite(diagonal))
    if stiffness.ndim == 1 or not len(finite):
        return np.eye(6)[finite], diagonal[finite]
    root = np.linalg.cholesky(np.linalg.inv(stiffness[np.ix_(finite, finite)]))
    screws = np.zeros((len(finite), 6))
    screws[:, finite] = (root / np.diagonal(root)).T
    return screws, np.square(1.0 / np.diagonal(root))


def _sliced(points: Points) -> Points:
    return Points(*(getattr(points, f.name)[:0] for f in fields(points)))


def _together(a: Points, b: Points, offset: int) -> Points:
    """Points of both; the elements of the second ones are numbered from ``offset`` on."""
    rows = {f.name: np.concatenate([getattr(a, f.name), getattr(b, f.name)]) for f in fields(a)}
    rows["element"][len(a.element) :] += offset
    return Points(**rows)
