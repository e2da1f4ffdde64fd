"""Assumed mode shapes of tower and blades: the motions to which a Galerkin method restricts a machine.

A shape is a field of displacements and rotations of the nodes; the elements' internal coordinates follow from least elastic
energy. It may be given by the curvature of the beam, in the flapwise and the edgewise direction of its sections, which twist
along it. ElastoDyn's polynomials are such shapes (J. Jonkman, M. Buhl, *FAST User's Guide*, NREL/EL-500-38230, 2005).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..blade import Blade, straight
from ..effects import ALL_EFFECTS
from ..element.mesh import Mesh
from ..space import spatial as sp
from ..tree import pencil

Array = NDArray[np.float64]

FINE = 4096
"""Number of intervals by which curvatures are integrated."""


Field = Callable[[Array], tuple[Array, Array]]
"""Displacements and rotations (k, n, 3) of k shapes at arc lengths (n,), in the axes of the beam without twist."""


@dataclass(frozen=True)
class Curvatures:
    """The curvatures of k shapes at m stations, linear between them.

    Attributes:
        stations: (m,) arc lengths, m, from the root to the tip.
        flapwise: (k, m) second derivative of the flapwise deflection, 1/m².
        edgewise: (k, m) that of the edgewise deflection; flapwise is z and edgewise y of the section's axes.
    """

    stations: Array
    flapwise: Array
    edgewise: Array


@dataclass(frozen=True)
class Assumed:
    """Shapes to which parts of a turbine are restricted; a part without them is free.

    Attributes:
        tower: of the tower; with none at all, only the yaw bearing moves.
        blade: of each blade.
    """

    tower: Field | None = None
    blade: Field | None = None


def motions(assumed: Assumed | None, *parts: tuple[Blade, Mesh]) -> tuple[Array | None, ...]:
    """(k, dn) rates of strains of each of tower and blade that has assumed shapes."""
    shape_sets = (assumed.tower, assumed.blade) if assumed else (None, None)
    return tuple(
        None if shapes is None else restricted_motions(beam, mesh, shapes)
        for shapes, (beam, mesh) in zip(shape_sets, parts, strict=True)
    )


def restricted_motions(beam: Blade, mesh: Mesh, shapes: Field) -> Array:
    """(k, dn) the shapes as rates (η, β) of the mesh's elements, and one motion of each joint that is not rigid.

    Raises:
        ValueError: the beam is curved.
    """
    if not straight(beam):
        raise ValueError(f"{beam.name}: a curved beam: assumed shapes are those of straight ones")
    p = pencil.linearize(mesh, pencil.undeformed(mesh), 0.0, np.zeros(3), ALL_EFFECTS)
    n, d = len(mesh.parent), p.M.shape[1] - 6
    axes = mesh.nodes[:, :3, :3]
    base = axes[0] @ sp.rotation(0, np.array(float(beam.twist[0]))).T
    along = ((mesh.nodes[:, :3, 3] - mesh.nodes[0, :3, 3]) @ base)[:, 0]
    displaced, rotations = shapes(along)
    local = base.T @ axes
    twists = np.concatenate([np.einsum("nji,knj->kni", local, part) for part in (displaced, rotations)], axis=-1)
    to_parent = np.linalg.inv(p.links.to_child)
    rho = np.einsum("nij,knj->kni", to_parent, twists[:, 1:]) - twists[:, mesh.parent]
    out = np.zeros((len(rho), n, d))
    inverse = sp.tangent_inverse(sp.log(mesh.between @ mesh.corner))
    out[..., :6] = np.einsum("nij,knj->kni", inverse, rho)
    if d > 6:
        load = np.einsum("nij,knj->kni", p.K[:, 12:, 6:12], rho)
        out[..., 6:] = -np.linalg.solve(p.K[:, 12:, 12:], load[..., None])[..., 0]
    free = [joint for joint in mesh.joints if joint.screw.any()]
    turning = np.zeros((len(free), n, d))
    for joint in mesh.joints:
        out[:, joint.link] = 0.0
    for row, joint in zip(turning, free, strict=True):
        row[joint.link, :6] = joint.screw
    return np.concatenate([out, turning]).reshape(-1, n * d)


def bending(beam: Blade, shapes: Curvatures) -> Field:
    """The field of shapes given by curvatures, which are integrated twice."""

    def field(at: Array) -> tuple[Array, Array]:
        return _integrated(beam, shapes, at)

    return field


def _integrated(beam: Blade, shapes: Curvatures, at: Array) -> tuple[Array, Array]:
    s = np.linspace(0.0, beam.length, FINE + 1)
    middle = 0.5 * (s[1:] + s[:-1])
    twist = np.interp(middle, beam.stations, beam.twist)
    flap, edge = (
        np.array([np.interp(middle, shapes.stations, row) for row in rows]).reshape(-1, FINE)
        for rows in (shapes.flapwise, shapes.edgewise)
    )
    c, sine = np.cos(twist), np.sin(twist)
    bending = np.stack([edge * c - flap * sine, edge * sine + flap * c], axis=-1)  # of y and z
    step = beam.length / FINE
    zero = np.zeros((len(flap), 1, 2))
    slope = np.concatenate([zero, np.cumsum(bending, axis=1) * step], axis=1)
    deflection = np.concatenate([zero, np.cumsum(0.5 * (slope[:, 1:] + slope[:, :-1]), axis=1) * step], axis=1)
    slope, deflection = (_at(at, s, part) for part in (slope, deflection))
    zeros = np.zeros((*slope.shape[:2], 1))
    return (
        np.concatenate([zeros, deflection], axis=-1),
        np.concatenate([zeros, -slope[..., 1:], slope[..., :1]], axis=-1),
    )


def _at(at: Array, s: Array, values: Array) -> Array:
    """(k, n, 2) values (k, m, 2) at ``s`` (m,), linear between."""
    return (
        np.array([[np.interp(at, s, column) for column in row.T] for row in values])
        .reshape(-1, 2, len(at))
        .swapaxes(1, 2)
    )
