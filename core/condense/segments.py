"""A segment of a blade: a complex stiffness element and the rigid body that follows it (Park et al. 2010, figs 1 and 2).

A 12×12 stiffness between two frames that has six rigid-body modes is equivalent to a 6×6: the wrench ``k ρ`` on b, with
ρ = ξ_b − ξ_a in a's axes. That is the complex stiffness element of ``core.element.beams``.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..element import sections
from ..space import spatial as sp
from ..space.inertia import transformed
from . import ties
from .ties import CondensationError

Array = NDArray[np.float64]

SYMMETRY_TOLERANCE = ties.ASYMMETRY
MIN_EIGENVALUE = (
    1e-8  # lowest eigenvalue of a 6×6 with a unit diagonal: below it there is a seventh motion without force
)

MOTIONS = tuple(f"{kind} {axis}" for kind in ("translation along", "rotation about") for axis in "xyz")


@dataclass(frozen=True)
class Segment:
    """A complex stiffness element from frame a to frame b, and the rigid body that follows it; in a's axes throughout.

    Attributes:
        undeformed: (4, 4) pose of b in a's frame.
        stiffness: (6, 6) wrench on b from the twist of b relative to a, both about a's origin.
        inertia: (6, 6) of the body, about a's origin.
        body_twist: (6, 6) the body's twist relative to a, from that of b.
    """

    undeformed: Array
    stiffness: Array
    inertia: Array
    body_twist: Array


def between(stiffness: Array, undeformed: Array, name: str) -> Array:
    """The 6×6 of a complex stiffness element from the 12×12 between its end frames.

    Args:
        stiffness: (12, 12) wrenches on a, then on b, from their twists, each in the axes of its frame.
        undeformed: (4, 4) pose of b in a's frame.
        name: label in messages.

    Raises:
        CondensationError: wrong size, not finite, not symmetric, not positive semi-definite, or not exactly six rigid-body
            modes.
    """
    k = np.asarray(stiffness, float)
    where = f"stiffness of {name!r}"
    if k.shape != (12, 12):
        raise CondensationError(
            f"{where}: shape {k.shape}, expected (12, 12): six freedoms of each end frame; condense the others first"
        )
    if not np.isfinite(k).all():
        raise CondensationError(f"{where}: not finite at index {np.argwhere(~np.isfinite(k))[0].tolist()}")
    diagonal = np.diagonal(k)
    if (diagonal <= 0).any():
        i = int(diagonal.argmin())
        raise CondensationError(
            f"{where}: diagonal {i} is {diagonal[i]:g}: not positive semi-definite, or no stiffness against "
            f"{MOTIONS[i % 6]} of frame {'ab'[i // 6]}; check the sign and order of freedoms, and that each has a stiffness"
        )
    unit = k / np.sqrt(np.outer(diagonal, diagonal))
    asymmetry = np.abs(unit - unit.T).max()
    if asymmetry > SYMMETRY_TOLERANCE:
        raise CondensationError(
            f"{where}: not symmetric (by {asymmetry:.1e}): supply both triangles with equal entries, and rows and "
            "columns in the same order"
        )
    lowest = np.linalg.eigvalsh(unit)[0]
    if lowest < -SYMMETRY_TOLERANCE:
        raise CondensationError(
            f"{where}: not positive semi-definite (lowest eigenvalue {lowest:.2e} of a unit diagonal): "
            "check the sign and the order of freedoms, and export the stiffness without load"
        )
    motions = (
        np.concatenate([np.eye(6), sp.adjoint(sp.inverse(undeformed))]) * np.sqrt(diagonal)[:, None]
    )  # by a twist of a
    unbalanced = np.abs(unit @ motions).max(0) / (np.abs(unit) @ np.abs(motions)).max(0)
    if unbalanced.max() > SYMMETRY_TOLERANCE:
        raise CondensationError(
            f"{where}: {MOTIONS[int(unbalanced.argmax())]} as a rigid body causes forces ({unbalanced.max():.1e} of their "
            "terms): fewer than six rigid-body modes; a support left in the model, or frames not at "
            "the nodes of the matrix (units?)"
        )
    to_a = sp.adjoint(sp.inverse(undeformed))
    k = to_a.T @ (0.5 * (k + k.T))[6:, 6:] @ to_a
    size = np.sqrt(np.diagonal(k))
    lowest = np.linalg.eigvalsh(k / np.outer(size, size))[0]
    if lowest < MIN_EIGENVALUE:
        raise CondensationError(
            f"{where}: more than six motions without force (lowest eigenvalue {lowest:.1e} of a unit diagonal): "
            "a mechanism between the sections; tie more nodes"
        )
    return k


def segment_from_matrix(stiffness: Array, undeformed: Array, inertia: Array, name: str = "segment") -> Segment:
    """A segment from its 12×12 stiffness and its rigid body, as condensed by another code.

    The body moves as the mass of a straight uniform beam of the same flexibility f. The compliance c of that beam's sections
    solves ``f = ∫ Ad c Adᵀ dt`` over its length, which is linear in c.

    Args:
        stiffness: (12, 12), see ``between``.
        undeformed: (4, 4) pose of b in a's frame.
        inertia: (6, 6) about a's frame and in its axes; see ``mechanism.inertia``.
        name: label in messages.

    Raises:
        CondensationError: as ``between``; frames that coincide.
    """
    k = between(stiffness, undeformed, name)
    if not undeformed[:3, 3].any():
        raise CondensationError(
            f"undeformed: the end frames of {name!r} coincide: a segment needs a length; give the pose of b in a's frame"
        )
    t, weight, within = sections.collocation(sections.GAUSS)
    slices = np.repeat(np.eye(4)[None], len(t), axis=0)
    slices[:, :3, 3] = t[:, None] * undeformed[:3, 3]
    lever = sp.adjoint(slices)
    integral = np.einsum("q,qij,qkl->ikjl", weight, lever, lever).reshape(36, 36)
    c = np.linalg.solve(integral, np.linalg.inv(k).ravel()).reshape(6, 6)
    twists = np.einsum("qp,pij->qij", within, lever @ c @ np.swapaxes(lever, -1, -2)) @ k
    line = np.diag([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    line[3:, 3:] = np.outer(undeformed[:3, 3], undeformed[:3, 3])  # rotation about the line is averaged separately
    masses = weight[:, None, None] * transformed(np.repeat(line[None], len(t), axis=0), slices)
    return Segment(undeformed, k, inertia, np.linalg.solve(masses.sum(0), (masses @ twists).sum(0)))
