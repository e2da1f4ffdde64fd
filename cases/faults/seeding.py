"""Seeded faults: the pipeline with one faulty component, which must be detected.

A fault replaces a named object of a module (a *seam*) while the real matrix runs a small case. It is detected by cells
that are bad with the fault and not without it. A fault in judging may make cells better instead of worse; it is
detected if another fault, which must be detected, no longer is.

A fault acts only in the thread that runs its trial, so that trials may share a process with real work. Compiled loops
cannot be replaced from Python: seams of core are the functions that call them.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import lru_cache, wraps
from threading import RLock, get_ident
from typing import Any, Literal

import msgspec
import numpy as np

from ...references.protocol import registry
from ...references.protocol.description import Description, describe
from ..input import library
from ..input.errors import CaseError
from ..input.schema import Case, Variant
from ..judge.results import Cell, Control, described
from ..plan import mechanism, turbine
from ..plan.blade import BladeSubject
from ..plan.mechanism import MechanismSubject
from ..plan.subject import Subject
from ..plan.turbine import TurbineSubject
from ..run.executors import Serial
from ..verify import matrix

Area = Literal["solver", "adapter", "pairing", "uncertainty", "verdict", "reader"]

Seam = tuple[Any, str, Callable[[Any], Any]]
"""A module or class, the name of a function or constant in it, and a function from the right to the faulty object."""

BAD = ("fail", "inconclusive")


def _unchanged(subject: Any) -> Any:
    return subject


@dataclass(frozen=True)
class Trial:
    """A small case: one blade, mechanism or turbine of the package, with few speeds and few codes.

    Attributes:
        case: ``case`` or ``case/blade``, as on the command line, or the name of a mechanism or a turbine.
        speeds: rad/s.
        codes: names.
        change: function that makes the trial's blade, mechanism or turbine from the package's.
        modes: number of modes compared; by default that of the case.
        motions: motions compared; by default those of the case.
        reuse: whether codes' earlier answers may be taken from the store. Faults act on what a code is sent and on what it
            returned, so they have the same effect on such answers.
    """

    case: str
    speeds: tuple[float, ...]
    codes: tuple[str, ...]
    change: Callable[[Any], Any] = _unchanged
    modes: int | None = None
    motions: tuple[str, ...] = ()
    reuse: bool = False


@dataclass(frozen=True)
class Fault:
    """One seeded fault.

    Attributes:
        name: short name, for a table and for ``verify --faults``.
        area: the faulty component.
        description: one sentence on what a program with this fault does.
        size: size of its effect on the compared quantities of the trial.
        seams: the replaced objects.
        trial: the case to run; None if the fault ``blinds`` another, whose trial is run.
        blinds: name of a fault that must be detected and, with this fault, no longer is.
        fast: whether every run includes it.
    """

    name: str
    area: Area
    description: str
    size: str
    seams: tuple[Seam, ...]
    trial: Trial | None = None
    blinds: str = ""
    fast: bool = False

    def control(self, case: str, omega: float) -> Control:
        """The result on a case at a rotor speed, rad/s, if nothing detects the fault."""
        return Control(self.name, self.area, self.description, self.size, case, omega, ())


_LOCK = RLock()


@contextmanager
def seeded(seams: Sequence[Seam]) -> Iterator[None]:
    """Context manager that installs the faulty objects for this thread.

    Raises:
        AttributeError: if a seam no longer exists.
    """
    thread = get_ident()
    with _LOCK:
        originals = [(owner, name, getattr(owner, name)) for owner, name, _ in seams]
        try:
            for (owner, name, make), (_, _, old) in zip(seams, originals, strict=True):
                new = make(old)
                setattr(owner, name, _only(thread, old, new) if callable(old) else new)
            yield
        finally:
            for owner, name, old in reversed(originals):
                setattr(owner, name, old)


def _only(thread: int, original: Callable[..., Any], faulty: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(original)
    def dispatch(*args: Any, **kwargs: Any) -> Any:
        return (faulty if get_ident() == thread else original)(*args, **kwargs)

    return dispatch


def cells(trial: Trial) -> tuple[Cell, ...]:
    """Cells of a trial run by the real matrix."""
    subject: Subject
    if trial.case in library.mechanisms():
        subject = _mechanism(trial)
    elif trial.case in library.turbines():
        subject = _turbine(trial)
    else:
        subject = _blade(trial)
    return matrix.run([subject], descriptions(trial), Serial(), reuse=trial.reuse, parts=False).cells


def _mechanism(trial: Trial) -> MechanismSubject:
    subject = mechanism.subject(library.mechanism(trial.case))
    altered = replace(subject.described, mechanism=trial.change(subject.described.mechanism))
    return replace(subject, described=altered, points=trial.speeds)


def _turbine(trial: Trial) -> TurbineSubject:
    subject = turbine.of_case(library.turbine(trial.case))
    modes = trial.modes or subject.modes
    return replace(subject, turbine=trial.change(subject.turbine), points=trial.speeds, modes=modes)


def _blade(trial: Trial) -> BladeSubject:
    case, variant = _variant(trial)
    original = case.text.compare
    compare = msgspec.structs.replace(
        original, modes=trial.modes or original.modes, motions=trial.motions or original.motions
    )
    return BladeSubject(replace(case, text=msgspec.structs.replace(case.text, compare=compare)), variant)


def _variant(trial: Trial) -> tuple[Case, Variant]:
    case = library.load(trial.case.partition("/")[0])
    (variant,) = (v for v in case.variants if v.name == trial.case)
    return case, replace(variant, blade=trial.change(variant.blade), speeds=np.array(trial.speeds))


def descriptions(trial: Trial) -> tuple[Description, ...]:
    """Descriptions of a trial's codes; a fault may replace where a code is found."""
    return _described(trial, tuple(registry.locate(name) for name in trial.codes))


