"""A turbine's references by core, and the answers of codes against them."""

import re
from collections import Counter
from collections.abc import Sequence
from functools import partial

import numpy as np

from ...core.effects import ALL_EFFECTS
from ...core.rotor.periodic import PeriodicError
from ...core.turbine.machine import FINER, Machine, Resolution, machine
from ...core.turbine.stations import COLUMNS, weights
from ...core.turbine.turbine import Turbine
from ...core.turbine.turbine_modes import TurbineModes, turbine_modes
from ...references.protocol import turbines
from ...references.protocol.process import Failure, Limits
from ...references.protocol.worker import Run, turbine_answers
from ..input.errors import NO_STATE
from ..judge.cells import Head, Rows, joined
from ..judge.convergence import RefinedMode
from ..judge.pairing import Pair, pair
from ..judge.reference import MARGIN, Converged, Reference
from ..judge.refined import refined
from ..judge.spectrum import Answer, Spectrum
from ..judge.uncertainty import ROUNDING, Estimate
from .reference import References
from .refinement import Refining
from .works import References as AtSpeeds
from .works import refinements

MOTION = "machine"
"""The motion of every mode: each part of a turbine moves in each."""


def references(turbine: Turbine, speeds: Sequence[float], count: int) -> References:
    """Core's modes at each speed, or a failure.

    The uncertainty is the change from the default resolution to the finer one, whose frequencies are the reference.
    """
    try:
        coarse, fine = machine(turbine, Resolution()), machine(turbine, FINER)
    except (*NO_STATE, ValueError) as error:
        return {ALL_EFFECTS: [Failure("no reference", f"{turbine.name}: {error}")] * len(speeds)}
    return {ALL_EFFECTS: [_reference(coarse, fine, omega, count) for omega in speeds]}


def _reference(coarse: Machine, fine: Machine, omega: float, count: int) -> Reference | Failure:
    requested = count + MARGIN
    try:
        rough, exact = (
            spectrum(assembled.turbine, turbine_modes(assembled, omega, requested)) for assembled in (coarse, fine)
        )
    except (*NO_STATE, PeriodicError) as error:
        return Failure("no reference", f"{fine.turbine.name}, {omega:g} rad/s: {error}")
    indices = tuple(range(min(count, len(exact.values))))
    frequencies = exact.frequencies[: len(indices)].tolist()
    modes = []
    for k, partner in enumerate(pair(exact, rough, indices)):
        change = None if partner.mode is None else abs(rough.frequencies[partner.mode] / frequencies[k] - 1.0)
        doubt = None if change is None else max(float(change), ROUNDING)
        modes.append(RefinedMode(Estimate(frequencies[k], doubt), Pair(k, 1.0), ()))
    core = Converged(exact, indices, tuple(modes), (MOTION,) * len(indices))
    count_compared = len(indices)
    return Reference(core, tuple(frequencies), (1.0,) * count_compared, ((),) * count_compared)


def spectrum(turbine: Turbine, modes: TurbineModes) -> Spectrum:
    """Core's modes in the form in which they are compared; they are undamped."""
    values = np.asarray(1j * modes.frequencies, np.complex128)
    return Spectrum(values, modes.motions, COLUMNS, weights(turbine), labels(modes.names))


def labels(names: Sequence[str]) -> tuple[str, ...]:
    """``1st flap forward whirl`` → ``flap forward whirl 1``; names without a number, and repeated ones, are counted."""
    out: list[str] = []
    occurrences: Counter[str] = Counter()
    for name in names:
        ordinal = re.match(r"(\d+)(?:st|nd|rd|th) ", name)
        label = f"{name[ordinal.end() :]} {ordinal[1]}" if ordinal else f"{name} 1"
        family, _, number = label.rpartition(" ")
        while label in occurrences:
            occurrences[family] += 1
            label = f"{family} {int(number) + occurrences[family]}"
        occurrences[label] += 1
        out.append(label)
    return tuple(out)


def of_turbines(answers: Sequence[turbines.TurbineModes | Failure]) -> list[Answer]:
    """The spectra of a code's answers."""
    return [
        a if isinstance(a, Failure) else Spectrum(a.values, a.shapes, COLUMNS, elements=a.elements) for a in answers
    ]


def refined_code(head: Head, name: str, turbine: Turbine, refining: Refining, limits: Limits, core: AtSpeeds) -> Rows:
    """Rows of a code, refined until it can be judged."""
    ask = partial(_asked, name, turbine, limits, head.version)
    return joined(refined(head, omega, r, s, refining.order) for omega, r, s in refinements(ask, refining, core))


def _asked(name: str, turbine: Turbine, limits: Limits, version: str, runs: Sequence[Run]) -> list[Answer]:
    return of_turbines(turbine_answers(name, turbine, runs, limits, version))
