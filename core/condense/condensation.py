"""From a finite element model to complex stiffness elements and rigid bodies (Park et al. 2010, figs 1 and 2).

Static condensation eliminates all freedoms but the twists of the frames that sections are tied to: with ``K u + Gᵀλ = 0``
inside and the ties' equations as constraints G, the stiffness between two end sections is 12×12 (R. J. Guyan, AIAA Journal
3 (1965) 380). It has six rigid-body modes, so a 6×6 says the same: the wrench ``k ρ`` on b, with ρ = ξ_b − ξ_a in a's axes,
the complex stiffness element of ``core.element.beams``.

A segment's mass becomes one rigid body with its mass, centre and inertia, which rides on the element: it moves as the
segment's mass does on average (by least squares, so momenta are kept) in the static displacements. What is left out is the
kinetic energy of its own deformation. In bending that is (βl)⁴/720 of the whole, l its length and β the wave number: fourth
order, as with consistent mass. In torsion and stretch the mass moves as the segment's middle does, and frequencies come out
too high by (βl)²/12: 5·10⁻⁴ for the lowest with 20 segments.
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

MAX_ASYMMETRY = 0.1  # largest departure from symmetry, of a unit diagonal, of a flexibility read in place


@dataclass(frozen=True)
class Condensed:
    """Stiffness (6m, 6m) between m tied frames, twists in their own axes, and what unit twists move: all freedoms (n, 6m)."""

    stiffness: Array
    displacements: Array


def condense(fe_model: FiniteElements, tied: Sequence[Tie]) -> Condensed:
    """Eliminate statically all but the twists of the tied frames.

    Raises:
        CondensationError: a freedom in two rigid ties, or unsupported freedoms.
    """
    n, m = len(fe_model.directions), len(tied)
    follow = np.zeros((n, 6 * m))
    rigidly_tied = np.zeros(n, bool)
    means = []
    for k, t in enumerate(tied):
        own = slice(6 * k, 6 * k + 6)
        if t.kind == "average":
            row = np.zeros((6, n))
            row[:, t.freedoms] = t.mean
            means.append((row, own))
        elif rigidly_tied[t.freedoms].any():
            raise CondensationError(
                f"section {t.name!r}: shares nodes with another rigid tie; a node can follow one frame"
            )
        else:
            follow[t.freedoms, own], rigidly_tied[t.freedoms] = t.motion, True
    K, free = fe_model.stiffness, np.flatnonzero(~rigidly_tied)
    unit = float(abs(K).max())
    G = np.concatenate([row for row, _ in means]) if means else np.zeros((0, n))
    ask = unit * G @ follow
    for k, (_, own) in enumerate(means):
        ask[6 * k : 6 * k + 6, own] -= unit * np.eye(6)
    g = ss.csr_array(unit * G[:, free])
    A = ss.csc_array(ss.block_array([[K[free][:, free], g.T], [g, None]]))
    B = np.concatenate([(K @ follow)[free], ask])
    try:
        X = -splu(A).solve(B) if len(B) else B
    except RuntimeError:
        X = np.full_like(B, np.nan)
    if not np.abs(A @ X + B).max(initial=0.0) <= 1e-6 * np.abs(B).max(initial=0.0):
        raise CondensationError(
            f"{fe_model.name}: unsupported freedoms among its {n} once the sections' frames are fixed: "
            "nodes without elements, loose parts, or rotations without stiffness? drop them from the model"
        )
    displacements = follow.copy()
    displacements[free] += X[: len(free)]
    return Condensed(follow.T @ (K @ follow) + B.T @ X, displacements)


def segment(fe_model: FiniteElements, a: Tie, b: Tie) -> Segment:
    """One segment of a blade alone, between its end sections.

    Raises:
        CondensationError: as ``condense`` and ``between``, or a model without mass.
    """
    c = condense(fe_model, (a, b))
    undeformed = ties.seen(a, b)
    displacements = c.displacements[:, 6:] @ sp.adjoint(sp.inverse(undeformed))
    return Segment(
        undeformed,
        between(c.stiffness, undeformed, f"{a.name} to {b.name}"),
        *_body(fe_model, fe_model.mass, a.frame, displacements),
    )


def segments_in_place(fe_model: FiniteElements, tied: Sequence[Tie], masses: Array) -> list[Segment]:
    """Every segment of a blade in its place between its neighbours, so that sections warp and contract as they do there.

    The blade is clamped at its first tie and loaded at its last by six wrenches; between, average ties read how far each
    section turns and moves past the one before: a segment's flexibility is its ρ over the wrench that passes through it.
    What the ties add or lack is felt at the two ends of the blade only.

    Args:
        fe_model: the whole blade.
        tied: m + 1 sections from the root on: rigid at a root that is clamped, average everywhere else.
        masses: (m, n) lumped mass of each segment at the model's freedoms; at a section between two, each has its share.

    Raises:
        CondensationError: as ``condense``; a section in between that is not average; no mass; a flexibility that is not one.
    """
    if bad := [t.name for t in tied[1:-1] if t.kind != "average"]:
        raise CondensationError(
            f"section {bad[0]!r}: a rigid tie stops the warping it should let pass; use an average one"
        )
    if np.shape(masses) != (len(tied) - 1, len(fe_model.directions)):
        raise CondensationError(
            f"masses: shape {np.shape(masses)}, expected {(len(tied) - 1, len(fe_model.directions))}: a row a segment"
        )
    c = condense(fe_model, (tied[0], tied[-1]))
    displacements, tip = (
        c.displacements[:, 6:],
        c.stiffness[6:, 6:],
    )  # per unit twist of the tip, and its wrenches
    twists = [t.mean @ displacements[t.freedoms] for t in tied]
    out = []
    for k, (a, b) in enumerate(pairwise(tied)):
        undeformed = ties.seen(a, b)
        rho = sp.adjoint(undeformed) @ twists[k + 1] - twists[k]
        wrench = sp.adjoint(ties.seen(tied[-1], a)).T @ tip
        flexibility = np.linalg.solve(wrench.T, rho.T).T
        size = np.sqrt(np.abs(np.diagonal(flexibility)))
        unit = flexibility / np.outer(size, size)
        wrong = np.abs(unit - unit.T).max()
        if wrong > MAX_ASYMMETRY or np.linalg.eigvalsh(unit + unit.T)[0] <= 0:
            raise CondensationError(
                f"segment {a.name!r} to {b.name!r}: its flexibility is {wrong:.1e} from symmetric, or not positive: "
                "sections too close together for the mesh, or ties of another model?"
            )
        J, mean = _body(fe_model, masses[k], a.frame, displacements)
        stiffness: Array = np.linalg.inv(0.5 * (flexibility + flexibility.T))
        ride: Array = (mean - twists[k]) @ np.linalg.inv(rho)
        out.append(Segment(undeformed, stiffness, J, ride))
    return out


def _body(fe_model: FiniteElements, mass: Array, frame: Array, displacements: Array) -> tuple[Array, Array]:
    """Inertia and mean twist of a mass whose freedoms move by ``displacements`` (n, 6), both about ``frame``, in its axes."""
    R = ties.motion(fe_model.points, fe_model.directions, frame)
    J = (R.T * mass) @ R
    size = np.sqrt(np.abs(np.diagonal(J)))
    if (size <= 0).any() or np.linalg.eigvalsh(J / np.outer(size, size))[0] < 1e-12:
        raise CondensationError(
            f"{fe_model.name}: no mass, or none with moments of inertia about all axes: give the freedoms' lumped mass"
        )
    return J, np.linalg.solve(J, (R.T * mass) @ displacements)
