"""The cases that ``southwell verify`` runs: by name, from files, or made of blade files, with changed properties if wanted."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from msgspec.structs import replace as replaced

from ...cases.input import changes as blade_changes
from ...cases.input import library, mechanisms
from ...cases.input.changes import Change
from ...cases.input.default_case import default_case
from ...cases.input.library import is_blade_file
from ...cases.input.readers import Mount
from ...cases.input.schema import Case
from ...cases.verify import mechanism_case
from ...cases.verify.mechanism_case import MechanismCase
from ..shared.units import RPM, Units
from .errors import UsageError
from .subjects import subjects


@dataclass(frozen=True)
class Decks:
    """What the command line gives for blade files: rotor speeds and their unit, and how they are mounted."""

    speeds: tuple[tuple[float, ...], Units] | None
    mount: Mount


def case_of(name: str, decks: Decks) -> Case | MechanismCase:
    """A case of blades or of a mechanism, by name or file; or the default case of a blade file."""
    if is_blade_file(name):
        (subject,) = subjects(name, decks.mount, rotating=decks.speeds is None or any(decks.speeds[0]))
        speeds, units = decks.speeds or (subject.speeds, subject.units)
        if not speeds:
            raise UsageError(f"--rpm: missing: {name} does not define rotor speeds: give them, as in 0,6.9,12.1")
        return default_case(
            subject.blade, speeds, rpm=units is RPM, source="; ".join(subject.about), unused=subject.unused
        )
    if name in library.mechanisms() or (name.endswith(".toml") and mechanisms.matches_format(Path(name))):
        return mechanism_case.case(library.mechanism(name))
    return library.select(name)


def changed(case: Case | MechanismCase, given: Sequence[Change]) -> Case | MechanismCase:
    """The case with changed blade properties and without printed tables, which no longer apply."""
    if not given:
        return case
    if not isinstance(case, Case):
        raise UsageError(f"--set {given[0]}: {case.name} is a mechanism, not a blade: leave it out")
    what = "changed: " + ", ".join(str(change) for change in given)
    text = replaced(
        case.text,
        title=f"{case.text.title}; {what}",
        compare=replaced(case.text.compare, tables=()),
        discretisation=None,
    )
    variants = tuple(replace(v, blade=blade_changes.apply(v.blade, given)) for v in case.variants)
    return replace(case, text=text, variants=variants)


def everything() -> list[Case | MechanismCase]:
    """Every case and mechanism whose files are present; the others are reported as not run."""
    found, absent = library.everything()
    for name, why in absent.items():
        print(f"southwell: {name}: not run: {why}", file=sys.stderr)
    return [*found.values(), *(mechanism_case.case(library.mechanism(name)) for name in library.mechanisms())]
