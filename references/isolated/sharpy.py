"""SHARPy: a geometrically exact beam with full 6×6 sections, in an isolated environment.

A. del Carre, A. Muñoz-Simón, N. Goizueta and R. Palacios, "SHARPy: A dynamic aeroelastic simulation toolbox for very
flexible aircraft and wind turbines", Journal of Open Source Software 4 (2019) 1885. Elements have three nodes,
displacements and rotation vectors quadratic in between, reduced integration, and one 6×6 stiffness and mass each:
fourth order for uniform blades, second order where properties vary. Each element has the mean compliance and mass of
its part of the blade.

Positions and axes of the sections are those of the adapters' reference line. SHARPy assembles the forces, and the mass,
gyroscopic and stiffness matrices, of the deformed, rotating beam; Newton's method on them is the adapter's. Twist is
included in the elements' stiffness and mass, not in their axes, because SHARPy does not allow axes to jump between
elements, and a blade's may. Rigid shears are given a large stiffness.
"""

import base64
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from ...core.blade import BEND_Y, BEND_Z, SHEAR_Y, SHEAR_Z, Blade, clamped
from ...core.effects import ALL_EFFECTS
from ...core.modes import STATIONS, Modes
from ...core.space.spatial import skew
from ..matrices.quadratic import gyroscopic_modes
from ..protocol.interface import REFERENCE_LINE, BladeAdapter, Independence
from ..sampling import mass_at, stiffness_at
from ..theories.reference_line import frames
from ..theories.spectral import gauss, intervals
from . import SHARPY, ask

Array = NDArray[np.float64]

RIGID = 1e7
"""Shear stiffness of sections rigid in shear, in EI/L²; it lowers the fifth frequency by 1e-5, the first by less than 1e-6."""

INTERVALS = 12
"""Largest number of intervals between kinks for which the coarsest level needs no more elements."""

JUMP = 1e-4
"""Relative to the length: stations closer than this are the two sides of a jump, with no element between them."""


class Sharpy(BladeAdapter):
    """See the module; coupled, curved, twisted blades with shear, precone, pitch and tip mass."""

    name = "sharpy"
    title = "SHARPy, geometrically exact beam"
    independence = Independence("SHARPy", "geometrically exact beam", "SHARPy", sections=REFERENCE_LINE)
    effects = ALL_EFFECTS
    levels = (INTERVALS, 2 * INTERVALS, 4 * INTERVALS)
    order = 2
    finest = 96
    max_elements = 200  # the matrices are dense, with 12 rows per element
    hint = SHARPY.hint
    digits = 8  # its steady state converges to a tolerance

    def version(self) -> str | None:
        """Version of SHARPy in its environment."""
        return SHARPY.version()

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if the root is not clamped, the curve has kinks, or a strain other than shear is rigid."""
        if not clamped(blade):
            return "the root is not clamped: the beam's first node is clamped"
        if blade.kinks:
            return f"a kink at {blade.kinks[0]:g} m: SHARPy does not allow axes to jump between elements"
        rigid = {int(strain) for strain in np.argwhere(np.isinf(blade.stiffness))[:, 1]} - {SHEAR_Y, SHEAR_Z}
        if rigid:
            return f"infinite stiffness of strain {min(rigid)}: only shears can be rigid here"
        return None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.BladeAdapter``. Elements end at kinks; ``Modes.elements`` gives their number.

        Raises:
            CodeError: too many elements, SHARPy missing or failing, or no stable steady state.
        """
        spans = _spans(blade, elements)
        n = len(spans)
        self.limit(n)
        s = nodes(spans)
        answer = ask(SHARPY, request(blade, omega, spans))
        q = _unpacked(answer["q"])
        M, C, K = (_unpacked(answer[name]).reshape(len(q), -1) for name in "MCK")
        frequencies, vectors = gyroscopic_modes(M, C, K, count)
        shapes = _shapes(s / blade.length, q, vectors)
        return Modes(omega, frequencies, shapes, n)


