"""Neighbouring segments joined in pairs: the result of condensation with every other section omitted.

The stiffness is exact: flexibilities add. The rigid body is that of both segments, moving as their masses do on average in
the static displacements, as for a single segment (see ``condensation``). Results with fewer segments show the error due to
their number.
"""

from collections.abc import Sequence

import numpy as np

from ..space import spatial as sp
from .segments import Segment


def joined(segments: Sequence[Segment]) -> list[Segment]:
    """Join every two neighbours, from the root; an odd last segment is unchanged."""
    pairs = [_pair(a, b) for a, b in zip(segments[::2], segments[1::2], strict=False)]
    return [*pairs, *segments[2 * len(pairs) :]]


def _pair(a: Segment, b: Segment) -> Segment:
    """One segment from two; all in the axes of a's first frame."""
    out, to_first_frame = sp.adjoint(a.undeformed), sp.adjoint(sp.inverse(a.undeformed))
    first = np.linalg.inv(a.stiffness)  # ρ of a, from a wrench at the far end
    second = out @ np.linalg.inv(b.stiffness) @ out.T
    second_inertia = to_first_frame.T @ b.inertia @ to_first_frame
    inertia = a.inertia + second_inertia
    twist_b = first + out @ b.body_twist @ to_first_frame @ second  # of b's body
    mean = np.linalg.solve(inertia, a.inertia @ a.body_twist @ first + second_inertia @ twist_b)
    stiffness = np.linalg.inv(first + second)
    return Segment(a.undeformed @ b.undeformed, 0.5 * (stiffness + stiffness.T), inertia, mean @ stiffness)
