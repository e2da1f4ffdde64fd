"""A whole turbine from OpenFAST's primary file: ElastoDyn's main file, its tower and blade files, ServoDyn's yaw spring.

OpenFAST's nacelle axes are x downwind, y to port, z up; the tower's here are x up, y = −y, z downwind. ElastoDyn's shaft tilt
is positive with the downwind end raised, and its overhang positive downwind. The nacelle's only moment of inertia is that about
the yaw axis, and the hub's that about the shaft. Sources: J. Jonkman, M. Buhl, *FAST User's Guide*, NREL/EL-500-38230, 2005;
OpenFAST documentation, *ElastoDyn*.
"""

import os
from pathlib import Path

import numpy as np

from .....core.space import spatial as sp
from .....core.space.inertia import transformed
from .....core.turbine.turbine import Drivetrain, Turbine, shaft_pose
from ...errors import CaseError
from ..source import Mount, Source, TurbineReading, Unused, unused
from ..text import Text, keys, load, number, value, whole
from . import elastodyn_tower as tower_reader
from . import fst

NAME = "OpenFAST turbine"
AXES = "nacelle: x downwind, y to port, z up; here x = its z, y = its −y, z = its x"

Named = dict[str, tuple[int, str]]

GROUND = "rigid ground: platform and water are not included"
FLOATER = f"{GROUND}; a TOML file with the keys openfast and support gives them as 6×6"
DAMPING = {"DTTorDmp": "N m s/rad"}
PLATFORM = ("PtfmSgDOF", "PtfmSwDOF", "PtfmHvDOF", "PtfmRDOF", "PtfmPDOF", "PtfmYDOF")
NO_TOWER_TORSION = "the tower is rigid in torsion, as in ElastoDyn"


def is_turbine(path: Path) -> bool:
    """Whether a file is a primary file of which the tower file exists and the rotor has at least three blades."""
    if path.suffix.lower() != ".fst" or not path.is_file():
        return False
    try:
        text = load(path)
        if not fst.matches_format(text):
            return False
        main = load(fst.file_named(text, "EDFile"))
        return tower_reader.tower_file(main).is_file() and whole(main, keys(main), "NumBl") >= 3
    except (CaseError, OSError):
        return False


def read(path: Path, mount: Mount | None = None) -> TurbineReading:
    """Read a turbine.

    Args:
        path: the primary file (.fst).
        mount: data that override those of the blade, such as its pitch.

    Raises:
        CaseError: naming the file and line at fault.
    """
    primary = load(path)
    main = load(fst.file_named(primary, "EDFile"))
    named = keys(main)
    blade = fst.read(path, mount)
    tower_text = load(tower_reader.tower_file(main))
    tower, tower_notes = tower_reader.beam(tower_text, tower_reader.tower_height(main))
    yaw, yaw_note, servo = _yaw(primary, main, named)
    stiffness = value(main, named, "DTTorSpr") if _flag(main, named, "DrTrDOF") else np.inf
    free = _flag(main, named, "GenDOF")
    drivetrain = Drivetrain(stiffness, value(main, named, "GenIner"), value(main, named, "GBRatio"), free)
    gravity = _number(primary, "Gravity", _number(main, "Gravity", 9.80665))
    turbine = Turbine(
        name=path.stem,
        tower=tower,
        blade=blade.blade,
        blades=whole(main, named, "NumBl"),
        nacelle=_nacelle(main, named),
        hub=_hub(main, named),
        shaft=shaft_pose(
            value(main, named, "Twr2Shft"), value(main, named, "OverHang"), np.radians(value(main, named, "ShftTilt"))
        ),
        yaw=yaw,
        drivetrain=drivetrain,
        gravity=gravity,
    )
    notes = (
        GROUND,
        f"gravity {gravity:g} m/s² acts on the tower through all that it carries, not on the blades' own motions",
        f"generator {'free (GenDOF)' if free else 'locked (GenDOF is False)'}; shaft "
        + ("rigid (DrTrDOF is False)" if np.isinf(stiffness) else f"{stiffness:g} N m/rad (DTTorSpr)"),
        yaw_note,
        NO_TOWER_TORSION,
        *tower_notes,
        *(note for note in blade.source.notes if "are not part of the blade" not in note),
    )
    unused_values = (*_unused(main, named), *tower_reader.of_tower(tower_text), *blade.source.unused)
    files = (*blade.source.files, tower_text.path, *servo)
    speed = _number(main, "RotSpeed", 0.0) * np.pi / 30.0
    return TurbineReading(turbine, Source(NAME, files, AXES, notes, unused_values), float(speed))


