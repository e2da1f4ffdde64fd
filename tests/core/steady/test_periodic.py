"""Periodic equations are refused with the name of the coordinate; steady mechanisms are accepted."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from southwell import multibody as mb
from southwell.reports.cli import app as cli

B, J, M, at = mb.Body, mb.Joint, mb.Motion, mb.at
STIFF = 1240481.8


def rotor(blades: int, stiffness: float = STIFF) -> mb.Mechanism:
    """Coleman's: a hub on two springs of the ground, blades on lag hinges (R. Coleman and A. Feingold, NACA 1351, 1958)."""
    places = 2 * np.pi * np.arange(blades) / blades
    hinges = []
    for k, angle in enumerate(places):
        place = np.eye(4)
        c, s = np.cos(angle), np.sin(angle)
        place[:2, :2] = [[c, -s], [s, c]]
        place[:2, 3] = 0.3048 * c, 0.3048 * s
        hinges.append(J(f"l{k}", "revolute", "rotor", f"b{k}", place))
    blade = mb.inertia(94.9, (0.0, 203.996, 203.996), (3.04636, 0, 0))
    return mb.Mechanism(
        (B("cx"), B("hub", mb.inertia(8026.6)), B("rotor"), *(B(f"b{k}", blade) for k in range(blades))),
        (
            J("X", "prismatic", "ground", "cx", at(axis="x"), at(axis="x")),
            J("Y", "prismatic", "cx", "hub", at(axis="y"), at(axis="y")),
            J("shaft", "revolute", "hub", "rotor"),
            *hinges,
        ),
        (M("shaft.rz", rate=15.0),),
        coordinate_springs=(mb.CoordinateSpring("X.z", stiffness), mb.CoordinateSpring("Y.z", stiffness)),
    )


def spinning(moments: tuple[float, float, float]) -> mb.Mechanism:
    return mb.Mechanism(
        (B("b", mb.inertia(3.0, moments)),), (J("p", "free", "ground", "b"),), (M("p.rz", rate=6.0, prescribed=False),)
    )


def pendulum_on_a_shaft(azimuth: float) -> mb.Mechanism:
    """A blade on a lag hinge, gravity across the axis it turns about."""
    return mb.Mechanism(
        (B("hub"), B("blade", mb.inertia(40.0, (0.1, 50.0, 50.0), (2.0, 0, 0)))),
        (J("shaft", "revolute", "ground", "hub"), J("lag", "revolute", "hub", "blade", at(x=0.3))),
        (M("shaft.rz", azimuth, 5.0),),
        gravity=(0, -9.81, 0),
    )


