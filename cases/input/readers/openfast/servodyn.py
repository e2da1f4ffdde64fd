"""ServoDyn's file: the spring of the yaw bearing, and what a turbine does not use of it.

OpenFAST reads it if ``CompServo`` is not 0. Structural controllers are tuned masses with springs and dampers in blades,
nacelle, tower and platform. Source: OpenFAST documentation, *ServoDyn*.
"""

import numpy as np

from ..source import Unused, unused
from ..text import Text, flag, keys, load, number_or

UNDAMPED = "modes are undamped"
CONTROLLERS = ("NumBStC", "NumNStC", "NumTStC", "NumSStC")
"""Numbers of structural controllers; ``OLD_CONTROLLERS`` are flags of earlier versions."""
OLD_CONTROLLERS = ("CompNTMD", "CompTTMD")
TUNED_MASSES = "tuned masses of structural controllers, and their springs, are not included"


def used(primary: Text) -> Text | None:
    """The file that a primary file uses; None if ``CompServo`` is 0, or no file is there."""
    servo = keys(primary).get("servofile")
    path = primary.path.parent / servo[1].replace("\\", "/") if servo else None
    active = number_or(primary, "CompServo", 1.0) != 0 and path is not None and path.is_file()
    return load(path) if active and path else None


def yaw(primary: Text, main: Text, servo: Text | None) -> tuple[float, str]:
    """Stiffness of the yaw bearing, N m/rad, and a note on it."""
    if not flag(main, "YawDOF"):
        return np.inf, "yaw bearing locked (YawDOF is False)"
    if number_or(primary, "CompServo", 1.0) == 0:
        return (
            np.inf,
            "yaw bearing locked: with CompServo = 0, OpenFAST has no yaw spring, and the nacelle turns freely",
        )
    if servo is None:
        return np.inf, "yaw bearing locked: its spring is in ServoDyn's file, which is missing"
    stiffness = number_or(servo, "YawSpr", 0.0)
    if stiffness <= 0:
        return np.inf, f"yaw bearing locked: YawSpr in {servo.path.name} is not positive"
    return stiffness, f"yaw spring {stiffness:g} N m/rad (YawSpr in {servo.path.name})"


def not_used(servo: Text | None, yaws: bool) -> tuple[Unused, ...]:
    """Structural controllers, and the damping of a yaw bearing that turns."""
    if servo is None:
        return ()
    names = [name for name in CONTROLLERS if number_or(servo, name, 0.0)]
    names += [name for name in OLD_CONTROLLERS if flag(servo, name)]
    return (
        *(unused("YawDamp", [number_or(servo, "YawDamp", 0.0)], "N m s/rad", servo.path, UNDAMPED) if yaws else ()),
        *unused(", ".join(names), [number_or(servo, name, 1.0) for name in names], "", servo.path, TUNED_MASSES),
    )
