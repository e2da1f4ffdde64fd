"""Rotors on supports with known answers: Coleman and Feingold's, and equations written by hand."""

import numpy as np

from southwell import multibody as mb

Array = np.ndarray
Matrices = tuple[Array, Array, Array]

LAG = 2 * np.pi * 0.8
"""rad/s, of a blade on its hinge."""


def turned(angle: float, radius: float = 0.0) -> Array:
    """The frame of a hinge at an azimuth and radius, m, its x axis along the blade."""
    pose = np.eye(4)
    c, s = np.cos(angle), np.sin(angle)
    pose[:2, :2] = [[c, -s], [s, c]]
    pose[:2, 3] = radius * c, radius * s
    return pose


def on_springs(
    omega: float,
    blade: Array,
    hinge: list[tuple[float, float]],
    hub: float,
    support: tuple[mb.CoordinateSpring, mb.CoordinateSpring],
    offset: float = 0.0,
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> mb.Mechanism:
    """Blades on lag hinges (stiffness, damping), the hub on springs along X and Y; the rotor turns about Z."""
    blades = range(len(hinge))
    return mb.Mechanism(
        bodies=(
            mb.Body("carriage"),
            mb.Body("hub", mb.inertia(hub)),
            mb.Body("rotor"),
            *(mb.Body(f"blade{k}", blade) for k in blades),
        ),
        joints=(
            mb.Joint("X", "prismatic", "ground", "carriage", mb.at(axis="x"), mb.at(axis="x")),
            mb.Joint("Y", "prismatic", "carriage", "hub", mb.at(axis="y"), mb.at(axis="y")),
            mb.Joint("shaft", "revolute", "hub", "rotor"),
            *(
                mb.Joint(f"lag{k}", "revolute", "rotor", f"blade{k}", turned(2 * np.pi * k / len(hinge), offset))
                for k in blades
            ),
        ),
        motions=(mb.Motion("shaft.rz", rate=omega),),
        coordinate_springs=(*support, *(mb.CoordinateSpring(f"lag{k}.rz", *hinge[k]) for k in blades)),
        gravity=gravity,
    )


def coleman_feingold(
    omega: float, stiffer: float = 1.0, gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> mb.Mechanism:
    """Three blades of 500 kg at 30 m, 0.8 Hz on hinges at the centre; 50,000 kg on springs of 2e5 and 2e4 N/m."""
    stiffness = 500.0 * 30.0**2 * LAG**2
    return on_springs(
        omega,
        mb.inertia(500.0, 0.0, (30.0, 0.0, 0.0)),
        [(stiffer * stiffness, 0.0), (stiffness, 0.0), (stiffness, 0.0)],
        50_000.0,
        (mb.CoordinateSpring("X.z", 2e5), mb.CoordinateSpring("Y.z", 2e4)),
        gravity=gravity,
    )


HAMMOND = {"mass": 94.9, "radius": 3.04636, "moment": 203.996, "offset": 0.3048, "hub": 8026.6}
"""A helicopter's blade and hub, after C. Hammond, J. Am. Helicopter Soc. 19, 1974, 14: kg, m, kg m² about the mass centre."""


def hammond(omega: float, damping: tuple[float, ...], support: tuple[float, float]) -> mb.Mechanism:
    """Four blades on lag dampers (N m s/rad each), the hub on equal springs and dampers along X and Y."""
    h = HAMMOND
    blade = mb.inertia(h["mass"], (0.0, h["moment"], h["moment"]), (h["radius"], 0.0, 0.0))
    springs = mb.CoordinateSpring("X.z", *support), mb.CoordinateSpring("Y.z", *support)
    return on_springs(omega, blade, [(0.0, c) for c in damping], h["hub"], springs, h["offset"])


def hammond_by_hand(omega: float, damping: tuple[float, ...], support: tuple[float, float], psi: float) -> Matrices:
    """Its equations at the azimuth ψ, derived by hand: x, y and the lag angles ζ_k.

    m ẍ + c ẋ + k x − S Σ (ζ_k sin ψ_k)¨ = 0,    m ÿ + c ẏ + k y + S Σ (ζ_k cos ψ_k)¨ = 0,
    I ζ̈_k + c_k ζ̇_k + Ω² e S ζ_k + S (ÿ cos ψ_k − ẍ sin ψ_k) = 0.
    """
    h, n = HAMMOND, len(damping)
    S, inertia = h["mass"] * h["radius"], h["moment"] + h["mass"] * h["radius"] ** 2
    k, c = support
    s, o = np.sin(psi + 2 * np.pi * np.arange(n) / n), np.cos(psi + 2 * np.pi * np.arange(n) / n)
    M, C, K = (np.zeros((n + 2, n + 2)) for _ in range(3))
    M[0, 0] = M[1, 1] = h["hub"] + n * h["mass"]
    C[0, 0] = C[1, 1] = c
    K[0, 0] = K[1, 1] = k
    lag = np.arange(n) + 2
    M[lag, lag], C[lag, lag], K[lag, lag] = inertia, damping, omega**2 * h["offset"] * S
    M[0, lag], C[0, lag], K[0, lag] = -S * s, -2 * omega * S * o, omega**2 * S * s
    M[1, lag], C[1, lag], K[1, lag] = S * o, -2 * omega * S * s, -(omega**2) * S * o
    M[lag, 0], M[lag, 1] = -S * s, S * o
    return M, C, K


def hammond_roots(omega: float, damping: float, support: tuple[float, float], blades: int = 4) -> Array:
    """Exponents of the isotropic rotor in multi-blade coordinates, without collective and differential motion.

    With z = x + iy and ξ = (2/N) Σ ζ_k e^{iψ_k} they are the roots of
    (m s² + c s + k) (I σ² + c_ζ σ + Ω² e S) − N/2 S² s⁴, σ = s − iΩ, and their conjugates.
    """
    h = HAMMOND
    S, inertia = h["mass"] * h["radius"], h["moment"] + h["mass"] * h["radius"] ** 2
    hub = np.polynomial.Polynomial([support[0], support[1], h["hub"] + blades * h["mass"]])
    sigma = np.polynomial.Polynomial([-1j * omega, 1.0])
    lag = inertia * sigma**2 + damping * sigma + omega**2 * h["offset"] * S
    return (hub * lag - 0.5 * blades * S**2 * np.polynomial.Polynomial([0, 0, 0, 0, 1.0])).roots()
