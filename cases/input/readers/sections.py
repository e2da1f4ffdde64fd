"""Blades in Southwell's TOML: full sections (``kind = "sections"``) or a file of any format (``"file"``), root and tip.

Axes are those of ``core.blade``: twist and pitch rotate y towards z, the leading edge downwind.
"""

import os
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from msgspec import Meta, Struct
from msgspec.structs import replace as replace_struct
from numpy.typing import NDArray

from ....core.blade import Blade
from ....core.blade_checks import MAX_LENGTH
from ....core.space.spatial import skew
from .. import files
from ..errors import CaseError, FilesMissingError, located
from .matrices import UPPER, symmetric
from .source import BladeFile, Unused

Array = NDArray[np.float64]
Vector = tuple[float, float, float]
Positive = Annotated[float, Meta(gt=0)]
Upper = Annotated[list[float], Meta(min_length=21, max_length=21)]

STRAINS = ("axial", "shear_y", "shear_z", "torsion", "bend_y", "bend_z")
HINGES = {"clamped": (), "flap hinge": (4,), "lag hinge": (5,), "both hinges": (4, 5)}


class Springs(Struct, frozen=True, forbid_unknown_fields=True):
    """Root springs along and about the blade's axes, in N/m and N m/rad; 0 is free, missing directions are clamped."""

    x: Annotated[float, Meta(ge=0)] | None = None
    y: Annotated[float, Meta(ge=0)] | None = None
    z: Annotated[float, Meta(ge=0)] | None = None
    torsion: Annotated[float, Meta(ge=0)] | None = None
    flap: Annotated[float, Meta(ge=0)] | None = None
    lag: Annotated[float, Meta(ge=0)] | None = None


class TipMass(Struct, frozen=True, forbid_unknown_fields=True):
    """A rigid body at the tip, in the tip section's axes."""

    mass: Annotated[float, Meta(ge=0, description="kg")]
    offset: Annotated[Vector, Meta(description="of its centre of mass from the tip, m")] = (0.0, 0.0, 0.0)
    inertia: Annotated[
        tuple[float, float, float, float, float, float],
        Meta(description="tensor about its centre of mass: xx, yy, zz, xy, yz, zx (signs of the tensor), kg m²"),
    ] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

    def matrix(self) -> Array:
        """Inertia (6, 6) of the rigid body about the tip."""
        cross = skew(np.array(self.offset))
        xx, yy, zz, xy, yz, zx = self.inertia
        tensor = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])
        m = self.mass
        return np.block([[m * np.eye(3), -m * cross], [m * cross, tensor - m * cross @ cross]])


