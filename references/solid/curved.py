"""A solid blade that is swept, prebent, twisted and tapered, of a fibrous material: its geometry, and how its root is held.

The direction of the reference curve turns in proportion to the arc length, in the plane of rotation (sweep) and out of it
(prebend), so that the curve is known in closed form. Sections are perpendicular to the curve. They are trapezoids, which
hexahedra represent exactly, and lie to one side of the curve in both directions: all 21 stiffnesses of a section and its
static moments differ from zero. Fibres lie in the plane of the chord at an angle to the curve, which couples bending and
torsion.

The root is held by tractions of St Venant, the nodal forces between two sections inside a blade, which are those at the root
of a solid that continues on both sides and is loaded at its ends. The six mean motions on which they do work are zero. The
root may warp and contract, as the theory of beams assumes of every section; a full clamp would prevent both, which is an
effect of the solid's end and not of its sections.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ...core.condense import ties
from ..cache_last import cache_last
from . import hexahedra
from .materials import Orthotropic
from .mesh import Bricks

Array = NDArray[np.float64]

STUB = 4.0
"""Length of solid on either side of a slice, in chords. The effect of how its ends are loaded falls by a factor of 14 per
chord; after four it is 5e-5 of the stiffness."""

PER_CHORD = 6
"""Elements along a length of one chord."""


@dataclass(frozen=True)
class CurvedSolid:
    """A solid blade; angles in rad, lengths in m.

    Attributes:
        name: of its case.
        length: arc length of the reference curve.
        hub_radius: from the rotor's axis to the root.
        sweep, prebend: angles of the curve at the tip from the x axis, towards y and towards z; 0 at the root.
        twist: of the sections, at the root and at the tip; linear between.
        chord, thickness: at the root and at the tip; linear between. The thickness is that at mid-chord.
        edges: thickness at the edges towards −y and +y over that at mid-chord; their mean is 1.
        behind, below: shares of the chord towards −y, and of the thickness towards −z, of the reference curve.
        material: its axes follow the sections.
    """

    name: str
    length: float
    hub_radius: float
    sweep: float
    prebend: float
    twist: tuple[float, float]
    chord: tuple[float, float]
    thickness: tuple[float, float]
    edges: tuple[float, float]
    behind: float
    below: float
    material: Orthotropic

    def curve(self, s: Array) -> Array:
        """(k, 3) points of the reference curve, m, from the root, at arc lengths ``s`` (k,), m."""
        a, b = self.sweep / self.length, self.prebend / self.length

        def sine(rate: float) -> Array:
            return s * np.sinc(rate * s / np.pi)  # ∫ cos(rate s) ds

        def versine(rate: float) -> Array:
            return 0.5 * rate * s**2 * np.sinc(0.5 * rate * s / np.pi) ** 2  # ∫ sin(rate s) ds

        along = 0.5 * (sine(a - b) + sine(a + b))
        return np.stack([along, 0.5 * (versine(a - b) + versine(a + b)), versine(b)], axis=-1)

    def position(self, s: Array) -> Array:
        """(k, 3) the same points from the rotor's axis, m."""
        out = self.curve(s)
        out[:, 0] += self.hub_radius
        return out

    def twisted(self, s: Array) -> Array:
        """(k,) twist, rad, at arc lengths ``s`` (k,), m."""
        return _linear(self.twist, s / self.length)

    def axes(self, s: Array) -> Array:
        """(k, 3, 3) section axes in columns: the blade's, turned as little as brings x onto the tangent, then twisted."""
        a, b = self.sweep * s / self.length, self.prebend * s / self.length
        t = np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)], axis=-1)
        across = np.cross([1.0, 0.0, 0.0], t)
        sine = np.linalg.norm(across, axis=-1, keepdims=True)
        swing = Rotation.from_rotvec(across * np.where(sine > 0, np.arcsin(sine) / np.where(sine > 0, sine, 1.0), 1.0))
        twist_rotation = Rotation.from_rotvec(np.outer(self.twisted(s), [1.0, 0.0, 0.0]))
        return (swing * twist_rotation).as_matrix()

    def section(self, s: Array, eta: Array, zeta: Array) -> tuple[Array, Array]:
        """y and z, m, of points of sections in their axes; ``eta`` and ``zeta`` are shares of chord and thickness, 0 to 1."""
        y = _linear(self.chord, s / self.length) * (eta - self.behind)
        z = _linear(self.thickness, s / self.length) * _linear(self.edges, eta) * (zeta - self.below)
        return y, z

    def bricks(self, s: Array, across: tuple[int, int]) -> Bricks:
        """Hexahedra with layers of corners at arc lengths ``s`` (nx+1,), m, and ``across`` elements in a section."""
        eta, zeta = (np.linspace(0.0, 1.0, 2 * n + 1) for n in across)
        at = np.empty(2 * len(s) - 1)
        at[::2], at[1::2] = s, 0.5 * (s[1:] + s[:-1])
        y, z = np.broadcast_arrays(*self.section(at[:, None, None], eta[:, None], zeta))
        local = np.stack([np.zeros_like(y), y, z], axis=-1)
        axes, position = self.axes(at), self.position(at)
        nodes = position[:, None, None] + np.einsum("sij,sabj->sabi", axes, local)
        return Bricks(nodes[::2, ::2, ::2], axes, nodes)


