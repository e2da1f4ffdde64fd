"""A whole turbine from OpenFAST's primary file: ElastoDyn's main file, its tower and blade files, ServoDyn's yaw spring.

OpenFAST's nacelle axes are x downwind, y to port, z up; the tower's here are x up, y = −y, z downwind. ElastoDyn's shaft tilt
is positive with the downwind end raised, and its overhang positive downwind. The nacelle's only moment of inertia is that about
the yaw axis, and the hub's that about the shaft. Sources: J. Jonkman, M. Buhl, *FAST User's Guide*, NREL/EL-500-38230, 2005;
OpenFAST documentation, *ElastoDyn*.
"""

from pathlib import Path

import numpy as np

from .....core.mechanism.description import inertia
from .....core.turbine.turbine import Drivetrain, Turbine, shaft_pose
from ...errors import CaseError
from ..source import Mount, Source, TurbineReading, Unused, unused
from ..text import Text, flag, integer, keys, load, number_or, value
from . import elastodyn_hub as hubs
from . import elastodyn_tower as tower_reader
from . import elastodyn_unused, fst, servodyn
from .mode_shapes import TOWER

NAME = "OpenFAST turbine"
AXES = "nacelle: x downwind, y to port, z up; here x = its z, y = its −y, z = its x"

Entries = dict[str, tuple[int, str]]

GROUND = "rigid ground: platform and water are not included"
FLOATER = f"{GROUND}; a TOML file with the keys openfast and support gives them as 6×6"
DAMPING = {"DTTorDmp": "N m s/rad", "YawFrctMod": "", "sig_v": "N m s/rad"}
MODULES = ("CompHydro", "CompSub", "CompMooring", "CompIce", "CompSoil", "MHK")
"""Modules of OpenFAST under the tower, and a rotor in water; 0 if they are not used."""
TOWER_MOTIONS = ("TwFADOF1", "TwFADOF2", "TwSSDOF1", "TwSSDOF2")
BLADE_MOTIONS = ("FlapDOF1", "FlapDOF2", "EdgeDOF")
INERTIA = {
    "PtfmMass": "kg",
    **dict.fromkeys(("PtfmRIner", "PtfmPIner", "PtfmYIner", "PtfmXYIner", "PtfmYZIner", "PtfmXZIner"), "kg m²"),
}
PLATFORM = ("PtfmSgDOF", "PtfmSwDOF", "PtfmHvDOF", "PtfmRDOF", "PtfmPDOF", "PtfmYDOF")
NO_TOWER_TORSION = "the tower is rigid in torsion, as in ElastoDyn"


def is_turbine(path: Path) -> bool:
    """Whether a file is a primary file of which the tower file exists and the rotor has at least two blades."""
    if path.suffix.lower() != ".fst" or not path.is_file():
        return False
    try:
        text = load(path)
        if not fst.matches_format(text):
            return False
        main = load(fst.file_named(text, "EDFile"))
        return tower_reader.tower_file(main).is_file() and integer(main, keys(main), "NumBl") >= 2
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
    entries = keys(main)
    blade = fst.read(path, mount)
    tower_text = load(tower_reader.tower_file(main))
    blades = integer(main, entries, "NumBl")
    hinge, undersling, hinge_note = hubs.teeter(main, entries) if blades == 2 else (None, 0.0, ())
    tower, tower_notes = tower_reader.beam(tower_text, tower_reader.tower_height(main))
    servo = servodyn.used(primary)
    yaw, yaw_note = servodyn.yaw(primary, main, servo)
    stiffness = value(main, entries, "DTTorSpr") if flag(main, "DrTrDOF") else np.inf
    free = flag(main, "GenDOF")
    drivetrain = Drivetrain(stiffness, value(main, entries, "GenIner"), value(main, entries, "GBRatio"), free)
    gravity = number_or(primary, "Gravity", number_or(main, "Gravity", 9.80665))
    turbine = Turbine(
        name=path.stem,
        tower=tower,
        blade=blade.blade,
        blades=blades,
        nacelle=_nacelle(main, entries),
        hub=hubs.hub(main, entries) if blades > 2 else hubs.hub_of_two(main, entries, undersling),
        shaft=shaft_pose(
            value(main, entries, "Twr2Shft"),
            value(main, entries, "OverHang") - undersling,
            np.radians(value(main, entries, "ShftTilt")),
        ),
        yaw=yaw,
        drivetrain=drivetrain,
        gravity=gravity,
        teeter=hinge,
    )
    notes = (
        GROUND,
        f"gravity {gravity:g} m/s² acts on the tower through all that it carries, not on the blades' own motions",
        f"generator {'free (GenDOF)' if free else 'locked (GenDOF is False)'}; shaft "
        + ("rigid (DrTrDOF is False)" if np.isinf(stiffness) else f"{stiffness:g} N m/rad (DTTorSpr)"),
        yaw_note,
        *hinge_note,
        NO_TOWER_TORSION,
        *_locked_motions(main, primary),
        *tower_notes,
        *(note for note in blade.source.notes if "are not part of the blade" not in note),
    )
    unused_values = (
        *_below(primary),
        *_unused(main, entries),
        *servodyn.not_used(servo, np.isfinite(yaw)),
        *elastodyn_unused.of_shapes(tower_text, TOWER),
        *hubs.without_hinge(blade.source.unused, hinge),
    )
    files = (*blade.source.files, tower_text.path, *([servo.path] if servo else []))
    speed = number_or(main, "RotSpeed", 0.0) * np.pi / 30.0
    return TurbineReading(turbine, Source(NAME, files, AXES, notes, unused_values), float(speed))


