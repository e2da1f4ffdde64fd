"""Find codes by name, registered in the entry-point group ``southwell.codes`` by this or another package, or by import path.

``code`` and ``loaded`` import a code, which runs foreign code. Only worker processes call them. Everything else uses
``description.describe`` to learn about a code and ``worker.answers`` to run it.
"""

import os
import sys
from difflib import get_close_matches
from functools import lru_cache
from importlib import import_module
from importlib.metadata import entry_points
from typing import Any, TypedDict

from .interface import BladeAdapter, MechanismAdapter
from .process import Failure, one_line, raised
from .turbines import TurbineAdapter

GROUP = "southwell.codes"
"""Entry-point group of codes, those of this package and those of others."""

PACKAGE = __name__.partition(".")[0]


class Address(TypedDict):
    """Where a worker process finds a code: its import path, and a folder that is searched last."""

    code: str
    folder: str | None


ADVICE = "give module:attribute of a module that is installed or in this folder"


class UnknownCodeError(ValueError):
    """Unknown code; the message gives its name, the likely cause and the remedy."""


def registered() -> dict[str, str]:
    """Name → import path of every registered code, sorted by name; no other package can take a name of this one.

    Raises:
        UnknownCodeError: if the codes of this package are missing: its installation is older than its sources.
    """
    return dict(_registered(tuple((folder, _changed(folder)) for folder in sys.path)))


@lru_cache(maxsize=1)
def _registered(_: tuple[tuple[str, int], ...]) -> dict[str, str]:
    """``registered`` while the search path and its folders are as they are: a run asks thousands of times."""
    entries = sorted(entry_points(group=GROUP), key=lambda entry: bundled(entry.value))
    if not entries or not bundled(entries[-1].value):
        raise UnknownCodeError("codes: southwell's own are not registered: run make, or pip install --editable .")
    return dict(sorted({entry.name: entry.value for entry in entries}.items()))


def _changed(folder: str) -> int:
    """When a package was last installed into a folder or removed from it, ns since 1970; 0 if there is no such folder."""
    try:
        return os.stat(folder or os.curdir).st_mtime_ns
    except OSError:
        return 0


def bundled(path: str) -> bool:
    """Whether the import path of a code is in this package."""
    return path.startswith(f"{PACKAGE}.")


def names() -> tuple[str, ...]:
    """Names of all registered codes, installed or not."""
    return tuple(registered())


def locate(name: str) -> str:
    """Import path ``module:attribute`` of a code.

    Args:
        name: a name from ``names()``, or an import path (of a code that is not registered).

    Raises:
        UnknownCodeError: if the name is unknown; the nearest is suggested.
    """
    if ":" in name:
        return name
    codes = registered()
    if name in codes:
        return codes[name]
    matches = get_close_matches(name, codes, 1)
    advice = f"did you mean {matches[0]}?" if matches else f"give one of {', '.join(codes)}"
    raise UnknownCodeError(f"code: {name!r} is not known: {advice}")


def address(name: str) -> Address:
    """Where a worker process finds a code: its import path, and a folder that may contain its modules.

    ``folder`` is the current one, searched last, for a code given by its import path; None otherwise.

    Raises:
        UnknownCodeError: as ``locate``.
    """
    return {"code": locate(name), "folder": os.getcwd() if ":" in name else None}


def loaded(request: dict[str, Any]) -> Any:
    """Import the code at an ``address``; a failure if that raises anything."""
    if (folder := request["folder"]) and folder not in sys.path:
        sys.path.append(folder)  # last, so that no file in it shadows an installed module
    try:
        return code(request["code"])
    except UnknownCodeError as error:
        return Failure("unknown", one_line(error))
    except BaseException as error:  # an exit, too
        return Failure("nonsense", f"import: {raised(error)}")


def code(name: str) -> Any:
    """Import the code called ``name`` (as for ``locate``), whose class is derived from one or several kinds of adapter.

    Raises:
        UnknownCodeError: if the name is unknown, or there is no code at the path.
        BaseException: anything else that its module raises.
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
        message = f"module {module!r} has no attribute {attribute!r}"
        raise UnknownCodeError(f"code: {name!r} cannot be loaded from {path}: {message}: {ADVICE}")
    adapter = getattr(holder, attribute)
    if not isinstance(adapter, BladeAdapter | MechanismAdapter | TurbineAdapter):
        bases = "southwell.references.protocol: interface.BladeAdapter, interface.MechanismAdapter or turbines.TurbineAdapter"
        raise UnknownCodeError(
            f"code: {path} is {type(adapter).__name__}, not an adapter: derive its class from {bases}"
        )
    return adapter
