"""Effect of well-known faults on a blade's frequencies, used to identify the cause of a difference.

Each fault that every run seeds (``faults.table.FAST``) is solved in core alone. Whether the run detects it is tested in
``faults``.
"""

from dataclasses import dataclass

from ...core.blade import Blade
from ...core.element.discretize import Mass
from ...core.element.measures import Measure
from ...core.modes import Modes
from ..faults import table
from ..faults.seeding import seeded
from ..input.schema import Compare, Variant
from ..solve import core_solver, error_budget
from ..solve.error_budget import ModeChange, changed

ELEMENTS = core_solver.COARSEST
"""Elements with and without a fault: the discretisation errors nearly cancel in the change due to the fault."""

SAME_MODE = 5e-2
"""Relative distance within which core's converged answer and this coarser one are the same mode of a family: the error
of lumped mass is 2 %, and modes of a family are farther apart."""

CONSISTENT: tuple[Mass, Measure] = ("consistent", "corotational")

LUMPED: tuple[Mass, Measure] = ("half_end", "body_fixed")
"""The paper's discretisation."""

DISCRETISATIONS = {"whole end mass": LUMPED}
"""Faults of another discretisation than ``CONSISTENT``."""


@dataclass(frozen=True)
class FaultEffect:
    """Effect of one fault on a blade's compared modes at one speed; empty if there is no steady state."""

    fault: str
    omega: float
    modes: tuple[ModeChange, ...]


def solve(variant: Variant, compare: Compare) -> list[FaultEffect]:
    """Solve one blade with every fault at every speed."""
    out = []
    for omega in variant.speeds.tolist():
        count = 2 * compare.modes + 2
        solutions = {how: solved("", variant.blade, omega, count, how) for how in (CONSISTENT, LUMPED)}
        for fault in table.FAST:
            how = DISCRETISATIONS.get(fault, CONSISTENT)
            faultless, faulty = solutions[how], solved(fault, variant.blade, omega, count, how)
            modes = changed(faultless, faulty, variant.blade, compare) if faultless and faulty else ()
            out.append(FaultEffect(fault, omega, modes))
    return out


def solved(fault: str, blade: Blade, omega: float, count: int, how: tuple[Mass, Measure] = CONSISTENT) -> Modes | None:
    """Core's modes with one fault of the table, none with an empty name; None without a stable steady state.

    Args:
        fault: name in ``faults.table``; empty for core without a fault.
        blade: the blade.
        omega: rotor speed, rad/s.
        count: number of modes.
        how: how mass is lumped, and the frame in which the stiffness is linear.
    """
    mass, stiffness = how
    with seeded(table.BY_NAME[fault].seams if fault else ()):
        return error_budget.solved(blade, omega, ELEMENTS, count, mass=mass, stiffness=stiffness)
