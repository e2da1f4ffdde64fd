"""The curved solids of the package, and how a blade is recognised as the beam of one of them."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade, clamped
from ..protocol import store
from . import hexahedra, identified
from .curved import CurvedSolid
from .materials import Orthotropic

Array = NDArray[np.float64]

GLASS = Orthotropic(
    young=(40e9, 12e9, 12e9),
    poisson=(0.28, 0.28, 0.4),
    shear=(4.5e9, 4.5e9, 12e9 / 2.8),
    density=1900.0,
    angle=float(np.radians(20.0)),
)
"""Glass fibres in epoxy, at 20° to the reference curve; isotropic across the fibres."""

CURVED = CurvedSolid(
    name="curved-solid",
    length=3.0,
    hub_radius=0.3,
    sweep=0.2,
    prebend=-0.12,
    twist=(0.3, 0.0),
    chord=(0.05, 0.04),
    thickness=(0.018, 0.0144),
    edges=(0.6, 1.4),
    behind=0.6,
    below=0.4,
    material=GLASS,
)
"""Sixty chords long, swept by 0.3 m against the motion's direction and prebent by 0.18 m upwind, twisted and tapered."""

SOLIDS = (CURVED,)

ACROSS = (4, 2)
"""Elements in a section, along the chord and through the thickness, of the solids and of their slices."""

TOLERANCE, STIFFNESS_TOLERANCE = 1e-6, 1e-3
"""Largest difference of curve, twist and mass, and of stiffness, of a blade that is recognised; relative."""

POINTS = 4
"""Stations at which sections are identified again; a polynomial between them follows the taper to 4e-5."""


def recognised(blade: Blade) -> tuple[CurvedSolid | None, str]:
    """The solid whose beam a blade is, or none and the reason."""
    why = "no solid with this axis is known"
    for solid in SOLIDS:
        if not _same_axis(solid, blade):
            continue
        if reason := _other_mount(blade):
            return None, reason
        if off := _off(blade.mass, identified.mass(solid, blade.stations), TOLERANCE):
            return None, f"mass: {off} from that of the solid {solid.name!r}"
        if hexahedra.version() and (
            off := _off(blade.stiffness, _stiffness(solid, tuple(blade.stations)), STIFFNESS_TOLERANCE)
        ):
            return None, f"stiffness: {off} from that identified from the solid {solid.name!r}"
        return solid, ""
    return None, why


def _same_axis(solid: CurvedSolid, blade: Blade) -> bool:
    s = blade.stations
    if abs(blade.length / solid.length - 1.0) > TOLERANCE:
        return False
    pairs = (
        (blade.curve / solid.length, solid.curve(s) / solid.length),
        (blade.twist, solid.twisted(s)),
        (blade.hub_radius / solid.length, solid.hub_radius / solid.length),
    )
    return all(np.abs(a - b).max() <= TOLERANCE for a, b in pairs)


def _other_mount(blade: Blade) -> str:
    """Reason if a blade has a mounting that the solid has not."""
    differing = {
        "precone": blade.precone,
        "pitch": blade.pitch,
        "tip mass": blade.tip_mass.any(),
        "a root that is not clamped": not clamped(blade),
        "kinks": blade.kinks,
    }
    return ", ".join(f"{name}: this solid has none" for name, present in differing.items() if present)


def _off(actual: Array, expected: Array, allowed: float) -> str:
    """The largest difference of symmetric matrices (k, 6, 6), relative to their diagonals, in words, if above ``allowed``."""
    size = np.sqrt(np.diagonal(expected, axis1=1, axis2=2))
    off = np.triu(np.abs(actual - expected) / (size[:, :, None] * size[:, None]))  # below, the same but for rounding
    if np.nan_to_num(off, nan=np.inf).max() <= allowed:
        return ""
    k, i, j = np.unravel_index(int(np.nan_to_num(off, nan=np.inf).argmax()), off.shape)
    return f"entry ({i}, {j}) at station {k} differs by {off[k, i, j]:.1e}"


@cache
def _stiffness(solid: CurvedSolid, stations: tuple[float, ...]) -> Array:
    """(k, 6, 6) section stiffness, interpolated between a few stations."""
    points = 0.5 * solid.length * (1.0 - np.cos(np.pi * np.arange(POINTS) / (POINTS - 1)))
    made_of = (solid, points.tolist(), hexahedra.version())
    sections = store.array(f"{solid.name}, sections", made_of, lambda: identified.stiffness(solid, points, ACROSS))
    at = 2.0 * np.array(stations) / solid.length - 1.0
    nodes = np.vander(2.0 * points / solid.length - 1.0, POINTS)
    return (np.vander(at, POINTS) @ np.linalg.solve(nodes, sections.reshape(POINTS, 36))).reshape(-1, 6, 6)
