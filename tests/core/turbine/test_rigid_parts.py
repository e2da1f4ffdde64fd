"""The size of what a turbine takes as rigid, against the same turbine with a stiff spring in its place."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from southwell.cases.input.readers.openfast import turbine as openfast
from southwell.core.turbine.machine import machine
from southwell.core.turbine.rigid_parts import RigidPart, lowering
from southwell.core.turbine.turbine import Turbine
from southwell.core.turbine.turbine_modes import turbine_modes
from southwell.tests.support.turbine_decks import deck

MODES = 8


def rigid(folder: Path, free: bool = False) -> Turbine:
    """A turbine with a rigid shaft and a locked yaw bearing, without weight."""
    read = openfast.read(deck(folder, free=free)).turbine
    return replace(read, gravity=0.0, yaw=np.inf, drivetrain=replace(read.drivetrain, stiffness=np.inf))


def change(soft: Turbine, stiff: Turbine) -> np.ndarray:
    """How much lower the frequencies of the soft turbine are at rest."""
    both = [turbine_modes(machine(turbine), 0.0, MODES).frequencies for turbine in (soft, stiff)]
    return 1.0 - both[0] / both[1]


def compliance(direction: int, stiffness: float) -> np.ndarray:
    out = np.zeros((6, 6))
    out[direction, direction] = 1.0 / stiffness
    return out


def check(part: RigidPart, soft: Turbine, stiff: Turbine) -> None:
    first_order = lowering(machine(stiff), [part])[0, :MODES]
    exact = change(soft, stiff)
    assert exact.max() > 1e-5
    np.testing.assert_allclose(first_order, exact, rtol=5e-3, atol=1e-8)


def test_between_tower_and_nacelle(tmp_path: Path) -> None:
    """The yaw bearing carries nacelle, generator and rotor; nothing else of the turbine turns about the tower's axis."""
    stiff = rigid(tmp_path)
    k = 3e11
    check(RigidPart("yaw", "all", compliance(3, k), stiff.nacelle), replace(stiff, yaw=k), stiff)


def test_between_nacelle_and_rotor(tmp_path: Path) -> None:
    """The shaft carries the rotor, with a locked generator and with one that turns."""
    for free, k in ((False, 3e11), (True, 3e10)):
        stiff = rigid(tmp_path, free)
        soft = replace(stiff, drivetrain=replace(stiff.drivetrain, stiffness=k))
        check(RigidPart("shaft", "rotor", compliance(5, k)), soft, stiff)


def test_between_hub_and_blades(tmp_path: Path) -> None:
    """A spring about the flapwise axis of the root of each blade, 1 m from the hub's centre and without cone or pitch."""
    stiff = rigid(tmp_path)
    stiff = replace(stiff, blade=replace(stiff.blade, precone=0.0))
    k = 3e11
    root = np.full(6, np.inf)
    root[4] = k
    move = np.eye(6)
    move[2, 4] = 1.0  # at the hub's centre, a rotation about y at (1, 0, 0) moves along z
    at_hub = move @ compliance(4, k) @ move.T
    check(RigidPart("hub", "blade", at_hub), replace(stiff, blade=replace(stiff.blade, root=root)), stiff)
