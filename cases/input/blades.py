"""Kinds of blades in a case file, and their conversion to a ``core`` blade.

Beams and stations are straight; shear is rigid (Euler–Bernoulli), and the sections' principal axes rotate with the
twist. Full sections, and files of other formats, are in ``readers.sections``. Every kind may specify its mounting on
the hub.
"""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, ClassVar

import numpy as np
from msgspec import Meta

from ...core.blade import (
    AXIAL,
    ROOT_TOLERANCE,
    TORSION,
    Blade,
    BladeError,
    section_mass,
    section_stiffness,
    uniform_blade,
)
from ...core.blade_checks import MAX_LENGTH
from ...core.sampling import mass_at, stiffness_at, twist_at
from ...core.space import spatial as sp
from . import files
from .errors import CaseError, located, nearest
from .readers.sections import FromFile, Mounted, Sections
from .readers.source import BladeFile, Mount, Source, Unused, unused

POISSON = 0.3
"""Poisson's ratio for the torsional stiffness of a dimensionless beam, which does not affect its bending."""


def _positive(description: str) -> Meta:
    return Meta(gt=0, description=description)


class Beam(Mounted, frozen=True, tag_field="kind", tag="beam"):
    """A uniform beam from its material and cross-section."""

    length: Annotated[float, Meta(gt=0, le=MAX_LENGTH, description="from root to tip, m")]
    E: Annotated[float, _positive("Young's modulus, Pa")]
    density: Annotated[float, _positive("kg/m³")]
    A: Annotated[float, _positive("area of the cross-section, m²")]
    I_y: Annotated[float, _positive("second moment of area about y, resisting flapwise motion, m⁴")]
    I_z: Annotated[float, _positive("second moment of area about z, resisting edgewise motion, m⁴")]
    G: Annotated[float, _positive("shear modulus, Pa; without G and J the beam is rigid in torsion")] | None = None
    J: Annotated[float, _positive("torsion constant, m⁴")] | None = None
    hub_radius: Annotated[float, Meta(ge=0, le=MAX_LENGTH, description="hub centre to root on the coned axis, m")] = 0.0
    rotary_inertia: Annotated[bool, Meta(description="whether the sections have moments of inertia, ρ I")] = True

    def blade(self, name: str) -> Blade:
        """The blade."""
        if (self.G is None) != (self.J is None):
            raise BladeError("G and J: give both, or neither for a beam that is rigid in torsion")
        inertia = self.density if self.rotary_inertia else 0.0
        blade = uniform_blade(
            name,
            self.length,
            self.hub_radius,
            EA=self.E * self.A,
            GJ=self.G * self.J if self.G and self.J else np.inf,
            EI_y=self.E * self.I_y,
            EI_z=self.E * self.I_z,
            mass=self.density * self.A,
            I_y=inertia * self.I_y,
            I_z=inertia * self.I_z,
        )
        return self.mounted(blade)


class Dimensionless(Mounted, frozen=True, tag_field="kind", tag="dimensionless"):
    """A uniform dimensionless beam: length, mass per length and bending stiffness (both directions) are 1.

    Speeds and frequencies are in units of ``√(EI / (ρ A L⁴))``, in place of ``rad/s``. No rotary inertia.
    """

    slenderness: Annotated[float, _positive("α = √(A L² / I), dimensionless")]
    hub_ratio: Annotated[float, Meta(ge=0, le=MAX_LENGTH, description="δ, hub radius over length")] = 0.0

    def blade(self, name: str) -> Blade:
        """The blade."""
        blade = uniform_blade(
            name,
            length=1.0,
            hub_radius=self.hub_ratio,
            EA=self.slenderness**2,
            GJ=1.0 / (1.0 + POISSON),
            EI_y=1.0,
            EI_z=1.0,
            mass=1.0,
        )
        return self.mounted(blade)


