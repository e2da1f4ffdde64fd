"""A mechanism's spanning tree as arrays: the topology, before any state."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..element.beams import Beams
from ..mechanism.description import GROUND, Mechanism, MechanismError
from ..mechanism.units import length_of

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Batch:
    """Beams that are processed together: of one strain measure, all with points or all without.

    Attributes:
        index: (e,) which of the mechanism's beams.
        ends: (e, 2) body indices, −1 for the ground.
        inner: (e,) the first of six internal coordinates, −1 if there are none.
        inside: (e,) row of the internal coordinates, after those of the bodies, −1 if there are none.
        beams: the elements.
        at_a, at_b: (e, 4, 4) poses of their end frames in the bodies.
        axes: (e,) index of the body in whose axes the loads on the points are given, −1 for the ground.
        damping: (e, 6, 6) forces conjugate to the strain, from its rate.
    """

    index: NDArray[np.intp]
    ends: NDArray[np.intp]
    inner: NDArray[np.intp]
    inside: NDArray[np.intp]
    beams: Beams
    at_a: Array
    at_b: Array
    axes: NDArray[np.intp]
    damping: Array


@dataclass(frozen=True)
class Groups:
    """Groups of coordinates that move the same rows of B: several of one joint, or of joints in series without mass between.

    Attributes:
        before: (g,) parent group of each, −1 for the ground; always a lower index.
        members: (g, k) coordinates of each group, padded with −1.
        row: (b + m,) the outermost group that moves each row of B, −1 for none.
        place: (n,) position of each coordinate in the flattened ``members``.
        of: (n,) group of each coordinate.
    """

    before: NDArray[np.intp]
    members: NDArray[np.intp]
    row: NDArray[np.intp]
    place: NDArray[np.intp]
    of: NDArray[np.intp]


@dataclass(frozen=True)
class Tree:
    """A mechanism's spanning tree as arrays, one link per coordinate.

    The internal coordinates of beams with mass come last, as links that move no body.

    Attributes:
        mechanism: the mechanism.
        coordinates: (n) names.
        before: (n,) parent link of each coordinate's link, −1 for the ground.
        fixed: (n, 4, 4) pose of the screw's frame in the parent link.
        screw: (n, 6) unit twist in that frame.
        bodies: (b) names, copies beyond cut joints last.
        link: (b,) link that carries each body, −1 for the ground.
        on_link: (b, 4, 4) pose of the body's frame in its link.
        inertia: (b, 6, 6) in the bodies' frames.
        welds: pairs (body, copy) of body indices that a cut joint welds together.
        weld_names: the cut joints' names.
        inner: (i,) the first of the six internal coordinates of each beam that has them.
        batches: the beams.
        above: (n, n) above[j, k]: link k is on the path from the ground to link j, or is j.
        beyond: (n, n) beyond[j, k] = 1: link j is a descendant of link k; else 0.
        carries: (b, n) carries[i, k]: coordinate k moves body i.
        groups: the coordinates that move the same rows of B.
    """

    mechanism: Mechanism
    coordinates: tuple[str, ...]
    before: NDArray[np.intp]
    fixed: Array
    screw: Array
    bodies: tuple[str, ...]
    link: NDArray[np.intp]
    on_link: Array
    inertia: Array
    welds: tuple[tuple[int, int], ...]
    weld_names: tuple[str, ...]
    inner: NDArray[np.intp]
    batches: tuple[Batch, ...]
    above: NDArray[np.bool_]
    beyond: Array
    carries: NDArray[np.bool_]
    groups: Groups

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
        return int(self.inner[0]) if len(self.inner) else len(self.coordinates)

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
