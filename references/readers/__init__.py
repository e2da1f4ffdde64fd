"""Second readers of blade files: parsers of other projects, with conversions of their own.

``read(format, path, asked)`` returns the stations of a blade as a parser other than Southwell's sees them. The conversion to
the axes of ``core.blade`` is written from the manual of each format; nothing here imports ``core`` or ``cases``, so that a
mistake in a reader or in a conversion is not repeated.

| format | parser |
|---|---|
| ElastoDyn with FAST 7's additional columns, BeamDyn, OpenFAST's .fst | weio |
| HAWC2: structural files, c2_def of an htc | wetb, as it comes with weio |
| BModes | pyBModes |
| windIO 1 and 2 | ruamel.yaml |
| Southwell CSV | pandas |

weio finds values by their labels and columns by their names. openfast-io counts lines and columns instead: its release 5.0.0
takes the column PitchAxis of older ElastoDyn tables for the twist and stops at older BeamDyn headers, its release 4.1.2 does
not read the files of OpenFAST 5. wetb alone requires sixty packages, among them a compiler.
"""

from importlib import import_module
from pathlib import Path

from .stations import HINT, NotInstalledError, NotReadError, ReadingOptions, Stations

__all__ = ["FORMATS", "HINT", "NotInstalledError", "NotReadError", "ReadingOptions", "Stations", "read"]

FORMATS = {
    "ElastoDyn": "openfast",
    "BeamDyn": "openfast",
    "BModes": "bmodes",
    "HAWC2": "hawc2",
    "windIO 1": "windio",
    "windIO 2": "windio",
    "Southwell CSV": "tables",
}
"""Format → module of its second reader."""


def read(format: str, path: Path, options: ReadingOptions) -> Stations:
    """The stations of the blade in a file, by the second reader of its format.

    Args:
        format: a name in ``FORMATS``.
        path: the file that a user names.
        options: what a user states besides it.

    Raises:
        NotReadError: in one line, if no second reader reads it.
    """
    if format not in FORMATS:
        raise NotReadError(f"no second reader of {format}")
    try:
        return import_module(f".{FORMATS[format]}", __package__).read(path, options)
    except NotReadError:
        raise
    except Exception as error:  # of a foreign parser, whatever it raises
        raise NotReadError(" ".join(f"{type(error).__name__}: {error}".split())[:300]) from error