@lru_cache
def _described(trial: Trial, _paths: tuple[str, ...]) -> tuple[Description, ...]:
    blades = [] if trial.case in (*library.mechanisms(), *library.turbines()) else [_variant(trial)[1].blade]
    return describe(trial.codes, blades)


@lru_cache
def faultless(trial: Trial) -> tuple[Cell, ...]:
    """Cells of a trial run by the real matrix without any fault; computed once per process."""
    return cells(trial)


def execute(fault: Fault, by_name: Callable[[str], Fault]) -> Control:
    """Run one fault's trial; ``by_name`` returns another fault by its name."""
    trial = fault.trial
    if fault.blinds:
        return _blinding(fault, by_name(fault.blinds))
    assert trial
    if identifiers := [description.asked for description in descriptions(trial) if not description.version]:
        return replace(_control(fault, ()), needs=", ".join(identifiers))
    correct_cells = faultless(trial)
    try:
        with seeded(fault.seams):
            faulty_cells = cells(trial)
    except CaseError as error:  # without core's answer there is no run at all
        return _control(fault, (f"{trial.case}, Southwell: {error}",))
    return _judged(fault, correct_cells, faulty_cells)


def _blinding(fault: Fault, blinded: Fault) -> Control:
    """Result for a fault in judging: another fault is no longer detected, or correct cells are bad."""
    assert blinded.trial
    if identifiers := [description.asked for description in descriptions(blinded.trial) if not description.version]:
        return replace(_control(fault, ()), needs=", ".join(identifiers))
    correct_cells = faultless(blinded.trial)
    with seeded(fault.seams):
        cells_without = cells(blinded.trial)
        with seeded(blinded.seams):
            cells_with = cells(blinded.trial)
    detected = _judged(blinded, cells_without, cells_with).detected_by
    false_alarms = _judged(fault, correct_cells, cells_without).detected_by
    return _control(fault, false_alarms if detected else (*false_alarms, f"seeded fault not detected: {blinded.name}"))


def _judged(fault: Fault, correct_cells: Sequence[Cell], faulty_cells: Sequence[Cell]) -> Control:
    """Result for a fault from the cells that are bad with it and not without it."""
    was_bad = {c.key for c in correct_cells if c.verdict in BAD}
    detections = [c for c in faulty_cells if c.verdict in BAD and c.key not in was_bad]
    changes = [c.difference for c in detections if c.difference is not None]
    return replace(_control(fault, tuple(map(_name, detections))), change=max(changes, key=abs, default=None))


def _name(cell: Cell) -> str:
    mode = f", {described(f'{cell.family} (mode {cell.mode})', cell.quantity, cell.where)}" if cell.mode else ""
    return f"{cell.case}, {cell.code}{mode}, {cell.omega:g} rad/s: {cell.verdict}"


def _control(fault: Fault, detected_by: tuple[str, ...]) -> Control:
    case, omega = (fault.trial.case, max(fault.trial.speeds)) if fault.trial else ("", 0.0)
    return replace(fault.control(case, omega), detected_by=detected_by)
