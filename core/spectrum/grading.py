"""The graded mesh of a blade: nodes at kinks and stations, short elements in the boundary layer at the root."""

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import trapezoid

from ..blade import Blade
from ..sampling import mass_at, stiffness_at

Array = NDArray[np.float64]

_GROWTH = 1.5  # largest ratio of the lengths of successive elements, from the root outwards
_JUMP = 1e-4  # fraction of the blade's length: stations closer than this are one step of the properties
_MAX_STATIONS = 200  # with more stations, these are not made nodes


def coarse(blade: Blade, elements: int, omega: float) -> Array:
    """(n+1,) arc lengths of nodes: at least ``elements`` elements, the first no longer than the boundary layer at the root.

    A blade under tension T bends within about √(EI/T) of its clamp. ``omega`` is in rad/s.
    """
    longest = blade.length / elements
    sizes = [min(longest, _layer(blade, omega))]
    while sum(sizes) < blade.length:
        sizes.append(min(longest, _GROWTH * sizes[-1]))
    ends = np.append(0.0, np.cumsum(sizes)) * blade.length / sum(sizes)
    number = np.arange(len(ends), dtype=float)
    stations = blade.stations[1:-1] if len(blade.stations) <= _MAX_STATIONS else np.empty(0)
    required = [0.0, *blade.kinks, blade.length]
    for s in stations:
        if np.abs(np.array(required) - s).min() > _JUMP * blade.length:
            required.append(float(s))
    required.sort()
    at = np.interp(required, ends, number)
    pieces = np.maximum(np.ceil(np.diff(at) - 1e-9).astype(int), 1)
    inside = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(at[:-1], at[1:], pieces, strict=True)]
    nodes = np.interp(np.append(np.concatenate(inside), at[-1]), number, ends)
    nodes[np.append(0, np.cumsum(pieces))] = required
    return nodes


def halved(nodes: Array) -> Array:
    """Nodes (2n+1,) of the mesh with every element divided in two."""
    out = np.empty(2 * len(nodes) - 1)
    out[::2], out[1::2] = nodes, 0.5 * (nodes[1:] + nodes[:-1])
    return out


def _layer(blade: Blade, omega: float) -> float:
    """Thickness √(EI/T) of the boundary layer at the root, m, with the smaller EI."""
    s = np.linspace(0.0, blade.length, 401)
    mass = mass_at(blade, s)[:, 0, 0]
    tension = omega**2 * (
        float(trapezoid(mass * (blade.hub_radius + s), s)) + blade.tip_mass[0, 0] * (blade.hub_radius + blade.length)
    )
    EI = np.diagonal(stiffness_at(blade, s[:1])[0])[4:].min()
    return float(np.sqrt(EI / tension)) if tension > 0 and np.isfinite(EI) else blade.length
