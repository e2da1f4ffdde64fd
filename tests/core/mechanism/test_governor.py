"""A Watt governor that spins freely: loops transmit large forces, and the spin has no stiffness."""

import numpy as np
import pytest

from southwell import multibody as mb

G = 9.81


def governor(ball: float, sleeve: float, arm: float, rate: float, spindle: float) -> tuple[mb.Mechanism, float]:
    """Two balls on arms that hang from a spindle, which is free to spin; rods lift a sleeve; and the steady arm angle.

    The sleeve turns and slides on a cylindrical joint: its loops turn it with the spindle. ``cos θ = (m + M) g/(m l Ω²)``.
    """
    angle = float(np.arccos((ball + sleeve) * G / (ball * arm * rate**2)))
    bodies = [
        mb.Body("spindle", mb.inertia(0.0, (spindle / 2, spindle / 2, spindle))),
        mb.Body("sleeve", mb.inertia(sleeve)),
    ]
    joints = [
        mb.Joint("shaft", "revolute", "ground", "spindle"),
        mb.Joint("slide", "cylindrical", "ground", "sleeve"),
    ]
    for axis, side in (("-y", "left"), ("y", "right")):
        upper, lower = f"{side} arm", f"{side} rod"
        hinge, end = mb.at(axis=axis), mb.at(z=-arm, axis=axis)
        bodies += [mb.Body(upper, mb.inertia(ball, 0.0, (0.0, 0.0, -arm))), mb.Body(lower)]
        joints += [
            mb.Joint(f"{side} top", "revolute", "spindle", upper, hinge, hinge),
            mb.Joint(f"{side} knee", "revolute", upper, lower, end, hinge),
            mb.Joint(f"{side} foot", "revolute", lower, "sleeve", end, hinge, cut=True),
        ]
    free = mb.Motion("shaft.rz", rate=rate, prescribed=False)
    return mb.Mechanism(tuple(bodies), tuple(joints), motions=(free,), gravity=(0.0, 0.0, -G)), angle


def exact(ball: float, sleeve: float, arm: float, rate: float, spindle: float, angle: float) -> float:
    """ω, rad/s, from ``T = ½ (I(θ) Ω² + a(θ) θ̇²)`` with ``I Ω`` constant, and ``V = −2 (m + M) g l cos θ``."""
    s, c = np.sin(angle), np.cos(angle)
    inertia, slope = spindle + 2 * ball * (arm * s) ** 2, 4 * ball * arm**2 * s * c
    curvature = 4 * ball * arm**2 * (c * c - s * s)
    moved = 2 * ball * arm**2 + 4 * sleeve * (arm * s) ** 2
    centrifugal = (inertia * rate) ** 2 * (slope**2 / inertia**3 - curvature / (2 * inertia**2))
    return float(np.sqrt((centrifugal + 2 * (ball + sleeve) * G * arm * c) / moved))


@pytest.mark.numerical
@pytest.mark.parametrize("seed", range(6))
def test_a_free_governor_has_the_frequency_of_its_closed_form(seed: int) -> None:
    """8.58 rad/s for the first; rounding of the loops' reactions is not an unbalanced force."""
    draw = np.random.default_rng(seed)
    ball, sleeve, arm, spindle = (
        draw.uniform(*limits) for limits in ((0.5, 3.0), (1.0, 8.0), (0.2, 0.6), (0.005, 0.1))
    )
    data = (ball, sleeve, arm, np.sqrt((ball + sleeve) * G / (ball * arm)) * draw.uniform(1.05, 2.0), spindle)
    data = (1.3, 4.0, 0.35, 14.0, 0.02) if seed == 0 else data
    mechanism, angle = governor(*data)
    guess = 1.02 * angle
    joints = {
        f"{side} {joint}.rz": turn
        for side in ("left", "right")
        for joint, turn in (("top", guess), ("knee", -2 * guess))
    }
    solution = mb.solve(mechanism, {**joints, "slide.z": -2 * data[2] * np.cos(guess)})
    vibration = solution.frequencies[solution.frequencies > 1e-4]
    assert vibration == pytest.approx([exact(*data, angle)], rel=1e-10)
