"""Files of whole turbines: OpenFAST's primary files, and Southwell's TOML files of a turbine."""

from pathlib import Path

from .. import files
from ..errors import CaseError
from ..readers.openfast import turbine as openfast
from ..readers.openfast.turbine import TurbineReading
from ..readers.source import Mount
from . import turbine_toml


def is_turbine(path: Path) -> bool:
    """Whether a file is that of a turbine with its tower."""
    if path.suffix.lower() != ".toml":
        return openfast.is_turbine(path)
    try:
        return path.is_file() and turbine_toml.holds(path) == "turbine"
    except (CaseError, OSError):
        return False


def read(path: Path, mount: Mount | None = None) -> TurbineReading:
    """Read a turbine; ``mount`` overrides data of its blades.

    Raises:
        CaseError: naming the file and line or field at fault.
    """
    toml = path.suffix.lower() == ".toml"
    with files.reading(path, deck=not toml):
        if toml:
            return TurbineReading(*turbine_toml.turbine(path, mount or Mount()))
        return openfast.read(path, mount)
