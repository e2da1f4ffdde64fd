"""Schema of a mechanism's file, in terms of ``core.multibody``; unknown keys are rejected; descriptions give the units.

Bodies and joints are tables by name, ``[bodies.hub]``; data for a coordinate are keyed by its name,
``shaft.rz = {rate = 30.0}`` under ``[motions]``; springs, bushings and beams are lists, ``[[springs]]``.
"""

from typing import Annotated, Any, Literal

from msgspec import Meta, Struct

from ...core.mechanism.joints import Kind
from .names import Name, Typed
from .schema import LOOSEST, Groups, Speeds, TimeLimit

Three = tuple[float, float, float]
Positive = Annotated[float, Meta(gt=0)]
NotNegative = Annotated[float, Meta(ge=0)]
Matrix = list[float | list[float]]

ORIGIN: Three = (0.0, 0.0, 0.0)


class Frame(Struct, frozen=True, forbid_unknown_fields=True):
    """A frame in a body: a point, and either the direction of its z axis or a rotation of all three axes."""

    point: Annotated[Three, Meta(description="m, in the body's frame")] = ORIGIN
    axis: Annotated[
        Literal["x", "y", "z", "-x", "-y", "-z"] | Three, Meta(description="its z axis: a name, or a vector")
    ] = "z"
    turn: Annotated[Three | None, Meta(description="rotation vector, rad, instead of axis")] = None


class BodyData(Struct, frozen=True, forbid_unknown_fields=True):
    """A rigid body; a body without mass only connects joints."""

    mass: Annotated[float, Meta(ge=0, description="kg")] = 0.0
    centre: Annotated[Three, Meta(description="centre of mass in the body's frame, m")] = ORIGIN
    moments: Annotated[
        Matrix | float,
        Meta(description="moments of inertia about the centre, kg m²: one, three principal ones, or a 3×3 tensor"),
    ] = 0.0


class JointData(Struct, frozen=True, forbid_unknown_fields=True):
    """A connection of two bodies; ``ground`` is the inertial frame."""

    kind: Kind
    parent: str
    child: str
    at_parent: Annotated[Frame, Meta(description="the joint's frame in the parent")] = Frame()
    at_child: Annotated[Frame, Meta(description="the joint's frame in the child")] = Frame()
    cut: Annotated[bool, Meta(description="close a loop here")] = False


class HarmonicData(Struct, frozen=True, forbid_unknown_fields=True):
    """``mean + amplitude sin(frequency t + phase)``."""

    amplitude: Annotated[float, Meta(description="m or rad")]
    frequency: Annotated[float, Meta(description="rad/s")]
    phase: Annotated[float, Meta(description="rad")] = 0.0
    mean: Annotated[float, Meta(description="m or rad")] = 0.0


class MotionData(Struct, frozen=True, forbid_unknown_fields=True):
    """Motion of a coordinate: values at one instant, or the sum of a polynomial and harmonics of time."""

    position: Annotated[float | None, Meta(description="m or rad")] = None
    rate: Annotated[float, Meta(description="m/s or rad/s")] = 0.0
    acceleration: Annotated[float, Meta(description="m/s² or rad/s²")] = 0.0
    prescribed: Annotated[bool, Meta(description="false: free to vibrate about this motion")] = True
    polynomial: Annotated[tuple[float, ...], Meta(description="coefficients of 1, t, t² …, SI")] = ()
    harmonics: tuple[HarmonicData, ...] = ()


class CoordinateSpringData(Struct, frozen=True, forbid_unknown_fields=True):
    """Spring and damper on one joint coordinate."""

    stiffness: Annotated[float, Meta(description="N/m or N m/rad")] = 0.0
    damping: Annotated[float, Meta(description="N s/m or N m s/rad")] = 0.0
    neutral: Annotated[float, Meta(description="position without force, m or rad")] = 0.0


class SpringData(Struct, frozen=True, forbid_unknown_fields=True):
    """Spring and damper between points of two bodies."""

    body_a: str
    body_b: str
    point_a: Annotated[Three, Meta(description="m, in body_a")] = ORIGIN
    point_b: Annotated[Three, Meta(description="m, in body_b")] = ORIGIN
    stiffness: Annotated[float, Meta(description="N/m")] = 0.0
    damping: Annotated[float, Meta(description="N s/m")] = 0.0
    free_length: Annotated[float, Meta(ge=0, description="length without tension, m")] = 0.0


