"""Finite element models as lists of freedoms, and sections tied to frames rigidly or on average.

A freedom is a displacement along, or a rotation about, a coordinate axis at a point. When a frame moves by a small twist
(in its axes), freedoms that follow it rigidly move by ``motion``. A section is tied to its frame in one of two ways:

* ``rigid`` (RBE2, MPC beam): every freedom of the section follows its frame. Warping and the contraction of the section
  are prevented: correct where the section really is stiff (a flange, a bulkhead, the clamp of a test rig), and an upper
  bound of the stiffness otherwise;
* ``average`` (RBE3, distributing coupling): the frame moves as the section does on average, by weighted least squares,
  ``mean = (RᵀWR)⁻¹RᵀW``; its wrench acts on the section as tractions ``WR(RᵀWR)⁻¹``, uniform for a force, linear for a
  moment. That is St Venant's distribution for tension and bending, which are exact for any length. For shear and torsion
  it is not, and the blade is too soft within about the size of the section. Inside a model, with elements on both sides
  (``condensation.segments_in_place``), the tie only measures the mean and causes no such error.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import scipy.sparse
from numpy.typing import NDArray

from ..space import spatial as sp

Array = NDArray[Any]
Index = NDArray[np.intp]
Kind = Literal["rigid", "average"]

ASYMMETRY = 1e-5  # largest asymmetry of a stiffness with a unit diagonal: rounding to seven printed digits
ON_SECTION = 1e-6  # largest distance of a section's node from its plane, as a fraction of the model's size
FARTHEST = 1e6  # largest coordinate of a point, m: larger ones are implausible, and their products overflow


class CondensationError(ValueError):
    """A model, tie or matrix that cannot be condensed: the message names it, the value, the likely cause, the remedy."""


@dataclass(frozen=True)
class FiniteElements:
    """A finite element model of n freedoms, as far as condensation needs it. SI, all in one set of axes.

    Attributes:
        name: label in messages.
        points: (n, 3) where each freedom acts.
        directions: (n,) 0, 1, 2: displacement along x, y, z; 3, 4, 5: rotation about them.
        stiffness: (n, n) symmetric, of the model without supports.
        mass: (n,) lumped at the freedoms, kg (kg m² for rotations); zeros if not known.
    """

    name: str
    points: Array
    directions: Index
    stiffness: scipy.sparse.csr_array
    mass: Array

    def __post_init__(self) -> None:
        n = len(self.directions)
        shapes = {"points": (n, 3), "stiffness": (n, n), "mass": (n,)}
        for field, shape in shapes.items():
            actual = getattr(self, field).shape
            if actual != shape:
                raise CondensationError(
                    f"{self.name}: {field} has shape {actual}, expected {shape} for {n} freedoms: give arrays of one model"
                )
        if not (np.abs(self.points) <= FARTHEST).all():
            raise CondensationError(
                f"{self.name}: a point at {np.abs(self.points).max():g} m: check the coordinates and their unit"
            )
        if not np.isfinite(self.stiffness.data).all():
            raise CondensationError(
                f"{self.name}: stiffness is not finite: check the exported matrix for gaps and overflow"
            )
        diagonal = self.stiffness.diagonal()
        unit = scipy.sparse.diags_array(1.0 / np.sqrt(np.where(diagonal > 0, diagonal, 1.0)))
        scaled = unit @ self.stiffness @ unit
        asymmetry = float(abs(scaled - scaled.T).max()) if n else 0.0
        if asymmetry > ASYMMETRY:
            raise CondensationError(
                f"{self.name}: stiffness is not symmetric (by {asymmetry:.1e}): supply both triangles, without follower loads"
            )


def motion(points: Array, directions: Index, frame: Array) -> Array:
    """Displacements (n, 6) of freedoms that follow unit twists of ``frame`` (4, 4), in its axes, rigidly."""
    axis = np.eye(3)[directions % 3]
    turning = directions >= 3
    lever = np.where(turning[:, None], axis, np.cross(points - frame[:3, 3], axis))
    return np.concatenate([np.where(turning[:, None], 0.0, axis), lever], axis=1) @ np.kron(np.eye(2), frame[:3, :3])


@dataclass(frozen=True)
class Tie:
    """A section's freedoms tied to a frame; made by ``rigid``, ``average`` or ``section``.

    Attributes:
        name: label in messages.
        kind: how they are tied.
        frame: (4, 4) pose in the model's axes.
        freedoms: (k,) indices.
        motion: (k, 6) freedoms from the frame's twist.
        mean: (6, k) the frame's twist from the freedoms.
    """

    name: str
    kind: Kind
    frame: Array
    freedoms: Index
    motion: Array
    mean: Array


def rigid(fe_model: FiniteElements, freedoms: Index, frame: Array, name: str) -> Tie:
    """Tie in which every given freedom follows the frame.

    Raises:
        CondensationError: no freedoms, or too few to determine the six motions of a frame.
    """
    return _tie(fe_model, freedoms, frame, name, "rigid")


def average(fe_model: FiniteElements, freedoms: Index, frame: Array, name: str, weights: Array | None = None) -> Tie:
    """Tie in which the frame moves as the given freedoms do on average; rotations are free, unless a section is one node.

    Args:
        fe_model: the model.
        freedoms: (k,) indices.
        frame: (4, 4) pose in the model's axes.
        name: label in messages.
        weights: (k,) share of the section's area that each freedom represents, by default its lumped mass; or (k, k), the
            matrix ∫NᵀN of the section's shape functions N. Shares suffice if they also integrate y·N, as those of Simpson's
            rule do (9 nodes per face). Corners of 8-node faces have negative shares and need the matrix; uniform weights
            concentrate the load at the corners: a square bar in tension became softer by a quarter.

    Raises:
        CondensationError: no freedoms, too few to determine the six motions of a frame, or no usable weights.
    """
    moves = fe_model.directions[freedoms] < 3
    if len(freedoms) == 6 and not moves.all():  # a beam model's node is the section, whatever the weights
        return _tie(fe_model, freedoms, frame, name, "average")
    shares = (fe_model.mass[freedoms] if weights is None else weights)[moves]
    if shares.ndim == 1 and not (shares > 0).all():
        raise CondensationError(
            f"section {name!r}: smallest weight {shares.min(initial=0.0):g}{' (lumped mass)' if weights is None else ''}: give "
            "each freedom's positive share of the section, or the matrix ∫NᵀN if corners have negative shares"
        )
    return _tie(fe_model, freedoms[moves], frame, name, "average", shares if shares.ndim == 1 else shares[:, moves])


def section(fe_model: FiniteElements, frame: Array, name: str, kind: Kind = "average") -> Tie:
    """Tie the nodes in the frame's yz plane.

    Raises:
        CondensationError: no nodes (the message gives the distance of the nearest), or too few.
    """
    distance = (fe_model.points - frame[:3, 3]) @ frame[:3, 0]
    on_section = np.abs(distance) < ON_SECTION * np.ptp(fe_model.points, axis=0).max()
    if not on_section.any():
        nearest = distance[np.abs(distance).argmin()] if len(distance) else np.inf
        raise CondensationError(
            f"section {name!r}: no nodes of {fe_model.name} in its plane, the nearest are {nearest:g} m from it: "
            "check the station and its unit; put sections where the mesh has a layer of nodes"
        )
    freedoms = np.flatnonzero(on_section)
    return rigid(fe_model, freedoms, frame, name) if kind == "rigid" else average(fe_model, freedoms, frame, name)


def _tie(
    fe_model: FiniteElements, freedoms: Index, frame: Array, name: str, kind: Kind, weights: Array | None = None
) -> Tie:
    """The tie; without ``weights``, a rotation counts as much as the displacement that it causes at the frame's origin."""
    if not len(freedoms):
        raise CondensationError(
            f"section {name!r}: a tie with no nodes: select the nodes of {fe_model.name} that lie on it"
        )
    points, directions = fe_model.points[freedoms], fe_model.directions[freedoms]
    R = motion(points, directions, frame)
    if weights is None:
        squared = float(((points - frame[:3, 3]) ** 2).sum(1).max())
        weights = np.where(directions < 3, 1.0, squared or 1.0)
    weighed = R.T * weights if weights.ndim == 1 else R.T @ weights
    gram = weighed @ R
    size = np.sqrt(np.diagonal(gram))
    if (size <= 0).any() or np.linalg.eigvalsh(gram / np.outer(size, size))[0] < 1e-12:
        raise CondensationError(
            f"section {name!r}: its {len(freedoms)} freedoms do not determine the six motions of a frame: they lie on one line "
            "or point; take all nodes of the section, or, in a beam model, the six freedoms of the node"
        )
    return Tie(name, kind, frame, freedoms, R, np.linalg.solve(gram, weighed))


def relative_pose(a: Tie, b: Tie) -> Array:
    """Pose (4, 4) of b's frame in a's."""
    return sp.inverse(a.frame) @ b.frame
