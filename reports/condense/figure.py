"""The figure of condensation: finite element model, sections, compressed model (Park et al. 2010, fig. 2).

Drawn from the data: the faces of the mesh; the sections and the frames tied to them; and the rigid bodies as boxes of
the same mass, inertia and position, shortened along the span to show the complex stiffness elements as springs.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...core.condense.segments import Segment
from ...core.space.inertia import about_centre
from ...references.solid.mesh import Bricks
from ..shared.style import COLOURS, INK, MUTED, house

Array = NDArray[np.float64]

BLUE, ORANGE = COLOURS[0], COLOURS[1]
AZIMUTH, ELEVATION = np.radians(-62.0), np.radians(31.0)
LIGHT = np.array([-0.3, -0.55, 0.8])
WIDTH, MARGIN, HEAD = 7.6, 0.15, 0.32  # inches
SHORTENED = 0.45
CUBE = np.array([(i, j, k) for i in (-0.5, 0.5) for j in (-0.5, 0.5) for k in (-0.5, 0.5)])
SIDES = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
COILS = 3


def stages(bricks: Bricks, cuts: NDArray[np.intp], segments: Sequence[Segment], root: Array, freedoms: int) -> Figure:
    """Draw the three stages.

    Args:
        bricks: the mesh.
        cuts: layers of corners along the span at which the mesh was cut into segments.
        segments: the condensed segments.
        root: (4, 4) pose of the first segment's frame a, in the mesh's axes.
        freedoms: number of degrees of freedom of the finite element model.
    """
    frames = [root]
    for s in segments:
        frames.append(frames[-1] @ s.undeformed)
    n = len(segments)
    titles = (
        f"Finite element model: {np.prod(bricks.counts)} hexahedra, {freedoms} degrees of freedom",
        f"{n + 1} sections, each tied to a frame",
        f"Compressed model: {n} rigid bodies, {n} complex stiffness elements, {6 * n} degrees of freedom",
    )
    seen = _project(bricks.corners)[0].reshape(-1, 2)
    low, high = seen.min(0) - 0.04 * np.ptp(seen[:, 1]), seen.max(0) + 0.04 * np.ptp(seen[:, 1])
    row = HEAD + (WIDTH - 2 * MARGIN) * (high - low)[1] / (high - low)[0]
    total = 3 * row + MARGIN
    with house():
        figure = Figure((WIDTH, total))
        for k, (title, draw) in enumerate(zip(titles, (_mesh, _sections, _compressed), strict=True)):
            bottom = (MARGIN + (2 - k) * row) / total
            axes = figure.add_axes((MARGIN / WIDTH, bottom, 1 - 2 * MARGIN / WIDTH, (row - HEAD) / total))
            axes.set_xlim(low[0], high[0])
            axes.set_ylim(low[1], high[1])
            axes.set_axis_off()
            draw(axes, bricks, cuts, segments, frames)
            figure.text(MARGIN / WIDTH, bottom + (row - 0.8 * HEAD) / total, title, weight="bold", size=10.0)
    return figure


def _mesh(axes: Axes, bricks: Bricks, *_: object) -> None:
    _faces(axes, _skin(bricks.corners), BLUE, 0.3)


def _sections(axes: Axes, bricks: Bricks, cuts: NDArray[np.intp], _: object, frames: Sequence[Array]) -> None:
    """Draw filled sections, thin lines for the blade's edges, and the axes of the frames."""
    outline = np.concatenate([bricks.corners[:, j, k][None] for j in (0, -1) for k in (0, -1)])
    axes.add_collection(LineCollection(list(_project(outline)[0]), colors=MUTED, linewidths=0.6))
    for c in sorted(cuts, key=lambda c: -_project(bricks.corners[c, 0, 0])[1]):
        ring = _project(_ring(bricks.corners[c]))[0]
        axes.add_collection(PolyCollection([ring], facecolors=[(*to_rgb(BLUE), 0.25)], edgecolors=BLUE, linewidths=0.9))
    size = 0.28 * np.ptp(bricks.corners[..., 1])
    for frame in frames:
        ends = np.stack([np.stack([frame[:3, 3], frame[:3, 3] + size * frame[:3, k]]) for k in (1, 2)])
        axes.add_collection(LineCollection(list(_project(ends)[0]), colors=INK, linewidths=0.8, zorder=3))
        axes.plot(*_project(frame[:3, 3])[0], "o", ms=2.6, color=INK, zorder=4)


