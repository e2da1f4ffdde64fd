"""Recognises core's own discretisation in the answers of a code that declares that it shares nothing with core.

Two independent programs with as many elements differ by their discretisation errors. Answers that equal core's to rounding,
where core itself is not converged, come from core's equations, whatever the code declares. So do numbers in a file that equal
those of ``southwell modes`` in more digits than are certain.
"""

import warnings
from collections.abc import Sequence
from typing import get_args

import numpy as np

from ...core.blade import Blade
from ...core.effects import Effects
from ...core.element.discretize import Mass
from ...core.element.measures import Measure
from ...core.modes import Modes
from ...core.solve import sweep
from ...core.spectrum.refinement import AccuracyWarning
from ..input.errors import NO_STATE
from ..judge.reference import Reference
from ..judge.spectrum import Spectrum
from . import core_solver

DIGITS = 1e-10
"""Relative difference up to which two answers are equal."""

UNCONVERGED = 1e-7
"""Least discretisation error of core, relative, at one speed at which equal answers are no coincidence."""


GIVEN_BACK = 1e-11
"""Relative difference up to which a number of a file is one that core printed."""

FEWEST = 3
"""Smallest number of frequencies that can be recognised."""


def given_back(blade: Blade, numbers: Sequence[tuple[float, float, float]]) -> bool:
    """Whether numbers are those that ``southwell modes`` prints for the blade.

    Equal digits prove it only where core's own uncertainty is larger: another program does not have the same error.

    Args:
        blade: the blade.
        numbers: rotor speed and frequency, rad/s, and half a unit of the last digit, relative.
    """
    speeds = sorted({omega for omega, _, _ in numbers})
    if len(numbers) < FEWEST or max(unit for *_, unit in numbers) > GIVEN_BACK:
        return False
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AccuracyWarning)  # the uncertainty is compared
            computed = {modes.omega: modes for modes in sweep(blade, speeds, allow_large_strain=True)}
    except (*NO_STATE, ArithmeticError):
        return False
    unsure = 0.0
    for omega, frequency, _ in numbers:
        modes = computed[omega]
        deviation = np.abs(frequency / modes.frequencies - 1.0)
        if deviation.min() > GIVEN_BACK:
            return False
        unsure = max(unsure, float(modes.uncertainty[deviation.argmin()]))
    return unsure > 100.0 * GIVEN_BACK


def copied(
    blade: Blade, effects: Effects, answers: Sequence[tuple[float, Reference, Spectrum]]
) -> tuple[int, float] | None:
    """The number of elements at which every answer equals core's, and the largest relative difference; None if they do not.

    Args:
        blade: the blade.
        effects: effects that the code keeps.
        answers: rotor speed in rad/s, core's reference and the code's answer with its fewest elements, at each speed.
    """
    for mass in get_args(Mass):
        for stiffness in get_args(Measure):
            if (differences := _differences(blade, effects, mass, stiffness, answers)) is not None:
                return answers[0][2].elements, differences
    return None


def _differences(
    blade: Blade,
    effects: Effects,
    mass: Mass,
    stiffness: Measure,
    answers: Sequence[tuple[float, Reference, Spectrum]],
) -> float | None:
    """The largest relative difference of the compared modes from core's with as many elements.

    None if one of them is larger than ``DIGITS``, or if core is converged at every speed.
    """
    largest, error = 0.0, 0.0
    for omega, reference, answer in answers:
        (core_answer,) = core_solver.answers(
            blade, [(omega, answer.elements, reference.core.count)], mass, stiffness, effects
        )
        indices = list(reference.core.indices)
        if not isinstance(core_answer, Modes) or min(len(core_answer.frequencies), len(answer.frequencies)) <= max(
            indices
        ):
            return None
        values = core_answer.frequencies[indices]
        largest = max(largest, float(np.abs(answer.frequencies[indices] / values - 1.0).max()))
        if largest > DIGITS:
            return None
        best = [m.estimate.value if m.estimate else np.nan for m in reference.core.modes]
        error = max(error, float(np.nanmax(np.abs(values / best - 1.0), initial=0.0)))
    return largest if error > UNCONVERGED else None
