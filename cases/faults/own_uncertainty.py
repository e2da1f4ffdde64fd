"""Faults of extrapolation and uncertainty on the blade that is verified.

Three meshes of core, judged as those of any code, give a frequency and its uncertainty. Core's refined frequency, whose
uncertainty is far smaller and comes from other code (``core.spectrum``), must lie within them; a mode fails if it does not.
"""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...core import solve
from ...core.modes import Modes
from ...core.spectrum.refinement import AccuracyWarning
from ..input.errors import NO_STATE
from ..judge import convergence
from ..judge.convergence import Compared, follow
from ..judge.pairing import weights
from ..judge.results import Control
from ..judge.spectrum import Spectrum, of_blade
from ..judge.uncertainty import Estimate
from ..judge.verdict import judge, unsigned
from ..plan.blade import BladeSubject
from ..solve import core_solver
from .seeding import Fault, seeded

MESHES = ((8, 16, 32), (12, 24, 48))
"""Numbers of elements of three meshes, more than once: errors may cancel in some modes."""

ORDER = 4
"""Order of convergence of core."""

ACCURACY = 1e-8
"""Requested accuracy of core's refined frequencies."""

NO_MESH = "meshes of 8 to 48 elements with a stable steady state"
"""Why the faults are not run on a blade that needs more elements."""

Refine = Callable[[Sequence[int], Sequence[float], int], Estimate]


@dataclass(frozen=True)
class _Known:
    """One set of meshes with core's refined frequencies.

    Attributes:
        elements: numbers of elements.
        answers: modes of the meshes.
        compared: the modes that are followed.
        factor: (m,) removes the bias of rigid strains.
        unsure: (m,) relative uncertainty of ``factor``.
        refined: core's refined modes.
    """

    elements: tuple[int, ...]
    answers: tuple[Spectrum, ...]
    compared: Compared
    factor: Any
    unsure: Any
    refined: Modes


def _altered(alter: Callable[[Estimate, Sequence[int], Sequence[float]], Estimate]) -> Callable[[Refine], Refine]:
    def make(original: Refine) -> Refine:
        return lambda elements, values, order: alter(original(elements, values, order), elements, values)

    return make


def _other_side(estimate: Estimate, _: Sequence[int], values: Sequence[float]) -> Estimate:
    return replace(estimate, value=2.0 * values[-1] - estimate.value)


def _first_order(estimate: Estimate, elements: Sequence[int], values: Sequence[float]) -> Estimate:
    if len(values) < 2:
        return estimate
    return replace(estimate, value=values[-1] + (values[-1] - values[-2]) / (elements[-1] / elements[-2] - 1.0))


def _thousandth(estimate: Estimate, *_: Any) -> Estimate:
    return replace(estimate, uncertainty=None if estimate.uncertainty is None else 1e-3 * estimate.uncertainty)


def _off(estimate: Estimate, *_: Any) -> Estimate:
    return replace(estimate, value=1.002 * estimate.value)


def _fault(name: str, description: str, size: str, alter: Callable[..., Estimate]) -> Fault:
    return Fault(name, "uncertainty", description, size, ((convergence, "from_refinement", _altered(alter)),))


FAULTS = (
    _fault("extrapolation: sign", "the limit is on the other side of the finest refinement", "twice the correction",
           _other_side),
    _fault("extrapolation: order", "the limit is that of a code of first order", "14 times the correction", _first_order),
    _fault("extrapolation: limit off", "limits are 0.2 % too large", "0.2 %", _off),
    _fault("uncertainty too small", "the uncertainty is a thousandth", "all uncertainties", _thousandth),
)  # fmt: skip
"""Faults of extrapolation and uncertainty."""


