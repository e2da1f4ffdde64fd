"""A turbine at rest with a locked generator, in the assumed modes of its ElastoDyn deck.

FAST and OpenFAST describe tower and blades by the polynomials in their files: two for each direction of the tower, two
flapwise and one edgewise for a blade. They integrate over nodes in the middle of equal parts of the tower, and of AeroDyn's
elements of the blade. The velocity of every point is linear in the rates of these coordinates and of the shaft's torsion. This
module shares the turbine's data with ``core`` and none of its mechanics. Source: J. Jonkman, M. Buhl, *FAST User's Guide*,
NREL/EL-500-38230, 2005.
"""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid
from scipy.linalg import eigh

from southwell.core.sampling import mass_at, stiffness_at, twist_at
from southwell.core.space import spatial as sp
from southwell.core.turbine.turbine import Turbine

Array = NDArray[np.float64]

TOWER = ("TwFAM1Sh", "TwFAM2Sh", "TwSSM1Sh", "TwSSM2Sh")
BLADE = ("BldFl1Sh", "BldFl2Sh", "BldEdgSh")

TOWER_NODES = 20
"""TwrNodes of the decks of the NREL 5 MW turbine."""

BLADE_ELEMENTS = np.array([2.7333] * 3 + [4.1] * 11 + [2.7333] * 3)
"""DRNodes of AeroDyn's file of 2009, m."""

FINE = 4001
"""Points at which curvatures of the blade are integrated."""


def polynomials(path: Path, names: Sequence[str]) -> list[Array]:
    """Coefficients of the mode shapes in a tower or blade file, from the constant upwards, over the fraction of the length."""
    text = path.read_text()
    rows = ([re.search(rf"([-+\d.Ee]+)\s+{name}\({k}\)", text) for k in range(2, 7)] for name in names)
    return [np.array([0.0, 0.0, *(float(result[1]) for result in row if result)]) for row in rows]


def frequencies(turbine: Turbine, tower_file: Path, blade_file: Path, gravity: float) -> tuple[Array, tuple[str, ...]]:
    """(14,) natural frequencies in Hz, and the coordinate with most of each mode's elastic energy.

    Gravity acts as in ElastoDyn on the tower: the weight above each point shortens it, and the mass centre on top tips over.
    """
    M, K = np.zeros((14, 14)), np.zeros((14, 14))
    tower, shapes = turbine.tower, polynomials(tower_file, TOWER)
    h, w = (np.arange(TOWER_NODES) + 0.5) / TOWER_NODES, np.full(TOWER_NODES, tower.length / TOWER_NODES)
    value, slope, bent = (_derivatives(shapes, h, tower.length, order) for order in range(3))
    m, EI = mass_at(tower, h * tower.length)[:, 0, 0], stiffness_at(tower, h * tower.length)
    top = np.zeros((6, 14))  # twist of the tower's top: x up, z downwind
    end, turned = (_derivatives(shapes, np.ones(1), tower.length, order)[:, 0] for order in (0, 1))
    top[2, :2], top[4, :2], top[1, 2:4], top[5, 2:4] = end[:2], -turned[:2], end[2:], turned[2:]
    hub = sp.adjoint(sp.inverse(turbine.shaft)) @ top
    hub[5, 4] += 1.0
    K[4, 4] = turbine.drivetrain.stiffness
    M += top.T @ turbine.nacelle @ top + hub.T @ turbine.hub @ hub
    mass, first = _blades(turbine, blade_file, hub, M, K)
    rotor = turbine.hub[0, 0] + turbine.blades * mass
    carried = turbine.nacelle[0, 0] + rotor
    # static moment about the tower's top, along its axis
    lever = turbine.nacelle[1, 5] + rotor * turbine.shaft[0, 3] + turbine.blades * first * turbine.shaft[0, 2]
    above = carried + np.array([(w * m)[h > height].sum() for height in h])
    for part, bending in ((slice(0, 2), EI[:, 4, 4]), (slice(2, 4), EI[:, 5, 5])):
        M[part, part] += (value[part] * w * m) @ value[part].T
        K[part, part] += (bent[part] * w * bending) @ bent[part].T
        K[part, part] -= gravity * (slope[part] * w * above) @ slope[part].T
        K[part, part] -= gravity * lever * np.outer(turned[part], turned[part])
    squares, vectors = eigh(K, M)
    names = ("fore-aft 1", "fore-aft 2", "side-side 1", "side-side 2", "shaft", *("flap 1", "flap 2", "edge 1") * 3)
    energy = np.abs(vectors * (K @ vectors))
    return np.sqrt(squares) / (2.0 * np.pi), tuple(names[int(k)] for k in energy.argmax(0))


