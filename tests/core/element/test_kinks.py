"""A kink in the reference curve: core agrees with a mechanism with a rigid corner, and with other codes' joint chains."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers import reading, southwell_toml
from southwell.core import curve
from southwell.core.blade import Blade, BladeError, section_mass, section_stiffness
from southwell.core.element.discretize import discretize, divide
from southwell.core.element.sections import frames
from southwell.core.participation import participation
from southwell.core.solve import mesh_modes
from southwell.core.space import spatial as sp
from southwell.core.tree.as_mechanism import mechanism, single_element
from southwell.references.joint_chains import joint_chain
from southwell.references.protocol import registry
from southwell.tests.support.codes import BLADE_CODES

from ...support.beams import curved

ANGLE, OMEGA = np.radians(30.0), 60 * np.pi / 30
DENSE = np.array([0, 4, 7, 7.5, 7.8, 7.9, 7.99, 7.999, 8, 8.001, 8.01, 8.1, 8.2, 8.5, 9, 10])


def line(s: np.ndarray, at: float = 8.0, angle: float = ANGLE) -> np.ndarray:
    """(n, 3) along x, and beyond ``at`` swept backwards."""
    beyond = np.maximum(s - at, 0.0)
    return np.stack([np.minimum(s, at) + beyond * np.cos(angle), -beyond * np.sin(angle), 0 * s], axis=1)


def beam(s: np.ndarray, curve: np.ndarray, kinks: tuple[float, ...] = (), **more: object) -> Blade:
    """A uniform beam along a curve."""
    n = len(s)
    stiffness = np.repeat(section_stiffness(1e7, 1e4, 1e4, 4e4, 4e6, 4e6), n, axis=0)
    mass = np.repeat(section_mass(10.0, 0.01, 0.02), n, axis=0)
    changes = {"hub_radius": 1.0, **more}
    return Blade("swept tip", s, stiffness, mass, np.zeros(n), curve=curve, kinks=kinks, **changes)  # type: ignore[arg-type]


def kinked(**more: object) -> Blade:
    """Two straight pieces, 8 m and 2 m."""
    s = np.array([0.0, 8.0, 10.0])
    return beam(s, line(s), (8.0,), **more)


def with_all() -> Blade:
    """A blade with all properties and two kinks, in different planes."""
    smooth = curved()
    s, r = smooth.stations, smooth.curve
    sweep, rise = sp.rotation(2, np.array(-0.3)), sp.rotation(1, np.array(0.2))
    rotations = [np.eye(3), sweep, sweep @ rise]
    pieces = [0, 0, 1, 2, 2]  # of the intervals; pieces of two points are straight
    steps = [rotations[p] @ (r[k + 1] - r[k]) for k, p in enumerate(pieces)]
    steps[2] *= (s[3] - s[2]) / np.linalg.norm(steps[2])
    return replace(smooth, curve=np.concatenate([r[:1], r[0] + np.cumsum(steps, axis=0)]), kinks=(s[2], s[3]))


@pytest.mark.parametrize(("mass", "stiffness"), [("consistent", "corotational"), ("half_end", "body_fixed")])
def test_a_kink_is_a_rigid_corner_between_two_straight_beams(mass, stiffness) -> None:
    """Two straight beams, divided separately and fixed to each other at an angle in a general mechanism."""
    s = np.array([0.0, 1.0])
    inner, outer = (beam(length * s, line(length * s)) for length in (8.0, 2.0))
    first, second = (
        discretize(inner, 8, mass, stiffness),
        discretize(replace(outer, hub_radius=0.0), 2, mass, stiffness),
    )
    m = mechanism(first, OMEGA)
    bodies = tuple(mb.Body(f"tip {k}", lump) for k, lump in enumerate(second.lumps))
    corner = mb.Joint(
        "corner", "fixed", "body 8", "tip 0", at_parent=sp.pose(sp.rotation(2, np.array(-ANGLE)), np.zeros(3))
    )
    undeformed = second.beams.undeformed
    joints = tuple(
        mb.Joint(f"tip element {k}", "elastic", f"tip {k}", f"tip {k + 1}", at_parent=undeformed[k]) for k in range(2)
    )
    beams = tuple(mb.Beam(f"tip {k}", f"tip {k + 1}", single_element(second.beams, k)) for k in range(2))
    whole = replace(m, bodies=(*m.bodies, *bodies), joints=(*m.joints, corner, *joints), beams=(*m.beams, *beams))
    frequencies = mesh_modes(kinked(), OMEGA, 10, 8, mass=mass, stiffness=stiffness).frequencies
    np.testing.assert_allclose(frequencies, mb.solve(whole).frequencies[:8], rtol=1e-9)


@pytest.mark.parametrize("blade", [kinked(), kinked(precone=0.1, pitch=0.2), with_all()], ids=["beam", "coned", "all"])
def test_the_general_solver_agrees_on_kinks(blade: Blade) -> None:
    """The same discretisation, with elements that end in frames other than those of their nodes."""
    frequencies = mesh_modes(blade, 1.0, 8, 6).frequencies
    np.testing.assert_allclose(frequencies, mb.solve(mechanism(discretize(blade, 8), 1.0)).frequencies[:6], rtol=1e-9)


def test_elements_end_at_kinks_and_refinement_is_of_fourth_order() -> None:
    f = [mesh_modes(kinked(), OMEGA, n, 6).frequencies for n in (80, 160, 320, 640)]
    change = np.abs(np.diff(f, axis=0)).max(1)
    assert np.log2(change[:-1] / change[1:]).min() > 3.7
    for n in (2, 7, 50, 200):
        assert {0.0, 8.0, 10.0} <= set(divide(kinked(), n))
        assert len(divide(kinked(), n)) == n + 1
    np.testing.assert_array_equal(divide(kinked(), 160)[::4], divide(kinked(), 40))
    assert mesh_modes(kinked(), OMEGA, 1, 2).elements == 2


def test_a_well_rounded_corner_is_nearly_the_kink() -> None:
    """A dense table differs by its rounded corner only; the difference vanishes with the radius."""
    exact = mesh_modes(kinked(), OMEGA, 160, 5).frequencies
    tighter = np.unique(np.concatenate([DENSE, 8 + np.outer([1, -1], 0.001 * 2.0 ** np.arange(10)).ravel()]))
    off = [np.abs(mesh_modes(beam(s, line(s)), OMEGA, 160, 5).frequencies / exact - 1).max() for s in (DENSE, tighter)]
    assert off[0] < 5e-4
    assert off[1] < off[0] / 4


def test_sections_turn_with_the_tangent_at_the_kink() -> None:
    before, beyond = (frames(kinked(), np.array([8.0]), root_side=b)[0] for b in (True, False))
    np.testing.assert_allclose(before[:3, :3], np.eye(3), atol=1e-15)
    np.testing.assert_allclose(beyond[:3, 0], [np.cos(ANGLE), -np.sin(ANGLE), 0], atol=1e-15)
    np.testing.assert_allclose(before[:3, 3], beyond[:3, 3], atol=1e-15)


@pytest.mark.parametrize("off", [-5e-12, 5e-12])
def test_an_arc_length_within_rounding_of_a_kink_is_the_kink(off: float) -> None:
    before, beyond = (
        curve.at(kinked().stations, kinked().curve, (8.0,), np.array([8.0 + off]), root_side=b)[1][0]
        for b in (True, False)
    )
    np.testing.assert_allclose(before, [1.0, 0.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(beyond, [np.cos(ANGLE), -np.sin(ANGLE), 0.0], atol=1e-15)


def test_a_kink_of_zero_angle_changes_nothing() -> None:
    s = np.array([0.0, 8.0, 10.0])
    plain, declared = (mesh_modes(beam(s, line(s, angle=0.0), k), OMEGA, 20, 6).frequencies for k in ((), (8.0,)))
    np.testing.assert_allclose(declared, plain, rtol=1e-12)


def test_stiff_springs_at_the_root_clamp_a_kinked_blade() -> None:
    clamped, stiff = (mesh_modes(kinked(root=np.full(6, k)), OMEGA, 10, 6).frequencies for k in (np.inf, 1e13))
    np.testing.assert_allclose(stiff, clamped, rtol=1e-7)


def test_energy_fractions_of_a_kinked_blade_are_those_of_the_rounded_one() -> None:
    sharp, round_ = (mesh_modes(b, OMEGA, 100, 4) for b in (kinked(), beam(DENSE, line(DENSE))))
    expected = participation(round_, beam(DENSE, line(DENSE)))
    np.testing.assert_allclose(participation(sharp, kinked()), expected, atol=0.01)


@pytest.mark.parametrize("blade", [kinked(), with_all()], ids=["beam", "all"])
@pytest.mark.parametrize("name", ["pinocchio", "mujoco", "drake"])
def test_joint_chains_have_the_kink_too(name: str, blade: Blade) -> None:
    """Kinematics, dynamics and derivatives by the other code, on core's nodes, bodies and elements."""
    code = registry.code(name)
    if code.version() is None:
        pytest.skip(f"{name} is not installed")
    actual = mesh_modes(blade, 1.0, 12, 6, mass="half_end", stiffness="body_fixed")
    expected = code.solve(blade, 1.0, 12, 6)
    np.testing.assert_allclose(expected.frequencies, actual.frequencies, rtol=1e-8 if name == "pinocchio" else 1e-6)
    np.testing.assert_allclose(
        np.abs(np.einsum("mij,mij->m", expected.shapes[..., :3].conj(), actual.shapes[..., :3])),
        np.linalg.norm(expected.shapes[..., :3], axis=(1, 2)) * np.linalg.norm(actual.shapes[..., :3], axis=(1, 2)),
        rtol=2e-3,
    )
    assert expected.elements == actual.elements


