"""All hypotheses: known effects that a program may lack, and plausible errors of its input, each a change of a ``Model``."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...core.blade import AXIAL, BEND_Y, BEND_Z, SHEAR_Y, SHEAR_Z, TORSION, Blade, clamped
from . import blade_errors as errors
from .blade_errors import Alteration
from .model import Model

G = 9.80665
"""Standard gravity, m/s²."""

POISSON = (0.25, 0.28, 0.3, 0.33)
"""Ratios for which E and G may have been mixed up."""


@dataclass(frozen=True)
class Hypothesis:
    """One possible cause.

    Attributes:
        name: completes "agrees with Southwell's own solver …".
        change: the model of a program with this cause, from the model without it and from ``factor``.
        fitted: whether the size of the cause is unknown; it is a factor, fitted to the numbers.
    """

    name: str
    change: Callable[[Model, float], Model]
    fitted: bool = False


def _fixed(name: str, change: Callable[[Model], Model]) -> Hypothesis:
    return Hypothesis(name, lambda model, _: change(model))


def _blade(name: str, alter: Alteration) -> Hypothesis:
    return _fixed(name, lambda model: replace(model, blade=alter(model.blade)))


def _lacking(name: str, **effects: bool) -> Hypothesis:
    return _fixed(name, lambda model: replace(model, effects=replace(model.effects, **effects)))


def _model(name: str, **values: object) -> Hypothesis:
    return _fixed(name, lambda model: replace(model, **values))  # type: ignore[arg-type]


def _factor(name: str, alter: Callable[[float], Alteration]) -> Hypothesis:
    return Hypothesis(name, lambda model, a: replace(model, blade=alter(a)(model.blade)), fitted=True)


def _field(name: str, **values: object) -> Hypothesis:
    return _blade(name, lambda blade: replace(blade, **values))  # type: ignore[arg-type]


def _stiff_root(blade: Blade) -> Blade:
    return blade if clamped(blade) else replace(blade, root=np.full(6, np.inf))


def _torsion_with_shear(factor: float) -> Alteration:
    return errors.scaled_strain(factor, TORSION, SHEAR_Y, SHEAR_Z)


def _down(name: str, *direction: float) -> Hypothesis:
    return _model(name, gravity=G * np.array(direction))


PHYSICS = (
    _lacking("without geometric stiffness", geometric=False),
    _model("with geometric stiffness reversed", geometric=-1.0),
    _model("with the sign of T′w′ reversed in the beam's equation", following=2.0),
    _lacking("without Coriolis terms", coriolis=False),
    _lacking("without rotary inertia", rotary_inertia=False),
    _lacking("about the undeformed blade", prestretch=False),
    _model("without spin softening", softening=0.0),
    _model("with half the spin softening", softening=0.5),
    _model("with spin softening reversed", softening=-1.0),
    _fixed(
        "without spin softening and Coriolis terms (a fixed frame)",
        lambda model: replace(model, softening=0.0, effects=replace(model.effects, coriolis=False)),
    ),
    _model("by Southwell's equation, with the slope at low speed", slow=True),
    _blade("rigid in shear (Euler–Bernoulli)", errors.rigid(SHEAR_Y, SHEAR_Z)),
    _blade("rigid in stretch", errors.rigid(AXIAL)),
    _blade("rigid in torsion", errors.rigid(TORSION)),
    _down("with gravity, blade hanging down", 1.0, 0.0, 0.0),
    _down("with gravity, blade upright", -1.0, 0.0, 0.0),
    _down("with gravity, blade horizontal, moving down", 0.0, 1.0, 0.0),
    _down("with gravity, blade horizontal, moving up", 0.0, -1.0, 0.0),
)
"""Effects that a program lacks, or has and the solver is not asked for."""

INPUT = (
    _field("without hub radius", hub_radius=0.0),
    _blade("with twice the hub radius", lambda b: replace(b, hub_radius=2.0 * b.hub_radius)),
    _blade("with the rotor radius as length of the blade", errors.rotor_radius_as_length),
    _model("without rotation", speed=0.0),
    _model("with the speed in rpm read as rad/s", speed=30.0 / np.pi),
    _model("with the speed in rad/s read as rpm", speed=np.pi / 30.0),
    _model("with the speed in rad/s read as Hz", speed=2.0 * np.pi),
    _model("with the speed in Hz read as rad/s", speed=0.5 / np.pi),
    _field("without precone", precone=0.0),
    _blade("with precone reversed", lambda b: replace(b, precone=-b.precone)),
    _field("without pitch", pitch=0.0),
    _blade("with pitch reversed", lambda b: replace(b, pitch=-b.pitch)),
    _blade("without twist", lambda b: replace(b, twist=0.0 * b.twist)),
    _blade("with twist reversed", lambda b: replace(b, twist=-b.twist)),
    _blade("with twist in degrees read as radians", lambda b: replace(b, twist=np.degrees(b.twist))),
    _blade("without prebend", errors.mirrored_curve(0.0, 1.0)),
    _blade("with prebend reversed", errors.mirrored_curve(-1.0, 1.0)),
    _blade("without sweep", errors.mirrored_curve(1.0, 0.0)),
    _blade("with sweep reversed", errors.mirrored_curve(1.0, -1.0)),
    _blade("with flapwise and edgewise stiffness exchanged", errors.exchanged_bending),
    _blade("without couplings of torsion", errors.scaled_coupling(0.0)),
    _blade("with couplings of torsion reversed", errors.scaled_coupling(-1.0)),
    _blade("without any coupling of the stiffness", errors.uncoupled_stiffness),
    _blade("with mass centres on the reference axis", errors.moved_mass_centres(0.0)),
    _blade("with mass centres on the other side of the reference axis", errors.moved_mass_centres(-1.0)),
    _blade("about an axis shifted by a quarter of the radius of gyration, without the couplings", errors.shifted_axis),
    _field("without tip mass", tip_mass=np.zeros((6, 6))),
    _blade("with the tip mass a point on the axis", errors.point_tip),
    _blade("with the tip mass on the other side of the axis", errors.mirrored_tip),
    _blade("clamped at the root", _stiff_root),
    _blade("without the mass of the root station", errors.lost_station_mass(0)),
    _blade("without the mass of the tip station", errors.lost_station_mass(-1)),
    _blade("with G = E", errors.scaled_strain(2.6, TORSION)),
    _blade("with shear stiffness G A instead of 5/6 G A", errors.scaled_strain(1.2, SHEAR_Y, SHEAR_Z)),
    *(
        _blade(f"with E/2·(1 + ν) for G (ν = {ratio:g})", errors.scaled_strain((1.0 + ratio) ** 2, TORSION))
        for ratio in POISSON
    ),
    *(
        _blade(f"with E/2·(1 + ν) for G, also in shear (ν = {ratio:g})", _torsion_with_shear((1.0 + ratio) ** 2))
        for ratio in POISSON
    ),
)
"""Errors of input."""

DISCRETISATION = (
    _blade("with the inner station's properties up to the next", errors.stepwise(0.0)),
    _blade("with the outer station's properties from the previous", errors.stepwise(1.0)),
    _blade("with constant properties between stations", errors.stepwise(0.5)),
    *(_model(f"with {n} elements", elements=n) for n in (2, 3, 5)),
    *(_model(f"with lumped mass on {n} elements", mass="half_end", elements=n) for n in (5, 10, 20, 50)),
    _model("with the whole of an element's mass at the tip, on 50", mass="half_end", whole_tip=True, elements=50),
    *(_model(f"in the {n} lowest modes at rest", basis=n) for n in (2, 3, 4, 5, 6, 8)),
)
"""Coarse discretisations."""

FACTORS = (
    _factor("mass", errors.scaled_mass),
    _factor("flapwise bending stiffness", lambda a: errors.scaled_strain(a, BEND_Y)),
    _factor("edgewise bending stiffness", lambda a: errors.scaled_strain(a, BEND_Z)),
    _factor("torsional stiffness", lambda a: errors.scaled_strain(a, TORSION)),
    _factor("length", errors.scaled_length),
    Hypothesis("rotor speed", lambda model, a: replace(model, speed=a * model.speed), fitted=True),
    Hypothesis(
        "hub radius",
        lambda model, a: replace(model, blade=replace(model.blade, hub_radius=a * model.blade.hub_radius)),
        fitted=True,
    ),
)
"""Properties that may be wrong by an unknown factor."""

ALL = (*PHYSICS, *INPUT, *DISCRETISATION, *FACTORS)
