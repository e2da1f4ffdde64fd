"""Validation of a blade: arc length of the curve, positive definite sections, physically possible inertias.

The tolerances admit the rounding of published files.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import curve
from .space import gauss
from .space.inertia import about_centre

if TYPE_CHECKING:
    from .blade import Blade

Array = NDArray[np.float64]

ROOT_TOLERANCE = 1e-9
"""Fraction of the length within which the first station counts as 0."""

MAX_ROOT_OFFSET = 0.2
"""Largest distance of the curve's first point from the x axis, as a fraction of the length."""

MIN_LENGTH, MAX_LENGTH = 1e-6, 1e4
"""Limits of the length, m; the second also of the hub radius. Values outside usually mean a wrong unit."""

MAX_PRECONE, MAX_PITCH = 90.0, 180.0
"""Largest magnitudes, degrees. At a precone of 90° the blade is parallel to the rotor's axis, like a shaft."""

ARC_TOLERANCE, COORDINATE_ROUNDING = 2e-4, 1e-5
"""Largest difference between the length of the curve and the stations: fractions of the interval and of the blade's length.

The second admits coordinates rounded to millimetres. A spline is too long by half its mean square angle to the true curve:
1.1° gives 2e-4. A smooth curve with a point every 15° passes; an undeclared kink of 3° between few points does not.
"""

SWING_REACH = 3
"""Number of stations over which a spline oscillates about a corner."""

MIN_TANGENT_X = -0.9
"""Smallest x component of the unit tangent: the rotation from the x axis to the tangent is undefined at −1."""

MASS_TOLERANCE, INERTIA_TOLERANCE = 1e-4, 1e-2
"""Largest deviation of a mass matrix from that of a rigid body, relative to its mass and to its moments of inertia."""

SYMMETRY_TOLERANCE = 1e-9
"""Largest asymmetry of a matrix scaled to a unit diagonal."""

ZERO_MOMENT = 1e-9
"""Smallest moment of inertia, as a fraction of the largest, that scales a matrix; smaller ones may be rounding of zero."""

MIN_SIZE, MAX_SIZE = 1e-100, 1e100
"""Smallest and largest stiffness, mass or moment of inertia, SI units: products of a few of them are finite and not zero."""

STRAINS = ("axial", "shear y", "shear z", "torsion", "bending about y", "bending about z")

GAUSS = 8


class BladeError(ValueError):
    """An invalid blade: the message names the field, the value, the likely cause and the remedy."""


def check_blade(blade: "Blade") -> None:
    """Validate a blade.

    Raises:
        BladeError: invalid data; the message names the field, the station, the value, the likely cause and the remedy.
    """
    _arrays(blade)
    _stations(blade)
    _kinks(blade)
    _curve(blade)
    _stiffness(blade)
    for k, s in enumerate(blade.stations):
        if problem := body_fault(blade.mass[k], "kg/m"):
            raise BladeError(f"mass: at station {k} ({s:g} m): {problem}")
    if blade.tip_mass.any() and (problem := body_fault(blade.tip_mass, "kg")):
        raise BladeError(f"tip_mass: {problem}")


def _arrays(blade: "Blade") -> None:
    n = len(blade.stations)
    matrices = dict.fromkeys(("stiffness", "mass"), (n, 6, 6))
    shapes = {"stations": (n,), "twist": (n,), "curve": (n, 3), "tip_mass": (6, 6), "root": (6,), **matrices}
    for name, shape in shapes.items():
        value = getattr(blade, name)
        if value.shape != shape:
            raise BladeError(f"{name}: shape {value.shape}, expected {shape}: one entry per station is needed")
        finite = ~np.isnan(value) if name in ("stiffness", "root") else np.isfinite(value)
        if not finite.all():
            where = np.argwhere(~finite)[0].tolist()
            raise BladeError(f"{name}: not a finite number at index {where}: give every value")


