"""The units of a case, which are those of its given speeds; results are in rad/s throughout."""

from dataclasses import dataclass
from math import pi


@dataclass(frozen=True)
class Units:
    """Names and conversion factors of units.

    Attributes:
        speed: name of the speed's unit.
        frequency: name of the frequency's unit.
        speeds: value in that unit of a rotor speed of 1 rad/s.
        frequencies: value in that unit of a frequency of 1 rad/s.
    """

    speed: str
    frequency: str
    speeds: float = 1.0
    frequencies: float = 1.0

    @property
    def speed_label(self) -> str:
        """Label of an axis or column of speeds."""
        return "rotor speed γ" if self.speed == "γ" else f"rotor speed, {self.speed}"

    @property
    def frequency_label(self) -> str:
        """Label of an axis or column of frequencies."""
        return f"frequency, {self.frequency}"

    def at(self, omega: float) -> str:
        """A rotor speed (rad/s) as text: ``10 rad/s``, ``γ = 10``, ``at rest``."""
        value = f"{omega * self.speeds:.6g}"
        if not omega:
            return "at rest"
        return f"γ = {value}" if self.speed == "γ" else f"{value} {self.speed}"


RAD_S = Units("rad/s", "rad/s")
RPM = Units("rpm", "Hz", 30 / pi, 0.5 / pi)
GAMMA = Units("γ", "in units of √(EI/ρAL⁴)")

BY_KEY = {"rad_s": RAD_S, "rpm": RPM, "gamma": GAMMA}
"""Units by the key of the speeds in a case file."""
