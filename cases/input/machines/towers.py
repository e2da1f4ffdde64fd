"""Files of towers: those of BModes and Southwell's TOML that contain nothing else, and files of turbines that contain one."""

from pathlib import Path

from ....core.turbine.tower import Tower
from .. import files
from ..errors import CaseError
from ..readers import bmodes_tower, windio_tower
from ..readers.hawc2 import bodies
from ..readers.hawc2 import tower as hawc2_tower
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
    """Read a tower; of a HAWC2 htc, a windIO file or a turbine's TOML file its tower alone.

    Raises:
        CaseError: naming the file and field at fault.
    """
    suffix = path.suffix.lower()
    with files.reading(path, deck=suffix not in (".toml", ".yaml", ".yml")):
        if suffix == ".toml":
            return turbine_toml.tower(path)
        if suffix in (".yaml", ".yml"):
            return windio_tower.read(path)
        text = load(path)
        if bodies.matches_format(text):
            return hawc2_tower.read(path)
        if not bmodes_tower.matches_format(text):
            raise CaseError(
                f"{path}: --tower: contains no tower in a supported format (BModes .bmi, HAWC2 .htc, windIO, Southwell's "
                "TOML); for ElastoDyn, give the tower's own file"
            )
        return bmodes_tower.read(path)
