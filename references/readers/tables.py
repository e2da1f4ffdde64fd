"""Southwell's CSV of stations, read by pandas.

``EI_flap`` resists bending about the section's y, ``EI_edge`` about z; ``I_flap`` and ``I_edge`` are moments of inertia about
the same axes through the mass centre, which lies ``cg_edge`` ahead of the axis, along y. Twist turns y towards z.
"""

from pathlib import Path
from typing import Any

import numpy as np

from . import sections
from .stations import NotReadError, ReadingOptions, Stations, parser, straight


def read(path: Path, options: ReadingOptions) -> Stations:
    """The stations of a CSV; ``options.length`` is the blade's.

    Raises:
        NotReadError: without a length.
    """

    def imported() -> Any:
        import pandas

        return pandas

    pandas, reader = parser("pandas", imported)
    if options.length is None:
        raise NotReadError("no length: its stations are fractions of it")
    table = pandas.read_csv(path, comment="#", skipinitialspace=True)
    columns = {name.split(" ")[0]: table[name].to_numpy(float) for name in table.columns}
    n = len(table)
    zeros, rigid = np.zeros(n), np.full(n, np.inf)
    s = columns["fraction"] * options.length
    by_mass, by_flap, by_edge = options.multipliers or (1.0, 1.0, 1.0)
    stiffness = np.zeros((n, 6, 6))
    values = (
        columns.get("EA", rigid),
        rigid,
        rigid,
        columns.get("GJ", rigid),
        by_flap * columns["EI_flap"],
        by_edge * columns["EI_edge"],
    )
    stiffness[:, range(6), range(6)] = sections.diagonal(*values)
    m, about_y, about_z = (by_mass * columns.get(name, zeros) for name in ("mass", "I_flap", "I_edge"))
    ahead = columns.get("cg_edge", zeros) * options.offsets
    mass = sections.mass(m, ahead, 0.0, about_z + m * ahead**2, about_y)
    return Stations(reader, s, stiffness, mass, np.radians(columns["twist"]), straight(s))
