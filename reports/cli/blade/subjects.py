"""The blades that a command is given: a blade file in any readable format, or the blades of a case."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ....cases.input import changes, readers
from ....cases.input.changes import PropertyChange
from ....cases.input.errors import CaseError
from ....cases.input.library import is_blade_file, select
from ....cases.input.readers import Mount, Unused
from ....cases.plan.settings import settings
from ....core.blade import Blade
from ...shared.units import BY_KEY, RPM, Units

FACTS = (
    "length",
    "hub radius",
    "mass",
    "stations",
    "twist",
    "rotary inertia",
    "not given, rigid",
    "slenderness",
    "hub ratio",
)
"""Facts on a case's blade that are shown."""


@dataclass(frozen=True)
class Subject:
    """A blade to solve.

    Attributes:
        blade: the blade.
        speeds: rotor speeds in rad/s, from the case or the blade's file; may be empty.
        units: of the speeds.
        about: origin of the blade, one fact per line.
        notes: what the blade's file leaves open, and the choices made.
        unused: non-zero quantities of the files that the blade does not use.
        files: files read; none for a case.
    """

    blade: Blade
    speeds: tuple[float, ...]
    units: Units
    about: tuple[str, ...]
    notes: tuple[str, ...] = ()
    unused: tuple[Unused, ...] = ()
    files: tuple[Path, ...] = ()


def changed(subjects: Sequence[Subject], property_changes: Sequence[PropertyChange]) -> list[Subject]:
    """The subjects with changed properties; ``about`` lists the changes.

    Raises:
        CaseError: if a blade does not allow a change.
    """
    lines = tuple(f"changed: {change}" for change in property_changes)
    return [replace(s, blade=changes.apply(s.blade, property_changes), about=(*s.about, *lines)) for s in subjects]


def single(name: str, mount: Mount, rotating: bool = True) -> Subject:
    """The only blade of a file or case; ``rotating`` as in ``subjects``.

    Raises:
        CaseError: as ``subjects``, or if the case has several blades.
    """
    blades = subjects(name, mount if is_blade_file(name) else Mount(), rotating)
    if len(blades) > 1:
        raise CaseError(f"{name}: {len(blades)} blades ({', '.join(s.blade.name for s in blades)}): name one of them")
    return blades[0]


def subjects(name: str, mount: Mount, rotating: bool = True) -> list[Subject]:
    """The blade of a file, with the given mount, or the blades of a case, which define how they are mounted.

    ``rotating``: whether the blade turns, so that its hub radius must be known.

    Raises:
        CaseError: if there is no such file or case, the file has an error, or the hub radius is unknown.
    """
    if is_blade_file(name):
        reading = readers.reading(Path(name), mount)
        source = reading.source
        speeds = () if reading.speed is None else (reading.speed,)
        blade = reading.mounted(Path(name)) if rotating else reading.blade
        return [Subject(blade, speeds, RPM, source.about, source.notes, source.unused, source.files)]
    case = select(name)
    if mount != Mount():
        raise CaseError(f"{name}: a case defines how its blade is mounted: leave out --main, --length and the like")
    out = []
    for variant, setting in zip(case.variants, settings(case), strict=True):
        facts = (f"{fact}: {value}" for fact, value in setting.facts.items() if fact in FACTS)
        about_lines = (setting.title, setting.description, f"source: {setting.source}", *facts)
        out.append(
            Subject(
                variant.blade, tuple(variant.speeds.tolist()), BY_KEY[setting.unit], about_lines, unused=variant.unused
            )
        )
    return out
