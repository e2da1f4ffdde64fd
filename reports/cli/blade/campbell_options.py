"""Converts the options of ``southwell campbell``; each function raises a CaseError that names the option."""

from collections.abc import Sequence
from math import inf
from pathlib import Path

from ....cases.campbell import prestress
from ....cases.input.errors import CaseError
from ....cases.plan import request
from ....core.blade import Blade
from ...shared.units import RAD_S, RPM, Units
from ..mounting import angle

MOST_PER_REV = 1000
"""Largest order n per revolution."""

TURBINES = (".fst", ".htc")
"""Endings of files that describe a whole turbine."""


def speeds(rpm: str | None, omega: str | None) -> tuple[tuple[float, ...], Units] | None:
    """Rotor speeds (rad/s) and their unit; None if neither option is given."""
    requested = request.speeds(rpm, omega)
    return requested and (requested[0], RPM if requested[1] else RAD_S)


def gravity(azimuth: float | None, tilt: float) -> tuple[float, float, float]:
    """Gravity in the hub's axes, m/s², at an azimuth and tilt in degrees; zero without an azimuth."""
    if azimuth is None and tilt:
        raise CaseError(f"--tilt {tilt:g}: no effect without --azimuth, since it tilts gravity: add --azimuth 0")
    at, tilt_angle = angle("--azimuth", azimuth), angle("--tilt", tilt)
    if at is None:
        return 0.0, 0.0, 0.0
    x, y, z = prestress.gravity(at, tilt_angle or 0.0).tolist()
    return x, y, z


def blade_alone(file: str) -> tuple[str, ...]:
    """A line for the model of a turbine, of which the diagram has one blade only; none for a blade's file."""
    if Path(file).suffix.lower() not in TURBINES:
        return ()
    name = Path(file).name
    return (
        f"{name}: one blade of the turbine, clamped at the hub; tower, drivetrain and other blades are not included",
    )


def no_blade_options(**given: bool) -> None:
    """Check that no option of a single blade is given for a turbine.

    Raises:
        CaseError: naming the first one.
    """
    for name, is_given in given.items():
        if is_given:
            raise CaseError(
                f"--{name}: this option is for one blade, not for a turbine: leave it out, or add --blade-only"
            )


def loads(azimuth: float | None, tilt: float, load: Path | None) -> tuple[str, ...]:
    """What the steady loads mean, one line each; empty without loads."""
    out = []
    if azimuth is not None:
        out.append(
            f"gravity: steady, with the blade frozen at azimuth {azimuth:g}° (0: up) and the rotor axis tilted by {tilt:g}° "
            "(positive: upwind end raised); on a turning rotor it varies once per revolution"
        )
    if load is not None:
        out.append(f"steady load of {load.name}: the blade is linearised about the deflection that it causes")
    return tuple(out)


def load(path: Path | None, blade: Blade) -> tuple[tuple[float, float, float], ...]:
    """The load of a file at the blade's stations, N/m in hub axes; empty without a file."""
    return () if path is None else tuple((x, y, z) for x, y, z in prestress.load(path, blade).tolist())


def per_rev(text: str) -> tuple[int, ...]:
    """The orders in ``1:6`` or ``1,2,3,6``, ascending."""
    first, colon, last = text.partition(":")
    try:
        orders = (
            tuple(range(int(first), min(int(last), MOST_PER_REV + 1) + 1))
            if colon
            else tuple(sorted({int(p) for p in text.split(",")}))
        )
    except ValueError:
        raise CaseError(
            f"--per-rev: {text!r} is neither first:last nor whole numbers with commas, as in 1:6 or 1,3,6"
        ) from None
    if not orders or orders[0] < 1 or orders[-1] > MOST_PER_REV:
        raise CaseError(f"--per-rev: {text!r}: needs 1 ≤ first ≤ last ≤ {MOST_PER_REV}, as in 1:6")
    return orders


def operating(text: str, units: Units, speeds: Sequence[float]) -> tuple[float, float]:
    """The operating range in rad/s from text such as ``6.9:12.1`` in ``units``, within ``speeds`` (rad/s)."""
    try:
        low, high = (float(p) for p in text.split(":"))
    except ValueError:
        raise CaseError(f"--operating: {text!r} is not lowest:highest, as in 6.9:12.1") from None
    if not (0 <= low <= high < inf and high > 0):
        raise CaseError(f"--operating: {text!r}: needs 0 ≤ lowest ≤ highest, as in 6.9:12.1")
    first, last = speeds[0] * units.speeds, speeds[-1] * units.speeds
    if low < first - 1e-9 * last or high > last * (1 + 1e-9):
        raise CaseError(
            f"--operating: {text!r}: beyond the speeds, {first:g} to {last:g} {units.speed}: widen the speeds, or correct "
            "the range"
        )
    return low / units.speeds, high / units.speeds
