"""A turbine as a case: its file, the speeds at which it is solved, and how closely codes must agree."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from msgspec import Meta, Struct

from .machines import turbines
from .names import Typed
from .readers.source import TurbineReading
from .schema import LOOSEST, Groups, Speeds, TimeLimit, rad_s
from .toml import convert, document, finite


class TurbineCompare(Struct, frozen=True, forbid_unknown_fields=True):
    """How closely codes must agree with Southwell's own solver on a turbine."""

    modes: Annotated[int, Meta(ge=1, description="number of modes, from the lowest")]
    target: Annotated[float, Meta(gt=0, le=LOOSEST, description="largest relative difference")] = 1e-3
    time_limit: TimeLimit = 300.0
    groups: Groups = 1


class TurbineCaseFile(Struct, frozen=True, forbid_unknown_fields=True):
    """A turbine's case file."""

    name: Typed
    title: Annotated[str, Meta(description="one line, as printed over a table")]
    description: Annotated[str, Meta(description="purpose and assumptions of the case")]
    source: Annotated[str, Meta(description="source of the data")]
    turbine: Annotated[str, Meta(description="file of the turbine, from the folder of this file")]
    speeds: Speeds
    compare: TurbineCompare


@dataclass(frozen=True)
class TurbineCase:
    """A turbine's case as read.

    Attributes:
        path: of its file.
        text: the file.
        reading: the turbine and its source.
        speeds: rad/s, ascending.
    """

    path: str
    text: TurbineCaseFile
    reading: TurbineReading
    speeds: tuple[float, ...]


def matches_format(path: Path) -> bool:
    """Whether a TOML file is a turbine's case.

    Raises:
        CaseError: it is not TOML.
    """
    return isinstance(document(path).get("turbine"), str)


def read(path: Path) -> TurbineCase:
    """Read a turbine's case.

    Raises:
        CaseError: naming the file and field at fault.
    """
    data = document(path)
    finite(data, str(path))
    text = convert(data, TurbineCaseFile, str(path))
    speeds = tuple(rad_s(text.speeds, str(path)).tolist())
    return TurbineCase(str(path), text, turbines.read(path.parent / text.turbine), speeds)