def test_bodies_of_the_joint_chain_are_at_the_ends_of_the_elements() -> None:
    mesh = discretize(with_all(), 9, "half_end", "body_fixed")
    here = np.eye(4)
    for k, place in enumerate(joint_chain.places(mesh), 1):
        here = here @ place
        np.testing.assert_allclose(here, mesh.nodes[k] @ mesh.corner[k - 1], atol=1e-12)


TAKE_KINKS = ("pinocchio", "mujoco", "drake", "scikit-fem-reissner")


@pytest.mark.parametrize("name", [n for n in BLADE_CODES if n not in TAKE_KINKS])
def test_other_codes_report_that_kinks_are_unsupported(name: str) -> None:
    assert registry.code(name).unsupported(kinked())


FILE = """
name = "swept tip"
[blade]
kind = "sections"
hub_radius = 1.0
s = [0.0, 8.0, 10.0]
kinks = {kinks}
stiffness = [{k}, {k}, {k}]
mass = [{m}, {m}, {m}]
curve = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [9.732050808, -1.0, 0.0]]
"""
K = "[1e7, 0, 0, 0, 0, 0, 4e6, 0, 0, 0, 0, 4e6, 0, 0, 0, 1e4, 0, 0, 1e4, 0, 4e4]"
M = "[10, 0, 0, 0, 0, 0, 10, 0, 0, 0, 0, 10, 0, 0, 0, 0.03, 0, 0, 0.01, 0, 0.02]"


