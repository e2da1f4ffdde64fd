"""Steady loads at the root as tables: one row per speed, in the hub's axes and in the blade's."""

from collections.abc import Sequence

import numpy as np

from ....core.root_loads import RootLoads
from ...shared.certain import certain
from ...shared.sheets import Sheet
from ...shared.units import Units

HEAD = ("speed", *(f"F{axis},\u00a0N" for axis in "xyz"), *(f"M{axis},\u00a0N\u00a0m" for axis in "xyz"))

NOTE = "Force and moment about the root with which the blade acts on the hub, in vacuo and without gravity"


def sheets(loads: Sequence[RootLoads], units: Units) -> tuple[Sheet, Sheet]:
    """The loads in the hub's axes, and in the axes that are coned and pitched with the blade."""
    hub = [_row(at, (*at.force, *at.moment), units) for at in loads]
    blade = [_row(at, (*force, *moment), units) for at in loads for force, moment in [at.in_blade_axes]]
    force, moment = np.max([at.uncertainty for at in loads], axis=0)
    note = f"{NOTE}; numerical uncertainty at most {force:.0e} N and {moment:.0e} N m."
    return (
        Sheet("Steady loads at the root, hub's axes (z: rotor's axis)", HEAD, tuple(hub)),
        Sheet("Steady loads at the root, blade's axes (coned and pitched)", HEAD, tuple(blade), note),
    )


CSV = "root-loads.csv"


def table(loads: Sequence[RootLoads]) -> str:
    """All digits as CSV: the loads in the hub's axes, then those in the blade's, and the uncertainties."""
    axes = [f"{kind}{axis} [{unit}]" for kind, unit in (("F", "N"), ("M", "N m")) for axis in "xyz"]
    head = ["omega [rad/s]", *axes, *(f"blade {name}" for name in axes), "± F [N]", "± M [N m]"]
    rows = [(at.omega, *at.force, *at.moment, *np.ravel(at.in_blade_axes), *at.uncertainty) for at in loads]
    return "\n".join([",".join(head), *(",".join(repr(float(x)) for x in row) for row in rows)]) + "\n"


def _row(at: RootLoads, values: Sequence[float], units: Units) -> tuple[str, ...]:
    force, moment = at.uncertainty
    fields = (number(x, u) for x, u in zip(values, (*[force] * 3, *[moment] * 3), strict=True))
    return (units.at(at.omega), *fields)


def number(x: float, uncertainty: float) -> str:
    """A load with the digits that its uncertainty allows, at most seven; zero within its uncertainty."""
    return "0" if abs(x) <= uncertainty else certain(x, uncertainty / abs(x))
