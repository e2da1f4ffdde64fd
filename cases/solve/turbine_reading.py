"""Compare a turbine with a second reading of its deck: tower, tower top and drivetrain, quantity by quantity."""

from pathlib import Path

import numpy as np

from ...core.blade import BEND_Y, BEND_Z
from ...core.turbine.turbine import Turbine
from ...references.readers import NotReadError, hawc2_turbine, openfast_turbine
from ..input.readers.source import Mount
from ..judge.results import PropertyCheck
from ..reading.comparison import TARGET

SMALL = 1e-9
"""Relative to the largest quantity of the same unit: below it a difference is rounding."""

OVERRIDDEN = {"hub radius": "hub_radius", "cone of the blades": "precone"}
"""Quantities that a field of ``Mount`` overrides."""


def quantities(turbine: Turbine) -> dict[str, float]:
    """The quantities of the second readers as the turbine has them; x up, y to starboard, z downwind."""
    tower, nacelle, shaft, drive = turbine.tower, turbine.nacelle, turbine.shaft, turbine.drivetrain

    def along(values: np.ndarray) -> float:
        return float(np.trapezoid(values, tower.stations))

    first = nacelle[[5, 3, 4], [1, 2, 0]]  # m c, from the lower left block m c×
    return {
        "height of the tower": tower.length,
        "mass of the tower": along(tower.mass[:, 0, 0]),
        "fore-aft stiffness along the tower": along(tower.stiffness[:, BEND_Y, BEND_Y]),
        "side-to-side stiffness along the tower": along(tower.stiffness[:, BEND_Z, BEND_Z]),
        "hub's centre above the tower's top": float(shaft[0, 3]),
        "hub's centre downwind of the tower's top": float(shaft[2, 3]),
        "rise of the shaft downwind": float(shaft[0, 2]),
        "mass of the nacelle": float(nacelle[0, 0]),
        "moment of the nacelle's mass downwind": float(first[2]),
        "moment of the nacelle's mass to port": float(-first[1]),
        "moment of the nacelle's mass up": float(first[0]),
        "nacelle's inertia about the yaw axis": float(nacelle[3, 3]),
        "mass of the hub": float(turbine.hub[0, 0]),
        "hub's inertia about the shaft": float(turbine.hub[5, 5]),
        "generator's inertia on the rotor's side": drive.generator * drive.gear_ratio**2,
        "stiffness of the shaft": drive.stiffness,
        "hub radius": turbine.blade.hub_radius,
        "cone of the blades": turbine.blade.precone,
    }


def read_again(case: str, turbine: Turbine, path: Path, mount: Mount | None = None) -> list[PropertyCheck]:
    """The rows of a second reading of a turbine's .fst or .htc, without what ``mount`` overrides; one that says why if none."""
    try:
        second, reader = (hawc2_turbine if path.suffix.lower() == ".htc" else openfast_turbine).read(path)
    except NotReadError as error:
        return [PropertyCheck(case, "second reader", "", "reading", "", TARGET, "not run", str(error))]
    name, _, version = reader.rpartition(" ")
    own = quantities(turbine)
    sizes: dict[str, float] = {}
    for value, unit in second.values():
        sizes[unit] = max(sizes.get(unit, 0.0), abs(value))
    rows = []
    overridden = {name for name, field in OVERRIDDEN.items() if mount and getattr(mount, field) is not None}
    for quantity, (value, unit) in second.items():
        if quantity in overridden:
            continue
        size = max(abs(own[quantity]), abs(value), SMALL * sizes[unit], np.finfo(float).tiny)
        difference = (own[quantity] - value) / size
        agrees = abs(difference) <= TARGET
        reason = "" if agrees else f"{quantity}: reader {own[quantity]:.6g} {unit}, {reader} {value:.6g}".strip()
        rows.append(
            PropertyCheck(
                *(case, name, version, "reading", quantity, TARGET, "pass" if agrees else "fail", reason),
                *(own[quantity], value, unit, float(difference)),
            )
        )
    return rows