def test_a_file_declares_its_kinks(tmp_path: Path) -> None:
    path = tmp_path / "blade.toml"
    path.write_text(FILE.format(kinks="[8.0]", k=K, m=M))
    blade = reading(path).blade
    expected = mesh_modes(kinked(), OMEGA, 20, 5).frequencies
    np.testing.assert_allclose(mesh_modes(blade, OMEGA, 20, 5).frequencies, expected, rtol=1e-8)
    southwell_toml.write(blade, path)
    assert reading(path).blade.kinks == (8.0,)


def test_too_few_points_around_a_corner_are_refused(tmp_path: Path) -> None:
    """With one spline through the kink, flapwise 2 was 6.7 % low."""
    path = tmp_path / "blade.toml"
    path.write_text(FILE.format(kinks="[]", k=K, m=M))
    with pytest.raises(CaseError, match=r"between 0 m and 8 m the spline.*30° at 8 m.*add points.*kinks = \[8\]"):
        reading(path)


@pytest.mark.parametrize("n", [3, 6, 11, 21])
@pytest.mark.parametrize("degrees", [10.0, 30.0, 60.0])
def test_a_corner_between_even_points_is_refused(n: int, degrees: float) -> None:
    s = np.union1d(np.linspace(0.0, 10.0, n), 8.0)
    with pytest.raises(BladeError, match="the spline through its points"):
        beam(s, line(s, angle=np.radians(degrees)))


@pytest.mark.parametrize(("degrees", "n"), [(10, 3), (30, 4), (60, 6), (90, 8)])
def test_smooth_curves_with_points_every_fifteen_degrees_are_accepted(degrees: float, n: int) -> None:
    s, a = np.linspace(0.0, 10.0, n), np.radians(degrees) / 10
    curve = np.stack([np.sin(a * s), 1 - np.cos(a * s), 0 * s], axis=1) / [a, a, 1]
    np.testing.assert_array_equal(beam(s, curve).curve, curve)


@pytest.mark.parametrize(
    ("kinks", "match"),
    [
        ((8.05,), r"kinks: 8\.05 m: not a station.*nearest is 8 m"),
        ((0.0,), "not a station between root and tip"),
        ((10.0,), "not a station between root and tip"),
        ((8.0, 8.0), "not ascending"),
        ((np.nan,), "not a station"),
    ],
)
def test_impossible_kinks_are_refused(kinks: tuple[float, ...], match: str) -> None:
    s = np.array([0.0, 8.0, 10.0])
    with pytest.raises(BladeError, match=match):
        beam(s, line(s), kinks)


def test_a_kink_within_rounding_of_its_station_is_moved_to_it() -> None:
    s = np.array([0.0, 8.0, 10.0])
    assert beam(s, line(s), (8.0 + 1e-12,)).kinks == (8.0,)