class BushingData(Struct, frozen=True, forbid_unknown_fields=True):
    """Elastic element in all six directions between two frames, strain-free if they coincide."""

    body_a: str
    body_b: str
    stiffness: Annotated[Matrix, Meta(description="6 numbers, or 6×6: N/m, N, N m/rad")]
    damping: Annotated[Matrix | None, Meta(description="6 numbers, or 6×6: N s/m, N s, N m s/rad")] = None
    preload: Annotated[tuple[float, ...], Meta(description="6 numbers: N, N m")] = (0.0,) * 6
    at_a: Frame = Frame()
    at_b: Frame = Frame()


class BeamData(Struct, frozen=True, forbid_unknown_fields=True):
    """A uniform beam element from one frame to another, along the first one's x axis."""

    body_a: str
    body_b: str
    length: Annotated[Positive, Meta(description="m")]
    EA: Annotated[Positive, Meta(description="N")]
    GJ: Annotated[Positive, Meta(description="N m²")]
    EI_y: Annotated[Positive, Meta(description="N m²")]
    EI_z: Annotated[Positive, Meta(description="N m²")]
    GA_y: Annotated[Positive | None, Meta(description="N; none: rigid in shear")] = None
    GA_z: Annotated[Positive | None, Meta(description="N; none: rigid in shear")] = None
    mass: Annotated[NotNegative, Meta(description="kg/m")] = 0.0
    I_y: Annotated[NotNegative, Meta(description="rotary inertia, kg m")] = 0.0
    I_z: Annotated[NotNegative, Meta(description="rotary inertia, kg m")] = 0.0
    at_a: Frame = Frame()
    at_b: Frame = Frame()


class Compare(Struct, frozen=True, forbid_unknown_fields=True):
    """How closely codes must agree with Southwell's own solver on the same mechanism."""

    modes: Annotated[int, Meta(ge=1, description="number of modes, from the lowest")]
    target: Annotated[
        float, Meta(gt=0, le=LOOSEST, description="largest difference: of frequencies relative, of damping ratios")
    ] = 1e-8
    time_limit: TimeLimit = 300.0
    groups: Groups = 1
    lacking: Annotated[str, Meta(description="reason if no group is required")] = ""


class ClosedForm(Struct, frozen=True, forbid_unknown_fields=True):
    """A formula for this mechanism, with separate parameters: see ``references.theories.blade_formulae``."""

    formula: str
    parameters: Annotated[dict[str, float], Meta(description="SI")]


class MechanismFile(Struct, frozen=True, forbid_unknown_fields=True):
    """A mechanism's file; the structures above describe its tables."""

    name: Typed
    bodies: Annotated[dict[Name, Any], Meta(min_length=1, description="name → BodyData")]
    joints: Annotated[dict[Name, Any], Meta(min_length=1, description="name → JointData")]
    title: Annotated[str, Meta(description="one line")] = ""
    description: Annotated[str, Meta(description="purpose and assumptions")] = ""
    source: Annotated[str, Meta(description="source of the data")] = ""
    gravity: Annotated[Three, Meta(description="m/s², in the ground's axes")] = ORIGIN
    motions: Annotated[dict[str, dict[str, Any]], Meta(description="joint.coordinate → MotionData")] = {}
    coordinate_springs: Annotated[
        dict[str, dict[str, Any]], Meta(description="joint.coordinate → CoordinateSpringData")
    ] = {}
    springs: tuple[SpringData, ...] = ()
    bushings: tuple[BushingData, ...] = ()
    beams: tuple[BeamData, ...] = ()
    guess: Annotated[dict[str, dict[str, float]], Meta(description="joint.coordinate → initial guess, m or rad")] = {}
    independent: Annotated[tuple[str, ...], Meta(description="independent coordinates; none: chosen numerically")] = ()
    rotor: Annotated[
        str, Meta(description="joint.coordinate that rotates at the rotor speed, if the speed is varied")
    ] = ""
    equal_blades: Annotated[
        tuple[tuple[str, ...], ...],
        Meta(description="joint.coordinate of each of at least three equal blades, in the order of their azimuths"),
    ] = ()
    speeds: Speeds | None = None
    compare: Compare | None = None
    closed_form: ClosedForm | None = None
