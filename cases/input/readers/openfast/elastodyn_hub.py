"""The hub in ElastoDyn's main file: its inertia, and the teeter hinge of two blades.

Source: J. Jonkman, M. Buhl, *FAST User's Guide*, NREL/EL-500-38230, 2005; ElastoDyn's source code.
"""

from dataclasses import replace

import numpy as np

from .....core.mechanism.description import inertia
from .....core.turbine.turbine import Teeter
from ...errors import CaseError
from ..source import Unused
from ..text import Text, flag, number_or, value
from .elastodyn_unused import TEETER

Entries = dict[str, tuple[int, str]]


def hub(main: Text, entries: Entries) -> np.ndarray:
    """(6, 6) inertia of the hub at the rotor's apex, in the shaft's axes."""
    moments = (0.0, 0.0, value(main, entries, "HubIner"))
    return inertia(value(main, entries, "HubMass"), moments, (0.0, 0.0, number_or(main, "HubCM", 0.0)))


def hub_of_two(main: Text, entries: Entries, undersling: float) -> np.ndarray:
    """(6, 6) inertia of the hub of two blades at the rotor's apex, in the shaft's axes.

    HubIner is about the teeter hinge, and the moment about the shaft is the same about the mass centre, as of a cylinder along
    the blades (ElastoDyn's source code, ``Hubg1Iner``); files with HubIner_Teeter give the two apart.
    """
    mass, centre = value(main, entries, "HubMass"), number_or(main, "HubCM", 0.0)
    of_shaft, name = value(main, entries, "HubIner"), "HubIner"
    if "hubiner_teeter" in entries:
        name = "HubIner_Teeter"
    transverse = value(main, entries, name) - mass * (undersling - centre) ** 2
    if transverse < 0:
        raise CaseError(
            f"{main.at(entries[name.lower()][0])}: {name}: less than HubMass at its distance from the teeter hinge, "
            f"{mass * (undersling - centre) ** 2:g} kg m²: the moment of inertia must be about the hinge; correct one of them"
        )
    moments = np.array([0.0, transverse, transverse if name == "HubIner" else of_shaft])
    return inertia(mass, moments, (0.0, 0.0, centre))


def teeter(main: Text, entries: Entries) -> tuple[Teeter | None, float, tuple[str, ...]]:
    """The teeter hinge of two blades, the undersling, m, and a note.

    The apex is upwind of the hinge by UndSling, and OverHang reaches to the hinge. A soft stop at 0 is a spring.
    """
    undersling = number_or(main, "UndSling", 0.0)
    if not flag(main, "TeetDOF"):
        return None, undersling, ("the hub does not teeter (TeetDOF is False)",)
    if number_or(main, "Delta3", 0.0):
        raise CaseError(
            f"{main.at(entries['delta3'][0])}: Delta3: {number_or(main, 'Delta3', 0.0):g}: only a teeter hinge perpendicular "
            "to the blades is supported; set Delta3 to 0, or TeetDOF to False"
        )
    soft = number_or(main, "TeetMod", 0.0) == 1 and number_or(main, "TeetSStP", 0.0) == 0
    stiffness = number_or(main, "TeetSSSp", 0.0) if soft else 0.0
    spring = f"a spring of {stiffness:g} N m/rad (TeetSSSp)" if stiffness else "no spring about its middle"
    return Teeter(undersling, stiffness), undersling, (f"the hub teeters, with {spring} and without its damper",)


def without_hinge(of_blade: tuple[Unused, ...], teeter: Teeter | None) -> tuple[Unused, ...]:
    """What a blade does not use, with the hinge's data that a turbine of two blades uses left out."""
    used_names = ("TeetDOF", "UndSling", "TeetMod", *(("TeetSSSp",) if teeter and teeter.stiffness else ()))
    out = (u for u in of_blade if u.name not in used_names)
    return tuple(replace(u, why="the hinge is linear and undamped") if u.name in TEETER else u for u in out)
