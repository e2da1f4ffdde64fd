"""A rotor of uniform blades on a tilting and sliding hub, against exact blades at ω, ω − Ω and ω + Ω.

A blade moves by w(r, t) out of the plane of rotation, ``m ẅ + (EI w'')'' − (T w')' = 0`` with the tension T, in the rotating
frame. The hub's slope θ along blade k gives w = R θ and w' = θ at the root. In a whirl forward all blades see it at ω − Ω,
backward at ω + Ω, and at ω if the hub slides along the axis. With D(ν) the blade's dynamic stiffness against θ or a
displacement, hub stiffness k and inertia I give ``k − I ω² + 3/2 D(ω ∓ Ω) = 0`` and ``k_z − m ω² + 3 D_z(ω) = 0``.
"""

from functools import partial

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from southwell.core.blade import uniform_blade
from southwell.core.effects import ALL_EFFECTS
from southwell.core.element.discretize import discretize
from southwell.core.spectrum.eigen import damped
from southwell.core.spectrum.mesh_solver import balance
from southwell.core.turbine import component
from southwell.core.turbine.rotor import rotor
from southwell.core.turbine.turbine import Turbine

OMEGA, RADIUS, LENGTH, EI, MASS = 6.0, 0.8, 10.0, 4e4, 5.0
TILT, TILT_INERTIA, SLIDE, SLIDE_MASS = 2e4, 200.0, 8e3, 60.0


def dynamic_stiffness(frequency: float, sliding: bool) -> float:
    """D(ν) of one blade, N m/rad, or D_z, N/m."""

    def tension(r: float) -> float:
        return 0.5 * OMEGA**2 * MASS * ((RADIUS + LENGTH) ** 2 - r**2)

    def slope(r: float, y: np.ndarray) -> np.ndarray:
        w, dw, moment, shear = y.reshape(4, -1)  # moment EI w'', shear (EI w'')' − T w'
        return np.concatenate([dw, moment / EI, shear + tension(r) * dw, MASS * frequency**2 * w])

    tip = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [0.0, 0.0]])  # free: no moment, no shear
    span = (RADIUS + LENGTH, RADIUS)
    root = solve_ivp(slope, span, tip.ravel(), "DOP853", rtol=1e-12, atol=1e-12).y[:, -1].reshape(4, 2)
    w, dw = (1.0, 0.0) if sliding else (RADIUS, 1.0)
    _, _, moment, shear = root @ np.linalg.solve(root[:2], [w, dw])
    rigid = 0.0 if sliding else tension(RADIUS) * RADIUS  # the hub from the axis to the root shortens as well
    return float(-moment * dw + shear * w + rigid)


ROOTS = {
    "backward": (0.39058548, 12.4170389, 26.8131348),
    "forward": (11.7648011, 19.1557471),
    "sliding": (5.1663459, 11.8836828, 29.1622659),
}
"""rad/s, all below 30 rad/s, from a scan of the equations."""

SHIFT = {"backward": OMEGA, "forward": -OMEGA, "sliding": 0.0}


def unbalanced(motion: str, frequency: float) -> float:
    """The hub's equation, zero at a natural frequency."""
    sliding = motion == "sliding"
    blades = (3.0 if sliding else 1.5) * dynamic_stiffness(frequency + SHIFT[motion], sliding)
    hub = SLIDE - SLIDE_MASS * frequency**2 if sliding else TILT - TILT_INERTIA * frequency**2
    return hub + blades


def frequencies(elements: int) -> np.ndarray:
    """Frequencies below 30 rad/s; in its plane and about the shaft, the hub is fixed."""
    blade = uniform_blade("blade", LENGTH, RADIUS, EA=np.inf, GJ=np.inf, EI_y=EI, EI_z=1e3 * EI, mass=MASS)
    mesh = discretize(blade, elements)
    reduced = component.reduced_component(mesh, balance(mesh, OMEGA, np.zeros(3), ALL_EFFECTS), 20)
    hub = np.diag([0.0, 0.0, SLIDE_MASS, TILT_INERTIA, TILT_INERTIA, 0.0])
    machine = Turbine("rotor", blade, blade, 3, np.zeros((6, 6)), hub, np.eye(4))
    M, C, K = rotor(machine, reduced, OMEGA, 0.0)
    n = 3 * reduced.size
    K[n + 2, n + 2] += SLIDE
    K[n + 3, n + 3] += TILT
    K[n + 4, n + 4] += TILT
    free = np.append(np.arange(n), [n + 2, n + 3, n + 4])
    M, C, K = (part[np.ix_(free, free)] for part in (M, C, K))
    frequencies = damped(M, C, K).frequencies
    return frequencies[frequencies < 30.0]


def test_a_rotor_of_uniform_blades_on_a_hub() -> None:
    coarse, fine = frequencies(45), frequencies(90)
    expected = []
    for motion, roots in ROOTS.items():
        for near in roots:
            expected.append(brentq(partial(unbalanced, motion), near * (1 - 1e-7), near * (1 + 1e-7), xtol=1e-12))
    exact = np.sort(np.array(expected, float))
    np.testing.assert_allclose(fine, exact, rtol=1e-8)
    np.testing.assert_allclose(fine + (fine - coarse) / 15.0, exact, rtol=1e-9)  # the error is of fourth order