def _stations(blade: "Blade") -> None:
    n = len(blade.stations)
    if n < 2:
        raise BladeError(f"stations: {n} given: a blade needs at least a root and a tip")
    if blade.stations[0] != 0.0:
        raise BladeError(f"stations: first is {blade.stations[0]:g} m: lengths are measured from the root; start at 0")
    if (np.diff(blade.stations) <= 0).any():
        k = int(np.argmax(np.diff(blade.stations) <= 0)) + 1
        raise BladeError(
            f"stations: number {k} ({blade.stations[k]:g} m) is not greater than the one before it "
            f"({blade.stations[k - 1]:g} m): sort them and remove duplicates"
        )
    if not MIN_LENGTH <= blade.stations[-1] <= MAX_LENGTH:
        raise BladeError(
            f"length: {blade.stations[-1]:g} m: not between {MIN_LENGTH:g} and {MAX_LENGTH:g} m: check the unit"
        )
    if not 0.0 <= blade.hub_radius <= MAX_LENGTH:
        raise BladeError(f"hub_radius: {blade.hub_radius:g} m: not between 0 and {MAX_LENGTH:g} m: check the unit")
    for name, limit in (("precone", MAX_PRECONE), ("pitch", MAX_PITCH)):
        angle = np.degrees(getattr(blade, name))
        if not abs(angle) <= limit + 1e-9:
            raise BladeError(f"{name}: {angle:.6g} degrees: beyond ±{limit:g}: check the unit")
    if (blade.root < 0).any():
        raise BladeError(f"root: {blade.root.min():g}: a negative spring; give 0 for free, inf for clamped")


def _kinks(blade: "Blade") -> None:
    inner_stations = blade.stations[1:-1]
    for kink in blade.kinks:
        if kink not in inner_stations:
            nearest = (
                f"; the nearest is {inner_stations[np.abs(inner_stations - kink).argmin()]:g} m"
                if len(inner_stations)
                else ""
            )
            raise BladeError(
                f"kinks: {kink:g} m: not a station between root and tip{nearest}: a kink must be at a station; "
                "add one there, or correct the kink"
            )
    if (np.diff(blade.kinks) <= 0).any():
        raise BladeError(f"kinks: {list(blade.kinks)}: not ascending: sort them and remove duplicates")


def _curve(blade: "Blade") -> None:
    """Check that the curve begins at the root and that its arc length is that of the stations, |r′(s)| = 1."""
    s, r, length = blade.stations, blade.curve, blade.length
    x, *across = np.abs(r[0])
    if x > COORDINATE_ROUNDING * length or np.hypot(*across) > MAX_ROOT_OFFSET * length:
        raise BladeError(
            f"curve: begins at ({r[0, 0]:.6g}, {r[0, 1]:.6g}, {r[0, 2]:.6g}) m: it must begin at the root, at x = 0 and "
            f"within {MAX_ROOT_OFFSET:g} of the length from the x axis; subtract its first point (the hub's radius goes into "
            "hub_radius)"
        )
    step = np.diff(s)
    with np.errstate(over="ignore"):
        chord = np.linalg.norm(np.diff(r, axis=0), axis=1)
    allowed = ARC_TOLERANCE * step + COORDINATE_ROUNDING * length
    if (chord > step + allowed).any():
        k = int(np.argmax(chord - step - allowed))
        spans = "the stations are spans along x; " if np.allclose(step, np.diff(r[:, 0]), rtol=1e-3) else ""
        raise BladeError(
            f"curve: its points at {s[k]:g} m and {s[k + 1]:g} m are {chord[k]:.6g} m apart, but their arc lengths differ by "
            f"{step[k]:.6g} m: {spans}give the arc length along the curve, in the unit of the curve"
        )
    arc = lengths(s, r, blade.kinks)
    if (np.abs(arc - step) > allowed).any():
        raise BladeError(_unresolved(blade, int(np.argmax(np.abs(arc - step) / allowed)), arc, chord, allowed))
    ends = np.concatenate([curve.at(s, r, blade.kinks, s, root_side=side)[1] for side in (False, True)])
    if (ends[:, 0] < MIN_TANGENT_X * np.linalg.norm(ends, axis=1)).any():
        k = int(np.argmin(ends[:, 0])) % len(s)
        raise BladeError(
            f"curve: turns back towards the hub at {s[k]:g} m: x must run along the blade; check the order of x, y and z"
        )


def lengths(s: Array, r: Array, kinks: tuple[float, ...] = ()) -> Array:
    """∫ |r′| ds (n−1,) between stations ``s`` (n,) of the spline through points ``r`` (n, 3), m."""
    inside, weight = gauss.between(s, GAUSS)
    _, rate = curve.at(s, r, kinks, inside.ravel())
    return (np.linalg.norm(rate, axis=1).reshape(inside.shape) * weight).sum(1)


