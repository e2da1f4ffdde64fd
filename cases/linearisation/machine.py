"""Modes of linearisations beside those of the turbine's deck, in vacuo, by Southwell's own solver."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.rotor.periodic import PeriodicError
from ...core.rotor.turbine import Turbine, machine
from ...core.rotor.turbine_modes import turbine_modes
from ..input import files
from ..input.errors import NO_STATE, CaseError, rad_s
from ..input.readers.openfast import turbine as reader
from .judged import JudgedSet
from .modes import Mode

MODES = 20
"""Number of the machine's modes that are compared."""

_NAME = re.compile(r"(\d)\w\w (tower fore-aft|tower side-side|flap|edge)(?: (collective|forward|backward))?(?: whirl)?")
_FAMILIES = {"flap": "flapwise", "edge": "edgewise"}


@dataclass(frozen=True)
class Beside:
    """A mode of a linearisation beside the machine's mode of that name.

    Attributes:
        mode: of the linearisation.
        frequency: of the machine, Hz.
        confidence: of the machine's name, 0 to 1.
    """

    mode: Mode
    frequency: float
    confidence: float

    @property
    def difference(self) -> float:
        """Of the linearisation's frequency from the machine's, relative."""
        return self.mode.frequency / self.frequency - 1


def read(path: Path) -> Turbine:
    """The turbine of a primary file (.fst).

    Raises:
        CaseError: if the deck cannot be read, or describes no turbine.
    """
    with files.reading(path, deck=True):
        if not reader.is_turbine(path):
            raise CaseError(
                f"--fst {path}: not the primary file (.fst) of a turbine with a tower and three blades: give it"
            )
        return reader.read(path).turbine


def beside(judged: JudgedSet, turbine: Turbine) -> tuple[Beside, ...]:
    """Modes of a set beside those of the machine at its rotor speed; modes whose name one of the two lacks are left out.

    Raises:
        CaseError: if the machine has no steady state at this speed.
    """
    omega = judged.each.omega
    try:
        found = turbine_modes(machine(turbine), omega, MODES)
    except (PeriodicError, *NO_STATE) as error:
        raise CaseError(f"--fst: at {rad_s(omega)}: {error}") from error
    names = [machine_name(name) for name in found.names]
    own = [mode.name.partition(" (")[0] for mode in judged.modes]
    out = []
    for mode, name in zip(judged.modes, own, strict=True):
        if names.count(name) == 1 and own.count(name) == 1:
            k = names.index(name)
            out.append(Beside(mode, float(found.frequencies[k] / (2 * np.pi)), float(found.confidence[k])))
    return tuple(out)


def machine_name(name: str) -> str:
    """The name that modes of linearisations have, of a mode of the machine: ``1st flap forward whirl``."""
    if name == "drivetrain torsion":
        return "drivetrain"
    match = _NAME.fullmatch(name)
    if not match:
        return name
    number, family, turning = match.groups()
    return " ".join(filter(None, (_FAMILIES.get(family, family), number, turning)))