def _compressed(axes: Axes, _: object, __: object, segments: Sequence[Segment], frames: Sequence[Array]) -> None:
    """Draw boxes from the farthest to the nearest, each with a spring, and frames as dots."""
    order = sorted(range(len(segments)), key=lambda k: -_project(frames[k][:3, 3])[1])
    for k in order:
        box = _box(segments[k].inertia) @ frames[k][:3, :3].T + frames[k][:3, 3]
        _faces(axes, box[SIDES], ORANGE, 0.5)
    for k, s in enumerate(segments):
        coil = _coil(s.undeformed[:3, 3]) @ frames[k][:3, :3].T + frames[k][:3, 3]
        axes.plot(*_project(coil)[0].T, color=INK, lw=0.9, zorder=3)
    for frame in frames:
        axes.plot(*_project(frame[:3, 3])[0], "o", ms=3.4, mfc="white", mec=INK, mew=0.9, zorder=4)


def _box(inertia: Array) -> Array:
    """(8, 3) corners of the cuboid with this inertia, in its frame: a² = 6 (I_b + I_c − I_a)/m, and so on."""
    mass, centre, tensor = about_centre(inertia)
    moments, axes = np.linalg.eigh(tensor)
    sides = np.sqrt(6.0 * np.maximum(moments.sum() - 2.0 * moments, 0.0) / mass)
    sides[np.abs(axes[0]).argmax()] *= SHORTENED
    return centre + (CUBE * sides) @ axes.T


def _coil(to: Array) -> Array:
    """(n, 3) points of a zigzag from the origin to a point, in the plane across the line of sight."""
    t = np.concatenate([[0.0, 0.2], np.linspace(0.2, 0.8, 2 * COILS + 1)[1:-1] - 0.3 / COILS, [0.8, 1.0]])
    side = np.zeros_like(t)
    side[2:-2] = np.where(np.arange(len(t) - 4) % 2, 1.0, -1.0)
    across = np.cross(_basis()[2], to)
    return t[:, None] * to + 0.16 * side[:, None] * across


def _skin(corners: Array) -> Array:
    """(f, 4, 3) outer faces of a block."""
    faces = []
    for axis in range(3):
        for side in (0, -1):
            c = np.take(corners, side, axis=axis)
            faces.append(np.stack([c[:-1, :-1], c[1:, :-1], c[1:, 1:], c[:-1, 1:]], axis=2).reshape(-1, 4, 3))
    return np.concatenate(faces)


def _ring(layer: Array) -> Array:
    """(k, 3) corners around a section (ny+1, nz+1, 3)."""
    return np.concatenate([layer[:-1, 0], layer[-1, :-1], layer[:0:-1, -1], layer[0, :0:-1]])


def _faces(axes: Axes, faces: Array, colour: str, width: float) -> None:
    """Draw quadrilaterals (f, 4, 3), lit from above, the farthest first."""
    flat, depth = _project(faces)
    order = np.argsort(-depth.mean(axis=1))
    normal = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    towards = np.where((normal @ _basis()[2])[:, None] < 0, normal, -normal)
    bright = 0.45 + 0.55 * np.clip(towards @ (LIGHT / np.linalg.norm(LIGHT)), 0.0, 1.0)
    colours = bright[:, None] * (1.0 - 0.75 * (1.0 - np.array(to_rgb(colour))))
    axes.add_collection(PolyCollection(list(flat[order]), facecolors=colours[order], edgecolors=INK, linewidths=width))


def _basis() -> Array:
    """(3, 3) rows: the directions to the right, upwards, and into the picture."""
    ca, sa, ce, se = np.cos(AZIMUTH), np.sin(AZIMUTH), np.cos(ELEVATION), np.sin(ELEVATION)
    return np.array([[-sa, ca, 0.0], [-se * ca, -se * sa, ce], [-ce * ca, -ce * sa, -se]])


def _project(points: Array) -> tuple[Array, Array]:
    """Parallel projection of points (…, 3): positions (…, 2) in the picture and depths (…)."""
    projected = points @ _basis().T
    return projected[..., :2], projected[..., 2]