def _linear(ends: tuple[float, float], share: Array) -> Array:
    return ends[0] + (ends[1] - ends[0]) * share


def layer(bricks: Bricks, at: int) -> NDArray[np.intp]:
    """Indices of the nodes of the ``at``-th layer of nodes along the span."""
    size = int(np.prod([2 * n + 1 for n in bricks.counts[1:]]))
    return np.arange(at * size, (at + 1) * size)


@cache_last
def with_root_forces(solid: CurvedSolid, layers: int, across: tuple[int, int]) -> tuple[Bricks, Array]:
    """The mesh of a solid with ``layers`` along the span, and the nodal forces (3n, 6) at its root, one column per reaction."""
    bricks = solid.bricks(np.linspace(0.0, solid.length, layers + 1), across)
    force = np.zeros((3, bricks.lattice().size // 3, 6))
    force[:, layer(bricks, 0)] = inside(solid, 0.0, across).force
    return bricks, force.reshape(-1, 6)


def loaded(solid: CurvedSolid, bricks: Bricks, body: hexahedra.Solid) -> Array:
    """(3n, 6) displacements of a block of the solid, fixed at its inner end, by six wrenches at its outer end.

    They are unit forces along, and moments about, the blade's axes at the root.
    """
    K = hexahedra.tangent(body)
    last = layer(bricks, 2 * bricks.counts[0])
    n = len(body.nodes)
    freedoms = np.concatenate([last + d * n for d in range(3)])
    frame = np.eye(4)
    frame[:3, 3] = [solid.hub_radius, 0.0, 0.0]
    points, directions = hexahedra.freedoms(body)
    R = ties.motion(points[freedoms], directions[freedoms], frame)
    area = np.tile(hexahedra.mass(body).sum(axis=1)[last], 3)
    force = np.zeros((3 * n, 6))
    force[freedoms] = np.linalg.solve((R.T * area) @ R, R.T * area).T
    free = np.ones(3 * n, bool)
    free[np.concatenate([layer(bricks, 0) + d * n for d in range(3)])] = False
    u = np.zeros((3 * n, 6))
    u[free] = hexahedra.factored(K[free][:, free]).solve(force[free])
    return u


@dataclass(frozen=True)
class Slice:
    """Two layers of elements inside a loaded solid.

    Attributes:
        length: along the reference curve, m.
        energy: (6, 6) product of each wrench's forces with the displacements by each other: twice the strain energy.
        force: (3, k, 6) forces at the nodes of its middle section, along the blade's axes, on the outer part.
    """

    length: float
    energy: Array
    force: Array


@cache
def inside(
    solid: CurvedSolid, at: float, across: tuple[int, int], stub: float = STUB, per_chord: int = PER_CHORD
) -> Slice:
    """The slice around the arc length ``at`` (m) of a solid that goes on for ``stub`` chords on both sides.

    ``across`` are the elements in a section, ``per_chord`` those along a length of one chord.
    """
    h = float(_linear(solid.chord, np.array(at / solid.length))) / per_chord
    n = int(np.ceil(stub * per_chord)) + 1
    bricks = solid.bricks(at + h * np.arange(-n, n + 1.0), across)
    body = hexahedra.solid(bricks, solid.material)
    u, middle = loaded(solid, bricks, body), layer(bricks, 2 * n)
    energy, force = np.zeros((6, 6)), np.zeros(0)
    for start in (n - 1, n):
        within = body.own.min(axis=1) // len(middle) == 2 * start
        force = hexahedra.tangent(hexahedra.part(body, within)) @ u
        energy += u.T @ force
    return Slice(2 * h, energy, -force.reshape(3, -1, 6)[:, middle])