def run(subject: BladeSubject) -> list[Control]:
    """Run the faults on a blade at its highest speed; a task for any process."""
    controls = [fault.control(subject.name, max(subject.points)) for fault in FAULTS]
    try:
        solutions = [_solved(subject, elements) for elements in MESHES]
    except (*NO_STATE, ArithmeticError):
        return [replace(control, needs=NO_MESH) for control in controls]
    values = _estimates(solutions)
    uncovered = _outside(subject, solutions, values)
    out = []
    for fault, control in zip(FAULTS, controls, strict=True):
        with seeded(fault.seams):
            faulty_values = _estimates(solutions)
        uncovered_by_fault = _outside(subject, solutions, faulty_values)
        failing = {mode: change for mode, change in uncovered_by_fault.items() if mode not in uncovered}
        largest = max(failing.values(), key=abs, default=None)
        result = replace(control, detected_by=tuple(f"{mode}: fail" for mode in failing), change=largest)
        out.append(
            replace(
                result, without_effect="" if failing else _exact(solutions) or _covered(subject, values, faulty_values)
            )
        )
    return out


def _solved(subject: BladeSubject, elements: tuple[int, ...]) -> _Known:
    blade, omega, count = subject.blade, max(subject.points), subject.cells
    meshes = [solve.mesh_modes(blade, omega, n, count) for n in elements]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # its uncertainty is taken into account
        refined = solve.modes(blade, omega, count=count, accuracy=ACCURACY, allow_large_strain=True)
    ((factor, unsure),) = core_solver.rigid_strain_bias(blade, [(omega, (elements[-2], elements[-1]))], count)
    answers = tuple(of_blade(modes) for modes in meshes)
    finest = of_blade(meshes[-1], weights(blade))
    return _Known(elements, answers, Compared(finest, tuple(range(count))), factor, unsure, refined)


def _estimates(solutions: Sequence[_Known]) -> list[list[Estimate | None]]:
    """The estimate of each mode from each set of meshes."""
    return [[mode.estimate for mode in follow(of.answers, of.compared, ORDER)] for of in solutions]


def _outside(
    subject: BladeSubject, solutions: Sequence[_Known], estimates: Sequence[Sequence[Estimate | None]]
) -> dict[str, float]:
    """Modes whose estimate does not cover the refined frequency, with the relative difference."""
    out = {}
    for of, modes in zip(solutions, estimates, strict=True):
        for k, estimate in enumerate(modes):
            if estimate is None or estimate.uncertainty is None:
                continue
            difference = float(estimate.value * of.factor[k] / of.refined.frequencies[k] - 1.0)
            uncertainty = float(of.refined.uncertainty[k] + of.unsure[k])
            if judge(difference, uncertainty, estimate.uncertainty)[0] == "fail":
                meshes = " and ".join([", ".join(map(str, of.elements[:-1])), str(of.elements[-1])])
                out[f"{subject.name}, mode {k + 1} from {meshes} elements, {of.refined.omega:g} rad/s"] = difference
    return out


def _exact(solutions: Sequence[_Known]) -> str:
    """Why no fault can be seen: no mesh has an error above the uncertainty of the refined frequencies; else empty."""
    errors = [
        np.abs(of.answers[-1].frequencies[: len(of.factor)] * of.factor / of.refined.frequencies - 1.0)
        for of in solutions
    ]
    if all((error <= of.refined.uncertainty + of.unsure).all() for error, of in zip(errors, solutions, strict=True)):
        return f"the meshes are right to {unsigned(max(float(error.max()) for error in errors))}"
    return ""


def _covered(
    subject: BladeSubject, correct: Sequence[Sequence[Estimate | None]], faulty: Sequence[Sequence[Estimate | None]]
) -> str:
    """By how much a fault of the limit moves the frequencies, if that is within the target; else empty."""
    pairs = [(a, b) for of in zip(correct, faulty, strict=True) for a, b in zip(*of, strict=True) if a and b]
    change = max((abs(b.value / a.value - 1.0) for a, b in pairs), default=0.0)
    if 0.0 < change <= subject.case.text.compare.target:
        return f"moves frequencies by at most {unsigned(change)}, within their uncertainty"
    return ""
