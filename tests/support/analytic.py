"""A made-up foreign code: a uniform beam at rest in closed form, with whatever error a test wants; found by import path.

Clamped-free Euler–Bernoulli beam (Rayleigh, *The Theory of Sound*, 1877, §§172–174): ``cos βL cosh βL = −1``.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import root_scalar

from southwell.core.blade import Blade
from southwell.core.effects import ALL_EFFECTS, Effects
from southwell.core.modes import STATIONS, Modes
from southwell.core.solve import mesh_modes
from southwell.references.protocol.interface import CORE, MOTIONS, BladeAdapter, Independence, Motion
from southwell.references.sampling import sample

ROOTS = [
    root_scalar(lambda x: np.cos(x) + 1.0 / np.cosh(x), bracket=((k + 0.5) * np.pi - 1.0, (k + 0.5) * np.pi + 1.0)).root
    for k in range(6)
]


def shape(root: float) -> np.ndarray:
    """(21,) displacement at the common stations."""
    x = root * STATIONS
    ratio = (np.cosh(root) + np.cos(root)) / (np.sinh(root) + np.sin(root))
    return np.cosh(x) - np.cos(x) - ratio * (np.sinh(x) - np.sin(x))


@dataclass(frozen=True)
class Analytic(BladeAdapter):
    """Exact frequencies times ``factor`` times ``1 + error / elements**order``."""

    name: str
    factor: float = 1.0
    error: float = 0.1
    order: int = 2
    true_order: float = 2.0
    levels: tuple[int, ...] = (10, 20, 40)
    columns: tuple[int, ...] = (1, 2)
    backwards: bool = False
    bracket: bool = False
    width: float = 0.0
    reason: str | None = None
    installed: bool = True
    title: str = "Closed form"
    effects: Effects = ALL_EFFECTS
    hint: str = "pip install nothing"
    motions: tuple[Motion, ...] = MOTIONS

    def version(self) -> str | None:
        return "1.0" if self.installed else None

    def unsupported(self, blade: Blade) -> str | None:
        return self.reason

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        section = sample(blade, 0.0)
        rate = np.sqrt(section.EI_y[0] / section.mass[0]) / blade.length**2
        altered = self.factor * (1.0 + self.error / elements**self.true_order)
        frequencies = np.repeat(np.square(ROOTS) * rate * altered, len(self.columns))
        shapes = np.zeros((len(frequencies), 21, 4), complex)
        for k, root in enumerate(ROOTS):
            for i, column in enumerate(self.columns):
                shapes[len(self.columns) * k + i, :, column] = shape(root)[:: -1 if self.backwards else 1]
        bracket = np.full(count, self.width) if self.bracket else np.zeros(0)
        return Modes(omega, frequencies[:count], shapes[:count], elements, uncertainty=bracket)


@dataclass(frozen=True)
class Twin(Analytic):
    """Core's own discretisation, in other words: half masses at element ends, stiffness in the parent's frame."""

    independence: Independence = Independence("twin", CORE, "twin")  # noqa: RUF009
    levels: tuple[int, ...] = (10,)

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        modes = mesh_modes(blade, omega, elements, count, mass="half_end", stiffness="body_fixed", effects=self.effects)
        return Modes(omega, modes.frequencies * self.factor, modes.shapes, elements)


GOOD = Analytic("good")
SPECTRAL = Analytic("spectral", error=1e-3, order=0, true_order=4.0)
WRONG = Analytic("wrong", factor=1.002)
ROUGH = Analytic("rough", error=5.0, true_order=2.5)
SLOW = Analytic("slow", true_order=0.2)
CRUDE = Analytic("crude", factor=1.03, bracket=True, width=0.04)
LYING = Analytic("lying", factor=1.03, bracket=True, width=0.02)
PLANAR = Analytic("planar", columns=(2,), motions=("flapwise",))
SIDEWAYS = Analytic("sideways", columns=(0, 3))
BACKWARDS = Analytic("backwards", backwards=True)
UNABLE = Analytic("unable", reason="blades only on Sundays")
ABSENT = Analytic("absent", installed=False)
TWIN = Twin("twin")
BAD_TWIN = Twin("bad-twin", factor=1.0 + 1e-7)