def follows(s: Array, r: Array) -> bool:
    """Whether the spline through points ``r`` (n, 3), m, has the arc lengths ``s`` (n,), m, as ``check_blade`` requires."""
    return bool((np.abs(lengths(s, r) - np.diff(s)) <= ARC_TOLERANCE * np.diff(s) + COORDINATE_ROUNDING * s[-1]).all())


def _unresolved(blade: "Blade", k: int, arc: Array, chord: Array, allowed: Array) -> str:
    """Message for a spline whose length between stations k and k + 1 is not the difference of their arc lengths."""
    s = blade.stations
    step, interval = s[k + 1] - s[k], f"curve: between {s[k]:g} m and {s[k + 1]:g} m"
    along = np.diff(blade.curve, axis=0) / chord[:, None]
    bend = np.arccos(np.clip((along[1:] * along[:-1]).sum(1), -1.0, 1.0))  # at the inner stations
    bend[np.isin(s[1:-1], blade.kinks)] = 0.0
    adjacent, nearby = (bend[max(k - n, 0) : k + n] for n in (1, SWING_REACH))
    longest = chord[k] / np.sinc(adjacent.max(initial=0.0) / (2 * np.pi))  # circular arc with that turn
    if nearby.max(initial=0.0) > np.radians(1.0) and chord[k] - allowed[k] < step < longest + allowed[k]:
        corner = s[max(k - SWING_REACH, 0) + 1 + int(nearby.argmax())]
        return (
            f"{interval} the spline through its points is {arc[k]:.6g} m long instead of {step:.6g} m: it oscillates because "
            f"the curve turns by {np.degrees(nearby.max()):.3g}° at {corner:g} m; add points there, or declare a kink: "
            f"kinks = [{corner:g}]"
        )
    return (
        f"{interval} it is {arc[k]:.6g} m long, but the stations differ by {step:.6g} m: check the arc lengths "
        "and the points"
    )


def _stiffness(blade: "Blade") -> None:
    rigid = np.isinf(blade.stiffness)
    for k, i, _ in np.argwhere(rigid != rigid.any(0))[:1]:
        raise BladeError(
            f"stiffness: {STRAINS[i]} at station {k} ({blade.stations[k]:g} m) is finite but rigid at other stations: a "
            "strain must be rigid (inf) at every station or at none"
        )
    rigid_entry = rigid.any(0)
    d = np.diagonal(blade.stiffness, axis1=1, axis2=2)
    if (d <= 0).any():
        k, i = np.argwhere(d <= 0)[0]
        raise BladeError(
            f"stiffness: diagonal {i} ({STRAINS[i]}) at station {k} ({blade.stations[k]:g} m) is {d[k, i]:g}: it must be "
            "positive; check its sign and unit"
        )
    rigid_d = np.isinf(d[0])
    extreme = ~rigid_d & ((d < MIN_SIZE) | (d > MAX_SIZE))
    for k, i in np.argwhere(extreme)[:1]:
        raise BladeError(
            f"stiffness: diagonal {i} ({STRAINS[i]}) at station {k} ({blade.stations[k]:g} m) is {d[k, i]:g}: not between "
            f"{MIN_SIZE:g} and {MAX_SIZE:g}: check the unit"
        )
    coupled = rigid_entry & ~np.eye(6, dtype=bool) | (blade.stiffness != 0).any(0) & (rigid_d[:, None] ^ rigid_d)
    for i, j in np.argwhere(coupled)[:1]:
        raise BladeError(
            f"stiffness: entry ({i}, {j}) couples a rigid strain: rows and columns of rigid strains are zero except for inf "
            "on the diagonal; remove it"
        )
    size = np.sqrt(np.where(np.isinf(d), 1.0, d))
    unit = np.where(rigid, 1.0, blade.stiffness) / (size[:, :, None] * size[:, None, :])
    asymmetry = np.abs(unit - np.swapaxes(unit, 1, 2))
    if asymmetry.max() > SYMMETRY_TOLERANCE:
        k, i, j = np.unravel_index(int(asymmetry.argmax()), asymmetry.shape)
        upper, lower = blade.stiffness[k, i, j], blade.stiffness[k, j, i]
        raise BladeError(
            f"stiffness: entries ({i}, {j}) and ({j}, {i}) at station {k} ({blade.stations[k]:g} m) are {upper:g} and "
            f"{lower:g}: it must be symmetric; supply both triangles with equal entries"
        )
    smallest = np.linalg.eigvalsh(unit)[:, 0]
    if smallest.min() <= 0:
        k = int(smallest.argmin())
        raise BladeError(
            f"stiffness: at station {k} ({blade.stations[k]:g} m) not positive definite (least eigenvalue {smallest[k]:.2g} "
            "of a unit diagonal): a coupling is too large; check the off-diagonal entries and their units"
        )


