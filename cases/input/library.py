"""The cases and mechanisms of the package, and others given by file."""

import os
from dataclasses import replace
from importlib.resources import as_file, files
from pathlib import Path

from .. import data
from . import turbine_cases
from .errors import CaseError, FilesMissingError, nearest
from .machines.turbines import is_turbine
from .mechanisms import Described, matches_format
from .mechanisms import read as describe
from .readers import southwell_toml
from .schema import Case, read
from .turbine_cases import TurbineCase


def _names(folder: str = "", ending: str = "") -> tuple[str, ...]:
    """Names of the TOML files in a folder of the package's data, sorted."""
    stems = (Path(f.name).stem for f in (files(data) / folder).iterdir() if f.name.endswith(f"{ending}.toml"))
    return tuple(sorted(stems))


def names() -> tuple[str, ...]:
    """Names of the cases of the package, sorted."""
    return _names()


def load_all() -> tuple[dict[str, Case], dict[str, str]]:
    """The cases of the package by name, and the remedy for each whose blade files are not included and not found."""
    cases, failures = {}, {}
    for name in names():
        try:
            cases[name] = load(name)
        except FilesMissingError as error:
            failures[name] = str(error).removeprefix(f"{name}: ")
    return cases, failures


def mechanisms() -> tuple[str, ...]:
    """Names of the mechanisms of the package, sorted."""
    return _names("mechanisms")


def mechanism(name: str) -> Described:
    """A mechanism by its name, or by the path of its TOML file.

    Raises:
        CaseError: if the mechanism does not exist (the nearest name is suggested), or its file is invalid.
    """
    if name in mechanisms():
        with as_file(files(data) / "mechanisms" / f"{name}.toml") as path:
            return describe(path)
    if name.endswith(".toml"):
        return describe(Path(name))
    raise CaseError(
        f"mechanism: {name!r} is not known: {nearest(name, mechanisms())}; or give the path of a .toml file"
    )


def turbines() -> tuple[str, ...]:
    """Names of the turbines of the package, sorted."""
    return _names("turbines", "-turbine")


def turbine(name: str) -> TurbineCase:
    """A turbine's case by its name, or by the path of its TOML file.

    Raises:
        CaseError: if its file is invalid.
    """
    if name in turbines():
        with as_file(files(data) / "turbines") as folder:
            return turbine_cases.read(folder / f"{name}.toml")
    return turbine_cases.read(Path(name))


def load(name: str) -> Case:
    """A case by its name, or by the path of its TOML file.

    Raises:
        CaseError: if the case does not exist (the nearest name is suggested), or its file is invalid.
    """
    if name in names():
        with as_file(files(data)) as folder:
            return read(folder / f"{name}.toml")
    is_file = name.endswith(".toml")
    if name in mechanisms() or (is_file and matches_format(Path(name))):
        raise CaseError(f"case: {name!r}: it is a mechanism, not a blade: see `southwell mechanism {name}`")
    if name in turbines() or (is_file and turbine_cases.matches_format(Path(name))):
        raise CaseError(
            f"case: {name!r}: it is a turbine, not a blade: see `southwell verify {name}`, or give the file of the turbine to "
            "`southwell campbell`"
        )
    if is_file:
        return read(Path(name))
    existing = (*names(), *mechanisms(), *turbines())
    raise CaseError(f"case: {name!r} is not known: {nearest(name, existing)}; or give the path of a .toml file")


def select(name: str) -> Case:
    """A case by name or file, optionally with only one of its blades: ``park-blade/surrogate``.

    Raises:
        CaseError: if the case or blade does not exist.
    """
    stem, _, blade = name.partition("/")
    if name.endswith(".toml") or not blade:
        return load(name)
    case = load(stem)
    variants = tuple(v for v in case.variants if v.name == name)
    if not variants:
        raise CaseError(f"case: {name!r}: no such blade: {nearest(name, [v.name for v in case.variants])}")
    return replace(case, variants=variants)


def is_blade_file(name: str) -> bool:
    """Whether a name is that of a file of a blade or of a turbine, not of a case."""
    path = Path(name)
    if (
        name in (*names(), *turbines())
        or name.partition("/")[0] in names()
        or not (path.suffix or os.path.isfile(path))
    ):
        return False
    if path.suffix.lower() != ".toml":
        return True
    return os.path.isfile(path) and (southwell_toml.matches_format(path) or is_turbine(path))
