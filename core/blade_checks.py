"""What a blade must be: a curve with the arc length of its stations, sections that resist, bodies that can exist.

Tolerances admit the rounding of published files and no more; each is stated where it is used.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import curve
from .space import spatial as sp

if TYPE_CHECKING:
    from .blade import Blade

Array = NDArray[np.float64]

ROOT = 1e-9
"""Of the length: a first station this near to 0 is the root."""

ASIDE = 0.2
"""Of the length: how far beside the root the reference curve may begin."""

ARC, ROUNDED = 2e-4, 1e-5
"""How much longer or shorter than the stations say the curve may be between two of them: of that length, and of the blade's.

The second admits coordinates rounded to millimetres. A spline is longer by half its mean square angle to the curve it should
follow: 1.1° is 2e-4. A smooth curve with points every 15° keeps within this; of a kink of 3° between few points it does not.
"""

NEAR = 3
"""How many stations away the corner may be about which a spline swings."""

BACK = -0.9
"""Least x component of the tangent: sections are swung from the blade's axes to it, which is not defined for −1."""

LINEAR, ROTARY = 1e-4, 1e-2
"""Departure of a mass matrix from a rigid body's: of its mass, of its moments of inertia (published ones are rounded)."""

SYMMETRIC = 1e-9
"""Departure from symmetry, of a unit diagonal."""

STRAINS = ("axial", "shear y", "shear z", "torsion", "bending about y", "bending about z")

GAUSS = 8


class BladeError(ValueError):
    """A blade that cannot be: the message names the field, the value, the likely cause and the remedy."""


def check(blade: "Blade") -> None:
    """Refuse a blade that cannot be.

    Raises:
        BladeError: naming the field, where along the blade, the value, the likely cause and the remedy.
    """
    _arrays(blade)
    _stations(blade)
    _kinks(blade)
    _curve(blade)
    _stiffness(blade)
    for k, s in enumerate(blade.stations):
        if wrong := body_fault(blade.mass[k], "kg/m"):
            raise BladeError(f"mass: at station {k} ({s:g} m): {wrong}")
    if blade.tip_mass.any() and (wrong := body_fault(blade.tip_mass, "kg")):
        raise BladeError(f"tip_mass: {wrong}")


def _arrays(blade: "Blade") -> None:
    n = len(blade.stations)
    matrices = dict.fromkeys(("stiffness", "mass"), (n, 6, 6))
    shapes = {"stations": (n,), "twist": (n,), "curve": (n, 3), "tip_mass": (6, 6), "root": (6,), **matrices}
    for name, shape in shapes.items():
        value = getattr(blade, name)
        if value.shape != shape:
            raise BladeError(f"{name}: shape {value.shape}, expected {shape}: one entry a station is needed")
        finite = ~np.isnan(value) if name in ("stiffness", "root") else np.isfinite(value)
        if not finite.all():
            where = np.argwhere(~finite)[0].tolist()
            raise BladeError(f"{name}: not a finite number at index {where}: a gap in the table? give every value")


def _stations(blade: "Blade") -> None:
    n = len(blade.stations)
    if n < 2:
        raise BladeError(f"stations: {n} given: a blade needs at least a root and a tip")
    if blade.stations[0] != 0.0:
        raise BladeError(f"stations: first is {blade.stations[0]:g} m: lengths are measured from the root; start at 0")
    if (np.diff(blade.stations) <= 0).any():
        k = int(np.argmax(np.diff(blade.stations) <= 0)) + 1
        raise BladeError(
            f"stations: number {k} ({blade.stations[k]:g} m) does not lie beyond the one before it "
            f"({blade.stations[k - 1]:g} m): sort them and drop duplicates"
        )
    if not np.isfinite(blade.hub_radius) or blade.hub_radius < 0:
        raise BladeError(f"hub_radius: {blade.hub_radius:g} m: it is a distance from the rotor's axis; give 0 or more")
    for name in ("precone", "pitch"):
        if not np.isfinite(getattr(blade, name)):
            raise BladeError(f"{name}: {getattr(blade, name)}: not a finite number; give an angle in radians")
    if (blade.root < 0).any():
        raise BladeError(f"root: {blade.root.min():g}: a negative spring; give 0 for free, inf for held")


def _kinks(blade: "Blade") -> None:
    inner = blade.stations[1:-1]
    for kink in blade.kinks:
        if kink not in inner:
            near = f"; the nearest is {inner[np.abs(inner - kink).argmin()]:g} m" if len(inner) else ""
            raise BladeError(
                f"kinks: {kink:g} m: not a station between root and tip{near}: the curve needs its point there; "
                "add a station, or correct the kink"
            )
    if (np.diff(blade.kinks) <= 0).any():
        raise BladeError(f"kinks: {list(blade.kinks)}: not ascending: sort them and drop duplicates")


