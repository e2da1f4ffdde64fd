"""Files of towers that stand alone: BModes' main files of a tower, and Southwell's TOML files of a tower."""

from pathlib import Path

from ....core.rotor.tower import Tower
from .. import files
from ..errors import CaseError
from ..readers import bmodes_tower
from ..readers.source import Source
from ..readers.text import load
from . import turbine_toml


def is_tower(path: Path) -> bool:
    """Whether a file is that of a tower, without a rotor."""
    try:
        if path.suffix.lower() == ".toml":
            return path.is_file() and turbine_toml.holds(path) == "tower"
        return path.suffix.lower() == ".bmi" and path.is_file() and bmodes_tower.matches_format(load(path))
    except (CaseError, OSError):
        return False


def read(path: Path) -> tuple[Tower, Source]:
    """Read a tower.

    Raises:
        CaseError: naming the file and field at fault.
    """
    with files.reading(path, deck=path.suffix.lower() != ".toml"):
        return turbine_toml.tower(path) if path.suffix.lower() == ".toml" else bmodes_tower.read(path)