REFUSED = {
    "ground resonance": (rotor(3), "shaft.rz"),
    "ground resonance, four blades": (rotor(4), "shaft.rz"),
    "two blades": (rotor(2), "shaft.rz"),
    "spin about the middle axis": (spinning((5.0, 11.0, 8.0)), "p.rz"),
    **{f"gravity across, {k} quarters": (pendulum_on_a_shaft(k * np.pi / 2), "shaft.rz") for k in range(3)},
    "a shaft that speeds up": (
        replace(pendulum_on_a_shaft(0.0), motions=(M("shaft.rz", 0.0, 5.0, 1.0),), gravity=(0, 0, 0)),
        "shaft.rz",
    ),
    "one spring of two is stiffer": (
        replace(
            rotor(3),
            bodies=(B("cx"), B("hub", mb.inertia(80.0)), B("rotor", mb.inertia(1.0, (1, 2, 2)))),
            joints=(*rotor(3).joints[:2], J("tilt", "revolute", "hub", "rotor", at(axis="x"))),
            motions=(M("tilt.rz", rate=3.0),),
            springs=(mb.Spring("ground", "rotor", np.array([0, 3.0, 1]), np.array([0, 0.5, 0.2]), 1e4),),
        ),
        "tilt.rz",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_equations_that_vary_are_refused_by_their_coordinate(name: str) -> None:
    """Gravity is named as the cause where the equations without it are constant, and only there."""
    mechanism, coordinate = REFUSED[name]
    cause = "gravity, which is not along its axis" if "gravity" in name else "its motion"
    with pytest.raises(
        mb.MechanismError, match=rf"{coordinate}': .* changes by .* as it moves: .* because of {cause}, .* law of time$"
    ) as caught:
        mb.solve(mechanism)
    assert "\n" not in str(caught.value)


def test_gravity_is_not_the_cause_where_the_motion_is_one_too() -> None:
    """A rotor of three blades on springs of the ground, in gravity across its axis: periodic without gravity as well."""
    with pytest.raises(mb.MechanismError, match="because of its motion"):
        mb.solve(replace(rotor(3), gravity=(0.0, -9.81, 0.0)))


def test_a_law_of_time_is_linearised_at_an_instant() -> None:
    m = pendulum_on_a_shaft(0.0)
    frozen = replace(m, motions=(M("shaft.rz", law=Polynomial([0.0, 5.0])),))
    assert len(mb.solve(frozen).values) == 1


def test_round_bodies_on_round_supports_are_steady() -> None:
    """A disc that spins on a free joint: nutation |I₃ − I₁| Ω/I₁ more, seen at rest: I₃ Ω/I₁ (Euler)."""
    solution = mb.solve(spinning((4.0, 4.0, 6.0)))
    assert np.abs(solution.frequencies - 6.0 * 6.0 / 4.0).min() < 1e-9
    assert (solution.damping >= -1e-9).all()


def test_two_motions_that_cancel_are_steady() -> None:
    """A yoke turns one way and the body on it the other way: the body does not rotate, and nothing changes."""
    m = mb.Mechanism(
        (B("yoke"), B("cage"), B("mass", mb.inertia(2.0, (1.0, 2.0, 2.5), (0.3, 0, 0)))),
        (
            J("there", "revolute", "ground", "yoke"),
            J("back", "revolute", "yoke", "cage"),
            J("swing", "revolute", "cage", "mass", at(axis="y"), at(axis="y")),
        ),
        (M("there.rz", rate=4.0), M("back.rz", rate=-4.0)),
        coordinate_springs=(mb.CoordinateSpring("swing.rz", 50.0),),
        gravity=(0.0, -3.0, 0.0),
    )
    expected = np.sqrt(50.0 / (2.0 + 2.0 * 0.09))
    assert mb.solve(m).frequencies == pytest.approx([expected], rel=1e-12)


def test_the_command_reports_periodic_equations_in_one_line(capsys, tmp_path) -> None:
    path = tmp_path / "spin.toml"
    path.write_text(
        'name = "spin"\n[bodies.b]\nmass = 3.0\nmoments = [5.0, 11.0, 8.0]\n[joints.p]\nkind = "free"\nparent = "ground"\n'
        'child = "b"\n[motions]\np.rz = { rate = 6.0, prescribed = false }\n',
        encoding="utf-8",
    )
    with pytest.raises(SystemExit) as exit_info:
        cli.main(["mechanism", str(path)])
    err = capsys.readouterr().err
    assert (exit_info.value.code, err.count("\n")) == (2, 1)
    assert "p.rz" in err


@pytest.mark.parametrize("stiff", [1.0, 1e6, 1e10, 1e12])
def test_a_falling_mass_is_not_steady_whatever_the_other_springs(stiff: float) -> None:
    m = mb.Mechanism(
        (B("a", mb.inertia(1.0, 1.0)), B("b", mb.inertia(1.0, 1.0))),
        (J("free", "prismatic", "ground", "a"), J("s", "revolute", "ground", "b")),
        coordinate_springs=(mb.CoordinateSpring("s.rz", stiff),),
        gravity=(0, 0, -9.81),
    )
    with pytest.raises(mb.MechanismError, match=r"free\.z': no steady state: 9\.81 N.*no stiffness resists"):
        mb.solve(m)