def _spans(blade: Blade, elements: int) -> Array:
    """Ends of each element (e, 2), m: the same number of elements in every interval between kinks, none in a jump."""
    kinks = intervals(blade)
    between = np.column_stack([kinks[:-1], kinks[1:]])
    between = between[np.diff(kinks) > JUMP * blade.length]
    pieces = -(-elements // min(len(between), INTERVALS))
    cut = between[:, :1] + np.diff(between) * np.arange(pieces + 1) / pieces
    return np.stack([cut[:, :-1], cut[:, 1:]], axis=-1).reshape(-1, 2)


def nodes(spans: Array) -> Array:
    """Arc lengths of the nodes (2e+1,), m: ends and middles of elements."""
    return np.append(np.column_stack([spans[:, 0], spans.mean(1)]).ravel(), spans[-1, 1])


def request(blade: Blade, omega: float, spans: Array) -> dict[str, Any]:
    """The request for ``sharpy_worker``; ``spans`` (e, 2) are the arc lengths of the elements' ends, m."""
    untwisted = replace(blade, twist=np.zeros_like(blade.twist))
    position, axes = frames(untwisted, nodes(spans))
    psi = Rotation.from_matrix(axes).as_rotvec()
    length = np.diff(spans).ravel()
    at, weight = (np.concatenate(part) for part in zip(*(gauss(span, 3) for span in spans), strict=True))
    share = (weight / np.repeat(length, 3))[:, None, None]
    level = np.swapaxes(frames(untwisted, at)[1], 1, 2)
    twist = np.kron(np.eye(2), level @ frames(blade, at)[1])
    stiffness = stiffness_at(blade, at)
    bending = np.diagonal(stiffness, axis1=1, axis2=2)[:, [BEND_Y, BEND_Z]].max(1) / blade.length**2
    stiffness = np.where(np.isinf(stiffness), RIGID * bending[:, None, None], stiffness)
    chord = np.linalg.norm(np.diff(position[::2], axis=0), axis=1)
    longer = (length / chord)[:, None, None]  # SHARPy measures an element by its chord
    transposed_twist = np.swapaxes(twist, 1, 2)
    compliance = longer * (share * (twist @ np.linalg.inv(stiffness) @ transposed_twist)).reshape(-1, 3, 6, 6).sum(1)
    mass = longer * (share * (twist @ mass_at(blade, at) @ transposed_twist)).reshape(-1, 3, 6, 6).sum(1)
    arrays = {
        "nodes": position,
        "rotations": np.stack([psi[:-2:2], psi[2::2], psi[1::2]], axis=1),
        "stiffness": np.linalg.inv(compliance),
        "mass": mass,
        "tip": blade.tip_mass,
    }
    return {"omega": omega, **{name: value.tolist() for name, value in arrays.items()}}


def _unpacked(text: str) -> Array:
    return np.frombuffer(base64.b64decode(text), dtype="<f8")


def _shapes(s: Array, q: Array, vectors: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """(m, 21, 4) by a spline through the nodes; a change of a rotation vector ψ is a rotation by J(ψ) times it.

    J = 1 + (1 − cos θ)/θ² ψ× + (θ − sin θ)/θ³ ψ×ψ×, θ = |ψ| (M. Géradin and A. Cardona, *Flexible Multibody Dynamics*,
    2001, §4.12).
    """
    psi, displacements = q.reshape(-1, 6)[:, 3:], vectors.reshape(len(q) // 6, 6, -1)
    angle = np.linalg.norm(psi, axis=1).clip(1e-8)[:, None, None]
    cross = skew(psi)
    J = np.eye(3) + (1 - np.cos(angle)) / angle**2 * cross + (angle - np.sin(angle)) / angle**3 * cross @ cross
    nodes = np.zeros((len(s), 4, vectors.shape[1]), complex)
    nodes[1:, :3], nodes[1:, 3] = displacements[:, :3], (J @ displacements[:, 3:])[:, 0]
    return CubicSpline(s, nodes)(STATIONS).transpose(2, 0, 1)


CODE = Sharpy()
