"""Writes the case ``curved-solid``: the beam of a curved solid, with sections identified from the solid.

``python -m southwell.tests.support.curved_solid`` writes it again; the numbers of the file come from there only.
"""

import sys
from pathlib import Path

import numpy as np

from southwell.cases import data
from southwell.cases.input import atomic
from southwell.cases.input.readers import southwell_toml
from southwell.core.blade import Blade
from southwell.references.solid import identified
from southwell.references.solid.curved import CurvedSolid
from southwell.references.solid.known import ACROSS, CURVED

STATIONS = 41

SPEEDS = (0.0, 5.0, 10.0)
"""rad/s: the last is above the first frequency at rest."""

MODES = 6

TEXT = '''name = "{name}"
title = "A curved, twisted solid blade with off-axis fibres, as a beam"
description = """
A solid blade of glass fibre, sixty chords long: swept, prebent, twisted and tapered, with fibres at 20° to its axis, so that
bending and torsion couple. The 6×6 sections of the beam are identified from slices of the same solid; scikit-fem-solid solves
the whole solid in three dimensions, which reads no sections. The difference between the two is that of beam theory. It grows
with the square of chord over wavelength, and is within the target for the modes compared. The root of the solid is held by St
Venant's tractions, which leave its section free to warp and contract; the numbers are written by
southwell.tests.support.curved_solid.
"""
source = "computed by tests/support/curved_solid.py; method: V. Giavotto et al., Computers and Structures 16 (1983) 403"

[speeds]
rad_s = [{speeds}]

[compare]
modes = {modes}
groups = 2
'''


def beam(solid: CurvedSolid, stations: int = STATIONS) -> Blade:
    """The solid as a beam; see ``identified``.

    Raises:
        ModuleNotFoundError: without scikit-fem.
    """
    s = np.linspace(0.0, solid.length, stations).round(12)
    return Blade(
        name=solid.name,
        stations=s,
        stiffness=identified.stiffness(solid, s, ACROSS),
        mass=identified.mass(solid, s),
        twist=solid.twisted(s),
        curve=solid.curve(s),
        hub_radius=solid.hub_radius,
    )


def head(solid: CurvedSolid) -> str:
    """All of a solid's case but the table ``blade``."""
    return TEXT.format(name=solid.name, speeds=", ".join(map(str, SPEEDS)), modes=MODES)


def write(solid: CurvedSolid, path: Path) -> None:
    """Write the case of a solid as TOML."""
    southwell_toml.write(beam(solid), path)
    _, _, blade = path.read_text(encoding="utf-8").partition("\n\n")
    atomic.write(path, f"{head(solid)}\n{blade}")


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(next(iter(data.__path__))) / f"{CURVED.name}.toml"
    write(CURVED, target)
