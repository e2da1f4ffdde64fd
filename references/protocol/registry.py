"""The codes by name: ours, those of installed packages (entry-point group ``southwell.codes``), and any by import path.

A code's module is imported only when the code is asked for, so that a missing or broken foreign package costs nothing
to those who do not use it.
"""

from difflib import get_close_matches
from importlib import import_module
from importlib.metadata import entry_points
from typing import Any

from .interface import Code
from .mechanism_interface import takes_mechanisms

GROUP = "southwell.codes"

BLADE_CODE = ("name", "model", "levels", "order", "version", "unsupported", "solve")
"""What a code that takes blades must have."""

OURS = {
    "exudyn-ancf": "southwell.references.exudyn.ancf:CODE",
    "exudyn-tree": "southwell.references.exudyn.tree:CODE",
    "scikit-fem": "southwell.references.scikit_fem.beam:CODE",
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


class UnknownCodeError(ValueError):
    """A code that cannot be had: the message names it, the likely cause, and the remedy."""


FOR_MECHANISMS = {"exudyn-loops": "southwell.references.exudyn.mechanism:CODE"}
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


def code(name: str) -> Any:
    """The code called ``name`` (as for ``locate``), imported now: an ``interface.Code``, a ``MechanismCode``, or both.

    Raises:
        UnknownCodeError: if it is not known, or what the path leads to cannot be imported or is not a code.
    """
    path = locate(name)
    module, _, attribute = path.partition(":")
    try:
        found = getattr(import_module(module), attribute)
    except Exception as error:  # whatever a foreign module does when it is imported
        what = error if isinstance(error, ImportError | AttributeError) else f"{type(error).__name__}: {error}"
        raise UnknownCodeError(
            f"code: {name!r} cannot be loaded from {path}: {what}: is it module:attribute, and installed or in this folder?"
        ) from error
    needed = ("name", "model", "version", "unsupported_mechanism") if takes_mechanisms(found) else BLADE_CODE
    missing = [a for a in needed if not hasattr(found, a)]
    if missing:
        raise UnknownCodeError(f"code: {path} lacks {', '.join(missing)}: see references.interface.Code")
    return found


def version_of(code: Any) -> tuple[str, str]:
    """A code's version, empty if it is not installed, and what it raised instead of telling, empty if nothing."""
    try:
        return str(code.version() or ""), ""
    except Exception as error:  # whatever a foreign code raises costs its own cells only
        return "", f"version(): {type(error).__name__}: {' '.join(str(error).split())}"


CAPS = {"pinocchio": 40, "drake": 80, "mujoco": 80, "pybmodes": 320, "sharpy": 96, "frame3dd": 100}
"""Finest refinement that a code can be asked for, where memory or time sets it: Pinocchio keeps dense cubes of all
freedoms, pyBModes dense squares; Drake, MuJoCo, SHARPy and Frame3DD take time that
grows as the cube."""


def cap(code: Code) -> int:
    """The finest refinement a code is taken to."""
    return CAPS.get(code.name, 8 * code.levels[-1])
