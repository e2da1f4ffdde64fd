"""The codes by name: ours, those of installed packages (entry-point group ``southwell.codes``), and any by import path.

``code`` and ``loaded`` import a code: foreign code runs then, and may do anything. Only a worker process calls them; everybody
else learns of a code by ``description.describe``, and has it solve by ``worker.answers``.
"""

import os
import sys
from difflib import get_close_matches
from importlib import import_module
from importlib.metadata import entry_points
from typing import Any, Protocol, TypedDict

from .mechanism_interface import takes_mechanisms
from .process import Failure, one_line, raised

GROUP = "southwell.codes"

BLADE_CODE = ("name", "effects", "levels", "order", "version", "unsupported", "solve")
"""What a code that takes blades must have."""

OURS = {
    "exudyn-ancf": "southwell.references.exudyn.ancf:CODE",
    "exudyn-tree": "southwell.references.exudyn.tree:CODE",
    "scikit-fem": "southwell.references.scikit_fem.beam:CODE",
    "scikit-fem-reissner": "southwell.references.scikit_fem.reissner:CODE",
    "pinocchio": "southwell.references.joint_chains.pinocchio:CODE",
    "drake": "southwell.references.joint_chains.drake:CODE",
    "mujoco": "southwell.references.joint_chains.mujoco:CODE",
    "pybmodes": "southwell.references.pybmodes.beam:CODE",
    "calculix": "southwell.references.solid.calculix_blade:CODE",
    "sharpy": "southwell.references.isolated.sharpy:CODE",
    "frame3dd": "southwell.references.isolated.frame3dd:CODE",
    "yoo-shin": "southwell.references.theories.yoo_shin:CODE",
    "assumed-modes": "southwell.references.theories.assumed_modes:CODE",
    "southwell-equation": "southwell.references.theories.southwell_equation:CODE",
    "exact-beam": "southwell.references.theories.exact_beam:CODE",
}
"""Name → ``module:attribute`` of the codes that come with the package."""


class Address(TypedDict):
    """Where a worker process finds a code: its import path, and a folder that is searched last for its module."""

    code: str
    folder: str | None


ADVICE = "is it module:attribute, and installed or in this folder?"


class UnknownCodeError(ValueError):
    """A code that cannot be had: the message names it, the likely cause, and the remedy."""


FOR_MECHANISMS = {
    "exudyn-loops": "southwell.references.exudyn.mechanism:CODE",
    "pinocchio-loops": "southwell.references.linkages.mechanism:CODE",
}
"""Likewise, of those that take mechanisms and no blades."""


def names() -> tuple[str, ...]:
    """Names of all codes known here, ours first; installed or not."""
    theirs = sorted(e.name for e in entry_points(group=GROUP) if e.name not in {**OURS, **FOR_MECHANISMS})
    return (*OURS, *FOR_MECHANISMS, *theirs)


def locate(name: str) -> str:
    """Import path ``module:attribute`` of a code.

    Args:
        name: a name from ``names()``, or an import path itself (a code nobody registered).

    Raises:
        UnknownCodeError: if no such name is known; the nearest is suggested.
    """
    if ":" in name:
        return name
    if name in OURS or name in FOR_MECHANISMS:
        return {**OURS, **FOR_MECHANISMS}[name]
    for entry in entry_points(group=GROUP, name=name):
        return entry.value
    near = get_close_matches(name, names(), 1)
    advice = f"did you mean {near[0]}?" if near else f"known: {', '.join(names())}"
    raise UnknownCodeError(f"code: {name!r} is not known: {advice}")


def address(name: str) -> Address:
    """Where a worker process finds a code: its import path, and the folder that may hold its module.

    That is the current one, searched last, of a code that is asked for by its import path; else none.

    Raises:
        UnknownCodeError: as ``locate``.
    """
    return {"code": locate(name), "folder": os.getcwd() if ":" in name else None}


def loaded(request: dict[str, Any]) -> Any:
    """The code at an ``address``, imported now, or why it cannot be, whatever it raises."""
    if (folder := request["folder"]) and folder not in sys.path:
        sys.path.append(folder)  # last, so that no file in it takes the place of an installed module
    try:
        return code(request["code"])
    except UnknownCodeError as error:
        return Failure("unknown", one_line(error))
    except BaseException as error:  # an exit, too
        return Failure("nonsense", f"import: {raised(error)}")


def code(name: str) -> Any:
    """The code called ``name`` (as for ``locate``), imported now: an ``interface.Code``, a ``MechanismCode``, or both.

    Raises:
        UnknownCodeError: if it is not known, or the path leads nowhere or to what is not a code.
        BaseException: what else its module raises.
    """
    path = locate(name)
    module, _, attribute = path.partition(":")
    if not module or module.startswith("."):
        raise UnknownCodeError(f"code: {name!r}: no module is named: {ADVICE}")
    try:
        holder = import_module(module)
    except ImportError as error:
        raise UnknownCodeError(f"code: {name!r} cannot be loaded from {path}: {error}: {ADVICE}") from error
    if not hasattr(holder, attribute):
        told = f"module {module!r} has no attribute {attribute!r}"
        raise UnknownCodeError(f"code: {name!r} cannot be loaded from {path}: {told}: {ADVICE}")
    found = getattr(holder, attribute)
    needed = ("name", "effects", "version", "unsupported_mechanism") if takes_mechanisms(found) else BLADE_CODE
    missing = [a for a in needed if not hasattr(found, a)]
    if missing:
        raise UnknownCodeError(f"code: {path} lacks {', '.join(missing)}: see references.protocol.interface.Code")
    return found


CAPS = {
    "pinocchio": 40,
    "drake": 80,
    "mujoco": 80,
    "pybmodes": 320,
    "sharpy": 96,
    "frame3dd": 100,
    "scikit-fem-reissner": 96,
}
"""Finest refinement that a code can be asked for, where memory or time sets it: Pinocchio keeps dense cubes of all
freedoms, pyBModes and scikit-fem-reissner dense squares; Drake, MuJoCo, SHARPy and Frame3DD take time that
grows as the cube."""


class Refinable(Protocol):
    """A code, or its description."""

    @property
    def name(self) -> str: ...  # noqa: D102

    @property
    def levels(self) -> tuple[int, ...]: ...  # noqa: D102


def cap(code: Refinable) -> int:
    """The finest refinement a code is taken to."""
    return CAPS.get(code.name, 8 * code.levels[-1])