class Mounted(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Mounting of a blade on its hub, and its tip mass; defaults are those of its file, else 0 and clamped."""

    precone_deg: Annotated[
        Annotated[float, Meta(ge=-90, le=90)] | None, Meta(description="towards +z (downwind), degrees")
    ] = None
    pitch_deg: Annotated[
        Annotated[float, Meta(ge=-180, le=180)] | None,
        Meta(description="y towards z (leading edge downwind): OpenFAST's BlPitch has the other sign; degrees"),
    ] = None
    root: Annotated[
        Literal["clamped", "flap hinge", "lag hinge", "both hinges"] | Springs | None,
        Meta(description="the root's joint"),
    ] = None
    tip_mass: Annotated[TipMass | None, Meta(description="a rigid body at the tip")] = None

    def read(self, name: str, folder: Path) -> tuple[Blade, tuple[Unused, ...], BladeFile | None]:
        """The blade, the unused quantities of its file, which is searched in ``folder``, and the file as read.

        The file is that before the case changes the blade; None if no second reader can read it.

        Raises:
            CaseError: if it cannot be read.
        """
        return self.blade(name), (), None

    def blade(self, name: str) -> Blade:
        """The blade of a kind that reads no file."""
        raise NotImplementedError

    def mounted(self, blade: Blade) -> Blade:
        """The blade with this mounting.

        Raises:
            CaseError: if the tip mass is invalid.
        """
        changes: dict[str, Any] = {}
        if self.precone_deg is not None:
            changes["precone"] = float(np.radians(self.precone_deg))
        if self.pitch_deg is not None:
            changes["pitch"] = float(np.radians(self.pitch_deg))
        if self.root is not None:
            changes["root"] = springs(self.root)
        if self.tip_mass is not None:
            changes["tip_mass"] = self.tip_mass.matrix()
        with located("blade."):
            return replace(blade, **changes)


class Sections(Mounted, frozen=True, tag_field="kind", tag="sections"):
    """Full sections of a blade: matrices about the reference curve in section axes, 21 numbers per station.

    The numbers are the rows of the upper triangle, first (11 … 16), then (22 … 26), and so on; rigid strains have zeros.
    ``kinks`` are the stations where the curve's direction jumps: ``s = [0, 8, 10]``, ``kinks = [8]`` is two straight
    pieces.
    """

    s: Annotated[list[float], Meta(min_length=2, description="arc length from the root, m")]
    stiffness: Annotated[list[Upper], Meta(description="N, N m, N m²")]
    mass: Annotated[list[Upper], Meta(description="kg/m, kg, kg m")]
    twist_deg: Annotated[list[float] | None, Meta(description="degrees")] = None
    curve: Annotated[
        list[Vector] | None,
        Meta(
            description="reference curve from the root in blade axes, m; between its points a spline of s, its arc length"
        ),
    ] = None
    kinks: Annotated[
        list[float],
        Meta(description="stations where the curve's tangent jumps, m; each piece between them is a separate spline"),
    ] = []
    rigid: Annotated[
        tuple[Literal["axial", "shear_y", "shear_z", "torsion"], ...], Meta(description="rigid strains")
    ] = ()
    hub_radius: Annotated[float, Meta(ge=0, le=MAX_LENGTH, description="hub centre to root on the coned axis, m")] = 0.0

    def blade(self, name: str) -> Blade:
        """The blade.

        Raises:
            CaseError: if the data are invalid.
        """
        n = len(self.s)
        for quantity in ("stiffness", "mass", "twist_deg", "curve"):
            values = getattr(self, quantity)
            if values is not None and len(values) != n:
                raise CaseError(
                    f"blade.{quantity}: {len(values)} entries for {n} stations in blade.s: give one per station"
                )
        stiffness = symmetric(np.array(self.stiffness))
        for i in (STRAINS.index(r) for r in self.rigid):
            if stiffness[:, i, :].any():
                raise CaseError(f"blade.rigid: {STRAINS[i]}: its stiffnesses are not zero: remove it or make them zero")
            stiffness[:, i, i] = np.inf
        with located("blade."):
            blade = Blade(
                name=name,
                stations=np.array(self.s),
                stiffness=stiffness,
                mass=symmetric(np.array(self.mass)),
                twist=np.radians(self.twist_deg) if self.twist_deg is not None else np.zeros(n),
                hub_radius=self.hub_radius,
                curve=np.array(self.curve) if self.curve is not None else np.zeros((0, 3)),
                kinks=tuple(self.kinks),
            )
        return self.mounted(blade)


class FromFile(Mounted, frozen=True, tag_field="kind", tag="file"):
    """A blade from a file of any supported format (ElastoDyn, BeamDyn, HAWC2, BModes, windIO, CSV)."""

    file: Annotated[str, Meta(description="path from the case file's folder, or from `files`")]
    files: Annotated[str | None, Meta(description="environment variable that names the folder `file` is in")] = None
    main: Annotated[
        str | None, Meta(description="main file that defines the mounting, relative to the case file's folder")
    ] = None
    length: (
        Annotated[float, Meta(gt=0, le=MAX_LENGTH, description="from root to tip, m, if no file states it")] | None
    ) = None
    hub_radius: (
        Annotated[
            float,
            Meta(ge=0, le=MAX_LENGTH, description="hub centre to root on the coned axis, m, if no file states it"),
        ]
        | None
    ) = None
    subset: Annotated[tuple[int, int] | None, Meta(description="set and subset of a HAWC2 structural file")] = None
    multipliers: Annotated[
        tuple[Positive, Positive, Positive] | None,
        Meta(description="of an ElastoDyn table, in place of the file's AdjBlMs, AdjFlSt, AdjEdSt"),
    ] = None
    offsets: Annotated[
        bool | None, Meta(description="whether the offset columns of a FAST 7 table are used; default: yes")
    ] = None

    def read(self, name: str, folder: Path) -> tuple[Blade, tuple[Unused, ...], BladeFile]:
        """See ``Mounted``; the path is relative to ``folder``.

        Raises:
            FilesMissingError: if the variable of ``files`` is not set, or its folder does not contain the file.
            CaseError: if the reader raises it.
        """
        from . import reading  # imports this module
        from .source import Mount

        mount = Mount(
            main=folder / self.main if self.main is not None else None,
            length=self.length,
            hub_radius=self.hub_radius,
            subset=self.subset,
            multipliers=self.multipliers,
            offsets=self.offsets,
        )
        folder_name = os.environ.get(self.files) if self.files else None
        with files.reading_also(Path(folder_name)) if folder_name else nullcontext():
            path = self._path(name, folder)
            as_read = reading(path, mount)
        blade = self.mounted(replace(as_read.mounted(path), name=name))
        return blade, as_read.source.unused, BladeFile(path, as_read.blade, as_read.source, mount)

    def _path(self, name: str, folder: Path) -> Path:
        if self.files is None:
            return folder / self.file
        folder_name = os.environ.get(self.files)
        if folder_name and os.path.isfile(path := Path(folder_name) / self.file):
            return path
        cause = f"not in {self.files}={folder_name}" if folder_name else f"{self.files} is not set"
        raise FilesMissingError(
            f"{name}: file: {self.file}: {cause}: set it to a folder with this file, which does not come with Southwell"
        )


def springs(root: str | Springs) -> Array:
    """Root stiffness (6,) from its name or springs."""
    out = np.full(6, np.inf)
    if isinstance(root, str):
        out[list(HINGES[root])] = 0.0
        return out
    for i, name in enumerate(("x", "y", "z", "torsion", "flap", "lag")):
        if getattr(root, name) is not None:
            out[i] = getattr(root, name)
    return out


def describe(blade: Blade) -> Sections:
    """Describe a blade by full sections."""
    finite = np.where(np.isinf(blade.stiffness), 0.0, blade.stiffness)
    clamped = np.isinf(blade.root)
    names = ("x", "y", "z", "torsion", "flap", "lag")
    springs = Springs(**{n: float(k) for n, k, h in zip(names, blade.root, clamped, strict=True) if not h})
    out = Sections(
        s=blade.stations.tolist(),
        stiffness=finite[:, UPPER[0], UPPER[1]].tolist(),
        mass=blade.mass[:, UPPER[0], UPPER[1]].tolist(),
        twist_deg=np.degrees(blade.twist).tolist(),
        curve=[tuple(p) for p in blade.curve.tolist()],
        kinks=list(blade.kinks),
        rigid=tuple(STRAINS[i] for i in range(4) if np.isinf(blade.stiffness[:, i, i]).all()),  # pyright: ignore[reportArgumentType]
        hub_radius=blade.hub_radius,
        precone_deg=float(np.degrees(blade.precone)),
        pitch_deg=float(np.degrees(blade.pitch)),
    )
    out = out if clamped.all() else replace_struct(out, root=springs)
    return replace_struct(out, tip_mass=_body(blade.tip_mass)) if blade.tip_mass.any() else out


def _body(matrix: Array) -> TipMass:
    m = float(matrix[0, 0])
    x, y, z = -np.array([matrix[4, 2], matrix[5, 0], matrix[3, 1]]) / m if m else np.zeros(3)  # of m c×, lower left
    cross = skew(np.array([x, y, z]))
    t = matrix[3:, 3:] + m * cross @ cross
    entries = (t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[1, 2], t[2, 0])
    return TipMass(mass=m, offset=(float(x), float(y), float(z)), inertia=tuple(float(e) for e in entries))  # pyright: ignore[reportArgumentType]
