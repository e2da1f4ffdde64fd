"""Schema of a case file: frozen structures; unknown keys are rejected; descriptions give the units.

A case specifies the same task for every code: blades, speeds, compared motions and the target.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

import numpy as np
from msgspec import UNSET, Meta, Struct, UnsetType, structs
from numpy.typing import NDArray

from ...core.blade import Blade
from ...core.effects import Effects
from ...references import published
from . import files
from .blades import BladeData, Dimensionless
from .errors import CaseError, located, nearest
from .names import Name, Typed
from .readers.source import BladeFile, Unused
from .toml import OR_A_NAME, convert, document, finite

Effect = Literal["prestretch", "coriolis", "rotary_inertia", "geometric"]
Motion = Literal["axial", "edgewise", "flapwise", "torsion"]
Values = list[Annotated[float, Meta(ge=0)]] | str


LOOSEST = 0.5
"""Widest allowed target."""

Confirmations = Annotated[int, Meta(ge=0, le=20)]

Groups = Annotated[
    Confirmations, Meta(description="number of independent groups that must agree with Southwell's own solver")
]

TimeLimit = Annotated[float, Meta(gt=0, le=86400, description="time limit of one solution by a foreign code, s")]


class Speeds(Struct, frozen=True, forbid_unknown_fields=True):
    """Rotor speeds in one unit: a list, or a range ``"first:last:step"`` with both ends, or ``"0, 5, 10"``."""

    rad_s: Annotated[Values, Meta(description="rad/s")] | UnsetType = UNSET
    rpm: Annotated[Values, Meta(description="revolutions per minute")] | UnsetType = UNSET
    gamma: (
        Annotated[Values, Meta(description="γ, in units of √(EI/(ρ A L⁴)); dimensionless blades only")] | UnsetType
    ) = UNSET


class Compare(Struct, frozen=True, forbid_unknown_fields=True):
    """The compared modes and the target."""

    modes: Annotated[int, Meta(ge=1, le=100, description="number of modes, from the lowest, of those that qualify")]
    motions: Annotated[
        tuple[Motion, ...],
        Meta(min_length=1, description="a mode qualifies if at least half its kinetic energy is in these motions"),
    ] = get_args(Motion)
    target: Annotated[float, Meta(gt=0, le=LOOSEST, description="largest difference, relative")] = 1e-3
    tables: Annotated[
        tuple[str, ...], Meta(description="published tables to compare with, by name, or by path (.toml)")
    ] = ()
    time_limit: TimeLimit = 300.0
    groups: Annotated[
        Confirmations | dict[str, Confirmations],
        Meta(
            description="number of independent groups that must agree with Southwell's own solver: a number, or one for each "
            "variant by name"
        ),
    ] = 1
    lacking: Annotated[str, Meta(description="reason if no group is required")] = ""

    def required(self, label: str) -> int:
        """Number of groups that must confirm the variant ``label``."""
        return self.groups if isinstance(self.groups, int) else self.groups.get(label, 1)


class Discretisation(Struct, frozen=True, forbid_unknown_fields=True):
    """A discretisation of Southwell's own solver, usually that of the source, shown in a separate column."""

    elements: Annotated[int, Meta(ge=1, description="number of elements")]
    mass: Annotated[Literal["consistent", "half_end"], Meta(description="how mass is lumped")]
    stiffness: Annotated[
        Literal["corotational", "body_fixed"], Meta(description="the frame the beam's stiffness is linear in")
    ]
    lacks: Annotated[tuple[Effect, ...], Meta(description="effects that the source leaves out")] = ()
    tables: Annotated[tuple[str, ...], Meta(description="series of compare.tables computed with it: table/series")] = ()

    @property
    def effects(self) -> Effects:
        """The effects kept."""
        return Effects(**dict.fromkeys(self.lacks, False))

    @property
    def label(self) -> str:
        """Its name in a sentence."""
        return f"{self.elements} elements, {self.mass} masses, {self.stiffness} stiffness".replace("_", "-")


class CaseFile(Struct, frozen=True, forbid_unknown_fields=True):
    """A case file."""

    name: Typed
    title: Annotated[str, Meta(description="one line, as printed over a table")]
    description: Annotated[str, Meta(description="purpose and assumptions of the case")]
    source: Annotated[str, Meta(description="source of data and numbers")]
    blade: BladeData
    speeds: Speeds
    compare: Compare
    variants: Annotated[
        dict[Name, dict[str, Any]],
        Meta(description="name → the keys of ``blade`` that differ; empty: the blade itself"),
    ] = {}
    discretisation: Discretisation | None = None


@dataclass(frozen=True)
class Variant:
    """One blade of a case.

    Attributes:
        name: the case's name, and the variant's after a slash if it has several.
        blade: as every code is given it.
        speeds: (k,) rad/s, ascending.
        unused: non-zero quantities of the blade's files that the blade does not use.
        file: the blade's file as read, for a second reading; None if there is none, or if the blade was changed since.
    """

    name: str
    blade: Blade
    speeds: NDArray[np.float64]
    unused: tuple[Unused, ...] = ()
    file: BladeFile | None = None


@dataclass(frozen=True)
class Case:
    """A case file as read, with its blades.

    Attributes:
        path: path of the file, for messages.
        text: the file's contents.
        variants: blades of the case, at least one.
    """

    path: str
    text: CaseFile
    variants: tuple[Variant, ...]

    @property
    def name(self) -> str:
        """Name on the command line."""
        return self.text.name


def read(path: Path) -> Case:
    """Read the case in a TOML file.

    Raises:
        CaseError: one line with file, field, value, cause and remedy.
    """
    with files.reading(path):
        return decode(document(path, OR_A_NAME), str(path), path.parent)


