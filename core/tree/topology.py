"""A mechanism's spanning tree as arrays: the topology, before any state."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..element.beams import Beams
from ..mechanism.description import GROUND, Mechanism, MechanismError
from ..mechanism.length import length_of
from .links import Links

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Batch:
    """Beams that are processed together: of one strain measure, all with points or all without.

    Attributes:
        index: (e,) which of the mechanism's beams.
        ends: (e, 2) body indices, −1 for the ground.
        first_internal: (e,) the first of six internal coordinates, −1 if there are none.
        internal_row: (e,) row of the internal coordinates, after those of the bodies, −1 if there are none.
        beams: the elements.
        at_a, at_b: (e, 4, 4) poses of their end frames in the bodies.
        axes: (e,) index of the body in whose axes the loads on the points are given, −1 for the ground.
        damping: (e, 6, 6) forces conjugate to the strain, from its rate.
    """

    index: NDArray[np.intp]
    ends: NDArray[np.intp]
    first_internal: NDArray[np.intp]
    internal_row: NDArray[np.intp]
    beams: Beams
    at_a: Array
    at_b: Array
    axes: NDArray[np.intp]
    damping: Array


@dataclass(frozen=True)
class Tree:
    """A mechanism's spanning tree as arrays, one link per coordinate.

    The internal coordinates of beams with mass come last, as links that move no body.

    Attributes:
        mechanism: the mechanism.
        coordinates: (n) names.
        parent: (n,) parent link of each coordinate's link, −1 for the ground.
        fixed: (n, 4, 4) pose of the screw's frame in the parent link.
        screw: (n, 6) unit twist in that frame.
        bodies: (b) names, copies beyond cut joints last.
        link: (b,) link that carries each body, −1 for the ground.
        on_link: (b, 4, 4) pose of the body's frame in its link.
        inertia: (b, 6, 6) in the bodies' frames.
        welds: pairs (body, copy) of body indices that a cut joint welds together.
        weld_names: the cut joints' names.
        first_internal: (i,) the first of the six internal coordinates of each beam that has them.
        batches: the beams.
    """

    mechanism: Mechanism
    coordinates: tuple[str, ...]
    parent: NDArray[np.intp]
    fixed: Array
    screw: Array
    bodies: tuple[str, ...]
    link: NDArray[np.intp]
    on_link: Array
    inertia: Array
    welds: tuple[tuple[int, int], ...]
    weld_names: tuple[str, ...]
    first_internal: NDArray[np.intp]
    batches: tuple[Batch, ...]

    @cached_property
    def links(self) -> Links:
        """The links for the sweeps of ``links``, with all twists and wrenches at the ground's origin, in its axes: Ad = 1."""
        n = len(self.coordinates)
        return Links(self.parent.astype(np.int64) + 1, np.tile(np.eye(6), (n, 1, 1)), np.zeros((0, 6, 6)))

    @cached_property
    def moves_link(self) -> NDArray[np.bool_]:
        """(n, n) whether the coordinate of the column moves the link of the row."""
        rows = np.eye(len(self.coordinates), dtype=bool)
        for link, parent in enumerate(self.parent.tolist()):
            if parent >= 0:
                rows[link] |= rows[parent]
        return rows

    @cached_property
    def moves_body(self) -> NDArray[np.bool_]:
        """(b, n) whether the coordinate of the column moves the body of the row."""
        return np.append(self.moves_link, np.zeros((1, len(self.coordinates)), bool), axis=0)[self.link]

    @cached_property
    def _number(self) -> dict[str, int]:
        return {name: j for j, name in enumerate(self.coordinates)}

    @cached_property
    def length(self) -> float:
        """Length of the undeformed mechanism, m; see ``units.length_of``."""
        return length_of(self.mechanism)

    @property
    def joints(self) -> int:
        """Number of coordinates of joints, which come before the internal ones of beams."""
        return int(self.first_internal[0]) if len(self.first_internal) else len(self.coordinates)

    def body(self, name: str) -> int:
        """Index of a body; −1 is the ground."""
        return -1 if name == GROUND else self.bodies.index(name)

    def coordinate(self, name: str) -> int:
        """Index of a coordinate.

        Raises:
            MechanismError: if no coordinate has that name.
        """
        if name not in self._number:
            raise MechanismError(f"coordinate {name!r} is unknown; there are {', '.join(self.coordinates)}")
        return self._number[name]
