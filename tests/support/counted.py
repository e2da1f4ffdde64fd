"""Codes that answer at once and write down what they were asked: which blade, at the beginning of each of its columns."""

import os
from dataclasses import dataclass
from pathlib import Path

from southwell.core import solve
from southwell.core.blade import Blade
from southwell.core.effects import ALL_EFFECTS, Effects
from southwell.core.modes import Modes
from southwell.references.protocol.interface import BladeAdapter


@dataclass(frozen=True)
class Counted(BladeAdapter):
    """Core under another name."""

    name: str
    title: str = "Counted"
    effects: Effects = ALL_EFFECTS
    levels: tuple[int, ...] = (10, 20)
    order: int = 4
    hint: str = ""

    def version(self) -> str | None:
        return os.environ.get("COUNTED_VERSION", "1.0")

    def unsupported(self, blade: Blade) -> str | None:
        return None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        if (elements, omega) == (self.levels[0], 0.0) and (folder := os.environ.get("SOUTHWELL_TEST")):
            with Path(folder, "asked.txt").open("a") as file:
                file.write(f"{self.name} {blade.name}\n")
        return solve.modes(blade, omega, elements, count)


FIRST, SECOND = Counted("first"), Counted("second")
