"""Solids for the examples of condensation: the paper's cantilever, a flat bar, and a tapered, twisted blade of steel."""

from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from southwell.core.condense import condensation, ties
from southwell.core.condense.segments import Segment
from southwell.core.space import spatial as sp
from southwell.references.solid import hexahedra
from southwell.references.solid.materials import Material
from southwell.references.solid.mesh import Bricks, straight_bricks
from southwell.tests.support.solid_sections import lumped, lumped_by_part

Array = NDArray[np.float64]
Index = NDArray[np.intp]

E, RHO, A, I = 7e10, 3000.0, 4e-4, 2e-7
"""The paper's cantilever (``park-cantilever``): Pa, kg/m³, m², m⁴."""

SIDE = np.sqrt(12 * I / A)
SQUARE = Material(E * A / SIDE**2, 0.3, RHO * A / SIDE**2)
"""A square section of this side and material has the EA, EI, mass and rotary inertia of the paper's cantilever."""

LENGTH, HUB = 6.0, 0.3

STEEL = Material(2.1e11, 0.3, 7850.0)
ROOT, SPAN, SEGMENTS = 0.3, 1.0, 20
SPEED = 100.0
"""rad/s: the tapered, twisted blade's first frequency rises by a third."""

LAYERS, ACROSS = 40, (6, 2)
"""Elements of the tapered, twisted blade: along the span, along the chord and through the thickness."""

CHORD, THICK, LAYER = 0.08, 0.02, 0.01
"""A flat bar of the cantilever's material, and how long its elements are, m."""


def at(x: float) -> Array:
    """Pose of a frame at x on the axis, parallel to the blade's axes."""
    return sp.pose(np.eye(3), np.array([x, 0.0, 0.0]))


def square_bar(length: float, layers: int, across: int = 2, start: float = 0.0) -> Bricks:
    """A piece of the paper's cantilever as a solid."""
    return straight_bricks(np.linspace(start, start + length, layers + 1), SIDE, SIDE, across=(across, across))


def cantilever_segment(kind: ties.Kind, count: int = SEGMENTS) -> Segment:
    """A segment of the paper's cantilever, condensed alone; all segments are equal."""
    length = LENGTH / count
    model = finite_elements(square_bar(length, 4), SQUARE)
    return condensation.segment(model, *(ties.section(model, at(x), f"{x:g} m", kind) for x in (0.0, length)))


def finite_elements(bricks: Bricks, material: Material, name: str = "solid") -> ties.FiniteElements:
    """A block as a model for condensation."""
    solid = hexahedra.solid(bricks, material)
    return ties.FiniteElements(name, *hexahedra.freedoms(solid), hexahedra.tangent(solid), lumped(solid))


@cache
def twisted(layers: int = LAYERS, across: tuple[int, int] = ACROSS) -> Bricks:
    """A blade of 1 m, its chord 160 → 80 mm, thickness 24 → 8 mm at mid-chord and 0.4 of it at the edges, twist 30° → 0."""
    x = np.linspace(ROOT, ROOT + SPAN, layers + 1)
    t = (x - ROOT) / SPAN
    return straight_bricks(x, 0.16 - 0.08 * t, 0.024 - 0.016 * t, np.radians(30.0) * (1 - t), across=across, edge=0.4)


def cuts(bricks: Bricks, segments: int = SEGMENTS) -> Index:
    """Layers of corners between the twisted blade's segments."""
    return np.arange(segments + 1) * bricks.counts[0] // segments


def segments_in_place(model: ties.FiniteElements, bricks: Bricks, segments: int = SEGMENTS) -> list[Segment]:
    """The twisted blade's segments, condensed in place from the model of the whole; rigid at the root, else average."""
    layers = cuts(bricks, segments)
    frames = [at(x) for x in bricks.corners[layers, 0, 0, 0]]
    root = ties.section(model, frames[0], "root", "rigid")
    tied = [root, *(ties.section(model, f, f"{f[0, 3]:g} m") for f in frames[1:])]
    return condensation.segments_in_place(model, tied, lumped_by_part(bricks, STEEL, layers))


def segments_apart(kind: ties.Kind, bricks: Bricks, segments: int = SEGMENTS) -> list[Segment]:
    """The same segments, each condensed alone with both ends tied."""
    out = []
    for k, (a, b) in enumerate(pairwise(cuts(bricks, segments))):
        part = bricks.part(a, b)
        model = finite_elements(part, STEEL, f"segment {k}")
        ends = (ties.section(model, at(x), f"{x:g} m", kind) for x in part.corners[[0, -1], 0, 0, 0])
        out.append(condensation.segment(model, *ends))
    return out


def st_venant() -> float:
    """G J (N m²) of the flat bar: J = c t³/3 (1 − 192 t/(π⁵ c) Σ tanh(nπc/2t)/n⁵), n odd.

    S. P. Timoshenko and J. N. Goodier, *Theory of Elasticity*, 3rd ed. 1970, art. 109.
    """
    n = np.arange(1, 60, 2)
    series = np.sum(np.tanh(n * np.pi * CHORD / (2 * THICK)) / n**5.0)
    return SQUARE.lame[1] * CHORD * THICK**3 / 3 * (1 - 192 / np.pi**5 * THICK / CHORD * series)


def torsion(length: float, kind: ties.Kind | None) -> float:
    """G J that a piece of the flat bar shows, relative to St Venant's; ``None``: in place, between neighbours of one chord."""
    layers = round(length / LAYER)
    margin = 0 if kind else round(CHORD / LAYER)
    x = np.linspace(-margin * LAYER, (layers + margin) * LAYER, layers + 2 * margin + 1)
    bricks = straight_bricks(x, CHORD, THICK, across=(6, 2))
    model = finite_elements(bricks, SQUARE)
    places = (0.0, length) if kind else (x[0], 0.0, length, x[-1])
    tied = [ties.section(model, at(v), f"{v:g} m", kind or "average") for v in places]
    if kind:
        piece = condensation.segment(model, *tied)
    else:
        bounds = np.array([0, margin, margin + layers, 2 * margin + layers])
        piece = condensation.segments_in_place(model, tied, lumped_by_part(bricks, SQUARE, bounds))[1]
    return float(length / np.linalg.inv(piece.stiffness)[3, 3] / st_venant())
