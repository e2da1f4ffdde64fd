"""Bending frequencies of a free steel shaft: length 300 mm, diameters 30.08 and 7 mm (petrobras/ross issue 885)."""

from itertools import pairwise
from math import pi

from southwell import multibody as mb

LENGTH, OUTER, INNER = 0.3, 30.08e-3, 7e-3  # m
E, G, DENSITY = 210e9, 80.76923e9, 7850.0  # N/m², N/m², kg/m³
SHEAR = 0.784  # shear factor

AREA = pi / 4 * (OUTER**2 - INNER**2)
INERTIA = pi / 64 * (OUTER**4 - INNER**4)


def free_shaft(elements: int = 12) -> mb.Mechanism:
    """A chain of equal beams whose first end is free."""
    nodes = [f"node{k}" for k in range(elements + 1)]
    h = LENGTH / elements
    links = list(pairwise(nodes))
    section = {"EA": E * AREA, "GJ": 2 * G * INERTIA, "EI_y": E * INERTIA, "EI_z": E * INERTIA}
    section |= {"GA_y": SHEAR * G * AREA, "GA_z": SHEAR * G * AREA}
    section |= {"mass": DENSITY * AREA, "I_y": DENSITY * INERTIA, "I_z": DENSITY * INERTIA}
    return mb.Mechanism(
        bodies=tuple(mb.Body(node) for node in nodes),
        joints=(
            mb.Joint("end", "free", "ground", nodes[0]),
            *(mb.Joint(f"to {b}", "elastic", a, b, mb.at(x=h)) for a, b in links),
        ),
        beams=tuple(mb.Beam(a, b, mb.straight_beam(h, **section)) for a, b in links),
    )


if __name__ == "__main__":
    for frequency in mb.solve(free_shaft()).frequencies[6:10]:  # after six rigid motions; each bending frequency twice
        print(f"{frequency:.1f} rad/s, {frequency / (2 * pi):.1f} Hz")
