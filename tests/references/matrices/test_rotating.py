"""Rotors with equal blades in every code for mechanisms: the same frequencies, each by its own transformation."""

from dataclasses import replace

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.references.exudyn.mechanism import CODE as EXUDYN
from southwell.references.linkages.mechanism import CODE as PINOCCHIO
from southwell.references.protocol.interface import CodeError
from southwell.tests.support.rotors import coleman_feingold

LAG = (("lag0.rz", "lag1.rz", "lag2.rz"),)


def flapping(blades: int, omega: float) -> mb.Mechanism:
    """Coned blades on sprung flap and lag hinges, on a nacelle that pitches, yaws and slides, its shaft tilted."""
    blade = mb.inertia(60.0, (1.0, 90.0, 95.0), (2.5, 0.1, 0.2))
    bodies, joints, springs = [], [], []
    for k in range(blades):
        turn = 2 * np.pi * k / blades
        pose = np.eye(4)
        c, s = np.cos(turn), np.sin(turn)
        pose[:2, :2], pose[:3, 3] = [[c, -s], [s, c]], [0.4 * c, 0.4 * s, 0.05]
        bodies += [mb.Body(f"knuckle{k}"), mb.Body(f"blade{k}", blade)]
        joints += [
            mb.Joint(f"flap{k}", "revolute", "rotor", f"knuckle{k}", pose @ mb.at(axis="-y"), mb.at(axis="-y")),
            mb.Joint(f"lag{k}", "revolute", f"knuckle{k}", f"blade{k}"),
        ]
        springs += [mb.CoordinateSpring(f"flap{k}.rz", 4e4, 30.0), mb.CoordinateSpring(f"lag{k}.rz", 9e4, 20.0)]
    tilted = mb.at(z=0.6, x=-0.8, axis=np.array([0.97, 0.0, -0.1]))
    return mb.Mechanism(
        bodies=(
            mb.Body("slide"),
            mb.Body("nacelle", mb.inertia(900.0, (300.0, 400.0, 500.0), (0.3, 0.1, 0.2))),
            mb.Body("rotor"),
            *bodies,
        ),
        joints=(
            mb.Joint("tower", "prismatic", "ground", "slide", mb.at(axis="y"), mb.at(axis="y")),
            mb.Joint("yaw", "universal", "slide", "nacelle"),
            mb.Joint("shaft", "revolute", "nacelle", "rotor", tilted),
            *joints,
        ),
        motions=(mb.Motion("shaft.rz", rate=omega),),
        coordinate_springs=(
            mb.CoordinateSpring("tower.z", 3e5, 100.0),
            mb.CoordinateSpring("yaw.rx", 6e5),
            mb.CoordinateSpring("yaw.ry", 4e5),
            *springs,
        ),
        equal_blades=tuple(tuple(f"{hinge}{k}.rz" for k in range(blades)) for hinge in ("flap", "lag")),
    )


@pytest.mark.parametrize("code", [PINOCCHIO, EXUDYN], ids=["pinocchio", "exudyn"])
@pytest.mark.parametrize("blades", [3, 4])
def test_a_flapping_rotor_on_a_nacelle(code, blades: int) -> None:
    pytest.importorskip("pinocchio" if code is PINOCCHIO else "exudyn")
    machine = flapping(blades, 9.0)
    exact = mb.solve(machine)
    solution = code.mechanism_modes(machine, {})
    np.testing.assert_allclose(np.abs(solution.values), exact.frequencies, rtol=1e-7)
    np.testing.assert_allclose(solution.values.real, exact.values.real, atol=1e-6)


def test_blades_numbered_backwards_and_unequal_ones_are_refused() -> None:
    pytest.importorskip("pinocchio")
    backwards = replace(coleman_feingold(1.6), equal_blades=tuple(group[::-1] for group in LAG))
    unequal = replace(coleman_feingold(1.6, stiffer=1.05), equal_blades=LAG)
    for invalid in (backwards, unequal):
        with pytest.raises(CodeError, match="also in Fourier coordinates"):
            PINOCCHIO.mechanism_modes(invalid, {})
        with pytest.raises(mb.MechanismError, match="equal_blades: azimuth: the matrices vary"):
            mb.solve(invalid)


def test_unknown_coordinates_and_a_rotor_at_rest() -> None:
    with pytest.raises(mb.MechanismError, match="no free coordinate of this name"):
        mb.solve(replace(coleman_feingold(1.6), equal_blades=(("lag0.rz", "lag1.rz", "lag9.rz"),)))
    with pytest.raises(mb.MechanismError, match="at least 3"):
        mb.solve(replace(coleman_feingold(1.6), equal_blades=(("lag0.rz", "lag1.rz"),)))
    rest = replace(coleman_feingold(0.0), equal_blades=LAG)
    np.testing.assert_allclose(mb.solve(rest).frequencies[0] / (2 * np.pi), 0.09917042, atol=5e-9)
