"""Closed forms of rigid hinged blades: small motion about steady rotation in the plane of the rotor.

From second-order Lagrangians, derived by hand. About the hinge at radius e: S = ∫x dm, inertias I. β is flap up, ζ lag
forward (along the motion), θ pitch with the leading edge up about the blade's axis, outboard of the flap hinge.
"""

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from ..matrices.quadratic import damped_modes
from ..protocol.interface import MechanismModes

Array = NDArray[np.float64]
Matrices = tuple[tuple[str, ...], Array, Array, Array]


def flap_lag(
    omega: float,
    *,
    offset: float,
    first: float,
    flap_inertia: float,
    lag_inertia: float,
    own_inertia: float,
    flap_spring: float = 0.0,
    lag_spring: float = 0.0,
    flap_damper: float = 0.0,
    lag_damper: float = 0.0,
) -> Matrices:
    """Coincident flap and lag hinges; the blade's mass is symmetric about its axis.

    I_β β̈ + c_β β̇ + (k_β + Ω² (I_ζ − I_x + e S)) β = 0 and I_ζ ζ̈ + c_ζ ζ̇ + (k_ζ + Ω² e S) ζ = 0: for a slender blade
    flap Ω √(1 + e S/I), lag Ω √(e S/I) (W. Johnson, *Helicopter Theory*, 1980, sec. 9-2).

    Args:
        omega: rotor speed, rad/s.
        offset: e, m.
        first: S, kg m.
        flap_inertia, lag_inertia, own_inertia: I_β, I_ζ, I_x about the hinge, kg m².
        flap_spring, lag_spring: N m/rad.
        flap_damper, lag_damper: N m s/rad.

    Returns:
        names of the coordinates; M, C, K (2, 2).
    """
    flap = flap_spring + omega**2 * (lag_inertia - own_inertia + offset * first)
    lag = lag_spring + omega**2 * offset * first
    return (
        ("flap.rz", "lag.rz"),
        np.diag([flap_inertia, lag_inertia]),
        np.diag([flap_damper, lag_damper]),
        np.diag([flap, lag]),
    )


def flap_pitch(
    omega: float,
    *,
    offset: float,
    xx: float,
    yy: float,
    zz: float,
    xy: float,
    first_x: float,
    first_y: float,
    horn_x: float,
    horn_y: float,
    control_spring: float,
    control_damper: float,
    rod_mass: float,
    link_mass: float,
) -> Matrices:
    """Flap hinge, pitch bearing outboard of it, and a vertical pitch link from a horn to a rod on the control spring.

    To second order a point (x, y, z) of the blade moves up by x β + y θ, inwards by x β²/2 + y θ β (+ z β), and back by
    y θ²/2 (+ z θ). Link and rod follow the vertical motion of the horn's end, the link's middle half of its inward
    motion. The blade is symmetric about z = 0, so the link is unloaded in the steady state.

    Args:
        omega: rotor speed, rad/s.
        offset: e, m.
        xx, yy, zz, xy: ∫x², ∫y², ∫z², ∫xy dm of the blade about the hinge, kg m².
        first_x, first_y: ∫x, ∫y dm, kg m.
        horn_x, horn_y: position of the horn's end relative to the hinge, m.
        control_spring, control_damper: N/m, N s/m.
        rod_mass, link_mass: kg.

    Returns:
        names of the coordinates; M, C, K (2, 2).
    """
    rise = np.array([horn_x, horn_y])
    M = np.array([[xx + zz, xy], [xy, yy + zz]]) + (rod_mass + link_mass) * np.outer(rise, rise)
    K = omega**2 * np.array(
        [[offset * first_x + xx - zz, offset * first_y + xy], [offset * first_y + xy, yy - zz]]
    ) + control_spring * np.outer(rise, rise)
    swing = np.array([[horn_x, horn_y], [horn_y, 0.0]]) * (offset + horn_x)  # inwards
    swing += np.array([[0.0, 0.0], [0.0, horn_y]]) * horn_y  # back
    K += 0.5 * omega**2 * link_mass * swing
    C = control_damper * np.outer(rise, rise) + 2.0 * omega * zz * np.array([[0.0, -1.0], [1.0, 0.0]])
    return ("flap.rz", "pitch.rz"), M, C, K


def lag_rotor(
    omega: float,
    *,
    mass: float,
    stiffness_x: float,
    stiffness_y: float,
    first: float,
    inertia: float,
    hinge_spring: float,
    offset: float,
) -> Matrices:
    """Three blades on lag hinges at 0°, 120° and 240°, the hub on springs along x and y: equations seen from the ground.

    With ζ_k = z + a cos ψ_k + b sin ψ_k, κ = k_ζ + Ω² e S and m the mass of hub and blades (Coleman and Feingold 1958):
    m ẍ + k_x x − 3/2 S b̈ = 0, m ÿ + k_y y + 3/2 S ä = 0, I z̈ + κ z = 0,
    I (ä + 2Ω ḃ − Ω² a) + κ a + S ÿ = 0, I (b̈ − 2Ω ȧ − Ω² b) + κ b − S ẍ = 0.

    Args:
        omega: rotor speed, rad/s.
        mass: m, kg.
        stiffness_x, stiffness_y: N/m.
        first: S of one blade about its hinge, kg m.
        inertia: I of one blade about its hinge, kg m².
        hinge_spring: k_ζ, N m/rad.
        offset: e, m.

    Returns:
        names of the coordinates; M, C, K (5, 5) over hub and blades at the azimuth 0.
    """
    kappa = hinge_spring + omega**2 * offset * first
    M = np.diag([mass, mass, inertia, inertia, inertia])
    M[0, 4], M[1, 3], M[3, 1], M[4, 0] = -1.5 * first, 1.5 * first, first, -first
    C = np.zeros((5, 5))
    C[3, 4], C[4, 3] = 2.0 * omega * inertia, -2.0 * omega * inertia
    whirl = kappa - omega**2 * inertia
    K = np.diag([stiffness_x, stiffness_y, kappa, whirl, whirl])
    azimuth = 2.0 * np.pi * np.arange(3) / 3.0
    T = np.eye(5)
    T[2:, 2:] = np.stack([np.ones(3), np.cos(azimuth), np.sin(azimuth)], axis=-1)
    M, C, K = (T @ part @ np.linalg.inv(T) for part in (M, C, K))
    return ("X.z", "Y.z", "lag0.rz", "lag1.rz", "lag2.rz"), M, C, K


FORMULAE: Mapping[str, Callable[..., Matrices]] = {
    "flap-lag": flap_lag,
    "flap-pitch": flap_pitch,
    "lag-rotor": lag_rotor,
}
"""Formulae by their names in case files."""


def solve(formula: str, omega: float, parameters: Mapping[str, float]) -> MechanismModes:
    """A formula's modes at rotor speed ``omega`` (rad/s) about its steady state, where its coordinates are 0.

    Raises:
        KeyError: if the formula is unknown.
        TypeError: if parameters are missing or unknown.
    """
    names, M, C, K = FORMULAE[formula](omega, **parameters)
    values, x = damped_modes(M, C, K)
    return MechanismModes(names, np.zeros(len(names)), values, x.T)
