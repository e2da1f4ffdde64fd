"""Effect of well-known faults on a blade's frequencies, used to identify the cause of a difference.

Each of ``core_faults.CORE_FAULTS`` is solved in core alone. Whether the matrix run detects such faults is tested in
``faults``.
"""

from dataclasses import dataclass

import numpy as np

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS
from ...core.modes import Modes
from ...core.spectrum.eigen import UnstableError
from ...core.steady.blade_state import SteadyStateError
from ..input.schema import Compare, Variant
from ..solve.changed import Changed, changed
from ..solve.core_solver import COARSEST
from .core_faults import CORE_FAULTS, Solve

ELEMENTS = COARSEST
"""Elements with and without a fault: the discretisation errors nearly cancel in the change due to the fault."""

SAME_MODE = 5e-2
"""Relative distance within which core's converged answer and this coarser one are the same mode of a family: the error
of lumped mass is 2 %, and modes of a family are farther apart."""


@dataclass(frozen=True)
class Wrong:
    """Effect of one fault on a blade's compared modes at one speed; empty if there is no steady state."""

    fault: str
    omega: float
    modes: tuple[Changed, ...]


def solve(variant: Variant, compare: Compare) -> list[Wrong]:
    """Solve one blade with every fault at every speed."""
    out = []
    for omega in variant.speeds.tolist():
        known: dict[Solve, Modes | None] = {}
        for m in CORE_FAULTS:
            if omega or m.at_rest:
                if m.right not in known:
                    known[m.right] = _solved(m.right, variant.blade, omega, compare)
                right, wrong = known[m.right], _solved(m.wrong, variant.blade, omega, compare)
                modes = changed(right, wrong, variant.blade, compare) if right and wrong else ()
                out.append(Wrong(m.name, omega, modes))
    return out


def _solved(solve: Solve, blade: Blade, omega: float, compare: Compare) -> Modes | None:
    """None without an answer: a faulty model may have no steady state, be singular, or give non-finite numbers."""
    try:
        with np.errstate(invalid="ignore"):
            return solve(blade, omega, ELEMENTS, 2 * compare.modes + 2, ALL_EFFECTS)
    except (SteadyStateError, UnstableError, ArithmeticError, ValueError):
        return None