class Stations(Mounted, frozen=True, tag_field="kind", tag="stations"):
    """A blade from a table of stations along its span: a CSV file next to the case file; ``#`` starts a comment."""

    file: Annotated[str, Meta(description="name of the CSV file; columns as in Stations.COLUMNS")]
    length: Annotated[float, Meta(gt=0, le=MAX_LENGTH, description="from root to tip, m")]
    hub_radius: Annotated[float, Meta(ge=0, le=MAX_LENGTH, description="hub centre to root on the coned axis, m")] = 0.0
    bending_factor: Annotated[float, _positive("multiplies both bending stiffnesses of the table, dimensionless")] = 1.0
    mass_factor: Annotated[float, _positive("multiplies masses and moments of inertia of the table, dimensionless")] = (
        1.0
    )
    twisted: Annotated[bool, Meta(description="whether the table's twist is used")] = True
    centred: Annotated[bool, Meta(description="leave out the offset of the mass centres")] = False
    pieces: Annotated[
        tuple[float, ...],
        Meta(description="ends, in fractions of length, of pieces with the properties of their middle"),
    ] = ()

    COLUMNS: ClassVar[tuple[str, ...]] = (
        "fraction [-]",
        "twist [deg]",
        "mass [kg/m]",
        "EI_flap [N m^2]",
        "EI_edge [N m^2]",
    )
    RIGID: ClassVar[tuple[str, ...]] = ("GJ [N m^2]", "EA [N]")
    """Columns without which the blade is rigid in torsion or along its axis."""
    OPTIONAL: ClassVar[tuple[str, ...]] = (*RIGID, "I_flap [kg m]", "I_edge [kg m]", "cg_edge [m]")

    def read(self, name: str, folder: Path) -> tuple[Blade, tuple[Unused, ...], BladeFile | None]:
        """See ``Mounted``; unused are columns of the table that a switch in the case excludes.

        There is no file if the case leaves out the twist or replaces the table by pieces.

        Raises:
            CaseError: if the table is missing or malformed.
        """
        path, unused_values = folder / self.file, ()
        columns = read_table(path, self.COLUMNS, self.OPTIONAL)
        blade = self._blade(name, path, columns)
        for column, switch, dropped in (
            ("twist [deg]", "twisted = false", not self.twisted),
            ("cg_edge [m]", "centred = true", self.centred),
        ):
            if dropped and column in columns:
                name_, _, unit = column.partition(" ")
                unused_values += unused(name_, columns[column], unit.strip("[]"), path, f"the case has {switch}")
        if self.pieces or not self.twisted:
            return blade, unused_values, None
        factors = (self.mass_factor, self.bending_factor, self.bending_factor)
        mount = Mount(length=self.length, multipliers=factors, offsets=not self.centred)
        return blade, unused_values, BladeFile(path, blade, Source("Southwell CSV", (path,), ""), mount)

    def _blade(self, name: str, path: Path, columns: dict[str, np.ndarray]) -> Blade:
        fraction, twist, mass, flap, edge = (columns[c] for c in self.COLUMNS)
        torsion, axial = (columns.get(c, np.full_like(mass, np.inf)) for c in self.RIGID)
        if abs(fraction[-1] - 1.0) > ROOT_TOLERANCE:
            raise CaseError(
                f"{path}: fraction [-]: last is {fraction[-1]:g}: stations are fractions of length; end at 1"
            )
        I_flap, I_edge, mass_offset = (columns.get(c, np.zeros_like(mass)) for c in self.OPTIONAL[len(self.RIGID) :])
        sections = offset(section_mass(mass, I_flap, I_edge), mass_offset * (not self.centred))
        with located(f"{path}: "):
            blade = Blade(
                name=name,
                stations=np.append(fraction[:-1], 1.0) * self.length,
                stiffness=section_stiffness(axial, torsion, self.bending_factor * flap, self.bending_factor * edge),
                mass=self.mass_factor * sections,
                twist=np.radians(twist) * self.twisted,
                hub_radius=self.hub_radius,
            )
            return self.mounted(stepped(blade, np.array(self.pieces)) if self.pieces else blade)


