"""A blade as HAWC2's elements take it: prismatic beams between the sections of c2_def, along the elastic centres.

HAWC2 averages each column of the structural file by itself over an element: E and I_x, not their product. The averaged mass
per length is the one with the same first moment about the root. These rules reproduce the elements that HAWC2 12.8 lists
for the DTU 10 MW blade (profhansen/CASEToolBox 7ee2e7c9, HAWC2_beam_dtu10mw.dat): the stiffness to 2e-5, the mass to 1e-3.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .....core.blade import Blade
from ..source import Mount
from ..text import Table
from . import c2_def
from .blade import contents, mass_of, stiffness_of

Array = NDArray[np.float64]

STEP = 2e-6
"""Distance behind a node at which the next element's properties begin, as a fraction of the blade's length."""


def with_elements(blade: Blade, path: Path, mount: Mount) -> Blade | None:
    """The blade that was read from ``path``, made of HAWC2's elements; None if no htc with c2_def belongs to the file.

    Raises:
        CaseError: as ``blade.read``.
    """
    columns, body, _, _ = contents(path, mount)
    if body is None:
        return None
    c2 = c2_def.blade_points(body)
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(c2[:, :3], axis=0), axis=1))])
    r = arc * (columns["r"][-1] / arc[-1])
    averaged = _averaged(columns, r)
    x, y = (np.interp(r, columns["r"], columns[name]) for name in ("x_e", "y_e"))
    twist = np.radians(c2[:, 3])
    c, s = np.cos(twist), np.sin(twist)
    nodes = np.stack([c2[:, 2], c2[:, 0] + c * x - s * y, c2[:, 1] + s * x + c * y], axis=1)
    nodes = nodes - nodes[0]
    along = np.diff(nodes, axis=0)
    ends = np.concatenate([[0.0], np.cumsum(np.linalg.norm(along, axis=1))])
    gap = STEP * ends[-1] * (np.arange(len(along)) > 0)
    element = np.repeat(np.arange(len(along)), 2)
    begin = nodes[:-1] + along * (gap / np.diff(ends))[:, None]
    return replace(
        blade,
        stations=np.stack([ends[:-1] + gap, ends[1:]], axis=1).ravel(),
        stiffness=stiffness_of(averaged)[element],
        mass=mass_of(averaged)[element],
        twist=(0.5 * (twist[1:] + twist[:-1]))[element],
        curve=np.stack([begin, nodes[1:]], axis=1).reshape(-1, 3),
        kinks=tuple(ends[1:-1].tolist()),
    )


def _averaged(columns: Table, nodes: Array) -> Table:
    """The columns averaged between the nodes (m,), positions r in m, with offsets from the elastic centre."""
    r = columns["r"]
    s = np.union1d(r, nodes)
    parts = np.stack([s[:-1], 0.5 * (s[1:] + s[:-1]), s[1:]])
    weight = np.diff(s) * np.array([[1.0], [4.0], [1.0]]) / 6.0  # Simpson: exact for a product of two linear functions
    start = np.searchsorted(s, nodes[:-1])

    def integral(values: Array) -> Array:
        return np.add.reduceat((weight * values).sum(axis=0), start)

    averaged = {
        name: integral(np.interp(parts, r, values)) / np.diff(nodes) for name, values in columns.columns.items()
    }
    averaged["m"] = integral(parts * np.interp(parts, r, columns["m"])) / integral(parts)
    for name in ("x_cg", "x_sh", "y_cg", "y_sh"):
        if name in averaged:
            averaged[name] = averaged[name] - averaged[f"{name[0]}_e"]
    zero = np.zeros(len(nodes) - 1)
    return Table(columns.text, averaged | {"x_e": zero, "y_e": zero}, columns.lines[:1] * len(zero))
