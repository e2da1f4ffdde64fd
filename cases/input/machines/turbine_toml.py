"""A turbine or a tower in Southwell's TOML format, see ``schema``."""

from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ....core.blade import Blade, section_mass, section_stiffness
from ....core.mechanism.description import inertia
from ....core.turbine.tower import Support, Tower, check_tower
from ....core.turbine.turbine import Drivetrain, Teeter, Turbine, shaft_pose
from .. import readers, toml
from ..errors import CaseError, located
from ..readers.matrices import BEAMDYN, in_axes
from ..readers.openfast import elastodyn, elastodyn_tower
from ..readers.source import Mount, Source
from ..readers.text import load
from .schema import DeckData, HubData, MachineData, NacelleData, RotorData, SupportData, Three, TowerData

Array = NDArray[np.float64]

NAME = "Southwell turbine"
AXES = "x downwind, y to port, z up; here x = its z, y = its −y, z = its x"

GROUND = "rigid ground: platform and water are not included"

DIRECTIONS = ("downwind", "port", "up", "roll", "pitch", "yaw")

ROTOR = ("rotor", "nacelle", "hub")
"""Tables that only a turbine has."""


def holds(path: Path) -> Literal["turbine", "tower"] | None:
    """What a TOML file describes; None if it has no tower, as a blade's or a mechanism's file.

    Raises:
        CaseError: it is not TOML.
    """
    content = toml.document(path)
    if isinstance(content.get("openfast"), str):
        return "turbine"
    if not isinstance(content.get("tower"), dict):
        return None
    return "turbine" if any(name in content for name in ROTOR) else "tower"


def deck(path: Path) -> DeckData | None:
    """OpenFAST's file and the support that a file names; None if it describes the turbine itself.

    Raises:
        CaseError: naming the field at fault.
    """
    content = toml.document(path)
    if "openfast" not in content:
        return None
    toml.finite(content, str(path))
    return toml.convert(content, DeckData, str(path))


def _data(path: Path) -> MachineData:
    content = toml.document(path)
    toml.finite(content, str(path))
    return toml.convert(content, MachineData, str(path))


def tower(path: Path) -> tuple[Tower, Source]:
    """Read a tower without a rotor.

    Raises:
        CaseError: naming the file and field at fault.
    """
    data = _data(path)
    beam, files = _beam(path, data.name or path.stem, data.tower)
    foundation = support(path, "tower.support", data.tower.support, data.tower.height)
    weight = f"gravity {data.gravity:g} m/s²" if data.gravity else "without weight"
    notes = (*((GROUND,) if foundation.rigid else ("on the springs of tower.support",)), weight)
    return Tower(beam, foundation, data.gravity), Source("Southwell tower", (path, *files), AXES, notes)


def turbine(path: Path, mount: Mount) -> tuple[Turbine, Source, float]:
    """Read a turbine, its source, and its rotor speed in rad/s; ``mount`` overrides the data of the blades.

    Raises:
        CaseError: naming the file and field at fault.
    """
    data = _data(path)
    missing = [name for name in ROTOR if getattr(data, name) is None]
    if missing:
        raise CaseError(f"{path}: {missing[0]}: missing: a turbine has the tables tower, {', '.join(ROTOR)}; add it")
    assert data.rotor is not None
    assert data.nacelle is not None
    assert data.hub is not None
    teeter = data.hub.teeter
    if teeter and data.rotor.blades != 2:
        raise CaseError(f"{path}: hub.teeter: with {data.rotor.blades} blades: only a hub of two teeters; correct one")
    blade = _blade(path, data.rotor, mount)
    name = data.name or path.stem
    beam, files = _beam(path, f"{name}'s tower", data.tower)
    drive = data.drivetrain
    foundation = support(path, "tower.support", data.tower.support, data.tower.height)
    machine = Turbine(
        name=name,
        tower=beam,
        blade=blade.mounted(path),
        blades=data.rotor.blades,
        nacelle=_body(data.nacelle.mass, data.nacelle.moments, data.nacelle.centre),
        hub=_hub(data.hub),
        shaft=_shaft(data.nacelle),
        yaw=data.nacelle.yaw_stiffness or np.inf,
        drivetrain=Drivetrain(
            drive.stiffness or np.inf, drive.generator_inertia, drive.gear_ratio, drive.generator == "free"
        ),
        gravity=data.gravity,
        support=foundation,
        teeter=Teeter(teeter.undersling, teeter.stiffness) if teeter else None,
    )
    notes = (
        GROUND if foundation.rigid else "on the springs of tower.support",
        f"gravity {data.gravity:g} m/s² acts on the tower through all that it carries, not on the blades' own motions",
        f"generator {drive.generator}; shaft {f'{drive.stiffness:g} N m/rad' if drive.stiffness else 'rigid'}",
        f"yaw bearing {f'{data.nacelle.yaw_stiffness:g} N m/rad' if data.nacelle.yaw_stiffness else 'locked'}",
        *blade.source.notes,
    )
    source = Source(NAME, (path, *files, *blade.source.files), AXES, notes, blade.source.unused)
    return machine, source, data.rotor_speed * np.pi / 30.0


