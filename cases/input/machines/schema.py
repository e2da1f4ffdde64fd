"""Schema of a turbine's or a tower's TOML file; unknown keys are rejected; descriptions give the units.

Directions are downwind, to port, and up, in this order, as x, y and z in OpenFAST's nacelle axes.
"""

from typing import Annotated, Literal

from msgspec import Meta, Struct

from ..names import Name

Three = tuple[float, float, float]
Positive = Annotated[float, Meta(gt=0)]
NotNegative = Annotated[float, Meta(ge=0)]

ZERO: Three = (0.0, 0.0, 0.0)


class BodyData(Struct, frozen=True, forbid_unknown_fields=True):
    """A rigid body."""

    mass: Annotated[float, Meta(ge=0, description="kg")]
    centre: Annotated[Three, Meta(description="centre of mass: downwind, to port, up, m")] = ZERO
    moments: Annotated[Three, Meta(description="moments of inertia about the centre of mass, same order, kg m²")] = ZERO


class SpringData(Struct, frozen=True, forbid_unknown_fields=True):
    """A spring at a height of the tower, such as guy wires."""

    height: Annotated[float, Meta(ge=0, description="above the base, m")]
    downwind: Annotated[float, Meta(ge=0, description="stiffness in this direction, N/m")]
    port: Annotated[float, Meta(ge=0, description="stiffness in this direction, N/m")]


class SupportData(Struct, frozen=True, forbid_unknown_fields=True):
    """Springs that hold the tower."""

    stiffness: (
        Annotated[
            list[list[float]],
            Meta(
                description="6 rows of 6: displacements downwind, to port, up, then rotations about them; N/m, N, N m"
            ),
        ]
        | None
    ) = None
    clamped: Annotated[
        list[Literal["downwind", "port", "up", "roll", "pitch", "yaw"]],
        Meta(description="directions of the stiffness that are clamped instead; their rows must be zero"),
    ] = []
    soil: Annotated[
        list[tuple[float, float]], Meta(description="height above the base, m, and lateral stiffness per length, N/m²")
    ] = []
    springs: list[SpringData] = []
    mass: (
        Annotated[
            list[list[float]],
            Meta(
                description="6 rows of 6 in the order of stiffness: inertia that moves with the base, as a floater with "
                "added mass; its weight is part of the stiffness; kg, kg m, kg m²"
            ),
        ]
        | None
    ) = None


class DeckData(Struct, frozen=True, forbid_unknown_fields=True):
    """A turbine of OpenFAST's files, on a support that these do not describe by a matrix."""

    openfast: Annotated[str, Meta(description="primary file (.fst)")]
    support: SupportData
    name: Name | None = None


class TowerData(Struct, frozen=True, forbid_unknown_fields=True):
    """A tower by stations, or by the file of another program."""

    height: Annotated[float, Meta(gt=0, description="of the flexible tower, m")]
    file: Annotated[str, Meta(description="ElastoDyn's tower file, instead of the lists below")] | None = None
    stations: Annotated[list[float], Meta(description="heights above the base, m, from 0 to the top")] = []
    mass: Annotated[list[float], Meta(description="per length, kg/m")] = []
    EI_fore_aft: Annotated[list[float], Meta(description="bending stiffness, N m²")] = []
    EI_side_side: Annotated[list[float], Meta(description="bending stiffness, N m²; as EI_fore_aft by default")] = []
    GJ: Annotated[list[float], Meta(description="torsional stiffness, N m²; rigid by default")] = []
    EA: Annotated[list[float], Meta(description="axial stiffness, N; rigid by default")] = []
    top: Annotated[BodyData, Meta(description="a body at the top, besides nacelle and rotor")] | None = None
    support: SupportData = SupportData()


class NacelleData(Struct, frozen=True, forbid_unknown_fields=True):
    """The nacelle, from the tower's top."""

    mass: Annotated[float, Meta(ge=0, description="kg")]
    centre: Annotated[Three, Meta(description="centre of mass from the tower's top: downwind, to port, up, m")] = ZERO
    moments: Annotated[Three, Meta(description="moments of inertia about the centre of mass, kg m²")] = ZERO
    shaft_height: Annotated[float, Meta(description="of the shaft above the tower's top on the yaw axis, m")] = 0.0
    overhang: Annotated[
        float, Meta(description="from the yaw axis to the hub's centre along the shaft, positive downwind, m")
    ] = 0.0
    tilt: Annotated[float, Meta(description="of the shaft, degrees; positive if its downwind end is higher")] = 0.0
    yaw_stiffness: Annotated[float, Meta(gt=0, description="N m/rad; locked by default")] | None = None


class TeeterData(Struct, frozen=True, forbid_unknown_fields=True):
    """A hinge across the shaft and the blades."""

    undersling: Annotated[
        float, Meta(description="from the hinge to the hub's centre along the shaft, positive upwind, m")
    ] = 0.0
    stiffness: Annotated[float, Meta(ge=0, description="N m/rad")] = 0.0


class HubData(Struct, frozen=True, forbid_unknown_fields=True):
    """The hub, which turns with the rotor."""

    mass: Annotated[float, Meta(ge=0, description="kg")]
    inertia: Annotated[float, Meta(ge=0, description="about the shaft, kg m²")] = 0.0
    transverse_inertia: Annotated[float, Meta(ge=0, description="about the hub's other axes, kg m²")] = 0.0
    centre: Annotated[float, Meta(description="of mass, from the hub's centre along the shaft, downwind, m")] = 0.0
    teeter: Annotated[TeeterData, Meta(description="hinge between the shaft and a hub of two blades")] | None = None


class RotorData(Struct, frozen=True, forbid_unknown_fields=True):
    """The blades; lengths and angles that their file defines need not be given."""

    blade: Annotated[str, Meta(description="file of a blade in any format that `southwell modes` reads")]
    blades: Annotated[int, Meta(ge=2, description="number of blades")] = 3
    length: Annotated[float, Meta(gt=0, description="of a blade, m")] | None = None
    hub_radius: Annotated[float, Meta(ge=0, description="m")] | None = None
    precone: Annotated[float, Meta(description="degrees towards downwind; an upwind rotor's is negative")] | None = None
    pitch: Annotated[float, Meta(description="degrees, positive like the twist: leading edge downwind")] | None = None


class DrivetrainData(Struct, frozen=True, forbid_unknown_fields=True):
    """The shaft and the generator."""

    stiffness: (
        Annotated[float, Meta(gt=0, description="torsional, N m/rad, on the rotor's side; default rigid")] | None
    ) = None
    generator: Annotated[Literal["locked", "free"], Meta(description="whether the generator turns freely")] = "locked"
    generator_inertia: Annotated[float, Meta(ge=0, description="about its own shaft, kg m²")] = 0.0
    gear_ratio: Annotated[float, Meta(gt=0, description="speed of the generator over that of the rotor")] = 1.0


class MachineData(Struct, frozen=True, forbid_unknown_fields=True):
    """A turbine; without rotor, nacelle, hub and drivetrain, a tower."""

    tower: TowerData
    name: Name | None = None
    gravity: Annotated[float, Meta(ge=0, description="m/s²")] = 9.80665
    rotor_speed: Annotated[float, Meta(ge=0, description="rpm, of the diagram's default range")] = 0.0
    nacelle: NacelleData | None = None
    hub: HubData | None = None
    rotor: RotorData | None = None
    drivetrain: DrivetrainData = DrivetrainData()