def _tables(text: CaseFile, path: str, folder: Path) -> tuple[str, ...]:
    """The tables of a case; a path is made absolute, and its table is read."""
    out = []
    for table in text.compare.tables:
        if table.endswith(".toml"):
            file = folder / table
            files.text(file, remedy="paths in a case are relative to its file; correct the name")
            try:
                published.load(str(file.resolve()))
            except published.TableError as error:
                raise CaseError(f"{path}: compare.tables: {error}") from error
            out.append(str(file.resolve()))
        elif table in published.names():
            out.append(table)
        else:
            raise CaseError(f"{path}: compare.tables: {table!r}: no such table: {nearest(table, published.names())}")
    return tuple(out)


def decode(data: Mapping[str, Any], path: str, folder: Path) -> Case:
    """Build the case from a decoded TOML document; ``folder`` contains the tables it references.

    Raises:
        CaseError: one line with file, field, value, cause and remedy.
    """
    finite(data, path)
    text = convert(data, CaseFile, path)
    text = structs.replace(text, compare=structs.replace(text.compare, tables=_tables(text, path, folder)))
    _confirmed(text, path)
    speeds = rad_s(text.speeds, path, isinstance(text.blade, Dimensionless))
    variants = []
    for label, changes in (text.variants or {"": {}}).items():
        tables, where = {**data, "blade": {**data["blade"], **changes}}, f"{path}: variants.{label}" if label else path
        blade = convert(tables, CaseFile, where).blade
        name = f"{text.name}/{label}" if label else text.name
        with located(f"{where}: blade: "):
            as_given, unused_values, file = blade.read(name, folder)
        variants.append(Variant(name, as_given, speeds, unused_values, file))
    return Case(path, text, tuple(variants))


def _confirmed(text: CaseFile, path: str) -> None:
    """Check that required groups refer to variants of this case, and that a requirement of none has a reason."""
    compare = text.compare
    if isinstance(compare.groups, dict):
        for label in compare.groups:
            if label not in text.variants:
                raise CaseError(f"{path}: compare.groups.{label}: no such variant: {nearest(label, text.variants)}")
    exempt = any(compare.required(label) == 0 for label in text.variants or {"": {}})
    if exempt != bool(compare.lacking):
        stated_groups = "0, and no reason" if exempt else "above 0, and a reason for none"
        raise CaseError(
            f"{path}: compare.groups: {stated_groups}: give groups = 0 and compare.lacking together, or neither"
        )


FASTEST, MOST_SPEEDS = 1e6, 10_000
"""Limits of a range: the highest speed, in any unit, and the number of steps."""


def speed_range(text: str) -> NDArray[np.float64]:
    """Parse speeds from ``first:last:step``, from a list ``0,5,10``, or from one number.

    Both ends of a range are included; the last step may be shorter.

    Raises:
        ValueError: if the text is invalid; the message gives the reason.
    """
    if "," in text:
        listed = np.concatenate([speed_range(part) for part in text.split(",")])
        if (np.diff(listed) <= 0).any():
            raise ValueError(f"{text!r}: not ascending: sort the speeds and remove duplicates")
        return listed
    parts = text.split(":")
    try:
        first, last, step = (float(p) for p in (parts if len(parts) == 3 else [*parts, *parts, "1"]))
    except ValueError:
        raise ValueError(
            f"{text!r} is neither a speed nor first:last:step, as in 0:30:5, nor a list, as in 0,5,10"
        ) from None
    if not (0 <= first <= last < math.inf and 0 < step < math.inf):
        raise ValueError(f"{text!r}: needs 0 ≤ first ≤ last and a step above 0, as in 0:30:5")
    if last > FASTEST:
        raise ValueError(f"{text!r}: {last:g} is implausibly fast: check the unit, and give at most {FASTEST:g}")
    steps = (last - first) / step
    if steps > MOST_SPEEDS:
        raise ValueError(f"{text!r}: {steps:.3g} steps: give at most {MOST_SPEEDS}, as in 0:30:5")
    speeds = [first + step * k for k in range(math.floor(steps + 1e-9) + 1)]
    return np.array([*speeds, last] if last - speeds[-1] > 1e-9 * step else speeds)


def rad_s(table: Speeds, path: str, dimensionless: bool = False) -> NDArray[np.float64]:
    """The speeds of a file in rad/s, ascending (unchanged if given as γ).

    Raises:
        CaseError: if there are no or several units, no speeds, or the speeds do not ascend.
    """
    units = {unit: value for unit in ("rad_s", "rpm", "gamma") if (value := getattr(table, unit)) is not UNSET}
    if len(units) != 1:
        listed = ", ".join(units) or "none"
        raise CaseError(f"{path}: speeds: {listed} given: give exactly one of rad_s, rpm, gamma")
    ((unit, value),) = units.items()
    if unit == "gamma" and not dimensionless:
        raise CaseError(f'{path}: speeds.gamma: requires blade.kind = "dimensionless": give rad_s or rpm')
    with located(f"{path}: speeds.{unit}: ", ValueError):
        speeds = speed_range(value) if isinstance(value, str) else np.array(value, dtype=float)
    if not len(speeds):
        raise CaseError(f"{path}: speeds.{unit}: empty: give at least one speed, 0 for rest")
    if speeds.max() > FASTEST:
        raise CaseError(
            f"{path}: speeds.{unit}: {speeds.max():g}: implausibly fast: check the unit, and give at most {FASTEST:g}"
        )
    if (np.diff(speeds) <= 0).any():
        raise CaseError(f"{path}: speeds.{unit}: {value}: not ascending: sort them and remove duplicates")
    return speeds * (np.pi / 30 if unit == "rpm" else 1.0)
