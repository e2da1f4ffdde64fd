"""A blade on the command line: a case's, or any blade file with what the file leaves to others."""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated

import numpy as np
from cyclopts import Parameter

from ..cases import library, readers
from ..cases.errors import CaseError
from ..cases.readers import own
from ..cases.readers.source import Mount, Source
from ..cases.schema import Variant
from ..cases.settings import settings
from .cli import select
from .units import BY_KEY, RPM, Units

SUFFIXES = frozenset({".dat", ".inp", ".txt", ".st", ".htc", ".bmi", ".yaml", ".yml", ".csv"})


@Parameter(name="*")
@dataclass(frozen=True)
class Mounting:
    """What a blade file leaves to others.

    Parameters
    ----------
    main
        Main file that says how a blade file is mounted: ElastoDyn's, or a HAWC2 htc.
    length
        Length of a blade file's blade in m, where no file says it.
    hub_radius
        Hub radius in m, where no file says it or it is to be different.
    precone
        Precone in degrees, positive downwind, likewise.
    pitch
        Pitch in degrees, positive with the leading edge upwind, likewise.
    subset
        Set and subset of a HAWC2 structural file that has several, as 1:1.
    """

    main: Path | None = None
    length: float | None = None
    hub_radius: float | None = None
    precone: float | None = None
    pitch: float | None = None
    subset: Annotated[str | None, Parameter()] = None

    def mount(self) -> Mount:
        """The same for a reader, in radians about our axes.

        Raises:
            CaseError: naming an option that cannot be.
        """
        for name, least in (("length", 1e-9), ("hub_radius", 0.0), ("precone", -90.0), ("pitch", -360.0)):
            value = getattr(self, name)
            if value is not None and not (np.isfinite(value) and value >= least):
                raise CaseError(
                    f"--{name.replace('_', '-')} {value:g}: must be a finite number, at least {least:g}: correct it"
                )
        return Mount(
            main=self.main,
            length=self.length,
            hub_radius=self.hub_radius,
            precone=None if self.precone is None else float(np.radians(self.precone)),
            pitch=None if self.pitch is None else -float(np.radians(self.pitch)),
            subset=_subset(self.subset) if self.subset else None,
        )


def _subset(text: str) -> tuple[int, int]:
    first, _, second = text.partition(":")
    try:
        return int(first), int(second or 1)
    except ValueError:
        raise CaseError(f"--subset: {text!r}: not set:subset, as in 1:1") from None


@dataclass(frozen=True)
class Chosen:
    """What was named.

    Attributes:
        variants: the blades; of a file, without speeds.
        units: what the case's speeds are in; of a file, revolutions per minute.
        source: of a file, where it came from.
    """

    variants: tuple[Variant, ...]
    units: Units
    source: Source | None = None


def choose(name: str, mounting: Mounting | None = None) -> Chosen:
    """The blades of a case by name or file, or the blade in a file of any format.

    Raises:
        CaseError: if there are none, or the file is at fault.
    """
    mounting = mounting or Mounting()
    path = Path(name)
    stem = name.partition("/")[0]
    if stem not in library.names() and _is_file(path):
        found = readers.reading(path, mounting.mount())
        return Chosen((Variant(found.blade.name, found.blade, np.zeros(0)),), RPM, found.source)
    given = [f.name for f in fields(mounting) if getattr(mounting, f.name) is not None]
    if given:
        raise CaseError(
            f"--{given[0].replace('_', '-')}: {name} is a case, which says how its blade is mounted: leave it out"
        )
    case = select(name)
    return Chosen(case.variants, BY_KEY[settings(case)[0].unit])


def _is_file(path: Path) -> bool:
    if path.suffix.lower() == ".toml":
        return path.is_file() and own.is_one(path)
    return path.suffix.lower() in SUFFIXES or path.is_file()
