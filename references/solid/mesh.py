"""A solid blade as a block of hexahedra, for any finite element code: mesh, clamp, and mean motion of sections.

Elements of a straight blade have straight edges (trilinear geometry), so the geometry is the same for 8, 20 or 27 nodes per
element.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import ArrayLike, NDArray

from ...core.condense import ties
from ...core.modes import STATIONS
from ..protocol.interface import CodeError

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

TWENTY = np.array(
    [
        *[(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)],
        *[(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)],
        *[(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)],
    ]
)
"""Positions of a 20-node element's nodes on its 3×3×3 lattice, in the order of CalculiX and Abaqus (C3D20)."""


@dataclass(frozen=True)
class Bricks:
    """A block of nx × ny × nz hexahedra, x along the span.

    Attributes:
        corners: (nx+1, ny+1, nz+1, 3) m, in blade axes from the rotor's axis (see ``core.blade``); all corners
            of a layer along the span have the same x, unless the blade is curved.
        axes: (2nx+1, 3, 3) section axes in columns, which an orthotropic material follows, at the layers of nodes; empty:
            the blade's axes.
        nodes: (2nx+1, 2ny+1, 2nz+1, 3) m, of curved elements; empty: edges are straight.
    """

    corners: Array
    axes: Array = field(default_factory=lambda: np.zeros((0, 3, 3)))
    nodes: Array = field(default_factory=lambda: np.zeros((0, 1, 1, 3)))

    @property
    def counts(self) -> tuple[int, int, int]:
        """Elements along x, y, z."""
        nx, ny, nz, _ = self.corners.shape
        return nx - 1, ny - 1, nz - 1

    def lattice(self) -> Array:
        """(2nx+1, 2ny+1, 2nz+1, 3) nodes: the corners and the midpoints of edges, faces and elements."""
        if len(self.nodes):
            return self.nodes
        out = self.corners
        for axis in range(3):
            a = np.moveaxis(out, axis, 0)
            full = np.empty((2 * len(a) - 1, *a.shape[1:]))
            full[::2], full[1::2] = a, 0.5 * (a[:-1] + a[1:])
            out = np.moveaxis(full, 0, axis)
        return out

    def part(self, start: int, stop: int) -> "Bricks":
        """The layers of elements from ``start`` to before ``stop`` along the span."""
        within = slice(2 * start, 2 * stop + 1)
        return Bricks(self.corners[start : stop + 1], self.axes[within], self.nodes[within])


def straight_bricks(
    x: Array,
    chord: ArrayLike,
    thickness: ArrayLike,
    twist: ArrayLike = 0.0,
    *,
    across: tuple[int, int],
    edge: float = 1.0,
) -> Bricks:
    """A straight solid blade.

    Args:
        x: (nx+1,) ends of the layers of elements, m from the rotor's axis.
        chord: (nx+1,) or scalar, m; along y without twist.
        thickness: (nx+1,) or scalar, m, at mid-chord; along z without twist.
        twist: (nx+1,) or scalar, rad, about x from y towards z.
        across: number of elements along the chord and through the thickness.
        edge: ratio of the thickness at the edges to that at mid-chord, parabolic between; 1 for a rectangle.
    """
    eta, zeta = (np.linspace(-1.0, 1.0, n + 1) for n in across)
    half_chord, half_thick, angle = (np.broadcast_to(v, x.shape)[:, None, None] for v in (chord, thickness, twist))
    y = 0.5 * half_chord * eta[:, None]
    z = 0.5 * half_thick * zeta * (1.0 - (1.0 - edge) * eta[:, None] ** 2)
    c, s = np.cos(angle), np.sin(angle)
    y, z = c * y - s * z, s * y + c * z
    return Bricks(np.stack([np.broadcast_to(x[:, None, None], z.shape), y, z], axis=-1))


Clamp = Callable[[Array], Bools]
"""Function of node positions (n, 3), m, that returns which displacements (n, 3) are fixed."""


def clamped_section(at: float) -> Clamp:
    """Fix all displacements of the section at ``x = at`` (m)."""

    def fixed(nodes: Array) -> Bools:
        return np.repeat(_near(nodes[:, :1], at), 3, axis=1)

    return fixed


def fixed_by(clamp: Clamp, nodes: Array) -> Bools:
    """(n, 3) which displacements a clamp fixes.

    Raises:
        CodeError: if the blade is not fixed along x, y and z.
    """
    fixed = clamp(nodes)
    if not fixed.any(axis=0).all():
        raise CodeError(
            f"clamp: fixes {fixed.sum()} displacements of {len(nodes)} nodes: check that its x is that of the root"
        )
    return fixed


def workless(forces: Array) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """The motions on which forces (3n, 6) do no work: ``u[follow] = ratio @ u[lead]``, all other displacements are free.

    Returns:
        ``follow`` (6,), ``lead`` (k,), ``ratio`` (6, k).
    """
    loaded = np.flatnonzero(np.abs(forces).max(axis=1))
    factors: Any = scipy.linalg.qr(forces[loaded].T, mode="economic", pivoting=True)
    pivot = factors[2]
    follow, lead = loaded[pivot[:6]], loaded[pivot[6:]]
    return follow, lead, -np.asarray(np.linalg.solve(forces[follow].T, forces[lead].T), float)


def _near(values: Array, target: float) -> Bools:
    return np.abs(values - target) < 1e-9 * max(float(np.abs(values).max()), abs(target))


def mean_motions(nodes: Array, weights: Array, u: NDArray[Any]) -> NDArray[np.complex128]:
    """(m, 21, 4) mean displacement, and mean rotation about x, of the sections at ``STATIONS``.

    Args:
        nodes: (n, 3), with a layer of them at every station along x; rotations are about the line y = z = 0.
        weights: (n,) weight of each node in its section.
        u: (3, n, m) displacements along x, y, z.

    Raises:
        CodeError: if a station has no nodes.
    """
    root, tip = nodes[:, 0].min(), nodes[:, 0].max()
    sections = []
    for at in root + STATIONS * (tip - root):
        on_section = np.flatnonzero(np.abs(nodes[:, 0] - at) < 1e-9 * max(abs(root), abs(tip)))
        if not len(on_section):
            raise CodeError(f"mesh: no layer of nodes at the station x = {at:g} m: use a multiple of ten layers")
        sections.append((on_section, np.array([at, 0.0, 0.0])))
    return means(nodes, weights, u, sections)


def means(
    nodes: Array, weights: Array, u: NDArray[Any], sections: Sequence[tuple[NDArray[np.intp], Array]]
) -> NDArray[np.complex128]:
    """(m, k, 4) mean displacement, and mean rotation about x, of k sections, in blade axes.

    Args:
        nodes, weights, u: as for ``mean_motions``.
        sections: indices of the nodes of each, and its point (3,), m, whose displacement is asked.
    """
    out = np.zeros((u.shape[2], len(sections), 4), complex)
    directions = np.arange(3)
    for k, (on_section, at) in enumerate(sections):
        frame = np.eye(4)
        frame[:3, 3] = at
        R = ties.motion(np.tile(nodes[on_section], (3, 1)), np.repeat(directions, len(on_section)), frame)
        weighed = R.T * np.tile(weights[on_section], 3)
        out[:, k] = np.linalg.solve(weighed @ R, weighed @ u[:, on_section].reshape(3 * len(on_section), -1))[:4].T
    return out
