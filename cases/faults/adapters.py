"""Faults in adapters: in the input that the matrix gives to a foreign code, and in the answer it receives."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...core.blade import Blade
from ...core.modes import Modes
from ...references.protocol import registry
from ...references.protocol.process import Failure
from ...references.protocol.worker import Answer
from ..solve import works
from .alterations import answered, sent
from .seeding import Fault, Trial
from .trials import CONED, FAST, PARK, PITCHED, TAPERED, TIP, TWISTED

CodeRun = tuple[float, int, int]


def altered_question(alter: Callable[[CodeRun], CodeRun]) -> Callable[[Any], Any]:
    """A different question is asked; the answer claims to be for the original one."""

    def make(original: Any) -> Any:
        def faulty(name: str, blade: Blade, runs: Sequence[CodeRun], *how: Any) -> list[Answer]:
            answers = original(name, blade, [alter(run) for run in runs], *how)
            return [
                answer if isinstance(answer, Failure) else replace(answer, omega=run[0], elements=run[1])
                for run, answer in zip(runs, answers, strict=True)
            ]

        return faulty

    return make


def _without(column: int) -> Callable[[Modes], Modes]:
    def alter(modes: Modes) -> Modes:
        shapes = modes.shapes.copy()
        shapes[:, :, column] = 0.0
        return replace(modes, shapes=shapes)

    return alter


def _times(factor: float) -> Callable[[Modes], Modes]:
    return lambda modes: replace(modes, frequencies=factor * modes.frequencies)


def _shuffled(modes: Modes) -> Modes:
    """The shapes of the first and the second pair of modes are interchanged."""
    order = np.arange(len(modes.frequencies))
    order[:4] = order[[2, 3, 0, 1]]
    return replace(modes, shapes=modes.shapes[order])


def _zero(modes: Modes) -> Modes:
    return replace(modes, frequencies=np.concatenate([[0.0], modes.frequencies[1:]]))


def _wide(modes: Modes) -> Modes:
    """60 % off, with a reported error bound of 90 %."""
    return replace(modes, frequencies=1.6 * modes.frequencies, uncertainty=np.full(len(modes.frequencies), 0.9))


def _found_at(path: str, code: str = "exact-beam") -> Callable[[Any], Any]:
    """The adapter of a code is replaced by another."""

    def make(original: Any) -> Any:
        return lambda name: path if name == code else original(name)

    return make


def _crashes(_: Any) -> Any:
    return lambda name, blade, runs, *how: (
        [Failure("crashed", "the code's process ended with signal SIGSEGV")] * len(runs)
    )


def _adapter(name: str, description: str, size: str, make: Any, trial: Trial = PARK) -> Fault:
    return Fault(name, "adapter", description, size, ((works, "answers", make),), trial)


REST = Trial("park-cantilever", (0.0,), ("exact-beam",))

SOLID = Trial("curved-solid", (0.0,), ("scikit-fem-solid",))

FAULTS = (
    _adapter("frequencies in Hz", "frequencies in Hz are read as rad/s", "factor 2π", answered(_times(1 / (2 * np.pi)))),
    _adapter("frequencies squared", "eigenvalues are read as frequencies", "factors",
             answered(lambda m: replace(m, frequencies=m.frequencies**2))),
    _adapter("axes exchanged", "the y and z axes are exchanged", "no frequency; no partner",
             answered(lambda m: replace(m, shapes=m.shapes[:, :, [0, 2, 1, 3]])), FAST),
    _adapter("root and tip exchanged", "shapes are sampled from the tip", "no frequency; no partner",
             answered(lambda m: replace(m, shapes=m.shapes[:, ::-1]))),
    _adapter("lost column", "the flapwise column of every shape is lost", "no frequency; no partner", answered(_without(2))),
    _adapter("swapped modes", "shapes are paired with other frequencies", "factor 6", answered(_shuffled)),
    _adapter("too few modes", "the code returns two modes for any request", "no answer",
             altered_question(lambda run: (run[0], run[1], 2))),
    _adapter("coarse declared fine", "three terms for any requested refinement", "third modes by several percent",
             altered_question(lambda run: (run[0], 3, min(run[2], 4)))),
    _adapter("no rotation", "the rotor speed does not reach the code", "flapwise −10 %",
             altered_question(lambda run: (0.0, *run[1:]))),
    _adapter("speed in rpm", "the speed in rpm is read as rad/s", "first flapwise by tens of percent",
             altered_question(lambda run: (run[0] * 30 / np.pi, *run[1:]))),
    _adapter("hub radius dropped", "the blade of the code begins on the rotor axis", "first modes −3 %",
             sent(lambda b: replace(b, hub_radius=0.0))),
    _adapter("tip mass dropped", "the blade of the code has no tip mass", "first modes by tens of percent",
             sent(lambda b: replace(b, tip_mass=np.zeros((6, 6)))), TIP),
    _adapter("twist in degrees", "degrees are read as radians, in the opposite sense", "second modes by several percent",
             sent(lambda b: replace(b, twist=np.degrees(b.twist))), TWISTED),
    _adapter("twist reversed in the adapter", "the twist of the code has the opposite sense", "no frequency; no partner",
             sent(lambda b: replace(b, twist=-b.twist)), TWISTED),
    _adapter("precone dropped", "the blade of the code has no precone", "first flapwise by several percent",
             sent(lambda b: replace(b, precone=0.0)), CONED),
    _adapter("pitch dropped", "the blade of the code has no pitch", "lowest modes by several percent",
             sent(lambda b: replace(b, pitch=0.0)), PITCHED),
    _adapter("taper dropped", "every element has the root's section", "first modes by tens of percent",
             sent(lambda b: replace(b, stiffness=b.stiffness[[0] * len(b.stations)],
                                             mass=b.mass[[0] * len(b.stations)])), TAPERED),
    _adapter("density", "mass half a percent too large", "all modes at rest −0.25 %",
             sent(lambda b: replace(b, mass=1.005 * b.mass)), REST),
    _adapter("modulus", "stiffness too small by a factor of 1000: kN for N", "all modes −97 % at rest",
             sent(lambda b: replace(b, stiffness=b.stiffness / 1000)), REST),
    _adapter("zero frequency", "the lowest frequency is 0", "first −100 %", answered(_zero)),
    _adapter("wide bracket", "wrong by 60 %, with a stated uncertainty of 90 %", "+60 %", answered(_wide)),
    _adapter("crash", "the code's process dies", "no answer", _crashes),
    _adapter("digits lost", "six digits of a code on Southwell's own discretisation", "1e-6",
             answered(_times(1 + 1e-6)), Trial("park-cantilever", (10.0,), ("pinocchio",))),
    Fault("one Gauss point per element", "adapter", "a finite element's matrices are integrated with one point", "factors",
          ((registry, "locate", _found_at("southwell.cases.faults.altered_scikit_fem:ONE_POINT", "scikit-fem")),),
          Trial("park-cantilever", (10.0,), ("scikit-fem",))),
    Fault("sweep reversed", "adapter", "the solid of a curved blade is swept to the other side", "several percent",
          ((registry, "locate", _found_at("southwell.cases.faults.altered_scikit_fem:SWEEP", "scikit-fem-solid")),), SOLID),
    Fault("fibres reversed", "adapter", "the fibres of a solid blade lie at the opposite angle: bend–twist coupling",
          "several percent",
          ((registry, "locate", _found_at("southwell.cases.faults.altered_scikit_fem:FIBRES", "scikit-fem-solid")),), SOLID),
    Fault("unsupported() raises", "adapter", "the adapter raises instead of refusing", "no answer",
          ((registry, "locate", _found_at("southwell.cases.faults.raising:UNSUPPORTED")),), PARK),
    Fault("version() raises", "adapter", "the adapter raises instead of returning its version", "no answer",
          ((registry, "locate", _found_at("southwell.cases.faults.raising:VERSION")),), PARK),
)  # fmt: skip
