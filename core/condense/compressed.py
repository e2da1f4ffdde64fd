"""The compressed model: segments end to end as a chain of rigid bodies and complex stiffness elements, and its modes.

The paper places its rigid bodies at the sections. Here the body of each segment follows its element (see ``condensation``),
which converges two orders faster in bending at no cost; the sections are massless.

A complex stiffness element is linear in its axes: the steady tension stiffens bending, as in any beam of ``core``, but not
torsion (a section that twists under tension also shortens). A solid model shows that stiffening, which grows as Ω².
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..element import beams as bm
from ..element.beams import Beams, Points
from ..element.measures import LARGEST_STRAIN, constant_strain
from ..element.mesh import Mesh
from ..modes import STATIONS, Modes
from ..solve import chain_modes
from ..space import spatial as sp
from ..space.inertia import about_centre, transformed
from ..spectrum import accuracy
from ..steady.blade_state import LargeStrainError
from .joined import joined
from .segments import Segment
from .ties import CondensationError

Array = NDArray[np.float64]


def mesh_from_segments(segments: Sequence[Segment], root: Array) -> Mesh:
    """Join segments end to end.

    Args:
        segments: from the root to the tip; frame b of each is frame a of the next.
        root: (4, 4) pose of the first frame, clamped to the hub, in the hub's axes (see ``core.blade``).

    Raises:
        CondensationError: if there are none.
    """
    if not segments:
        raise CondensationError("segments: none given: a chain needs at least one")
    n = len(segments)
    undeformed = np.array([s.undeformed for s in segments])
    nodes = [root]
    for x in undeformed:
        nodes.append(nodes[-1] @ x)
    centres, bodies = _centred(np.array([s.inertia for s in segments]))
    zeros = np.zeros((n, 6, 6))
    return Mesh(
        nodes=np.array(nodes),
        lumps=np.zeros((n + 1, 6, 6)),
        beams=Beams(
            law=constant_strain("corotational", undeformed),
            stiffness=bm.end_stiffness("corotational", undeformed, np.array([s.stiffness for s in segments])),
            points=bm.carried_points(
                undeformed, np.arange(n), centres, np.array([s.body_twist for s in segments]), zeros, bodies
            ),
            preload=np.zeros((n, 6)),
            internal_preload=np.zeros((n, 6)),
        ),
        samples=_samples(undeformed),
        scale=float(np.linalg.norm(undeformed[:, :3, 3], axis=1).sum()),
        force=np.zeros((n + 1, 3)),
    )


def segment_modes(
    segments: Sequence[Segment], root: Array, omega: float, count: int = 10, *, allow_large_strain: bool = False
) -> Modes:
    """The lowest modes of segments end to end, with the relative uncertainties due to their number.

    The uncertainties are estimated from the same blade with a half and a quarter of the segments, joined in pairs; they are
    infinite for fewer than four. Torsion and stretch converge with second order, bending with fourth; second is assumed.

    Args:
        segments: as for ``mesh_from_segments``.
        root: as for ``mesh_from_segments``.
        omega: rotor speed, rad/s.
        count: number of modes (fewer if there are fewer).
        allow_large_strain: accept steady strains above ``LARGEST_STRAIN``.

    Raises:
        CondensationError: no segments.
        SteadyStateError: no steady state at this speed.
        LargeStrainError: steady strains above ``LARGEST_STRAIN``.
        UnstableError: the steady state is not stable.
    """
    fine = chain_modes(mesh_from_segments(segments, root), omega, count)
    if fine.strain > LARGEST_STRAIN and not allow_large_strain:
        raise LargeStrainError(
            f"omega: {omega:.6g} rad/s: steady strain {fine.strain:.0%}: too large for linear elements: the speed is too high "
            "or the blade too soft; check units, or allow large strains"
        )
    m = len(fine.frequencies)
    without_estimate = replace(fine, uncertainty=np.full(m, np.inf))
    if len(segments) < 4:
        return without_estimate
    half_as_many = joined(segments)
    levels = [
        chain_modes(mesh_from_segments(s, root), omega, m).frequencies for s in (joined(half_as_many), half_as_many)
    ]
    if min(len(f) for f in levels) < m:
        return without_estimate
    uncertainty = accuracy.estimate(np.array([*levels, fine.frequencies]), order=2).of_finest
    return replace(fine, uncertainty=uncertainty + fine.rounding)


def _centred(inertia: Array) -> tuple[Array, Array]:
    """Poses (n, 4, 4) of the centres of mass, parallel to the frames, and the inertias (n, 6, 6) about them."""
    poses = sp.pose(np.eye(3), about_centre(inertia)[1])
    return poses, transformed(inertia, sp.inverse(poses))


def _samples(undeformed: Array) -> Points:
    """Points at which mode shapes are sampled; the strain is constant between two sections."""
    length = np.append(0.0, np.cumsum(np.linalg.norm(undeformed[:, :3, 3], axis=1)))
    at = STATIONS * length[-1]
    element = np.clip(np.searchsorted(length, at, side="right") - 1, 0, len(undeformed) - 1)
    share = (at - length[element]) / np.diff(length)[element]
    return Points(
        element=element,
        zeta0=share[:, None] * sp.log(undeformed)[element],
        shape=share[:, None, None] * np.eye(6),
        bubble=np.zeros((len(at), 6, 6)),
        mass=np.zeros((len(at), 6, 6)),
    )
