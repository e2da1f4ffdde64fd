"""Validation against a measurement: comparison error and validation uncertainty (ASME V&V 20-2009, sec. 1-5).

``E = S − D`` contains the model error δ and the errors of the numerical solution, of the inputs and of the data. Only
the standard uncertainties of the latter are known: ``u_val² = u_num² + u_input² + u_D²``. Therefore δ lies within
``E ± k u_val``. A measurement is not a code: it neither confirms nor contradicts one.
"""

from dataclasses import dataclass, replace
from math import hypot, isfinite

from .cells import Head, empty, mode_fields
from .reference import Reference
from .results import Cell
from .verdict import percent, unsigned

COVERAGE = 2.0
"""Coverage factor k: about 95 % for normally distributed errors."""


@dataclass(frozen=True)
class Validation:
    """One simulated and measured frequency; all values in the same unit.

    Attributes:
        simulated: S.
        measured: D.
        numerical, inputs, data: standard uncertainties u_num, u_input and u_D; non-negative.
    """

    simulated: float
    measured: float
    numerical: float
    inputs: float
    data: float

    def __post_init__(self) -> None:
        for name in ("simulated", "measured"):
            if not (isfinite(getattr(self, name)) and getattr(self, name) > 0.0):
                raise ValueError(f"{name}: {getattr(self, name)}: a frequency is finite and above zero")
        for name in ("numerical", "inputs", "data"):
            value = getattr(self, name)
            if not (isfinite(value) and value >= 0.0):
                raise ValueError(f"{name}: {value}: an uncertainty is finite and not negative")

    @property
    def error(self) -> float:
        """E = S − D."""
        return self.simulated - self.measured

    @property
    def uncertainty(self) -> float:
        """u_val, the standard uncertainty of the comparison error."""
        return hypot(self.numerical, self.inputs, self.data)

    @property
    def relative(self) -> tuple[float, float]:
        """D/S − 1 and its uncertainty k u_val/S: the data relative to the simulation, as codes are to core."""
        return self.measured / self.simulated - 1.0, COVERAGE * self.uncertainty / self.simulated

    @property
    def visible(self) -> float:
        """Lower bound on the size of the model error: the part of |E| above k u_val, or 0."""
        return max(abs(self.error) - COVERAGE * self.uncertainty, 0.0)


def statement(v: Validation) -> str:
    """The conclusion about the model error, relative to the measured value."""
    if v.visible > 0.0:
        return f"model error visible (at least {least(v.visible / v.measured)})"
    return f"model error not visible at u_val = {100 * v.uncertainty / v.measured:.1f} %"


def least(size: float) -> str:
    """Format a visible error in percent: one decimal, or two significant digits below 0.1 %."""
    return f"{100 * size:.1f} %" if size >= 1e-3 else f"{100 * size:.2g} %"


def explained(v: Validation) -> str:
    """The statement with E and every uncertainty, relative to the measured value."""
    parts = {"u_num": v.numerical, "u_input": v.inputs, "u_D": v.data}
    sizes = ", ".join(f"{name} {unsigned(value / v.measured) if value else '0'}" for name, value in parts.items())
    u = f"u_val = {unsigned(v.uncertainty / v.measured)}" if v.visible > 0.0 else "u_val"
    return f"{statement(v)}: E = {percent(v.error / v.measured)}, {u} from {sizes}"


def visible(cell: Cell) -> float:
    """Lower bound on the model error at a measured point, relative to the measured value; 0 if none is visible."""
    if cell.difference is None or cell.uncertainty is None or not cell.value or not cell.reference:
        return 0.0
    return max(abs(cell.difference) - cell.uncertainty, 0.0) * cell.reference / cell.value


@dataclass(frozen=True)
class Datum:
    """A measured frequency.

    Attributes:
        value: D, rad/s.
        data, inputs: relative standard uncertainties of the datum, and of the simulation due to its inputs.
    """

    value: float
    data: float
    inputs: float


def measured(head: Head, omega: float, i: int, reference: Reference, datum: Datum) -> Cell:
    """The cell of a measured frequency of the ``i``-th mode that the case compares; never evidence.

    The numerical uncertainty of core's answer is a bound and is used as the standard uncertainty. If it is unknown, no
    statement is made.
    """
    cell = replace(
        empty(head, omega, "measured", ""),
        value=datum.value,
        **mode_fields(reference, i),
    )
    base = reference.core.modes[i].estimate
    if base is None:
        return replace(cell, verdict="not applicable", reason="Southwell's own solver has no frequency to compare with")
    validation = Validation(
        base.value,
        datum.value,
        (base.uncertainty or 0.0) * base.value,
        datum.inputs * base.value,
        datum.data * datum.value,
    )
    difference, uncertainty = validation.relative
    cell = replace(cell, reference=base.value, difference=difference)
    if base.uncertainty is None:
        return replace(cell, reason=f"not judged: u_num is unknown ({base.note})")
    return replace(cell, uncertainty=uncertainty, reason=explained(validation))
