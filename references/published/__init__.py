"""Printed tables as data, one TOML file a source, every number as it is printed.

A number is kept as its digits, so that its rounding is known: half a unit of the last one. A datum that exact computation
contradicts by more than that stays, marked ``suspect``, with the evidence. ``provenance`` says where the digits were read:
a reprint is no proof of what the original prints.
"""

import tomllib
from difflib import get_close_matches
from importlib.resources import files
from typing import Annotated, Literal

import msgspec
from msgspec import Meta, Struct

from ...core.effects import Effects

COARSEST = 0.02
"""Largest relative target that a table may be given: twenty times the paper's 0.1 %."""

Family = Literal["chordwise", "flapwise", "axial", "torsion"]
Effect = Literal["prestretch", "coriolis", "rotary_inertia", "geometric"]
Unit = Literal["rad/s", "rpm, Hz", "dimensionless"]


class TableError(ValueError):
    """A table that cannot be had: the message names the file and field, the likely cause, and the remedy."""


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
        """Half a unit of the last digit, in the table's unit: the most that rounding can have moved the value."""
        return 0.5 * 10.0 ** -len(self.printed.partition(".")[2])


class Series(Struct, frozen=True, forbid_unknown_fields=True):
    """Numbers of one author's computation for one beam."""

    name: str
    title: str
    provenance: Annotated[str, Meta(description="where the digits were read")]
    description: Annotated[str, Meta(description="of the authors' model and method")]
    lacks: Annotated[tuple[Effect, ...], Meta(description="effects that the authors' model leaves out")]
    data: Annotated[tuple[Datum, ...], Meta(min_length=1)]
    hub_ratio: Annotated[float, Meta(ge=0, description="δ, hub radius over length; of a uniform beam")] = 0.0
    blade: Annotated[str, Meta(description="the case's blade it is about, where that is no uniform beam")] = ""
    target: (
        Annotated[
            float, Meta(gt=0, le=COARSEST, description="what the numbers can be held to, where coarser than the case's")
        ]
        | None
    ) = None
    grounds: Annotated[str, Meta(description="of such a target")] = ""
    theory: Annotated[str, Meta(description="that a code has too, as its ``Independence`` names it")] = ""
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
    """All that was taken from one source."""

    citation: str
    beam: Annotated[str, Meta(description="what vibrates")]
    unit: Annotated[Unit, Meta(description="of speeds and frequencies")]
    scale: Annotated[
        str, Meta(description="what a dimensionless speed or frequency is; else how the numbers are given")
    ]
    series: Annotated[tuple[Series, ...], Meta(min_length=1)]
    doi: str = ""
    notes: str = ""
    errata: tuple[str, ...] = ()


def names() -> tuple[str, ...]:
    """All tables, sorted."""
    return tuple(sorted(f.name.removesuffix(".toml") for f in files(__name__).iterdir() if f.name.endswith(".toml")))


def load(name: str) -> Table:
    """The table called ``name`` (see ``names()``).

    Raises:
        TableError: if there is none.
    """
    if name not in names():
        near = get_close_matches(name, names(), 1)
        advice = f"did you mean {near[0]}?" if near else f"known: {', '.join(names())}"
        raise TableError(f"table: {name!r} is not known: {advice}")
    return parse((files(__name__) / f"{name}.toml").read_text(encoding="utf-8"), f"{name}.toml")


def parse(text: str, path: str) -> Table:
    """The table in a TOML document; ``path`` is for messages.

    Raises:
        TableError: broken TOML, an unknown or missing key, a wrong type, a number that is none.
    """
    try:
        return msgspec.convert(tomllib.loads(text), Table)
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise TableError(f"{path}: {error}: correct the file") from error