def _nacelle(main: Text, named: Named) -> np.ndarray:
    """(6, 6) inertia of nacelle and yaw bearing at the tower's top, in the tower's axes."""
    mass = value(main, named, "NacMass")
    x, y, z = (value(main, named, name) for name in ("NacCMxn", "NacCMyn", "NacCMzn"))
    about_yaw = value(main, named, "NacYIner")
    own = about_yaw - mass * (x**2 + y**2)
    if own < 0:
        raise CaseError(
            f"{main.at(named['nacyiner'][0])}: NacYIner: {about_yaw:g}: less than NacMass at its distance from the yaw axis, "
            f"{mass * (x**2 + y**2):g} kg m²: it is about the yaw axis; correct one"
        )
    out = _body(mass, np.array([own, 0.0, 0.0]), np.array([z, -y, x]))
    out[:3, :3] += _number(main, "YawBrMass", 0.0) * np.eye(3)
    return out


def _hub(main: Text, named: Named) -> np.ndarray:
    """(6, 6) inertia of the hub at the rotor's apex, in the shaft's axes."""
    moments = np.array([0.0, 0.0, value(main, named, "HubIner")])
    return _body(value(main, named, "HubMass"), moments, np.array([0.0, 0.0, _number(main, "HubCM", 0.0)]))


def _body(mass: float, moments: np.ndarray, centre: np.ndarray) -> np.ndarray:
    """(6, 6) inertia of a body with these moments about its mass centre (3,), kg m²."""
    out = np.diag([mass] * 3 + moments.tolist())
    return np.ascontiguousarray(transformed(out, sp.pose(np.eye(3), centre)))


def _yaw(primary: Text, main: Text, named: Named) -> tuple[float, str, tuple[Path, ...]]:
    """Stiffness of the yaw bearing, N m/rad, a note on it, and the file that states it."""
    if not _flag(main, named, "YawDOF"):
        return np.inf, "yaw bearing locked (YawDOF is False)", ()
    servo = keys(primary).get("servofile")
    path = primary.path.parent / servo[1].replace("\\", "/") if servo else None
    if path is None or not os.path.isfile(path):
        return np.inf, "yaw bearing locked: its spring is in ServoDyn's file, which is missing", ()
    text = load(path)
    stiffness = _number(text, "YawSpr", 0.0)
    if stiffness <= 0:
        return np.inf, f"yaw bearing locked: YawSpr in {path.name} is not positive", ()
    return stiffness, f"yaw spring {stiffness:g} N m/rad (YawSpr in {path.name})", (path,)


def _unused(main: Text, named: Named) -> tuple[Unused, ...]:
    """Non-zero quantities of the main file that the turbine does not use."""
    out: list[Unused] = []
    for name, unit in DAMPING.items():
        out += unused(name, [_number(main, name, 0.0)], unit, main.path, "modes are undamped")
    free = [name for name in PLATFORM if _flag(main, named, name)]
    if free:
        out += unused(", ".join(free), [1.0] * len(free), "", main.path, FLOATER)
        for name, unit in (("PtfmMass", "kg"), ("PtfmRIner", "kg m²"), ("PtfmPIner", "kg m²"), ("PtfmYIner", "kg m²")):
            out += unused(name, [_number(main, name, 0.0)], unit, main.path, FLOATER)
    out += unused("NacYaw", [_number(main, "NacYaw", 0.0)], "deg", main.path, "the nacelle faces the wind")
    if _flag(main, named, "Furling"):
        out += unused("Furling", [1.0], "", main.path, "furling is not included")
    return tuple(out)


def _number(text: Text, name: str, otherwise: float) -> float:
    """The finite number under a name, or another one."""
    line = keys(text).get(name.lower())
    out = number(line[1]) if line else None
    return out if out is not None and np.isfinite(out) else otherwise


def _flag(text: Text, named: Named, name: str) -> bool:
    line = named.get(name.lower())
    return line is not None and line[1].lower().strip(".") in ("true", "t")