def _blade(path: Path, data: RotorData, mount: Mount) -> readers.Reading:
    """The blade; ``mount`` overrides the file's table ``rotor``, which overrides the blade's file."""

    precone, pitch = (None if angle is None else float(np.radians(angle)) for angle in (data.precone, data.pitch))
    of_file = Mount(length=data.length, hub_radius=data.hub_radius, precone=precone, pitch=pitch)
    return readers.reading(path.parent / data.blade, elastodyn.complete(mount, of_file))


def _beam(path: Path, name: str, data: TowerData) -> tuple[Blade, tuple[Path, ...]]:
    """The tower as a beam that stands, and the file read."""
    columns = {
        key: getattr(data, key)
        for key in ("stations", "mass", "EI_fore_aft", "EI_side_side", "GJ", "EA")
        if getattr(data, key)
    }
    top = np.zeros((6, 6)) if data.top is None else _body(data.top.mass, data.top.moments, data.top.centre)
    if data.file is not None:
        if columns:
            raise CaseError(f"{path}: tower.{next(iter(columns))}: with tower.file, which contains it: leave one out")
        file = path.parent / data.file
        beam, _ = elastodyn_tower.beam(load(file), data.height)
        return Blade(name, beam.stations, beam.stiffness, beam.mass, beam.twist, tip_mass=top), (file,)
    for key in ("stations", "mass", "EI_fore_aft"):
        if key not in columns:
            raise CaseError(f"{path}: tower.{key}: missing: give it at every station, or tower.file")
    count = len(data.stations)
    for key, values in columns.items():
        if len(values) != count:
            raise CaseError(f"{path}: tower.{key}: {len(values)} values for {count} stations: give one per station")
        if key != "stations" and min(values) <= 0:
            raise CaseError(f"{path}: tower.{key}: {min(values):g}: it must be positive")
    if data.stations[0] != 0 or abs(data.stations[-1] / data.height - 1.0) > 1e-9:
        raise CaseError(
            f"{path}: tower.stations: from {data.stations[0]:g} to {data.stations[-1]:g} m: begin at 0 and end at the height, "
            f"{data.height:g} m"
        )

    def column(key: str, otherwise: object) -> Array:
        return np.array(columns.get(key, otherwise), float)

    rigid = np.full(count, np.inf)
    with located(f"{path}: tower: "):
        beam = Blade(
            name=name,
            stations=np.array(data.stations),
            stiffness=section_stiffness(
                column("EA", rigid),
                column("GJ", rigid),
                column("EI_fore_aft", 0),
                column("EI_side_side", data.EI_fore_aft),
            ),
            mass=section_mass(column("mass", 0)),
            twist=np.zeros(count),
            tip_mass=top,
        )
    return beam, ()


def support(path: Path, key: str, data: SupportData, height: float) -> Support:
    """The support in the table ``key`` of a tower of this height, m.

    Raises:
        CaseError: naming the field at fault.
    """
    base = None
    if data.stiffness is not None:
        K = _six(f"{path}: {key}.stiffness", data.stiffness)
        base = in_axes(K, BEAMDYN)
        clamped = [DIRECTIONS.index(name) for name in data.clamped]
        for k, name in zip(clamped, data.clamped, strict=True):
            if K[k].any() or K[:, k].any():
                raise CaseError(
                    f"{path}: {key}.clamped: {name}: its row of the stiffness is not zero: make it zero, or do not clamp "
                    "this coordinate"
                )
        directions = np.flatnonzero(np.diagonal(in_axes(np.diag(np.isin(range(6), clamped).astype(float)), BEAMDYN)))
        base[directions, directions] = np.inf
    elif data.clamped:
        raise CaseError(f"{path}: {key}.clamped: without a stiffness all directions are clamped: leave it out")
    springs = tuple((s.height, np.diag([0.0, s.port, s.downwind, 0.0, 0.0, 0.0])) for s in data.springs)
    mass = None if data.mass is None else in_axes(_six(f"{path}: {key}.mass", data.mass), BEAMDYN)
    out = Support(base, springs, np.array(data.soil) if data.soil else None, mass)
    with located(f"{path}: {key}: ", ValueError):
        check_tower(height, out)
    return out


def _six(where: str, rows: list[list[float]]) -> Array:
    out = np.array([row for row in rows if len(row) == 6])
    if out.shape != (6, 6) or len(rows) != 6:
        raise CaseError(f"{where}: give 6 rows of 6 numbers")
    return out


def _body(mass: float, moments: Three, centre: Three) -> Array:
    """(6, 6) inertia in the tower's axes."""
    x, y, z = centre
    return inertia(mass, moments[::-1], (z, -y, x))


def _hub(data: HubData) -> Array:
    return inertia(data.mass, [data.transverse_inertia] * 2 + [data.inertia], (0.0, 0.0, data.centre))


def _shaft(data: NacelleData) -> Array:
    return shaft_pose(data.shaft_height, data.overhang, float(np.radians(data.tilt)))
