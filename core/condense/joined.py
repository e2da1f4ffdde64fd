"""Two segments in a row as one: what the same sections, every other left out, would have been condensed to.

The stiffness loses nothing: flexibilities add. The rigid body is that of both, moving as their masses do on average in the
static displacements, as a segment's own does (see ``condensation``). Fewer segments show what the number of them costs.
"""

from collections.abc import Sequence

import numpy as np

from ..space import spatial as sp
from .segments import Segment


def joined(segments: Sequence[Segment]) -> list[Segment]:
    """Every two neighbours in one, from the root; of an odd number the last stays."""
    pairs = [_pair(a, b) for a, b in zip(segments[::2], segments[1::2], strict=False)]
    return [*pairs, *segments[2 * len(pairs) :]]


def _pair(a: Segment, b: Segment) -> Segment:
    """In the first frame's axes throughout."""
    out, back = sp.adjoint(a.undeformed), sp.adjoint(sp.inverse(a.undeformed))
    first = np.linalg.inv(a.stiffness)  # ρ of a, from a wrench at the far end
    second = out @ np.linalg.inv(b.stiffness) @ out.T
    far = back.T @ b.inertia @ back
    inertia = a.inertia + far
    turned = first + out @ b.ride @ back @ second  # twist of b's body
    mean = np.linalg.solve(inertia, a.inertia @ a.ride @ first + far @ turned)
    stiffness = np.linalg.inv(first + second)
    return Segment(a.undeformed @ b.undeformed, 0.5 * (stiffness + stiffness.T), inertia, mean @ stiffness)
