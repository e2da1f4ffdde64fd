"""Codes that answer, crash, hang, refuse, return no numbers or are not installed; found by import path."""

import ctypes
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from southwell.core.blade import Blade
from southwell.core.effects import ALL_EFFECTS, Effects
from southwell.core.modes import Modes
from southwell.references.protocol.interface import BladeAdapter, CodeError


def answer(omega: float, elements: int, count: int) -> Modes:
    """Something recognisable, so that a test sees which run was answered."""
    shapes = np.full((count, 21, 4), 1.0 / 3.0 + 2.0j / 7.0)
    return Modes(omega, omega + np.arange(1.0, count + 1), shapes, elements)


def segfault() -> None:
    ctypes.string_at(0)


def hang() -> None:
    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])  # holds our pipes open, too
    time.sleep(60)
    child.wait()


def give_up() -> None:
    raise CodeError("no steady state\nat this speed")


@dataclass(frozen=True)
class Misbehaving(BladeAdapter):
    """Solves properly below 1 rad/s, and does ``deed`` first above."""

    deed: Callable[[], None]
    answer: Callable[[float, int, int], Modes] = answer
    installed: bool = True
    name: str = "misbehaving"
    title: str = "Misbehaving"
    effects: Effects = ALL_EFFECTS
    levels: tuple[int, ...] = (1, 2, 4)
    order: int = 2
    hint: str = "pip install manners"

    def version(self) -> str | None:
        return "1.0" if self.installed else None

    def unsupported(self, blade: Blade) -> str | None:
        return None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        if omega >= 1.0:
            self.deed()
            return self.answer(omega, elements, count)
        return answer(omega, elements, count)


def nothing() -> None:
    """Behave."""


def not_a_number(omega: float, elements: int, count: int) -> Modes:
    modes = answer(omega, elements, count)
    return Modes(omega, modes.frequencies * np.nan, modes.shapes, elements)


SEGFAULT = Misbehaving(segfault)
HANG = Misbehaving(hang)
GIVE_UP = Misbehaving(give_up)
NOT_A_NUMBER = Misbehaving(nothing, answer=not_a_number)
ABSENT = Misbehaving(nothing, installed=False)
WELL_BEHAVED = Misbehaving(nothing)
