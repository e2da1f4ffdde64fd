"""Files of whole turbines: OpenFAST's primary files, HAWC2's htc files, and Southwell's TOML files of a turbine."""

from dataclasses import replace
from pathlib import Path

from .. import files
from ..errors import CaseError
from ..readers.hawc2 import turbine as hawc2
from ..readers.openfast import turbine as openfast
from ..readers.source import Mount, TurbineReading
from . import turbine_toml
from .schema import DeckData


def is_turbine(path: Path) -> bool:
    """Whether a file is that of a turbine with its tower."""
    suffix = path.suffix.lower()
    if suffix != ".toml":
        return hawc2.is_turbine(path) if suffix == ".htc" else openfast.is_turbine(path)
    try:
        return path.is_file() and turbine_toml.holds(path) == "turbine"
    except (CaseError, OSError):
        return False


def read(path: Path, mount: Mount | None = None) -> TurbineReading:
    """Read a turbine; ``mount`` overrides data of its blades.

    Raises:
        CaseError: naming the file and line or field at fault.
    """
    suffix = path.suffix.lower()
    with files.reading(path, deck=suffix != ".toml"):
        if suffix == ".htc":
            return hawc2.read(path, mount)
        if suffix != ".toml":
            return openfast.read(path, mount)
        if data := turbine_toml.deck(path):
            return _supported(path, data, openfast.read(path.parent / data.openfast, mount))
        return TurbineReading(*turbine_toml.turbine(path, mount or Mount()))


def _supported(path: Path, data: DeckData, reading: TurbineReading) -> TurbineReading:
    """A turbine of OpenFAST's files on the support that a TOML file gives."""
    foundation = turbine_toml.support(path, "support", data.support, reading.turbine.tower.length)
    mass = "without its inertia" if foundation.mass is None else "with its inertia"
    note = f"the tower's base is held by the support of {path.name}, {mass}"
    notes = tuple(note if line == openfast.GROUND else line for line in reading.source.notes)
    unused = tuple(replace(u, why=note) if u.why == openfast.FLOATER else u for u in reading.source.unused)
    source = replace(reading.source, files=(path, *reading.source.files), notes=notes, unused=unused)
    turbine = replace(reading.turbine, name=data.name or reading.turbine.name, support=foundation)
    return replace(reading, turbine=turbine, source=source)
