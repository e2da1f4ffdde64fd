"""The subjects of a request: by name, from files, or made of blade files, with changed properties if asked."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from msgspec.structs import replace as replaced

from ..input import changes as blade_changes
from ..input import library, mechanisms, readers, turbine_cases
from ..input.changes import PropertyChange
from ..input.default_case import default_case
from ..input.errors import CaseError
from ..input.library import is_blade_file
from ..input.machines import turbines
from ..input.readers import BladeFile, Mount
from ..input.schema import Case
from . import linearised, mechanism, turbine
from .blade import blades
from .request import Request, speeds
from .subject import Subject


def subjects(request: Request, note: Callable[[str], None]) -> list[Subject]:
    """The subjects of a request; ``note`` is called with one line for each that is not run.

    Raises:
        CaseError: for a subject that cannot be read, or an option that does not apply to it.
    """
    decks = speeds(request.rpm, request.omega)
    edits = [blade_changes.parse(text) for text in request.changes]
    requested = request.subjects
    unique = [s for k, s in enumerate(requested) if not isinstance(s, str) or s not in requested[:k]] or _everything(
        note
    )
    selection = [_changed(_read(subject, decks, request), edits) for subject in unique]
    if not any(isinstance(s, str) and _deck(s) for s in unique) and (decks or request.mount != Mount()):
        raise CaseError(
            "--rpm, --omega, --length and the like are for blade files: a case defines its speeds and mounting"
        )
    return [part for case in selection for part in (blades(case) if isinstance(case, Case) else [case])]


def _read(
    subject: str | Case | Subject, decks: tuple[tuple[float, ...], bool] | None, request: Request
) -> Case | Subject:
    """A case of blades or a mechanism, by name or file; or the default case of a turbine's or a blade's file."""
    if not isinstance(subject, str):
        return subject
    if _deck(subject):
        if not request.blade_only and turbines.is_turbine(Path(subject)):
            return _turbine(Path(subject), decks, request)
        return _of_blade_file(subject, decks, request.mount)
    if subject in library.mechanisms() or (subject.endswith(".toml") and mechanisms.matches_format(Path(subject))):
        return mechanism.subject(library.mechanism(subject))
    if subject in library.turbines() or (subject.endswith(".toml") and turbine_cases.matches_format(Path(subject))):
        return turbine.of_case(library.turbine(subject))
    return library.select(subject)


def _deck(name: str) -> bool:
    """Whether a name is the file of a blade or a turbine, which defines no speeds to compare at."""
    return is_blade_file(name) or turbines.is_turbine(Path(name))


def _turbine(path: Path, decks: tuple[tuple[float, ...], bool] | None, request: Request) -> turbine.TurbineSubject:
    """The turbine in a file; speeds that are not given are those of added linearisations, or that of the file."""
    reading = turbines.read(path, request.mount)
    at, rpm = decks or (linearised.speeds(request.add) or (reading.speed,), True)
    return turbine.subject(path, reading, at, rpm, request.mount)


def _of_blade_file(name: str, decks: tuple[tuple[float, ...], bool] | None, mount: Mount) -> Case:
    reading = readers.reading(Path(name), mount)
    source = reading.source
    speeds = () if reading.speed is None else (reading.speed,)
    at, rpm = decks or (speeds, True)
    blade = reading.mounted(Path(name)) if decks is None or any(at) else reading.blade
    if not at:
        raise CaseError(f"--rpm: missing: {name} does not define rotor speeds: give them, as in 0,6.9,12.1")
    file = BladeFile(Path(name), reading.blade, source, mount)
    return default_case(blade, at, rpm=rpm, source="; ".join(source.about), unused=source.unused, file=file)


def _changed(case: Case | Subject, edits: Sequence[PropertyChange]) -> Case | Subject:
    """The case with changed blade properties and without printed tables, which no longer apply."""
    if not edits:
        return case
    if not isinstance(case, Case):
        raise CaseError(f"--set {edits[0]}: {case.name} is not a blade: leave it out")
    note = "changed: " + ", ".join(str(change) for change in edits)
    text = replaced(
        case.text,
        title=f"{case.text.title}; {note}",
        compare=replaced(case.text.compare, tables=()),
        discretisation=None,
    )
    variants = tuple(replace(v, blade=blade_changes.apply(v.blade, edits), file=None) for v in case.variants)
    return replace(case, text=text, variants=variants)


def _everything(note: Callable[[str], None]) -> tuple[Case | Subject, ...]:
    """Every case and mechanism whose files are present."""
    cases, failures = library.load_all()
    for name, why in failures.items():
        note(f"{name}: not run: {why}")
    machines = [mechanism.subject(library.mechanism(name)) for name in library.mechanisms()]
    turbines = [turbine.of_case(library.turbine(name)) for name in library.turbines()]
    return (*cases.values(), *machines, *turbines)
