"""Motion of a turbine at common points: at the stations of its tower and of each blade, at the instant of azimuth 0.

Displacements of the tower are in the ground's axes, those of blade k in the axes of the hub turned by 2πk/N, in which its
undeformed line is that of blade 0. They are total motions: those of a blade include the hub's. At one instant they do not
depend on the frame in which the machine was linearised, so that codes with other coordinates can be compared.
"""

import numpy as np
from numpy.typing import NDArray

from ..blade import Blade
from ..element.mesh import Mesh
from ..modes import STATIONS
from ..rotor import multiblade
from ..sampling import mass_at
from ..space import spatial as sp
from ..tree.links import Links, twists
from ..tree.mode_shapes import mode_shapes
from ..tree.pencil import Shape
from .assembly import Assembled
from .component import Component
from .rotor import RZ, turned_axes
from .turbine import Turbine

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

COLUMNS = ("x", "y", "z", "rotation")
"""Displacements, and the rotation about x."""


def elastic(component: Component, mesh: Mesh, shape: Shape, links: Links) -> NDArray[np.complex128]:
    """(r, 21, 4) displacement and rotation about x at the stations in each elastic motion, relative to node 0."""
    nodes = twists(links, component.vectors)
    rows = np.stack([nodes, np.zeros_like(nodes)], axis=1).reshape(-1, *nodes.shape[1:])
    return mode_shapes(mesh, shape, rows)


def motions(turbine: Turbine, a: Assembled, vectors: Complex) -> Complex:
    """(m, 21 (1 + N), 4) motion of tower and blades in the modes ``vectors`` (n, m) of the assembled turbine."""
    t, n = a.tower.size, len(a.blades)
    tower = elastic(a.tower, a.meshes[0], a.shapes[0], a.tower_links)
    blade = elastic(a.blade, a.meshes[1], a.shapes[1], a.blade_links)
    hub = sp.adjoint(sp.inverse(turbine.shaft)) @ a.tower.tip @ vectors[:t]
    if a.shaft:
        hub = hub + np.outer(RZ, vectors[a.shaft[0]])
    T = multiblade.transformation(0.0, n)
    at = positions(turbine.blade)
    out = [np.einsum("xsc,xm->msc", tower, vectors[:t])]
    for k in range(n):
        q = np.einsum("j,jrm->rm", T[k], vectors[a.blades])
        root = turned_axes(2.0 * np.pi * k / n)[0] @ hub
        carried = root[:3].T[:, None] + np.cross(root[3:].T[:, None], at[None])
        rigid = np.concatenate([carried, np.broadcast_to(root[3][:, None, None], (*carried.shape[:2], 1))], axis=2)
        out.append(np.einsum("xsc,xm->msc", blade, q) + rigid)
    return np.concatenate(out, axis=1)


def positions(blade: Blade) -> Array:
    """(21, 3) positions of the undeformed blade's stations in the hub's axes, m; straight between the given ones."""
    s = STATIONS * blade.length
    line = np.stack([np.interp(s, blade.stations, blade.curve[:, c]) for c in range(3)], axis=-1)
    cone, pitch = sp.rotation(1, np.array(-blade.precone)), sp.rotation(0, np.array(blade.pitch))
    return (line + np.array([blade.hub_radius, 0.0, 0.0])) @ (cone @ pitch).T


def weights(turbine: Turbine) -> Array:
    """(21 (1 + N), 4, 4) mass, kg, and moment of inertia about x, kg m², that belongs to each station."""
    tower, blade = _lumps(turbine.tower), _lumps(turbine.blade)
    tower[-1] += [*[turbine.nacelle[0, 0]] * 3, turbine.nacelle[3, 3]]
    if turbine.support.mass is not None:
        tower[0] += np.diagonal(turbine.support.mass)[:4]
    return np.array([np.diag(row) for row in (*tower, *np.tile(blade, (turbine.blades, 1)))])


def _lumps(beam: Blade) -> Array:
    """(21, 4) mass three times and moment of inertia about x of the part of a beam that is nearest to each station."""
    spacing = np.gradient(STATIONS) * beam.length * np.where((STATIONS == 0.0) | (STATIONS == 1.0), 0.5, 1.0)
    mass = mass_at(beam, STATIONS * beam.length)
    out = np.stack([mass[:, 0, 0]] * 3 + [mass[:, 3, 3]], axis=-1) * spacing[:, None]
    out[-1] += [*[beam.tip_mass[0, 0]] * 3, beam.tip_mass[3, 3]]
    return out
