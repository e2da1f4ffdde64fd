"""A body of an htc as a line of sections with masses at its nodes: its inertia, and its compliance.

Sections follow the straight lines between the points of c2_def, with their x and y axes next to those of the body, turned by
c2_def's twist. A ``concentrated_mass`` is a node, the place of the mass centre from there, a mass, and moments of inertia about
the mass centre, all in the body's axes: the nacelle of the DTU 10 MW turbine has 4.106e6 kg m² about its vertical axis in
HAWC2, and 446,040 kg at 2.687 m; DTU's file for ElastoDyn has the sum, 7.326e6 kg m² about the yaw axis. Source: T. J. Larsen,
A. M. Hansen, *How 2 HAWC2, the user's manual*, Risø-R-1597, ch. 6.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .....core.blade import TORSION
from .....core.mechanism.description import inertia
from .....core.space import spatial as sp
from .....core.space.inertia import transformed
from ...errors import CaseError
from ..matrices import between
from ..source import Unused, unused
from ..text import Text, load, number
from . import blade, bodies, c2_def

Array = NDArray[np.float64]

GAUSS = 8
"""Gauss points of each interval between stations and nodes."""

EVEN = 1e-9
"""Largest relative difference of the sections of a uniform body."""


@dataclass(frozen=True)
class Mass:
    """A concentrated mass: its node, from 0, and inertia (6, 6) at the body's origin, in the body's axes."""

    node: int
    inertia: Array


@dataclass(frozen=True)
class Line:
    """A body.

    Attributes:
        name: of the body.
        file: its structural file.
        nodes: (n, 3) points of c2_def, m.
        arc: (q,) arc lengths of integration points, m.
        at: (q, 4, 4) poses of the sections there, in the body's axes.
        weights: (q,) of the integral along the line, m.
        stiffness, mass: (q, 6, 6) of the sections.
        masses: the concentrated masses.
        unused: quantities of the body that are not used.
    """

    name: str
    file: Path
    nodes: Array
    arc: Array
    at: Array
    weights: Array
    stiffness: Array
    mass: Array
    masses: tuple[Mass, ...]
    unused: tuple[Unused, ...]

    @property
    def length(self) -> float:
        """Of the line, m."""
        return float(self.weights.sum())

    @property
    def end(self) -> Array:
        """(3,) the last node, m."""
        return np.asarray(self.nodes[-1])

    def inertia(self, beyond_root: bool = False) -> Array:
        """(6, 6) of the sections and masses at the body's origin; ``beyond_root`` leaves out masses at the first node."""
        out = np.einsum("q,qij->ij", self.weights, transformed(self.mass, self.at))
        return out + sum((m.inertia for m in self.masses if m.node or not beyond_root), np.zeros((6, 6)))

    def compliance(self, torsion: bool = True) -> Array:
        """(6, 6) twist of the end from the wrench there, both about the body's origin, with or without torsion."""
        flexibility = np.linalg.inv(self.stiffness)
        if not torsion:
            flexibility[:, TORSION] = flexibility[:, :, TORSION] = 0.0
        move = sp.adjoint(self.at)
        return np.einsum("q,qij,qjk,qlk->il", self.weights, move, flexibility, move)

    def twisting(self) -> Array:
        """(q,) torsional flexibility of the sections, 1/(N m²)."""
        return np.asarray(np.linalg.inv(self.stiffness)[:, TORSION, TORSION], float)


