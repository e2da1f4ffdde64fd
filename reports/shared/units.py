"""The units a case is read in: what its speeds were given in decides; results are in rad/s throughout."""

from dataclasses import dataclass
from math import pi


@dataclass(frozen=True)
class Units:
    """Factors and names.

    Attributes:
        speed: name of the speed's unit.
        frequency: name of the frequency's unit.
        speeds: rotor speed in that unit, per rad/s.
        frequencies: likewise.
    """

    speed: str
    frequency: str
    speeds: float = 1.0
    frequencies: float = 1.0

    @property
    def speed_label(self) -> str:
        """For an axis or a table's head."""
        return "rotor speed γ" if self.speed == "γ" else f"rotor speed, {self.speed}"

    @property
    def frequency_label(self) -> str:
        """For an axis or a table's head."""
        return f"frequency, {self.frequency}"

    def at(self, omega: float) -> str:
        """A rotor speed (rad/s) in words: ``10 rad/s``, ``γ = 10``, ``at rest``."""
        value = f"{omega * self.speeds:.6g}"
        if not omega:
            return "at rest"
        return f"γ = {value}" if self.speed == "γ" else f"{value} {self.speed}"


RAD_S = Units("rad/s", "rad/s")
RPM = Units("rpm", "Hz", 30 / pi, 0.5 / pi)
GAMMA = Units("γ", "in units of √(EI/ρAL⁴)")

BY_KEY = {"rad_s": RAD_S, "rpm": RPM, "gamma": GAMMA}
"""By the key of a case file's speeds."""
