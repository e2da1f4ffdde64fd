"""Exudyn's ANCF cable in a co-rotating frame: a geometrically nonlinear beam, independent of core.

The cable has cubic positions between nodes that carry position and slope, ``r`` and ``r' = ∂r/∂s``, and the energy
``½ EA (|r'| − 1)² + ½ EI (|r' × r''| / |r'|²)²`` (J. Gerstmayr, H. Irschik, "On the correct representation of bending
and axial deformation in the absolute nodal coordinate formulation with an elastic line approach", J. Sound Vib. 318,
2008, eq. 17–25). Positions are linear in the coordinates, so the mass matrix M is constant, and in axes that turn with
the hub the inertia forces are exactly

    M q̈ + 2Ω M B q̇ + Ω² M B² q,   B = e_z × on every position and slope.

Exudyn provides M, the steady state and the tangent stiffness there; this module computes the terms of the rotating
frame from M.
"""

from itertools import pairwise
from typing import Any

import numpy as np
from scipy import sparse
from scipy.interpolate import CubicHermiteSpline

from ...core.blade import BEND_Y, BEND_Z, Blade, uniform
from ...core.effects import Effects
from ...core.modes import STATIONS, Modes
from ..matrices.quadratic import gyroscopic_modes
from ..protocol.fingerprint import SPIN, Fingerprint, of_matrix, rigid_motions
from ..protocol.interface import BladeAdapter, Independence, Motion
from ..sampling import sample
from . import system as ex

ROUNDING = 2e-15
"""Rounding error of an axial force, relative to EA times the number of elements (their stiffness is EA over their length)."""

CLAMPED = [0, 1, 2, 4, 5]
"""Clamped coordinates of the root node: position and transverse slope; the axial slope is free, to allow stretch."""


class ExudynAncf(BladeAdapter):
    """See the module; one bending stiffness, no torsion, no rotary inertia, no shear."""

    name = "exudyn-ancf"
    title = "Exudyn, ANCF cable"
    independence = Independence("Exudyn", "ANCF cable", "exudyn-ancf's adapter")
    motions: tuple[Motion, ...] = ("axial", "edgewise", "flapwise")
    effects = Effects(rotary_inertia=False)
    levels = (10, 20, 40)
    order = 4
    hint = ex.HINT
    distribution = ex.DISTRIBUTION

    def unsupported(self, blade: Blade) -> str | None:
        """A reason unless the blade is uniform, straight, extensible and rigid in shear, with one bending stiffness."""
        flap, chord = blade.stiffness[:, BEND_Y, BEND_Y], blade.stiffness[:, BEND_Z, BEND_Z]
        if (flap != chord).any():
            k = int(np.argmax(flap != chord))
            return (
                f"EI_y = {flap[k]:g}, EI_z = {chord[k]:g} N m² at station {k}: an ANCF cable has one bending stiffness"
            )
        if not uniform(blade):
            return "sections couple or vary, or curvature, twist, precone, pitch or tip mass: this cable is uniform"
        section = sample(blade, 0.0)
        if np.isinf(section.EI_y[0]) or np.isinf(section.EA[0]):
            return "rigid in bending or stretch: an ANCF cable needs finite EI and EA"
        if np.isfinite(section.GA_y[0]) or np.isfinite(section.GA_z[0]):
            return "finite shear stiffness: an ANCF cable is rigid in shear (Euler–Bernoulli)"
        return None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.BladeAdapter``.

        Raises:
            CodeError: no stable steady state at this speed.
        """
        matrices: list[Any] = [sparse.csc_array(matrix) for matrix in _matrices(blade, omega, elements)]
        size = matrices[0].shape[0]
        free = np.delete(np.arange(size), CLAMPED)
        M, C, K = (matrix[free][:, free] for matrix in matrices)
        frequencies, vectors = gyroscopic_modes(M, C, K, count)
        q = np.zeros((size, vectors.shape[1]), complex)
        q[free] = vectors
        return Modes(omega, frequencies, _shapes(q, blade.length), elements)

    def fingerprint(self, blade: Blade, elements: int) -> Fingerprint:
        """From Exudyn's mass matrix; see ``interface.BladeAdapter``."""
        M, _, _ = _matrices(blade, 0.0, elements)
        position = np.zeros((elements + 1, 3))
        position[:, 0] = blade.hub_radius + np.linspace(0.0, blade.length, elements + 1)
        motions = rigid_motions(position)
        slopes = np.zeros_like(motions)
        slopes[:, :, 3:] = rigid_motions(np.array([1.0, 0.0, 0.0]))[:, 3:]
        q = np.stack([motions, slopes], axis=1).reshape(-1, 6)
        return of_matrix(q.T @ (M @ q), elements)


def _matrices(blade: Blade, omega: float, elements: int):
    """M, C, K (n, n) of all coordinates, (r, r') per node, about the steady state in co-rotating axes."""
    exu, _container, mbs = ex.system()
    items, section = exu.itemInterface, sample(blade, 0.0)
    x = blade.hub_radius + np.linspace(0.0, blade.length, elements + 1)
    nodes = [mbs.AddNode(items.NodePointSlope1(referenceCoordinates=[at, 0, 0, 1, 0, 0])) for at in x]
    for pair in pairwise(nodes):
        mbs.AddObject(
            items.ObjectANCFCable(
                length=blade.length / elements,
                massPerLength=section.mass[0],
                bendingStiffness=section.EI_y[0],
                axialStiffness=section.EA[0],
                nodeNumbers=list(pair),
            )
        )
    ex.hold(exu, mbs, nodes[0], CLAMPED)
    mbs.Assemble()
    M, _, K = ex.linearized(exu, mbs, at_rest=True)
    M, B = sparse.csr_array(M), sparse.kron(sparse.eye_array(2 * len(nodes)), SPIN, format="csr")
    if omega:
        centrifugal = omega**2 * M @ B @ B
        reference = mbs.systemData.GetODE2Coordinates(configuration=exu.ConfigurationType.Reference)
        mbs.AddObject(  # the coordinates are displacements: positions are these plus the reference
            items.ObjectGenericODE2(
                nodeNumbers=nodes,
                stiffnessMatrix=ex.sparse_matrix(exu, centrifugal),
                forceVector=-centrifugal @ reference,
            )
        )
        mbs.Assemble()
        ex.settle(exu, mbs, omega, rounding=ROUNDING * section.EA[0] * elements)
        _, _, K = ex.linearized(exu, mbs, at_rest=True)
    return M, 2 * omega * M @ B, K


def _shapes(q, length: float):
    """Shapes (m, 21, 4) from coordinates (n, m), by the elements' cubics; a cable has no rotation about its axis."""
    node = q.reshape(-1, 2, 3, q.shape[1])
    cubic = CubicHermiteSpline(np.linspace(0.0, length, len(node)), node[:, 0], node[:, 1])
    displacements = cubic(STATIONS * length)
    return np.concatenate([displacements, np.zeros_like(displacements[:, :1])], axis=1).transpose(2, 0, 1)


CODE = ExudynAncf()
