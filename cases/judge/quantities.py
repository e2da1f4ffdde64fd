"""The quantities of a mode that are compared, each with its unit and what a difference is relative to."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """One quantity.

    Attributes:
        name: in words.
        plural: of several.
        unit: SI; empty for a plain number.
        scale: what a difference is divided by, in ``unit``; None: the reference.
    """

    name: str
    plural: str
    unit: str
    scale: float | None


QUANTITIES = {
    "frequency": Quantity("frequency", "frequencies", "rad/s", None),
    "damping": Quantity("damping ratio", "damping ratios", "", 1.0),
}
"""Names in results → quantities. The difference of two damping ratios is absolute: it is a fraction of critical damping."""


def difference(name: str, value: float, reference: float) -> float:
    """The difference of a value from its reference, relative to the scale of its quantity."""
    scale = QUANTITIES[name].scale
    return value / reference - 1.0 if scale is None else (value - reference) / scale


def reference(name: str, value: float, difference: float) -> float:
    """The reference from which ``value`` differs by ``difference``."""
    scale = QUANTITIES[name].scale
    return value / (1.0 + difference) if scale is None else value - difference * scale
