"""A simulation against a measurement: the comparison error and what it says of the model (ASME V&V 20-2009, sec. 1-5).

``E = S − D`` holds the model's error δ, and errors of the numerical solution, of the inputs and of the data that are known
only by their standard uncertainties: ``u_val² = u_num² + u_input² + u_D²``. So δ lies within ``E ± k u_val``. A measurement
is no code: nothing here contradicts anything.
"""

from dataclasses import dataclass
from math import hypot, isfinite

from .results import Cell
from .verdict import percent, unsigned

COVERAGE = 2.0
"""k: about 95 % where the errors are normally distributed."""


@dataclass(frozen=True)
class Validation:
    """One frequency, simulated and measured; all in one unit.

    Attributes:
        simulated: S.
        measured: D.
        numerical, inputs, data: standard uncertainties u_num, u_input and u_D, not negative.
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
        """u_val, of the comparison error."""
        return hypot(self.numerical, self.inputs, self.data)

    @property
    def relative(self) -> tuple[float, float]:
        """D/S − 1 and its uncertainty k u_val/S: the data against the simulation, as codes are against core."""
        return self.measured / self.simulated - 1.0, COVERAGE * self.uncertainty / self.simulated

    @property
    def visible(self) -> float:
        """The least size that the model's error has: what of E exceeds k u_val, 0 if nothing does."""
        return max(abs(self.error) - COVERAGE * self.uncertainty, 0.0)


def statement(v: Validation) -> str:
    """What the comparison says of the model, relative to the measured value."""
    if v.visible > 0.0:
        return f"model error visible (at least {least(v.visible / v.measured)})"
    return f"model error not visible at u_val = {100 * v.uncertainty / v.measured:.1f} %"


def least(size: float) -> str:
    """A visible error in percent, to a tenth, or to two digits where it is less."""
    return f"{100 * size:.1f} %" if size >= 1e-3 else f"{100 * size:.2g} %"


def explained(v: Validation) -> str:
    """The statement with its numbers: E and every uncertainty relative to the measured value."""
    parts = {"u_num": v.numerical, "u_input": v.inputs, "u_D": v.data}
    sizes = ", ".join(f"{name} {unsigned(value / v.measured) if value else '0'}" for name, value in parts.items())
    u = f"u_val = {unsigned(v.uncertainty / v.measured)}" if v.visible > 0.0 else "u_val"
    return f"{statement(v)}: E = {percent(v.error / v.measured)}, {u} from {sizes}"


def visible(cell: Cell) -> float:
    """The least size of the model's error that a measured point shows, relative to the measured value; 0 if none is visible."""
    if cell.difference is None or cell.uncertainty is None or not cell.frequency or not cell.reference:
        return 0.0
    return max(abs(cell.difference) - cell.uncertainty, 0.0) * cell.reference / cell.frequency
