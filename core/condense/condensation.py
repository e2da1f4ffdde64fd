"""From a finite element model to complex stiffness elements and rigid bodies (Park et al. 2010, figs 1 and 2).

Static condensation eliminates all freedoms but the twists of the frames that sections are tied to: with ``K u + Gᵀλ = 0``
inside and the ties' equations as constraints G, the stiffness between two end sections is 12×12 (R. J. Guyan, AIAA Journal
3 (1965) 380). It has six rigid-body modes, so a 6×6 is equivalent: the wrench ``k ρ`` on b, with ρ = ξ_b − ξ_a in a's axes,
the complex stiffness element of ``core.element.beams``.

A segment's mass becomes one rigid body with its mass, centre and inertia, which follows the element: it moves as the
segment's mass does on average (by least squares, so momenta are preserved) in the static displacements. The kinetic energy
of the segment's deformation is neglected. In bending it is (βl)⁴/720 of the whole, l the segment's length and β the wave
number: fourth order, as with consistent mass. In torsion and stretch the mass moves as the segment's middle does, and
frequencies are too high by (βl)²/12: 5·10⁻⁴ for the lowest with 20 segments.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import scipy.sparse as ss
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from ..space import spatial as sp
from . import ties
from .segments import Segment, between
from .ties import CondensationError, FiniteElements, Tie

Array = NDArray[Any]

MAX_ASYMMETRY = 0.1  # of a flexibility measured in place and scaled to a unit diagonal
MAX_SOLUTION = 1e13  # largest displacement by loads of order 1 on freedoms with a stiffness of 1


@dataclass(frozen=True)
class Condensed:
    """Stiffness (6m, 6m) of m tied frames, twists in their axes, and displacements (n, 6m) of all freedoms by unit twists."""

    stiffness: Array
    displacements: Array


def condense(fe_model: FiniteElements, sections: Sequence[Tie]) -> Condensed:
    """Eliminate statically all freedoms but the twists of the tied frames.

    Raises:
        CondensationError: a freedom in two rigid ties, or unsupported freedoms.
    """
    n, m = len(fe_model.directions), len(sections)
    follow = np.zeros((n, 6 * m))
    rigidly_tied = np.zeros(n, bool)
    means = []
    for k, t in enumerate(sections):
        columns = slice(6 * k, 6 * k + 6)
        if t.kind == "average":
            row = np.zeros((6, n))
            row[:, t.freedoms] = t.mean
            means.append((row, columns))
        elif rigidly_tied[t.freedoms].any():
            raise CondensationError(
                f"section {t.name!r}: shares nodes with another rigid tie; a node can follow only one frame"
            )
        else:
            follow[t.freedoms, columns], rigidly_tied[t.freedoms] = t.motion, True
    K, free = fe_model.stiffness, np.flatnonzero(~rigidly_tied)
    G = np.concatenate([row for row, _ in means]) if means else np.zeros((0, n))
    residual = G @ follow  # of the ties' equations
    for k, (_, columns) in enumerate(means):
        residual[6 * k : 6 * k + 6, columns] -= np.eye(6)
    stiffness = K.diagonal()[free]
    unit = 1.0 / np.sqrt(np.where(stiffness > 0, stiffness, 1.0))  # of each freedom: its stiffness becomes 1
    G = G[:, free] * unit
    size = np.linalg.norm(G, axis=1)
    g, scale = ss.csr_array(G / size[:, None]), ss.diags_array(unit)
    A = ss.csc_array(ss.block_array([[scale @ K[free][:, free] @ scale, g.T], [g, None]]))
    B = np.concatenate([unit[:, None] * (K @ follow)[free], residual / size[:, None]])
    X = -_solved(A, B)
    if not np.isfinite(X).all():
        raise CondensationError(
            f"{fe_model.name}: unsupported freedoms among its {n} once the sections' frames are fixed: "
            "remove nodes without elements, loose parts and rotations without stiffness from the model"
        )
    displacements = follow.copy()
    displacements[free] += unit[:, None] * X[: len(free)]
    return Condensed(follow.T @ (K @ follow) + B.T @ X, displacements)


def _solved(A: ss.csc_array, B: Array) -> Array:
    """A⁻¹ B; not finite if A is singular: an entry of the solution for a random right side exceeds ``MAX_SOLUTION``."""
    if not len(B):
        return B
    load = np.random.default_rng(1965).uniform(1.0, 2.0, (len(B), 1))
    try:
        X = splu(A).solve(np.hstack([B, load]))
    except RuntimeError:  # a pivot is exactly zero
        return np.full_like(B, np.nan)
    return X[:, :-1] if np.abs(X[:, -1]).max() < MAX_SOLUTION else np.full_like(B, np.nan)


def segment(fe_model: FiniteElements, a: Tie, b: Tie) -> Segment:
    """Condense one isolated segment of a blade, between its end sections.

    Raises:
        CondensationError: as ``condense`` and ``between``, or a model without mass.
    """
    c = condense(fe_model, (a, b))
    undeformed = ties.relative_pose(a, b)
    displacements = c.displacements[:, 6:] @ sp.adjoint(sp.inverse(undeformed))
    return Segment(
        undeformed,
        between(c.stiffness, undeformed, f"{a.name} to {b.name}"),
        *_body(fe_model, fe_model.mass, a.frame, displacements),
    )


def segments_in_place(fe_model: FiniteElements, sections: Sequence[Tie], masses: Array) -> list[Segment]:
    """Condense every segment of a blade in place between its neighbours, so that sections warp and contract as in the blade.

    The blade is clamped at its first tie and loaded at its last by six wrenches. Between them, average ties measure the
    motion of each section relative to the previous one: a segment's flexibility is its ρ divided by the wrench that it
    transmits. Errors of the ties affect only the two ends of the blade.

    Args:
        fe_model: the whole blade.
        sections: m + 1 sections from the root to the tip: rigid at a clamped root, average at all others.
        masses: (m, n) lumped mass of each segment at the model's freedoms; two segments share that of their common section.

    Raises:
        CondensationError: as ``condense``; an inner section that is not average; no mass; an invalid flexibility.
    """
    if rigid := [t.name for t in sections[1:-1] if t.kind != "average"]:
        raise CondensationError(
            f"section {rigid[0]!r}: a rigid tie prevents warping inside the blade; use an average one"
        )
    if np.shape(masses) != (len(sections) - 1, len(fe_model.directions)):
        raise CondensationError(
            f"masses: shape {np.shape(masses)}, expected {(len(sections) - 1, len(fe_model.directions))}: one row per segment"
        )
    c = condense(fe_model, (sections[0], sections[-1]))
    displacements, tip = (
        c.displacements[:, 6:],
        c.stiffness[6:, 6:],
    )  # per unit twist of the tip, and its wrenches
    twists = [t.mean @ displacements[t.freedoms] for t in sections]
    out = []
    for k, (a, b) in enumerate(pairwise(sections)):
        undeformed = ties.relative_pose(a, b)
        rho = sp.adjoint(undeformed) @ twists[k + 1] - twists[k]
        wrench = sp.adjoint(ties.relative_pose(sections[-1], a)).T @ tip
        flexibility = np.linalg.solve(wrench.T, rho.T).T
        size = np.sqrt(np.abs(np.diagonal(flexibility)))
        unit = flexibility / np.outer(size, size)
        asymmetry = np.abs(unit - unit.T).max()
        if asymmetry > MAX_ASYMMETRY or np.linalg.eigvalsh(unit + unit.T)[0] <= 0:
            raise CondensationError(
                f"segment {a.name!r} to {b.name!r}: its flexibility is not symmetric (by {asymmetry:.1e}), or not positive: "
                "check that its sections are apart by at least one element, and that the ties are of this model"
            )
        J, mean = _body(fe_model, masses[k], a.frame, displacements)
        stiffness: Array = np.linalg.inv(0.5 * (flexibility + flexibility.T))
        body_twist: Array = (mean - twists[k]) @ np.linalg.inv(rho)
        out.append(Segment(undeformed, stiffness, J, body_twist))
    return out


def _body(fe_model: FiniteElements, mass: Array, frame: Array, displacements: Array) -> tuple[Array, Array]:
    """Inertia and mean twist of a mass whose freedoms move by ``displacements`` (n, 6), both about ``frame``, in its axes."""
    R = ties.motion(fe_model.points, fe_model.directions, frame)
    J = (R.T * mass) @ R
    size = np.sqrt(np.abs(np.diagonal(J)))
    if (size <= 0).any() or np.linalg.eigvalsh(J / np.outer(size, size))[0] < 1e-12:
        raise CondensationError(
            f"{fe_model.name}: no mass, or no moment of inertia about some axis: give the lumped mass of its freedoms"
        )
    return J, np.linalg.solve(J, (R.T * mass) @ displacements)