def line(htc: Text, name: str, body: bodies.Body) -> Line:
    """Read a body.

    Raises:
        CaseError: naming the file and line at fault.
    """
    file, subset = bodies.properties(htc, body)
    r, stiffness, mass = blade.sections(load(file), subset)
    points = c2_def.points(body)
    if np.diff(points[:, 2]).min() < 0 and any(np.abs(mass[:, i, j]).any() for i, j in ((0, 4), (0, 5), (4, 5))):
        raise CaseError(
            f"{file}: x_cg, y_cg, pitch: not zero on {name}, which points along −z: their directions are ambiguous; set "
            "them to zero"
        )
    if np.abs(points[0, :3]).max() > EVEN * np.abs(points[:, :3]).max():
        raise CaseError(f"{c2_def.sections(body)[0].at}: sec: {name} does not begin at 0, 0, 0, which is not supported")
    steps = np.linalg.norm(np.diff(points[:, :3], axis=0), axis=1)
    if steps.min() <= 0:
        k = int(steps.argmin()) + 1
        raise CaseError(
            f"{c2_def.sections(body)[k].at}: sec: at the position of the previous section: remove one of them"
        )
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    uniform = all(np.abs(m - m[:1]).max() <= EVEN * np.abs(m).max() for m in (stiffness, mass))
    if abs(r[-1] - arc[-1]) <= c2_def.LENGTHS * arc[-1]:
        r = r * (arc[-1] / r[-1])
    elif not uniform:
        raise CaseError(
            f"{file}: r: from {r[0]:g} to {r[-1]:g} m: c2_def of {name} is {arc[-1]:g} m long: make the lengths equal"
        )
    grid = np.unique(np.concatenate([arc, r[(r > 0) & (r < arc[-1])]]))
    x, w = np.polynomial.legendre.leggauss(GAUSS)
    half_length = 0.5 * np.diff(grid)[:, None]
    s = (0.5 * (grid[1:] + grid[:-1])[:, None] + half_length * x).ravel()
    at = sp.pose(_axes(points, arc, s), np.stack([np.interp(s, arc, column) for column in points[:, :3].T], axis=-1))
    masses, products = _masses(body, points[:, :3])
    return Line(
        name,
        file,
        points[:, :3],
        s,
        at,
        (half_length * w).ravel(),
        between(r, stiffness, s),
        between(r, mass, s),
        masses,
        (*bodies.unused_quantities(body, masses=False), *products),
    )


def _axes(points: Array, arc: Array, s: Array) -> Array:
    """(q, 3, 3) axes of the sections at arc lengths (q,), in the body's."""
    k = np.clip(np.searchsorted(arc, s, side="right") - 1, 0, len(arc) - 2)
    directions = np.diff(points[:, :3], axis=0)[k]
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    sideways = np.eye(3)[np.where(np.abs(directions[:, 0]) < 0.9, 0, 1)]
    y = sideways - np.einsum("qi,qi->q", sideways, directions)[:, None] * directions
    y /= np.linalg.norm(y, axis=1)[:, None]
    axes = np.stack([directions, y, np.cross(directions, y)], axis=-1)
    return axes @ sp.rotation(0, np.radians(np.interp(s, arc, points[:, 3])))


def moved(inertia: Array, pose: Array) -> Array:
    """An inertia (6, 6) at another origin and in other axes, in which its own frame has the pose (4, 4)."""
    return np.asarray(transformed(np.ascontiguousarray(inertia), np.ascontiguousarray(pose)), float)


def _masses(body: bodies.Body, nodes: Array) -> tuple[tuple[Mass, ...], tuple[Unused, ...]]:
    """The concentrated masses of a body, and their products of inertia, which are not used."""
    out: list[Mass] = []
    not_used: list[Unused] = []
    for command in (c for c in body if c.words[0] == "concentrated_mass"):
        values = [number(word) for word in command.words[1:]]
        numbers = [v for v in values if v is not None and np.isfinite(v)]
        if len(numbers) < 8 or len(numbers) < len(values):
            raise CaseError(f"{command.at}: concentrated_mass: give node, x, y, z, mass and three moments of inertia")
        node = int(numbers[0]) - 1
        if node + 1 != numbers[0] or not 0 <= node < len(nodes):
            raise CaseError(f"{command.at}: concentrated_mass: node {numbers[0]:g}: the body has {len(nodes)} nodes")
        if node and not _nodes_are_sections(body):
            raise CaseError(
                f"{command.at}: concentrated_mass: node {node + 1}: nodes are the sections of c2_def only with "
                "`node_distribution c2_def`: use it"
            )
        if min(numbers[4:8]) < 0:
            raise CaseError(f"{command.at}: concentrated_mass: a negative mass or moment of inertia: correct it")
        centre = nodes[node] + numbers[1:4]
        out.append(Mass(node, inertia(numbers[4], numbers[5:8], centre)))
        why = "products of inertia of a concentrated mass are not supported"
        not_used += unused("concentrated_mass", numbers[8:], "kg m²", command.text.path, why)
    return tuple(out), tuple(not_used)


def _nodes_are_sections(body: bodies.Body) -> bool:
    kinds = [c.words[1].lower() for c in body if c.words[0] == "node_distribution" and len(c.words) > 1]
    return not kinds or kinds[-1] == "c2_def"
