"""The strain of a mechanism's beams, and whether their strain measure is valid at it."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..element import measures
from ..space import spatial as sp
from .state import State
from .topology import Batch, Tree

Array = NDArray[Any]


def largest_strain(tree: Tree, state: State) -> float:
    """Largest axial or shear strain of a beam's reference line, mean over its length; bushings have none."""
    largest = 0.0
    for batch, x in _relative(tree, state.kinematics.poses):
        law = batch.beams.law
        beta = (
            state.q[batch.first_internal[:, None] + np.arange(6)]
            if batch.beams.internal_count
            else np.zeros((len(x), 0))
        )
        strain = measures.relative_strain(law, x, beta)[~batch.beams.bushings]
        largest = max(largest, float(strain.max(initial=0.0)))
    return largest


def out_of_range(tree: Tree, poses: Array) -> list[str]:
    """Beams that bodies at ``poses`` (b, 4, 4) deform beyond the range of their strain measure, as ``a–b``."""
    out = []
    for batch, x in _relative(tree, poses):
        for k in batch.index[measures.out_of_range(batch.beams.law, x)]:
            beam = tree.mechanism.beams[k]
            out.append(f"{beam.body_a}–{beam.body_b}")
    return out


def _relative(tree: Tree, poses: Array) -> Iterator[tuple[Batch, Array]]:
    """For each batch of beams, the poses (e, 4, 4) of their ends b in the frames of their ends a."""
    x = np.concatenate([poses, np.eye(4)[None]])
    for batch in tree.batches:
        a, b = batch.ends.T
        yield batch, sp.inverse(x[a] @ batch.at_a) @ x[b] @ batch.at_b
