"""Faults in the assembly of a turbine by core, in its transformation to the ground's frame, and in adapters for turbines."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...core.mechanism.description import inertia
from ...core.modes import STATIONS
from ...core.space.inertia import about_centre
from ...core.turbine import rotor as equations
from ...core.turbine.turbine import Turbine, shaft_pose
from ...references.protocol.turbines import TurbineModes
from ..solve import turbine as solving
from ..solve import turbine_weights
from .alterations import answered, received
from .seeding import Fault, Seam, Trial

SHAFT = shaft_pose(2.0, -7.0, np.radians(-15.0))
CONE = np.radians(-10.0)


def _exaggerated(turbine: Turbine) -> Turbine:
    """Large angles, and a heavy nacelle far from the tower's top: the first modes depend on each."""
    return replace(
        turbine,
        nacelle=inertia(4e5, (8e6, 6e6, 6e6), (3.0, 1.0, 4.0)),
        shaft=SHAFT,
        blade=replace(turbine.blade, precone=CONE),
        yaw=2e9,
        drivetrain=replace(turbine.drivetrain, stiffness=2e8),
    )


TURBINE = Trial("nrel-5mw-turbine", (1.5,), ("exudyn-turbine",), _exaggerated)


def _assembled(alter: Callable[[Turbine], Turbine]) -> tuple[Seam, ...]:
    """Core assembles a different turbine."""
    return (solving, "machine", received(alter)), (turbine_weights, "machine", received(alter))


def _projected(alter: Callable[[Any], Any]) -> tuple[Seam, ...]:
    return ((equations, "in_ground_frame", alter),)


def _frozen(original: Any) -> Any:
    """The azimuth is a constant: its derivatives are missing."""
    return lambda matrices, omega, P: original(matrices, omega, (P[0], 0.0 * P[1], 0.0 * P[2]))


def _not_gyroscopic(original: Any) -> Any:
    """Multi-blade coordinates without the term 2 Ω M P′."""

    def faulty(matrices: Any, omega: float, P: Sequence[Any]) -> Any:
        M, C, K = original(matrices, omega, P)
        return M, C - 2.0 * omega * P[0].T @ matrices[0] @ P[1], K

    return faulty


def _about_top(turbine: Turbine) -> Turbine:
    """Moments of inertia about the nacelle's mass centre are taken for those about the tower's top."""
    nacelle = turbine.nacelle.copy()
    nacelle[3:, 3:] = about_centre(nacelle)[2]
    return replace(turbine, nacelle=nacelle)


def shaft_of(turbine: Turbine) -> tuple[float, float, float]:
    """Height, overhang, m, and tilt, rad, of ``shaft_pose``."""
    rise, downwind = float(turbine.shaft[0, 2]), float(turbine.shaft[2, 2])
    overhang = float(turbine.shaft[2, 3]) / downwind
    return float(turbine.shaft[0, 3]) - overhang * rise, overhang, float(np.arctan2(rise, downwind))


def with_shaft(turbine: Turbine, height: float, overhang: float, tilt: float) -> Turbine:
    """The turbine with another shaft."""
    return replace(turbine, shaft=shaft_pose(height, overhang, tilt))


def other_tilt(turbine: Turbine) -> Turbine:
    """The tilt with the other sign."""
    height, overhang, tilt = shaft_of(turbine)
    return with_shaft(turbine, height, overhang, -tilt)


def other_cone(turbine: Turbine) -> Turbine:
    """The precone with the other sign."""
    return replace(turbine, blade=replace(turbine.blade, precone=-turbine.blade.precone))


def plain_ratio(turbine: Turbine) -> Turbine:
    """The generator's inertia behind the gear ratio, not squared."""
    drive = turbine.drivetrain
    return replace(turbine, drivetrain=replace(drive, generator=drive.generator / drive.gear_ratio))


def _answered(alter: Callable[[TurbineModes], TurbineModes]) -> tuple[Seam, ...]:
    """The answer of a code is altered."""
    return ((solving, "turbine_answers", answered(alter)),)


def _at_rest(original: Any) -> Any:
    def faulty(name: str, turbine: Turbine, runs: Sequence[Any], *how: Any) -> Any:
        return original(name, turbine, [(0.0, elements, count) for _, elements, count in runs], *how)

    return faulty


def _backwards(modes: TurbineModes) -> TurbineModes:
    """The order of the blades is reversed after the first."""
    tower, first, *blades = np.split(modes.shapes, modes.shapes.shape[1] // len(STATIONS), axis=1)
    return replace(modes, shapes=np.concatenate([tower, first, *blades[::-1]], axis=1))


def _turbine(name: str, description: str, size: str, seams: tuple[Seam, ...], area: Any = "solver") -> Fault:
    return Fault(f"turbine: {name}", area, description, size, seams, TURBINE)


FAULTS = (
    _turbine("frozen azimuth", "the rotor is transformed at one azimuth, as if it did not turn", "tens of %",
             _projected(_frozen)),
    _turbine("transformation", "multi-blade coordinates lack their gyroscopic term", "tens of %",
             _projected(_not_gyroscopic)),
    _turbine("tilt", "the tilt of the shaft has the other sign", "percent", _assembled(other_tilt)),
    _turbine("precone", "the blades are coned to the other side", "percent", _assembled(other_cone)),
    _turbine("nacelle", "the nacelle's inertia about its mass centre is taken for that about the tower's top", "percent",
             _assembled(_about_top)),
    _turbine("gear ratio", "the generator's inertia is multiplied by the ratio instead of its square", "tens of %",
             _assembled(plain_ratio)),
    _turbine("blades backwards", "blades are numbered against the rotation", "whirls exchanged",
             _answered(_backwards), "adapter"),
    _turbine("rotor at rest", "the rotor's speed does not reach the code", "tens of %",
             ((solving, "turbine_answers", _at_rest),), "adapter"),
)  # fmt: skip