def _curve(blade: "Blade") -> None:
    """|r′(s)| = 1: the spline through the points must have the arc length that the stations say, from a point at the root."""
    s, r, length = blade.stations, blade.curve, blade.length
    x, *beside = np.abs(r[0])
    if x > ROUNDED * length or np.hypot(*beside) > ASIDE * length:
        raise BladeError(
            f"curve: begins at ({r[0, 0]:.6g}, {r[0, 1]:.6g}, {r[0, 2]:.6g}) m: the curve is measured from the root and "
            f"begins there, at x = 0 and no more than {ASIDE:g} of the length beside it; subtract its first point "
            "(the hub's radius goes into hub_radius)"
        )
    step = np.diff(s)
    with np.errstate(over="ignore"):
        chord = np.linalg.norm(np.diff(r, axis=0), axis=1)
    allowed = ARC * step + ROUNDED * length
    if (chord > step + allowed).any():
        k = int(np.argmax(chord - step - allowed))
        raise BladeError(
            f"curve: its points at {s[k]:g} m and {s[k + 1]:g} m are {chord[k]:.6g} m apart, by their arc lengths "
            f"{step[k]:.6g} m: stations that are spans along x, or of another unit or blade? give the arc length along the "
            "curve"
        )
    arc = lengths(s, r, blade.kinks)
    if (np.abs(arc - step) > allowed).any():
        raise BladeError(_unresolved(blade, int(np.argmax(np.abs(arc - step) / allowed)), arc, chord, allowed))
    ends = np.concatenate([curve.at(s, r, blade.kinks, s, before=side)[1] for side in (False, True)])
    if (ends[:, 0] < BACK * np.linalg.norm(ends, axis=1)).any():
        k = int(np.argmin(ends[:, 0])) % len(s)
        raise BladeError(
            f"curve: turns back towards the hub at {s[k]:g} m: x, y and z in another order? the first runs along the blade"
        )


def lengths(s: Array, r: Array, kinks: tuple[float, ...] = ()) -> Array:
    """∫ |r′| ds (n−1,) between stations ``s`` (n,) of the spline through points ``r`` (n, 3), m."""
    node, weight = np.polynomial.legendre.leggauss(GAUSS)
    step = np.diff(s)
    inside = s[:-1, None] + step[:, None] * (node + 1) / 2
    _, rate = curve.at(s, r, kinks, inside.ravel())
    return np.linalg.norm(rate, axis=1).reshape(inside.shape) @ weight / 2 * step


def follows(s: Array, r: Array) -> bool:
    """Whether a spline through points ``r`` (n, 3) has the arc length that stations ``s`` (n,) say, as a blade's must."""
    return bool((np.abs(lengths(s, r) - np.diff(s)) <= ARC * np.diff(s) + ROUNDED * s[-1]).all())


def _unresolved(blade: "Blade", k: int, arc: Array, chord: Array, allowed: Array) -> str:
    """What to say of a spline whose length between stations k and k + 1 is not the arc length there."""
    s = blade.stations
    step, found = s[k + 1] - s[k], f"curve: between {s[k]:g} m and {s[k + 1]:g} m"
    along = np.diff(blade.curve, axis=0) / chord[:, None]
    turn = np.arccos(np.clip((along[1:] * along[:-1]).sum(1), -1.0, 1.0))  # at the inner stations
    turn[np.isin(s[1:-1], blade.kinks)] = 0.0
    beside, around = (turn[max(k - n, 0) : k + n] for n in (1, NEAR))
    longest = chord[k] / np.sinc(beside.max(initial=0.0) / (2 * np.pi))  # of an arc that turns so much
    if around.max(initial=0.0) > np.radians(1.0) and chord[k] - allowed[k] < step < longest + allowed[k]:
        corner = s[max(k - NEAR, 0) + 1 + int(around.argmax())]
        return (
            f"{found} the spline through its points is {arc[k]:.6g} m long instead of {step:.6g} m: it swings about the "
            f"curve, which turns by {np.degrees(around.max()):.3g}° at {corner:g} m; add points around there, or declare a "
            f"kink: kinks = [{corner:g}]"
        )
    return (
        f"{found} it is {arc[k]:.6g} m long, by the stations {step:.6g} m: not the arc length along the curve, or a point out "
        "of line? correct either"
    )


