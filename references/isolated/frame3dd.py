"""Frame3DD, of WISDEM: straight frame elements with the geometric stiffness of their axial force, masses at the nodes.

H. P. Gavin, "Frame3DD: static and dynamic structural analysis of 2D and 3D frames" (2010), in NREL's WISDEM, in an
isolated environment. Rotation is modelled as a static load, the centrifugal force of every node. Displacement of a node
in the plane of rotation increases that force, which is equivalent to a spring of stiffness −m Ω². Frame3DD's first step
has no tension yet and would buckle under these springs. Springs of +m Ω² across the plane and none within are used
instead, so all ω² are higher by Ω², which is subtracted.

Frame3DD leaves out the Coriolis force; the steady stretch, as masses keep their undeformed positions; and the inertia
of the sections. Its mass matrix assumes one material, with a rotary inertia proportional to EI / EA. EA is therefore
increased by a factor of ten thousand, which does not affect bending, and there are no axial or torsional modes.
Elements have the mean compliance and mass of their part of the blade: second order.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ...core.blade import Blade, clamped, coupled, straight
from ...core.effects import Effects
from ...core.modes import STATIONS, Modes
from ..protocol.interface import BladeAdapter, CodeError, Independence, Motion
from ..sampling import mass_at, sample
from ..theories.grading import element_ends
from ..theories.spectral import gauss, intervals
from . import FRAME3DD, ask

Array = NDArray[np.float64]

SECTIONS = 10
"""Largest number of intervals between stations for the coarsest level, with two elements in each."""

STIFF = 1e4
"""Factor on the stiffness in stretch and torsion."""

POINTS = 4
"""Gauss points per element."""

MAX_ELEMENTS = 120
"""Largest number of elements: the time grows as its cube, and is a quarter of a minute for this number."""

STIFFNESSES = ("EA", "EI_y", "EI_z", "GJ")


class Frame3DD(BladeAdapter):
    """See the module; straight blades, uncoupled, shear-free and clamped; twist, taper, pitch, a point mass at the tip."""

    name = "frame3dd"
    title = "Frame3DD, frame elements"
    independence = Independence("Frame3DD", "frame elements", "frame3dd's adapter", eigensolver="Frame3DD")
    motions: tuple[Motion, ...] = ("edgewise", "flapwise")
    effects = Effects(prestretch=False, coriolis=False, rotary_inertia=False)
    levels = (2 * SECTIONS, 3 * SECTIONS, 9 * SECTIONS // 2)
    order = 2
    finest = 100
    max_elements = MAX_ELEMENTS
    hint = FRAME3DD.hint
    digits = 8  # it iterates on equations that ``STIFF`` makes ill-conditioned

    def version(self) -> str | None:
        """Version of WISDEM in its environment."""
        return FRAME3DD.version()

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if the frame does not support a property of the blade."""
        if coupled(blade):
            return "sections couple (off-diagonal entries): elements need principal axes through the reference curve"
        if not straight(blade) or blade.precone:
            return "prebend, sweep or precone: the springs that model the rotation need a straight blade in its plane"
        if not clamped(blade):
            return "the root is not clamped: the first node is clamped"
        if np.diagonal(blade.tip_mass)[3:].any() or (blade.tip_mass - np.diag(np.diagonal(blade.tip_mass))).any():
            return "tip_mass: a body with inertia or offset; nodes support mass only"
        if (parts := len(intervals(blade)) - 1) > SECTIONS:
            return f"{parts} intervals between stations: uniform elements need more than the {MAX_ELEMENTS} allowed"
        if np.ptp(np.diagonal(blade.mass, axis1=1, axis2=2)[:, :3], axis=1).any():
            return "mass differs with direction: a node has one mass"
        at = sample(blade, blade.stations)
        if np.isfinite([at.GA_y, at.GA_z]).any():
            return "finite shear stiffness: the elements are used without shear (Euler–Bernoulli)"
        for name in ("EA", "GJ", "EI_y", "EI_z"):
            if np.isinf(getattr(at, name)).any():
                return f"{name} is infinite: the elements need it finite"
        return None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.BladeAdapter``. Elements end at kinks; ``Modes.elements`` gives their number.

        Raises:
            CodeError: too many elements, Frame3DD missing or failing, or no stable steady state.
        """
        ends = element_ends(blade, elements, elements)
        n = len(ends) - 1
        self.limit(n)
        answer = ask(FRAME3DD, request(blade, omega, ends, count))
        squares, shapes = np.array(answer["frequencies"]) ** 2 - omega**2, np.array(answer["shapes"])
        if not (np.isfinite(squares).all() and (squares > 0).all()):
            raise CodeError(
                f"{blade.name}: squares of frequencies {squares.tolist()}: no stable steady state; lower the speed"
            )
        order = np.argsort(squares)
        shapes[:, [0, 3]] = 0.0  # along and about the axis it is nearly rigid: only rounding
        at_stations = CubicSpline(ends / blade.length, shapes, axis=2)(STATIONS).transpose(0, 2, 1)
        return Modes(omega, np.sqrt(squares[order]), at_stations[order].astype(complex), n)


def request(blade: Blade, omega: float, ends: Array, count: int) -> dict[str, object]:
    """The request for ``frame3dd_worker``; elements lie between arc lengths ``ends`` (n+1,), m."""
    h = np.diff(ends)
    s, weight = gauss(ends, POINTS)
    at = sample(blade, s)
    share = weight.reshape(-1, POINTS) / h[:, None]
    mean = {name: 1 / np.sum(share / getattr(at, name).reshape(-1, POINTS), axis=1) for name in STIFFNESSES}
    mean["EA"], mean["GJ"] = STIFF * mean["EA"], STIFF * mean["GJ"]
    mass = mass_at(blade, s)[:, 0, 0]
    x = blade.hub_radius + s
    spring, force = (_at_nodes(ends, s, weight * mass * omega**2 * arm) for arm in (np.ones_like(x), x))
    tip = float(blade.tip_mass[0, 0])
    spring[-1] += tip * omega**2
    force[-1] += tip * omega**2 * (blade.hub_radius + blade.length)
    arrays = {
        **mean,
        "x": blade.hub_radius + ends,
        "mass": np.sum(share * mass.reshape(-1, POINTS), axis=1),
        "twist": np.sum(share * at.twist.reshape(-1, POINTS), axis=1) + blade.pitch,
        "force": force,
        "spring": spring,
    }
    return {"count": count, "tip": tip, **{name: value.tolist() for name, value in arrays.items()}}


def _at_nodes(ends: Array, s: Array, amount: Array) -> Array:
    """(n+1,) nodal values of amounts at ``s`` in each element, distributed to its nodes with the same sum and moment."""
    along = (s.reshape(-1, POINTS) - ends[:-1, None]) / np.diff(ends)[:, None]
    amount = amount.reshape(-1, POINTS)
    at_start, at_end = np.sum(amount * (1 - along), axis=1), np.sum(amount * along, axis=1)
    return np.append(at_start, 0.0) + np.append(0.0, at_end)


CODE = Frame3DD()
