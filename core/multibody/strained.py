"""The strain of a mechanism's beams, and whether their strain measure is valid at it."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..element import measures
from ..space import spatial as sp
from .state import State
from .tree import Batch, Tree

Array = NDArray[Any]


def largest_strain(tree: Tree, state: State) -> float:
    """Largest axial or shear strain of a beam's reference line, mean over its length; bushings have none."""
    largest = 0.0
    for batch, x in _relative(tree, state.kinematics.poses):
        law = batch.beams.law
        beta = state.q[batch.inner[:, None] + np.arange(6)] if batch.beams.inner else np.zeros((len(x), 0))
        real = law.shortening.any(axis=(1, 2))
        largest = max(largest, float(measures.relative_strain(law, x, beta)[real].max(initial=0.0)))
    return largest


def out_of_range(tree: Tree, poses: Array) -> list[str]:
    """Beams that bodies at ``poses`` (b, 4, 4) deform beyond the range of their strain measure, as ``a–b``."""
    out = []
    for batch, x in _relative(tree, poses):
        for k in batch.index[measures.out_of_range(batch.beams.law, x)]:
            beam = tree.mechanism.beams[k]
            out.append(f"{beam.body_a}–{beam.body_b}")
    return out


def undeformed(tree: Tree, guess: Mapping[str, float]) -> dict[str, float]:
    """A guess without the coordinates of elastic joints and of the inside of beams."""
    inner = {tree.coordinates[j + i] for j in tree.inner for i in range(6)}
    elastic = tuple(f"{j.name}." for j in tree.mechanism.joints if j.kind == "elastic")
    return {name: value for name, value in guess.items() if name not in inner and not name.startswith(elastic)}


def _relative(tree: Tree, poses: Array) -> Iterator[tuple[Batch, Array]]:
    """For each batch of beams, the poses (e, 4, 4) of their ends b in the frames of their ends a."""
    x = np.concatenate([poses, np.eye(4)[None]])
    for batch in tree.batches:
        a, b = batch.ends.T
        yield batch, sp.inverse(x[a] @ batch.at_a) @ x[b] @ batch.at_b