STEP = 1e-7
"""Width of the transition between two pieces, as a fraction of the length."""


def stepped(blade: Blade, ends: np.ndarray) -> Blade:
    """The blade with piecewise constant properties, those at the middle of each piece.

    ``ends`` are the ends of the pieces as fractions of the length.

    Raises:
        BladeError: if ``ends`` do not ascend from 0 to 1.
    """
    if len(ends) < 2 or ends[0] != 0.0 or ends[-1] != 1.0 or (np.diff(ends) <= STEP).any():
        raise BladeError(f"pieces: {ends.tolist()}: ends of pieces ascend from 0 to 1; correct them")
    middle = 0.5 * (ends[1:] + ends[:-1]) * blade.length
    inside = np.concatenate([ends[:1], np.repeat(ends[1:-1], 2) + np.tile([-STEP, 0.0], len(ends) - 2), ends[-1:]])
    piece = np.repeat(np.arange(len(middle)), 2)
    return replace(
        blade,
        stations=inside * blade.length,
        stiffness=stiffness_at(blade, middle)[piece],
        mass=mass_at(blade, middle)[piece],
        twist=twist_at(blade, middle)[piece],
        curve=np.zeros((0, 3)),
    )


def offset(mass: np.ndarray, distance: np.ndarray) -> np.ndarray:
    """Transfer section masses (n, 6, 6) from their mass centres to an axis ``distance`` (n,) m behind these, along y."""
    from_axis = sp.adjoint(sp.pose(np.eye(3), np.multiply.outer(-distance, [0.0, 1.0, 0.0])))
    return np.swapaxes(from_axis, -1, -2) @ mass @ from_axis


BladeData = Beam | Dimensionless | Stations | Sections | FromFile


def rigid_strains(blade: Blade) -> str:
    """What a blade's data leave out and therefore make rigid: ``axial and torsional stiffness``; empty if neither."""
    rigid = np.array(np.isinf(np.diagonal(blade.stiffness, axis1=1, axis2=2)).any(0))
    names = [name for name, strain in (("axial", AXIAL), ("torsional", TORSION)) if rigid[strain]]
    return f"{' and '.join(names)} stiffness" if names else ""


def read_table(path: Path, needed: tuple[str, ...], optional: tuple[str, ...] = ()) -> dict[str, np.ndarray]:
    """Read the columns of a CSV file by name; ``#`` starts a comment.

    Raises:
        CaseError: if the table is invalid; the message names file, line and column.
    """
    table = files.table(path, remedy="paths in a case are relative to its file; correct the name")
    numbers, rows = zip(*table, strict=True)
    header = rows[0]
    for column in header:
        if column not in needed + optional:
            raise CaseError(
                f"{path}: line {numbers[0]}: unknown column {column!r}: {nearest(column, needed + optional)}"
            )
    for column in needed:
        if column not in header:
            raise CaseError(f"{path}: column {column!r} is missing: the header must have {', '.join(needed)}")
    out = np.zeros((len(rows) - 1, len(header)))
    for i, row in enumerate(rows[1:]):
        where = f"{path}: line {numbers[i + 1]}"
        if len(row) != len(header):
            raise CaseError(f"{where}: {len(row)} columns instead of {len(header)}: check for a missing or stray comma")
        for j, cell in enumerate(row):
            try:
                out[i, j] = float(cell)
            except ValueError:
                raise CaseError(f"{where}: {header[j]}: {cell!r} is not a number: correct it") from None
            if not np.isfinite(out[i, j]):
                raise CaseError(f"{where}: {header[j]}: {cell}: not a finite number: fill gaps in the table")
    if len(out) < 2:
        raise CaseError(f"{path}: rows: {len(out)}: at least two are needed (root and tip): add them")
    return {column: out[:, j] for j, column in enumerate(header)}