def _nacelle(main: Text, entries: Entries) -> np.ndarray:
    """(6, 6) inertia of nacelle and yaw bearing at the tower's top, in the tower's axes."""
    mass = value(main, entries, "NacMass")
    x, y, z = (value(main, entries, name) for name in ("NacCMxn", "NacCMyn", "NacCMzn"))
    about_yaw = value(main, entries, "NacYIner")
    about_centre = about_yaw - mass * (x**2 + y**2)
    if about_centre < 0:
        raise CaseError(
            f"{main.at(entries['nacyiner'][0])}: NacYIner: {about_yaw:g}: less than NacMass at its distance from the yaw axis, "
            f"{mass * (x**2 + y**2):g} kg m²: the moment of inertia must be about the yaw axis; correct one of them"
        )
    out = inertia(mass, (about_centre, 0.0, 0.0), (z, -y, x))
    out[:3, :3] += number_or(main, "YawBrMass", 0.0) * np.eye(3)
    return out


def _locked_motions(main: Text, primary: Text) -> tuple[str, ...]:
    """Assumed modes that the deck locks; BeamDyn's blades have none."""
    names = (*TOWER_MOTIONS, *(BLADE_MOTIONS if number_or(primary, "CompElast", 1.0) == 1 else ()))
    locked = [name for name in names if name.lower() in keys(main) and not flag(main, name)]
    if not locked:
        return ()
    return (
        f"not used: False of {', '.join(locked)} ({main.path.name}): tower and blades move in all their modes here",
    )


def _below(primary: Text) -> tuple[Unused, ...]:
    """Modules of the primary file that the turbine does not use."""
    active = [name for name in MODULES if number_or(primary, name, 0.0)]
    return unused(", ".join(active), [number_or(primary, name, 0.0) for name in active], "", primary.path, FLOATER)


def _unused(main: Text, entries: Entries) -> tuple[Unused, ...]:
    """Non-zero quantities of the main file that the turbine does not use."""
    out: list[Unused] = []
    for name, unit in DAMPING.items():
        out += unused(name, [number_or(main, name, 0.0)], unit, main.path, servodyn.UNDAMPED)
    free = [name for name in PLATFORM if flag(main, name)]
    if free:
        out += unused(", ".join(free), [1.0] * len(free), "", main.path, FLOATER)
        for name, unit in INERTIA.items():
            out += unused(name, [number_or(main, name, 0.0)], unit, main.path, FLOATER)
    out += unused("NacYaw", [number_or(main, "NacYaw", 0.0)], "deg", main.path, "the nacelle faces the wind")
    if flag(main, "Furling"):
        out += unused("Furling", [1.0], "", main.path, "furling is not included")
    return tuple(out)
