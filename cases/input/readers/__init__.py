"""Readers of blade files: the format is recognised from the contents, and axes are converted on reading.

``reading(path)`` returns the blade with its source, ``read(path)`` only the blade; the module of each format has its own
``read``. ``southwell_toml.write`` and ``cases.writers`` write files that are read as the same blade.

The text formats are parsed here, since no library reports the line of an error: weio 2.0.0 reads a missing column as
zeros, accepts NaN and negative stiffness, and does not read ``1.0D+03``; openfast_io 5.0.0 does not read BeamDyn's old
header. YAML and TOML are parsed by libraries.
"""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import numpy as np

from ....core.blade import Blade, BladeError
from .. import files
from ..errors import CaseError
from ..names import MAX_NAME, has_name
from .source import BladeFile, Mount, Reading, Source, Unused

__all__ = ["FORMATS", "BladeFile", "Mount", "Reading", "Source", "Unused", "read", "reading", "recognise"]

FORMATS = ("ElastoDyn", "BeamDyn", "OpenFAST .fst", "BModes", "HAWC2", "windIO", "Southwell TOML and CSV")

_BY_SUFFIX = {".toml": "southwell_toml", ".csv": "southwell_toml", ".yaml": "windio", ".yml": "windio"}
"""Module by suffix of a file; files of other formats are recognised by their contents."""


def read(path: Path, mount: Mount | None = None) -> Blade:
    """Read the blade in a file of any format.

    Raises:
        CaseError: as ``reading``.
    """
    return reading(path, mount).blade


def reading(path: Path, mount: Mount | None = None) -> Reading:
    """Read the blade in a file of any format, with its source.

    Args:
        path: path of the file; for formats with several files, of the main file or the blade file.
        mount: data that the files do not contain, or that override them.

    Raises:
        CaseError: one line with file and line, value, likely cause and remedy.
    """
    deck = path.suffix.lower() not in _BY_SUFFIX
    with files.reading(path, *([mount.main] if mount and mount.main else []), deck=deck):
        try:
            blade_reading = recognise(path)(path, mount)
        except (
            BladeError
        ) as error:  # of a value that a reader adds to a valid blade, such as the tip mass of a main file
            raise CaseError(f"{path}: {error}") from error
    if mount is not None:
        for option, setting, format in (
            ("multipliers", mount.multipliers, "ElastoDyn"),
            ("subset", mount.subset, "HAWC2"),
            ("offsets", mount.offsets, "ElastoDyn"),
        ):
            if setting is not None and blade_reading.source.format != format:
                raise CaseError(
                    f"{path}: {option}: {blade_reading.source.format} files have no such option, {format} files do: leave "
                    "it out"
                )
    blade = blade_reading.blade
    if not has_name(blade.name):
        raise CaseError(f"{path}: name: {blade.name[:MAX_NAME]!r}: a name is one line of at most {MAX_NAME} characters")
    if np.abs(blade.twist).max() > np.pi:
        k = int(np.abs(blade.twist).argmax())
        raise CaseError(
            f"{path}: twist: {np.degrees(blade.twist[k]):.6g} degrees at {blade.stations[k]:g} m: more than half a "
            "turn: check the unit and the column"
        )
    return blade_reading


def recognise(path: Path) -> Callable[[Path, Mount | None], Reading]:
    """The reader of a file's format.

    Raises:
        CaseError: if the format is unknown or the file does not exist.
    """
    module = _BY_SUFFIX.get(path.suffix.lower())
    if module is None:
        from . import bmodes, other_files, text
        from .hawc2 import blade as hawc2
        from .openfast import beamdyn, elastodyn, elastodyn_tower, fst

        lines = text.load(path)
        signs = (
            ("openfast.elastodyn", elastodyn.is_blade),
            ("openfast.elastodyn", elastodyn.is_main),
            ("openfast.elastodyn_tower", elastodyn_tower.is_tower),
            ("openfast.fst", fst.matches_format),
            ("openfast.beamdyn", beamdyn.is_blade),
            ("openfast.beamdyn", beamdyn.is_main),
            ("bmodes", bmodes.matches_format),
            ("hawc2.blade", hawc2.is_st),
            ("hawc2.blade", hawc2.is_htc),
        )
        module = next((name for name, sign in signs if sign(lines)), None)
        if module is None and (what := other_files.description(lines)):
            raise CaseError(f"{path}: {what}")
    if module is None:
        raise CaseError(
            f"{path}: not a blade file of a known format ({', '.join(FORMATS)}): contains no keyword of these formats: "
            "keep the comments behind the values"
        )
    return import_module(f".{module}", __package__).read