def body_fault(matrix: Array, unit: str) -> str | None:
    """Describe why an inertia (6, 6) is not that of a rigid body or a slice of one, with the remedy; None if it is.

    It must be ``[[m, −m c×], [m c×, J]]`` with one mass m ≥ 0 in all directions. The moments of inertia about the mass centre,
    ``J + m c× c×``, must be those of a distribution of mass: none negative, none larger than the sum of the other two.
    ``unit`` is the unit of the mass.
    """
    m, J = matrix[0, 0], matrix[3:, 3:]
    d = np.diag(matrix)
    if (d < 0).any() or (m == 0 and matrix[:3].any()) or (unit != "kg" and m == 0):
        i = int(np.argmin(d)) if (d < 0).any() else 0
        return (
            f"diagonal {i} is {d[i]:g} {unit if i < 3 else ''}".rstrip()
            + ": it must be positive; check its sign and unit"
        )
    if ((d > 0) & (d < MIN_SIZE) | (d > MAX_SIZE)).any():
        i = int(np.argmax((d > 0) & (d < MIN_SIZE) | (d > MAX_SIZE)))
        return f"diagonal {i} is {d[i]:g}: not between {MIN_SIZE:g} and {MAX_SIZE:g}: check the unit"
    if np.ptp(d[:3]) > MASS_TOLERANCE * m:
        return (
            f"{d[0]:g}, {d[1]:g}, {d[2]:g} {unit} along x, y, z: a body has the same mass in all directions; check "
            "the order of the columns"
        )
    size = np.sqrt(
        np.maximum(d, ZERO_MOMENT * np.repeat([m, d[3:].max()], 3))
    )  # of a unit diagonal; np.outer may underflow
    asymmetry = np.abs(matrix - matrix.T) - SYMMETRY_TOLERANCE * (size[:, None] * size)
    if (asymmetry > 0).any():
        i, j = np.unravel_index(int(asymmetry.argmax()), asymmetry.shape)
        return (
            f"entries ({i}, {j}) and ({j}, {i}) are {matrix[i, j]:g} and {matrix[j, i]:g}: it must be symmetric; supply "
            "both triangles with equal entries"
        )
    linear = np.abs(np.triu(matrix[:3, :3], 1))
    if linear.max() > MASS_TOLERANCE * m:
        i, j = np.unravel_index(int(linear.argmax()), (3, 3))
        return (
            f"entry ({i}, {j}) is {matrix[i, j]:g}: motion along one axis has no momentum along another; check the "
            "order of the rows"
        )
    moment = matrix[:3, 3:]
    symmetric_part = np.abs(moment + moment.T)
    if symmetric_part.max() > MASS_TOLERANCE * np.abs(moment).max() + 1e-6 * np.sqrt(m * max(np.trace(J), 0.0)):
        i, j = np.unravel_index(int(symmetric_part.argmax()), (3, 3))
        return (
            f"entries ({i}, {j + 3}) and ({j}, {i + 3}) are {moment[i, j]:g} and {moment[j, i]:g}: they must be opposite "
            "(mass times offset of the centre), 0 on the diagonal; check signs and the order of the rows"
        )
    *_, moments = about_centre(matrix)
    smallest_moment, middle, largest_moment = np.linalg.eigvalsh(moments)
    rounding = INERTIA_TOLERANCE * np.trace(J)
    if (smallest := np.linalg.eigvalsh(J)[0]) < -rounding:
        return (
            f"smallest principal moment of inertia is {smallest:.3g}: the products of inertia are too large for the moments "
            f"{J[0, 0]:.3g}, {J[1, 1]:.3g}, {J[2, 2]:.3g}; correct them, or set all moments and products to zero to leave out "
            "rotary inertia"
        )
    if smallest_moment < -rounding:
        return (
            f"smallest moment of inertia about the mass centre is {smallest_moment:.3g}: negative; give the moments about the "
            "reference point, m d² included"
        )
    if largest_moment - middle - smallest_moment > rounding:
        return (
            f"moments of inertia about the mass centre are {smallest_moment:.3g}, {middle:.3g}, {largest_moment:.3g}: none "
            "can be larger than the sum of the other two; a section's polar one is that sum; give all three"
        )
    return None