def _stiffness(blade: "Blade") -> None:
    rigid = np.isinf(blade.stiffness)
    for k, i, _ in np.argwhere(rigid != rigid.any(0))[:1]:
        raise BladeError(
            f"stiffness: {STRAINS[i]} at station {k} ({blade.stations[k]:g} m) is finite where other stations are rigid: a "
            "strain is rigid all along or nowhere; give inf, or a number, at every station"
        )
    never = rigid.any(0)
    d = np.diagonal(blade.stiffness, axis1=1, axis2=2)
    if (d <= 0).any():
        k, i = np.argwhere(d <= 0)[0]
        raise BladeError(
            f"stiffness: diagonal {i} ({STRAINS[i]}) at station {k} ({blade.stations[k]:g} m) is {d[k, i]:g}: it must be "
            "positive; wrong sign or unit?"
        )
    loose = np.isinf(d[0])
    coupled = never & ~np.eye(6, dtype=bool) | (blade.stiffness != 0).any(0) & (loose[:, None] ^ loose)
    for i, j in np.argwhere(coupled)[:1]:
        raise BladeError(
            f"stiffness: entry ({i}, {j}) couples a rigid strain: rows and columns of rigid strains are zero but for inf on "
            "the diagonal; remove it"
        )
    size = np.sqrt(np.where(np.isinf(d), 1.0, d))
    unit = np.where(rigid, 1.0, blade.stiffness) / (size[:, :, None] * size[:, None, :])
    wrong = np.abs(unit - np.swapaxes(unit, 1, 2))
    if wrong.max() > SYMMETRIC:
        k, i, j = np.unravel_index(int(wrong.argmax()), wrong.shape)
        one, other = blade.stiffness[k, i, j], blade.stiffness[k, j, i]
        raise BladeError(
            f"stiffness: entries ({i}, {j}) and ({j}, {i}) at station {k} ({blade.stations[k]:g} m) are {one:g} and "
            f"{other:g}: it must be symmetric; one triangle only, or a sign lost? correct one"
        )
    least = np.linalg.eigvalsh(unit)[:, 0]
    if least.min() <= 0:
        k = int(least.argmin())
        raise BladeError(
            f"stiffness: at station {k} ({blade.stations[k]:g} m) not positive definite (least eigenvalue {least[k]:.2g} of a "
            "unit diagonal): a coupling too large, or of the wrong unit? correct it"
        )


def body_fault(matrix: Array, unit: str) -> str | None:
    """Why an inertia (6, 6) about a point is no rigid body's, or a slice's: cause and remedy; None if it is one.

    It must be ``[[m, −m c×], [m c×, J]]``, one mass m ≥ 0 in all directions, and the moments of inertia about the mass centre,
    ``J + m c× c×``, must be those of a distribution of mass: none negative, none larger than the two others together.
    ``unit`` is that of the mass.
    """
    scale = np.abs(matrix).max()
    m, J = matrix[0, 0], matrix[3:, 3:]
    d = np.diag(matrix)
    if (d < 0).any() or (m == 0 and matrix[:3].any()) or (unit != "kg" and m == 0):
        i = int(np.argmin(d)) if (d < 0).any() else 0
        return (
            f"diagonal {i} is {d[i]:g} {unit if i < 3 else ''}".rstrip() + ": it must be positive; wrong sign or unit?"
        )
    if np.ptp(d[:3]) > LINEAR * m:
        return (
            f"{d[0]:g}, {d[1]:g}, {d[2]:g} {unit} along x, y, z: a body has one mass in all directions; a table's "
            "columns shifted? give one"
        )
    size = np.maximum(np.sqrt(d)[:, None] * np.sqrt(d), 1e-9 * scale)  # np.outer(d, d) may underflow
    wrong = np.abs(matrix - matrix.T) / size
    if wrong.max() > SYMMETRIC:
        i, j = np.unravel_index(int(wrong.argmax()), wrong.shape)
        return (
            f"entries ({i}, {j}) and ({j}, {i}) are {matrix[i, j]:g} and {matrix[j, i]:g}: it must be symmetric; one "
            "triangle only, or a sign lost? correct one"
        )
    linear = np.abs(np.triu(matrix[:3, :3], 1))
    if linear.max() > LINEAR * m:
        i, j = np.unravel_index(int(linear.argmax()), (3, 3))
        return (
            f"entry ({i}, {j}) is {matrix[i, j]:g}: motion along one axis has no momentum along another; wrong order of "
            "rows? make it 0"
        )
    moment = matrix[:3, 3:]
    even = np.abs(moment + moment.T)
    if even.max() > LINEAR * np.abs(moment).max() + 1e-6 * np.sqrt(m * max(np.trace(J), 0.0)):
        i, j = np.unravel_index(int(even.argmax()), (3, 3))
        return (
            f"entries ({i}, {j + 3}) and ({j}, {i + 3}) are {moment[i, j]:g} and {moment[j, i]:g}: mass times the centre's "
            "offset has opposite signs there, and zeros on the diagonal; wrong sign or order of rows? correct them"
        )
    first = 0.5 * np.array([moment[1, 2] - moment[2, 1], moment[2, 0] - moment[0, 2], moment[0, 1] - moment[1, 0]])
    cross = sp.skew(first / m) if m else np.zeros((3, 3))
    least, middle, most = np.linalg.eigvalsh(J + m * cross @ cross)
    rounding = ROTARY * np.trace(J)
    if least < -rounding or (m * np.abs(cross).max() ** 2 > 1e-12 * scale and not np.trace(J)):
        return (
            f"moments of inertia about the mass centre reach down to {least:.3g}: less than none; are those given about the "
            "mass centre? they are about the reference point, m d² included"
        )
    if most - middle - least > rounding:
        return (
            f"moments of inertia about the mass centre are {least:.3g}, {middle:.3g}, {most:.3g}: none can be larger than the "
            "two others together; of a section the polar one is their sum; give all three"
        )
    return None
