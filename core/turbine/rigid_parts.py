"""How much lower the frequencies of a turbine are if parts that it takes as rigid are flexible: to first order, at rest.

A mode of unit modal mass with the frequency ω moves what a part carries with the momentum p, so that the part transmits the
wrench ω² p. Its compliance C stores the energy ω⁴ pᵀ C p / 2, where the mode has ω² / 2: the frequency is lower by the fraction
ω² pᵀ C p / 2 (Rayleigh's quotient in terms of forces; the flexible part adds to the flexibility of the whole). The moments of
the weight, which the part transmits too, are left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from ..rotor import multiblade
from ..space import spatial as sp
from .assembly import assemble
from .machine import Machine
from .rotor import RZ, rotor, turned_axes

Array = NDArray[np.float64]

MODES = 12
"""Number of modes, from the lowest."""


@dataclass(frozen=True)
class RigidPart:
    """A part that a turbine takes as rigid.

    Attributes:
        name: for messages.
        carries: what moves at its end: all on the tower, the rotor, or one blade (a part of each blade).
        compliance: (6, 6) twist of its end due to the wrench there, in the frame of the tower's top, of the hub's centre, or of
            the hub turned to the blade.
        nacelle: (6, 6) inertia of what it carries besides the rotor, at the tower's top, if it carries all.
    """

    name: str
    carries: Literal["all", "rotor", "blade"]
    compliance: Array
    nacelle: Array = field(default_factory=lambda: np.zeros((6, 6)))


def lowering(machine: Machine, parts: Sequence[RigidPart]) -> Array:
    """(p, m) fractions by which the flexibility of each part would lower the ``MODES`` lowest frequencies at rest."""
    a = assemble(machine, 0.0)
    values, vectors = eigh(0.5 * (a.K + a.K.T), a.M)
    turbine, t, r = machine.turbine, machine.tower.size, a.blade.size
    drive = turbine.drivetrain
    first = 1 if drive.free else 0  # without the rotor that turns freely
    squared, x = values[first : first + MODES], vectors[:, first : first + MODES]
    top, hub, z = machine.tower.tip @ x[:t], a.hub @ x, x[a.blades.ravel()]
    of_rotor = rotor(turbine, a.blade, 0.0, 0.0)[0][-6:] @ np.concatenate([z, hub])
    to_shaft = sp.adjoint(sp.inverse(turbine.shaft))
    turns = to_shaft[5] @ top + (drive.gear_ratio * x[a.shaft[-1]] if drive.free else 0.0)
    of_generator = np.outer(RZ, drive.generator * turns)
    T, n = multiblade.transformation(0.0, turbine.blades), turbine.blades
    of_blades = []
    for k in range(n):
        coordinates = np.concatenate([np.kron(T[k], np.eye(r)) @ z, turned_axes(2.0 * np.pi * k / n)[0] @ hub])
        of_blades.append(a.blade.M[-6:] @ coordinates)
    out = []
    for part in parts:
        if part.carries == "all":
            momenta = [part.nacelle @ top + to_shaft.T @ (of_rotor + of_generator)]
        else:
            momenta = [of_rotor] if part.carries == "rotor" else of_blades
        energy = sum(np.einsum("im,ij,jm->m", p, part.compliance, p) for p in momenta)
        out.append(0.5 * squared * energy)
    return np.array(out).reshape(len(parts), len(squared))
