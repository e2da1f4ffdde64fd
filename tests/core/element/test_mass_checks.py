"""Impossible masses and stiffnesses are refused, from a file and from Python."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers import reading
from southwell.core.blade import Blade, BladeError, section_mass, without_rotary_inertia
from southwell.core.blade_checks import body_fault
from southwell.core.mechanism.description import MechanismError, check_mechanism, inertia
from southwell.core.solve import mesh_modes

from ...support.beams import PARK, curved

FILE = """
name = "beam"
[blade]
kind = "sections"
hub_radius = 1.0
s = [0.0, 10.0]
stiffness = [{k}, {k}]
mass = [{good}, {m}]
"""
K = "[1e7, 0, 0, 0, 0, 0, 4e6, 0, 0, 0, 0, 4e6, 0, 0, 0, 1e4, 0, 0, 1e4, 0, 4e4]"
GOOD = "[10, 0, 0, 0, 0, 0, 10, 0, 0, 0, 0, 10, 0, 0, 0, 0.03, 0, 0, 0.01, 0, 0.02]"


@pytest.mark.parametrize(
    ("mass", "match"),
    [
        (
            "[10, 0, 0, 0, 0, 0, 20, 0, 0, 0, 0, 10, 0, 0, 0, 0.03, 0, 0, 0.01, 0, 0.02]",
            r"10, 20, 10 kg/m along x, y, z: a body has the same mass in all directions",
        ),
        (
            "[10, 2, 0, 0, 3, 0, 10, 0, 0, 0, 0, 10, 0, 0, 0, 0.03, 0, 0, 0.01, 0, 0.02]",
            r"entry \(0, 1\) is 2: motion along one axis has no momentum along another",
        ),
        (
            "[10, 0, 0, 0, 3, 0, 10, 0, 0, 0, 0, 10, 0, 0, 0, 0.03, 0, 0, 0.01, 0, 0.02]",
            r"entries \(0, 4\) and \(1, 3\) are 3 and 0: they must be opposite",
        ),
        (
            "[10, 0, 0, 0, 0, -1, 10, 0, 0, 0, 0, 10, 1, 0, 0, 0.03, 0, 0, 0.01, 0, 0.02]",
            r"smallest moment of inertia about the mass centre is -0\.08.*m d² included",
        ),
        (
            "[10, 0, 0, 0, 0, 0, 10, 0, 0, 0, 0, 10, 0, 0, 0, 0.09, 0, 0, 0.01, 0, 0.02]",
            r"moments.* are 0\.01, 0\.02, 0\.09: none can be larger than the sum of the other two.*polar one is that sum",
        ),
        (
            "[10, 0, 0, 0, 0, 0, 10, 0, 0, 0, 0, 10, 0, 0, 0, 0.03, 0, 0, 0.01, 0.05, 0.02]",
            r"smallest principal moment of inertia is .*the products of inertia are too large",
        ),
        ("[-10, 0, 0, 0, 0, 0, -10, 0, 0, 0, 0, -10, 0, 0, 0, 0.03, 0, 0, 0.01, 0, 0.02]", r"diagonal 0 is -10 kg/m"),
    ],
    ids=["m_y", "cross", "offset", "about the centre", "polar", "product", "negative"],
)
def test_a_file_with_an_impossible_mass_is_refused(tmp_path: Path, mass: str, match: str) -> None:
    path = tmp_path / "blade.toml"
    path.write_text(FILE.format(k=K, good=GOOD, m=mass))
    with pytest.raises(CaseError, match=r"blade\.mass: at station 1 \(10 m\): " + match):
        reading(path)


def test_a_file_with_an_impossible_tip_mass_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "blade.toml"
    body = "[blade.tip_mass]\nmass = 3.0\ninertia = [9.0, 1.0, 1.0, 0.0, 0.0, 0.0]\n"
    path.write_text(FILE.format(k=K, good=GOOD, m=GOOD) + body)
    with pytest.raises(CaseError, match=r"blade\.tip_mass: moments.* 1, 1, 9: none can be larger"):
        reading(path)


def changed(name: str, at: tuple[int, ...], value: float) -> Blade:
    matrix = getattr(curved(), name).copy()
    matrix[at] = value
    return replace(curved(), **{name: matrix})


def test_a_negative_tip_mass_is_refused() -> None:
    with pytest.raises(BladeError, match=r"tip_mass: diagonal 0 is -3 kg: it must be positive"):
        replace(PARK, tip_mass=-3.0 * np.diag([1.0, 1, 1, 0, 0, 0]))


def test_an_unsymmetric_mass_is_refused() -> None:
    with pytest.raises(
        BladeError, match=r"mass: at station 2 \(10 m\): entries \(4, 5\) and \(5, 4\) are 1 and 0: .*symmetric"
    ):
        changed("mass", (2, 4, 5), 1.0)
    with pytest.raises(BladeError, match=r"tip_mass: entries .* symmetric"):
        replace(PARK, tip_mass=np.diag([3.0, 3, 3, 1, 1, 1]) + np.eye(6, k=5))


@pytest.mark.parametrize(
    ("at", "value", "match"),
    [
        ((2, 3, 5), 1e7, r"entries \(3, 5\) and \(5, 3\) at station 2 \(10 m\) are 1e\+07 and 0: it must be symmetric"),
        ((2, 4, 4), -1.0, r"diagonal 4 \(bending about y\) at station 2 \(10 m\) is -1: it must be positive"),
        ((2, 4, 4), 1e-310, r"diagonal 4 \(bending about y\) at station 2 \(10 m\) is 1e-310: not between 1e-100 and"),
        ((2, 0, 0), np.inf, r"axial at station 0 \(0 m\) is finite but rigid at other stations"),
    ],
)
def test_an_impossible_stiffness_is_refused(at: tuple[int, ...], value: float, match: str) -> None:
    with pytest.raises(BladeError, match="stiffness: " + match):
        changed("stiffness", at, value)


def test_a_coupling_beyond_its_diagonal_is_refused() -> None:
    stiffness = curved().stiffness.copy()
    stiffness[3, 3, 4] = stiffness[3, 4, 3] = 1.01 * np.sqrt(stiffness[3, 3, 3] * stiffness[3, 4, 4])
    with pytest.raises(BladeError, match=r"stiffness: at station 3 \(20 m\) not positive definite"):
        replace(curved(), stiffness=stiffness)


def test_a_coupling_with_a_rigid_strain_is_refused() -> None:
    stiffness = PARK.stiffness.copy()  # rigid in shear
    stiffness[:, 1, 3] = stiffness[:, 3, 1] = 1.0
    with pytest.raises(BladeError, match=r"stiffness: entry \(1, 3\) couples a rigid strain"):
        replace(PARK, stiffness=stiffness)


def test_possible_bodies_are_accepted() -> None:
    """Any cloud of point masses is a body; so are a rod, a point, and a section rounded in a table."""
    rng = np.random.default_rng(1)
    for _ in range(200):
        points = rng.normal(size=(rng.integers(1, 9), 3)) * rng.uniform(0.01, 10)
        cloud = sum(inertia(m, 0.0, p) for m, p in zip(rng.uniform(0.1, 5, len(points)), points, strict=True))
        assert body_fault(np.asarray(cloud), "kg") is None
    assert body_fault(section_mass(10.0, 0.01, 0.02)[0] + np.diag([0, 1e-4, 0, 1e-4, 0, 0]), "kg/m") is None
    assert body_fault(np.diag([0, 0, 0, 1.0, 1.0, 1.0]), "kg") is None


def test_offset_masses_keep_their_moments_without_rotary_inertia() -> None:
    """Without moments about the reference curve, those about the mass centre would be negative."""
    bare = without_rotary_inertia(curved())
    centred = bare.mass[:, 3:, 3:] - curved().mass[:, 3:, 3:]
    assert (np.linalg.eigvalsh(centred) <= 1e-9).all()
    first = bare.mass[:, 2, 3]
    np.testing.assert_allclose(bare.mass[:, 3, 3], first**2 / bare.mass[:, 0, 0], rtol=1e-12)
    assert np.isfinite(mesh_modes(bare, 1.0, 8, 4).frequencies).all()


def test_impossible_bodies_of_a_mechanism_are_refused() -> None:
    for matrix, match in (
        (np.diag([1.0, 2, 1, 1, 1, 1]), "the same mass in all directions"),
        (np.diag([1.0, 1, 1, 1, 1, 3]), "none can be larger"),
        (np.diag([-1.0, -1, -1, 1, 1, 1]), "must be positive"),
        (inertia(1.0, 0.0, (1.0, 0, 0)) * np.where(np.arange(6) < 3, 1, 0.5), "symmetric"),
    ):
        with pytest.raises(MechanismError, match=f"body 'b': .*{match}"):
            check_mechanism(mb.Mechanism((mb.Body("b", matrix),), (mb.Joint("j", "revolute", "ground", "b"),)))
