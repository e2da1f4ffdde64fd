"""ElastoDyn's blade file (FAST 7 to OpenFAST 4), and the hub in its main file.

The blade is straight along the pitch axis; mass, flap and edge stiffness act there, uncoupled, in axes rotated by the
structural twist. In OpenFAST positive twist and pitch move the leading edge upwind: a rotation about −x here. The format
contains no axial or torsional stiffness and no rotary inertia: these strains are rigid, and the moments of inertia are
zero. The additional columns of FAST 7 (GJStff, EAStff, FlpIner, EdgIner, and the offsets, see ``fast7_offsets``) are used if
present. AdjBlMs, AdjFlSt and AdjEdSt multiply the table. A main file's BlPitch is the initial pitch of a simulation, not
an operating point: it is listed, not used. Source: J. Jonkman, M. Buhl, *FAST User's Guide*, NREL/EL-500-38230, 2005.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .....core.blade import Blade, section_mass, section_stiffness
from ...errors import CaseError, located
from ..matrices import about
from ..source import OPENFAST_AXES, Mount, Reading, Source
from ..text import Text, fractions, keys, load, path_named, value
from . import elastodyn_table, elastodyn_unused, fast7_offsets
from .mode_shapes import BLADE

Array = NDArray[np.float64]

NAME = "ElastoDyn"
NEEDED = ("BlFract", "StrcTwst", "BMassDen", "FlpStff", "EdgStff")
POSITIVE = ("BMassDen", "FlpStff", "EdgStff", "GJStff", "EAStff")
USED = (*NEEDED, "GJStff", "EAStff", "FlpIner", "EdgIner")
LAYOUT = elastodyn_table.Layout(
    count="NBlInpSt",
    multipliers=("AdjBlMs", "AdjFlSt", "AdjEdSt"),
    columns=("BlFract", "PitchAxis", "StrcTwst", "BMassDen", "FlpStff", "EdgStff"),
    needed=NEEDED,
    spellings=(*USED, *fast7_offsets.COLUMNS, *elastodyn_unused.COLUMNS),
)
MAX_BYTES = 1_000_000
"""Maximum size of a main file, bytes: larger files in the folder of a blade are not searched."""


@dataclass(frozen=True)
class Hub:
    """Data of the first blade in a main file: ``mount``, its tip mass in kg, and the blade file."""

    mount: Mount
    tip_mass: float
    blade_file: Path


def is_blade(text: Text) -> bool:
    """Whether these are lines of a blade file."""
    return "nblinpst" in keys(text)


def is_main(text: Text) -> bool:
    """Whether these are lines of a main file."""
    entries = keys(text)
    return "tiprad" in entries and "hubrad" in entries


def read(path: Path, mount: Mount | None = None) -> Reading:
    """Read the blade in an ElastoDyn blade file, or the first blade of a main file.

    Args:
        path: path of either file. A blade file's length is in the main file: ``mount.main``, or the only main file in
            the same folder that references it; or ``mount.length``.
        mount: data that the files do not contain, or that override them.

    Raises:
        CaseError: naming the file and line at fault.
    """
    mount = mount or Mount()
    text = load(path)
    if is_main(text):
        main, text = path, load(hub(text).blade_file)
    else:
        main = mount.main or (None if mount.length else sibling_file(path, is_main, blade_file))
    hub_data = hub(load(main)) if main else None
    return _blade(text, mount, hub_data, main)


def sibling_file(path: Path, kind: Callable[[Text], bool], file_of: Callable[[Text], Path]) -> Path | None:
    """The only main file in the folder of ``path`` that references ``path``; None if there is none.

    Raises:
        CaseError: if there are several.
    """
    candidates = []
    for candidate in sorted(path.parent.glob("*")):
        fits = (
            candidate.suffix.lower() in {".dat", ".inp", ".txt", ".fst"}
            and candidate.is_file()
            and candidate.stat().st_size < MAX_BYTES
        )
        if not fits or candidate == path:
            continue
        try:
            text = load(candidate)
        except CaseError:  # empty or not text: output of a run, not a main file
            continue
        if kind(text) and file_of(text).resolve() == path.resolve():
            candidates.append(candidate)
    if len(candidates) > 1:
        names = ", ".join(f.name for f in candidates)
        raise CaseError(f"{path}: {len(candidates)} main files in its folder name it ({names}): choose one with --main")
    return candidates[0] if candidates else None


def hub(text: Text) -> Hub:
    """The hub of a main file; OpenFAST's coning is positive downwind, as in ``core.blade``.

    Raises:
        CaseError: if a value is missing or not a number.
    """
    entries = keys(text)
    tip, root = value(text, entries, "TipRad"), value(text, entries, "HubRad")
    if tip <= root:
        raise CaseError(
            f"{text.path}: TipRad {tip:g} is not beyond HubRad {root:g}: the blade has no length; correct one of them"
        )
    mount = Mount(
        length=tip - root,
        hub_radius=root,
        precone=np.radians(value(text, entries, "PreCone1", "PreCone")),
    )
    mass = value(text, entries, "TipMass1", "TipMass")
    return Hub(mount, mass, blade_file(text))


def blade_file(text: Text) -> Path:
    """Path of the first blade's file in a main file.

    Raises:
        CaseError: if it is missing.
    """
    return path_named(text, "BldFile1", "BldFile")


def complete(mount: Mount, file_mount: Mount | None) -> Mount:
    """``mount`` with missing values from ``file_mount``."""
    values = {f.name: getattr(mount, f.name) for f in fields(Mount) if getattr(mount, f.name) is not None}
    return replace(file_mount or Mount(), **values)


def _blade(text: Text, mount: Mount, hub_data: Hub | None, main: Path | None) -> Reading:
    sections, factors = elastodyn_table.read(text, LAYOUT)
    count, columns = len(sections.lines), tuple(sections.columns)
    sections.positive(*[name for name in POSITIVE if name in columns])
    eta = fractions(sections, "BlFract")
    mounted = complete(mount, hub_data.mount if hub_data else None)
    if mounted.length is None:
        raise CaseError(
            f"{text.path}: length: missing: stations are fractions of the length, and no main file defines it: "
            "give --main FILE, or --length and --hub-radius"
        )
    by_mass, by_flap, by_edge = mount.multipliers or tuple(factors.values())
    flap_inertia, edge_inertia = (sections.columns.get(n, np.zeros(count)) for n in ("FlpIner", "EdgIner"))
    tip = np.diag([hub_data.tip_mass] * 3 + [0.0] * 3) if hub_data else np.zeros((6, 6))
    twist = -np.radians(sections["StrcTwst"])
    offsets = mount.offsets is not False
    offset_columns = {name: sections[name] for name in fast7_offsets.COLUMNS if offsets and name in sections.columns}
    axis = fast7_offsets.line(eta * mounted.length, offset_columns, twist)
    mass = section_mass(by_mass * sections["BMassDen"], flap_inertia, edge_inertia)
    with located(f"{text.path}: "):
        blade = Blade(
            name=text.path.stem,
            stations=axis.s,
            stiffness=section_stiffness(
                sections.columns.get("EAStff", np.full(count, np.inf)),
                sections.columns.get("GJStff", np.full(count, np.inf)),
                by_flap * sections["FlpStff"],
                by_edge * sections["EdgStff"],
            ),
            mass=about(mass, *axis.mass_centre.T) if axis.mass_centre.any() else mass,
            twist=twist,
            curve=axis.curve,
            hub_radius=mounted.hub_radius or 0.0,
            precone=mounted.precone or 0.0,
            pitch=mounted.pitch or 0.0,
            tip_mass=tip,
        )
    used_offsets = [name for name, values in offset_columns.items() if values.any()]
    axes = f"{OPENFAST_AXES}; {'the axis is the elastic axis' if used_offsets else 'all centres on the pitch axis'}"
    unused_values = (
        *elastodyn_unused.of_table(sections, USED, offsets),
        *elastodyn_unused.of_shapes(text, BLADE),
        *(elastodyn_unused.of_main(load(main)) if main else ()),
    )
    files = (text.path,) if main is None else (text.path, main)
    notes = _notes(factors, main, mounted, columns)
    if main is not None:
        notes += elastodyn_unused.other_blades(load(main), "BldFile")
    if used_offsets:
        largest = ", ".join(f"{name} {max(offset_columns[name], key=abs):g} m" for name in used_offsets)
        notes += (
            f"offsets used (largest): {largest}; rotated by the structural twist; `offsets = false` or --no-offsets leaves "
            "them out, as FAST itself does",
        )
    return Reading(blade, Source(NAME, files, axes, notes, unused_values), unstated=mounted.unstated)


def _notes(factors: dict[str, float], main: Path | None, mounted: Mount, columns: tuple[str, ...]) -> tuple[str, ...]:
    factors_text = ", ".join(f"{name} = {factor:g}" for name, factor in factors.items())
    multipliers = mounted.multipliers
    use = "multiply the table" if multipliers is None else "replaced by {:g}, {:g}, {:g}".format(*multipliers)
    out = [f"{factors_text}: {use}"]
    rigid = [strain for strain, name in (("axial", "EAStff"), ("torsional", "GJStff")) if name not in columns]
    if rigid:
        out.append(f"{' and '.join(rigid)} stiffness not in this format: treated as rigid; shear is rigid")
    if "FlpIner" not in columns:
        out.append("sectional moments of inertia are not in this format: taken as zero")
    if main is not None:
        out.append("tower, nacelle, hub and drive train of the main file are not part of the blade")
    if main is None:
        out.append("no main file" + (f": {mounted.assumption}" if mounted.assumption else ""))
    return tuple(out)