def blade_mass(turbine: Turbine) -> float:
    """Mass of a blade integrated over AeroDyn's elements, kg."""
    w = BLADE_ELEMENTS / BLADE_ELEMENTS.sum()
    s = (np.cumsum(w) - 0.5 * w) * turbine.blade.length
    return float((w * turbine.blade.length * mass_at(turbine.blade, s)[:, 0, 0]).sum())


def _blades(turbine: Turbine, path: Path, hub: Array, M: Array, K: Array) -> tuple[float, float]:
    """Add the blades to M and K; return a blade's mass and its first moment along the shaft's axis."""
    blade, shapes = turbine.blade, polynomials(path, BLADE)
    w = BLADE_ELEMENTS / BLADE_ELEMENTS.sum()
    h = np.cumsum(w) - 0.5 * w
    s, w = h * blade.length, w * blade.length
    m, EI = mass_at(blade, s)[:, 0, 0], stiffness_at(blade, s)
    bent = _derivatives(shapes, h, blade.length, 2)
    own = np.diag((bent**2 * w * np.stack([EI[:, 4, 4], EI[:, 4, 4], EI[:, 5, 5]])).sum(1))
    own[0, 1] = own[1, 0] = (bent[0] * bent[1] * w * EI[:, 4, 4]).sum()
    fine = np.linspace(0.0, 1.0, FINE)
    twist, curvature = twist_at(blade, fine * blade.length), _derivatives(shapes, fine, blade.length, 2)
    lag = np.stack([-np.sin(twist), -np.sin(twist), np.cos(twist)])  # of the section's flap and edge directions
    flap = np.stack([np.cos(twist), np.cos(twist), np.sin(twist)])
    y, z = (_twice(curvature * part, blade.length, h) for part in (lag, flap))
    c, d = np.cos(blade.precone), np.sin(blade.precone)
    along, out = np.array([c, 0.0, d]), np.array([-d, 0.0, c])
    for k in range(turbine.blades):
        turn = sp.rotation(2, np.array(2.0 * np.pi * k / turbine.blades))
        columns = slice(5 + 3 * k, 8 + 3 * k)
        for n, weight in enumerate(w * m):
            velocity = hub[:3] + np.cross(hub[3:], turn @ along * (blade.hub_radius + s[n]), axis=0)
            velocity[:, columns] += turn @ (np.outer([0.0, 1.0, 0.0], y[:, n]) + np.outer(out, z[:, n]))
            M += weight * velocity.T @ velocity
        K[columns, columns] += own
    return float((w * m).sum()), float((w * m * (blade.hub_radius + s)).sum() * d)


def _derivatives(shapes: Sequence[Array], h: Array, length: float, order: int) -> Array:
    """(shapes, points) derivatives along the beam."""
    values = np.array([polynomial.polyval(h, polynomial.polyder(c, order)) for c in shapes], float)
    return np.divide(values, length**order)


def _twice(curvature: Array, length: float, h: Array) -> Array:
    """Curvatures at ``FINE`` points, integrated twice, at fractions ``h`` of the length."""
    fine = np.linspace(0.0, 1.0, FINE)
    out = curvature
    for _ in range(2):
        out = cumulative_trapezoid(out, fine * length, initial=0.0, axis=1)
    return np.array([np.interp(h, fine, row) for row in out])
