"""All seeded faults by name, those that every run includes, and the task that executes some of them."""

from collections.abc import Sequence
from dataclasses import replace

from ..input.errors import CaseError, nearest
from ..judge.results import Control
from .adapters import FAULTS as ADAPTERS
from .core import FAULTS as CORE
from .judging import FAULTS as JUDGING
from .mechanisms import FAULTS as MECHANISMS
from .seeding import Fault, execute
from .turbines import FAULTS as TURBINES

ALL: tuple[Fault, ...] = (*CORE, *ADAPTERS, *MECHANISMS, *TURBINES, *JUDGING)

BY_NAME = {fault.name: fault for fault in ALL}

FAST = tuple(fault.name for fault in ALL if fault.fast)


def chosen(text: str) -> tuple[str, ...]:
    """Names of faults: ``fast``, ``all``, ``none``, or names separated by commas.

    Raises:
        CaseError: if a fault does not exist; the nearest name is suggested.
    """
    sets = {"fast": FAST, "all": tuple(BY_NAME), "none": ()}
    names = sets.get(text, tuple(dict.fromkeys(name.strip() for name in text.split(","))))
    for name in names:
        if name not in BY_NAME:
            raise CaseError(f"--faults: {name!r} is no fault: {nearest(name, (*sets, *BY_NAME))}")
    return names


def run(names: Sequence[str], reuse: bool = False) -> list[Control]:
    """Execute faults, one after the other; a task for any process.

    With ``reuse``, codes' earlier answers may be taken from the store.
    """

    def fault(name: str) -> Fault:
        fault = BY_NAME[name]
        return replace(fault, trial=replace(fault.trial, reuse=reuse)) if fault.trial else fault

    return [execute(fault(name), fault) for name in names]
