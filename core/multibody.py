"""Mechanisms built in Python: bodies, joints, motions and springs by name; ``solve`` finds the steady state and the modes.

A rigid blade of 40 kg on a lag hinge 0.3 m off the rotor's axis, with a damper across the hinge, at 30 rad/s::

    from southwell import multibody as mb

    blade = mb.Mechanism(
        bodies=(mb.Body("hub"), mb.Body("blade", mb.inertia(40.0, (0.1, 50.0, 50.0), centre=(2.0, 0, 0)))),
        joints=(
            mb.Joint("shaft", "revolute", "ground", "hub"),
            mb.Joint("lag", "revolute", "hub", "blade", mb.at(x=0.3)),
        ),
        motions=(mb.Motion("shaft.rz", rate=30.0),),
        coordinate_springs=(mb.CoordinateSpring("lag.rz", damping=600.0),),
    )
    solution = mb.solve(blade)
    solution.frequencies, solution.damping  # 10.14 rad/s, 0.141 of critical

Lengths in m, angles in rad, SI throughout. A joint's axis is the z axis of its frame (see ``at``); its coordinates are named
``joint.rz`` and so on (see ``mechanism.joints.SCREWS``). Joints that close loops are found automatically, or marked with
``cut=True``.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .blade import uniform_blade
from .element.beams import Beams, bushing
from .element.discretize import discretize
from .element.measures import LARGEST_STRAIN
from .mechanism.description import Beam, Body, CoordinateSpring, Load, Mechanism, MechanismError, Spring, inertia
from .mechanism.joints import Joint, at
from .mechanism.motion import Harmonic, Motion, Sum
from .rotor.equal_blades import EXACT, turning, whirling
from .spectrum.eigen import Damped, Eigen
from .spectrum.modal import Linearization, linearize, modes
from .spectrum.rounding import rounding
from .tree.strained import largest_strain

__all__ = [
    "Beam",
    "Body",
    "CoordinateSpring",
    "Harmonic",
    "Joint",
    "Load",
    "Mechanism",
    "MechanismError",
    "Motion",
    "Solution",
    "Spring",
    "Sum",
    "at",
    "bushing",
    "inertia",
    "solve",
    "straight_beam",
]

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Solution:
    """A mechanism's steady state and its modes.

    Attributes:
        values: (m,) complex eigenvalues λ, 1/s, by modulus: one of each conjugate pair, and real ones.
        shapes: (m, n) motion of all coordinates in each mode, the largest 1; zero where motion is prescribed.
        coordinates: names of the n coordinates.
        steady: their values in the steady state, m or rad, by name.
        independent: names of the independent coordinates; the others follow from them.
        redundant: redundant constraint equations, as ``joint: component``.
        linear: M̂, Ĉ, K̂ over the independent coordinates, with the steady state and the partition.
        eigenpairs: the modes over the independent coordinates, as returned by the eigenvalue solver.
    """

    values: Complex
    shapes: Complex
    coordinates: tuple[str, ...]
    steady: dict[str, float]
    independent: tuple[str, ...]
    redundant: tuple[str, ...]
    linear: Linearization
    eigenpairs: Eigen | Damped

    @cached_property
    def uncertainty(self) -> Array:
        """(m,) uncertainty due to rounding: relative for frequencies, absolute for damping ratios (see ``rounding``).

        Computed at the first access, which takes as long as the modes. For a rotor with equal blades, it is the largest
        variation with the azimuth that counts as none.
        """
        if turning(self.linear.tree.mechanism):
            return np.full(len(self.values), EXACT)
        return rounding(self.linear, self.eigenpairs)

    @property
    def strain(self) -> float:
        """Largest steady strain of a beam's reference line, axial or shear, mean over the beam."""
        return largest_strain(self.linear.tree, self.linear.state)

    @property
    def frequencies(self) -> Array:
        """(m,) undamped natural frequencies |λ|, rad/s, ascending; for a real eigenvalue, its modulus."""
        return np.abs(self.values)

    @property
    def damping(self) -> Array:
        """(m,) damping ratios −Re λ/|λ|: negative grows, ±1 does not oscillate; 0 for a rigid mode."""
        size = np.abs(self.values)
        return 0.0 - np.divide(self.values.real, size, out=np.zeros_like(size), where=size > 0)

    @property
    def leading(self) -> tuple[str, ...]:
        """For each mode, the independent coordinate with the largest fraction of the kinetic energy."""
        x = self.shapes[:, self.linear.partition.independent]
        energies = np.real(x.conj() * (x @ self.linear.M.T))
        return tuple(self.independent[row.argmax()] for row in energies)


def solve(
    mechanism: Mechanism,
    guess: Mapping[str, float] | None = None,
    *,
    count: int | None = None,
    independent: tuple[str, ...] | None = None,
    time: float = 0.0,
    allow_large_strain: bool = False,
) -> Solution:
    """Find the steady state of a mechanism and its modes about it.

    With ``equal_blades``, a rotor that turns on a support is solved in multi-blade coordinates: frequencies are in the ground's
    frame, and ``shapes`` are the motions at the azimuth 0.

    Args:
        mechanism: the mechanism.
        guess: coordinates to start from, by name; others start at 0.
        count: number of modes, from the lowest; all by default.
        independent: independent coordinates; chosen numerically if not given.
        time: instant of the frozen-time linearisation, s, for motions that follow laws of time (see ``linearize``).
        allow_large_strain: accept steady strains of beams above ``LARGEST_STRAIN``.

    Raises:
        MechanismError: the mechanism cannot be assembled, balanced or partitioned, is periodic, or has beams with large
            strains; the message gives the cause.
        EigenError: if the eigenvalue solver fails.
    """
    rotor = turning(mechanism)
    if rotor:
        linear, eigenpairs = whirling(mechanism, rotor, guess, count)
    else:
        linear = linearize(mechanism, guess, independent, time)
        eigenpairs = None
    strain = largest_strain(linear.tree, linear.state)
    if strain > LARGEST_STRAIN and not allow_large_strain:
        raise MechanismError(
            f"beams: steady strain {strain:.0%}: too large for linear elastic sections: loads or speeds are too high or a beam "
            "too soft; check units, or allow large strains"
        )
    eigenpairs = eigenpairs or modes(linear, count)
    values: Complex = np.asarray(
        eigenpairs.values if isinstance(eigenpairs, Damped) else 1j * eigenpairs.frequencies, np.complex128
    )
    tree, part = linear.tree, linear.partition
    shapes: Complex = np.zeros((len(values), len(tree.coordinates)), np.complex128)
    shapes[:, part.free] = (part.R @ eigenpairs.vectors).T
    if len(values):
        shapes /= shapes[np.arange(len(values)), np.abs(shapes).argmax(1)][:, None]
    return Solution(
        values=values,
        shapes=shapes,
        coordinates=tree.coordinates,
        steady=dict(zip(tree.coordinates, linear.state.q.tolist(), strict=True)),
        independent=linear.names,
        redundant=part.redundant,
        linear=linear,
        eigenpairs=eigenpairs,
    )


def straight_beam(length: float, **section: Any) -> Beams:
    """One uniform beam element along x, for a ``Beam``; ``section`` as for ``blade.uniform_blade``: EA, GJ, EI_y, EI_z, mass …

    Its mass is consistent, so its ends must move together in the steady state. Without ``mass`` it is massless.
    """
    massless = not section.get("mass")
    section["mass"] = section.get("mass") or 1.0
    mesh = discretize(uniform_blade("beam", length, 0.0, **section), 1, "half_end" if massless else "consistent")
    return mesh.beams
