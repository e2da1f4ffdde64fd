"""Published tables as data, one TOML file per source, with every number as printed.

Numbers are stored as their digits, so that the rounding is known: half a unit of the last digit. A datum that exact
computation contradicts by more than its rounding stays in the table, marked ``suspect``, with the evidence.
``provenance`` gives the document that was read, since a reprint may differ from the original.
"""

import tomllib
from difflib import get_close_matches
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta, Struct

from ...core.effects import Effects
from ...core.regular_files import read_bytes

COARSEST = 0.02
"""Largest relative target allowed for a table: twenty times the paper's 0.1 %."""

Family = Literal["edgewise", "flapwise", "axial", "torsion"]
Effect = Literal["prestretch", "coriolis", "rotary_inertia", "geometric"]
Unit = Literal["rad/s", "rpm, rad/s", "rpm, Hz", "dimensionless"]


class TableError(ValueError):
    """Unknown or invalid table; the message gives the file, field, likely cause and remedy."""


class Datum(Struct, frozen=True, forbid_unknown_fields=True):
    """One printed number."""

    family: Family
    mode: Annotated[int, Meta(ge=1, description="ordinal within the family")]
    speed: Annotated[float, Meta(ge=0, description="rotor speed, in the table's unit")]
    printed: Annotated[str, Meta(pattern=r"^\d+(\.\d+)?$", description="the frequency's digits, in the table's unit")]
    suspect: Annotated[bool, Meta(description="whether exact computation contradicts it by more than its rounding")] = (
        False
    )
    evidence: Annotated[str, Meta(description="of the contradiction")] = ""

    def __post_init__(self) -> None:
        if self.suspect != bool(self.evidence):
            raise ValueError("suspect and evidence go together: give both or neither")

    @property
    def value(self) -> float:
        """The frequency, in the table's unit."""
        return float(self.printed)

    @property
    def half_unit(self) -> float:
        """Half a unit of the last digit, in the table's unit: the largest rounding error."""
        return 0.5 * 10.0 ** -len(self.printed.partition(".")[2])


class DeckBlade(Struct, frozen=True, forbid_unknown_fields=True):
    """The blade of a published deck, by which a user's file is recognised."""

    length: Annotated[float, Meta(gt=0, description="arc length, m")]
    mass: Annotated[float, Meta(gt=0, description="kg, without a mass at the tip")]


class Series(Struct, frozen=True, forbid_unknown_fields=True):
    """Numbers of one author's computation for one beam."""

    name: str
    title: str
    provenance: Annotated[str, Meta(description="where the digits were read")]
    description: Annotated[str, Meta(description="of the authors' model and method")]
    lacks: Annotated[tuple[Effect, ...], Meta(description="effects that the authors' model leaves out")]
    data: Annotated[tuple[Datum, ...], Meta(min_length=1)]
    hub_ratio: Annotated[float, Meta(ge=0, description="δ, hub radius over length; of a uniform beam")] = 0.0
    blade: Annotated[str, Meta(description="blade of the case, if it is not a uniform beam")] = ""
    deck: Annotated[DeckBlade, Meta(description="blade of a deck, for which the numbers appear too")] | None = None
    target: (
        Annotated[float, Meta(gt=0, le=COARSEST, description="target of the numbers, if larger than the case's")] | None
    ) = None
    grounds: Annotated[str, Meta(description="reason for such a target")] = ""
    theory: Annotated[str, Meta(description="theory shared with a code, as named in ``Independence``")] = ""
    slenderness: Annotated[float, Meta(gt=0, description="α = √(A L² / I); none: inextensible")] | None = None
    tip_mass_ratio: Annotated[float, Meta(ge=0, description="μ, tip mass over the beam's mass")] = 0.0
    height_taper: Annotated[
        float, Meta(ge=0, lt=1, description="of a linear taper: 1 less the ratio of tip to root")
    ] = 0.0
    breadth_taper: Annotated[float, Meta(ge=0, lt=1, description="the same, of the breadth")] = 0.0

    def __post_init__(self) -> None:
        if (self.target is None) != (not self.grounds):
            raise ValueError(f"series {self.name}: target and grounds go together: give both or neither")

    @property
    def tapered(self) -> bool:
        """Whether the beam is not uniform."""
        return bool(self.height_taper or self.breadth_taper)

    @property
    def effects(self) -> Effects:
        """The physical effects that the authors' model keeps."""
        return Effects(**dict.fromkeys(self.lacks, False))


class Table(Struct, frozen=True, forbid_unknown_fields=True):
    """All data from one source."""

    citation: str
    beam: Annotated[str, Meta(description="what vibrates")]
    unit: Annotated[Unit, Meta(description="of speeds and frequencies")]
    scale: Annotated[
        str, Meta(description="definition of a dimensionless speed or frequency; otherwise, how the numbers are given")
    ]
    series: Annotated[tuple[Series, ...], Meta(min_length=1)]
    doi: str = ""
    notes: str = ""
    errata: tuple[str, ...] = ()


def names() -> tuple[str, ...]:
    """All tables, sorted."""
    return tuple(sorted(f.name.removesuffix(".toml") for f in files(__name__).iterdir() if f.name.endswith(".toml")))


def label(name: str) -> str:
    """Name of a table in columns: that of its file without folder and ending, if it is given by path."""
    return Path(name).stem if name.endswith(".toml") else name


def load(name: str) -> Table:
    """The table called ``name`` (see ``names()``), or in the file ``name``, if it ends with ``.toml``.

    Raises:
        TableError: if there is none, or the file cannot be read or is invalid.
    """
    if name.endswith(".toml"):
        try:
            return parse(read_bytes(Path(name)).decode("utf-8"), name)
        except (OSError, UnicodeDecodeError) as error:
            raise TableError(f"{name}: {error}: give the path of a table, relative to the case file") from error
    if name not in names():
        matches = get_close_matches(name, names(), 1)
        advice = f"did you mean {matches[0]}?" if matches else f"give one of {', '.join(names())}"
        raise TableError(f"table: {name!r} is not known: {advice}")
    return parse((files(__name__) / f"{name}.toml").read_text(encoding="utf-8"), f"{name}.toml")


def parse(text: str, path: str) -> Table:
    """The table in a TOML document; ``path`` is for messages.

    Raises:
        TableError: invalid TOML, an unknown or missing key, a wrong type, or an invalid number.
    """
    try:
        return msgspec.convert(tomllib.loads(text), Table)
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise TableError(f"{path}: {error}: correct the file") from error
