"""Changes of a blade's properties: each scales what it says, exactly, and nothing else."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.cases.input.changes import apply, parse
from southwell.cases.input.errors import CaseError
from southwell.cases.input.properties import sections
from southwell.core.blade import AXIAL, BEND_Y, BEND_Z, TORSION, Blade, uniform_blade
from southwell.core.solve import mesh_modes
from southwell.core.space import spatial as sp

E_I_Y, E_I_Z, EA, GJ, MASS = 4e4, 9e4, 3e7, 2e4, 5.0


def plain() -> Blade:
    return uniform_blade("beam", 10.0, 1.0, EA=EA, GJ=GJ, EI_y=E_I_Y, EI_z=E_I_Z, mass=MASS)


def offset() -> Blade:
    """The same sections about another reference axis: 0.1 m and 0.2 m away, with shear that is not rigid."""
    blade = plain()
    stiffness = np.where(np.isinf(blade.stiffness), 0.0, blade.stiffness)
    stiffness[:, 1, 1], stiffness[:, 2, 2] = 2e6, 3e6
    move = sp.adjoint(sp.pose(np.eye(3), np.array([0.0, 0.1, 0.2])))
    return replace(blade, stiffness=move.T @ stiffness @ move)


@pytest.mark.parametrize("blade", [plain(), offset()], ids=["plain", "offset"])
@pytest.mark.parametrize("name", ["EI_flap", "EI_edge", "GJ", "EA"])
def test_a_stiffness_is_scaled_about_its_own_centre_and_all_else_stays(blade: Blade, name: str) -> None:
    before, after = sections(blade), sections(apply(blade, [parse(f"{name}=*1.3")]))
    for other in ("EI_flap", "EI_edge", "GJ", "EA"):
        factor = 1.3 if other == name else 1.0
        np.testing.assert_allclose(getattr(after, other), factor * getattr(before, other), rtol=1e-9)
    for centre in ("mass_centre", "tension_centre", "shear_centre"):
        np.testing.assert_allclose(getattr(after, centre), getattr(before, centre), atol=1e-9)


@pytest.mark.parametrize(("name", "strain"), [("EI_flap", BEND_Y), ("EI_edge", BEND_Z), ("GJ", TORSION), ("EA", AXIAL)])
def test_a_small_factor_loses_no_digits(name: str, strain: int) -> None:
    """A factor of 1e-14 once left what rounding had made of the stiffness; one that leaves nothing is refused."""
    small = apply(plain(), [parse(f"{name}=*1e-14")])
    np.testing.assert_allclose(
        small.stiffness[:, strain, strain], 1e-14 * plain().stiffness[:, strain, strain], rtol=1e-12
    )
    with pytest.raises(CaseError, match="stiffness: diagonal"):
        apply(plain(), [parse(f"{name}=*1e-200")])


def test_frequencies_at_rest_follow_the_square_root() -> None:
    """ω ∝ √(EI/m) of a uniform beam without rotary inertia: flapwise with EI_flap, all bending with mass."""
    base = mesh_modes(plain(), 0.0, 24, 2).frequencies  # flapwise 1, edgewise 1
    stiff = mesh_modes(apply(plain(), [parse("EI_flap=*1.21")]), 0.0, 24, 2).frequencies
    heavy = mesh_modes(apply(plain(), [parse("mass=*1.21")]), 0.0, 24, 2).frequencies
    np.testing.assert_allclose(stiff, base * [1.1, 1.0], rtol=1e-6)
    np.testing.assert_allclose(heavy, base / 1.1, rtol=1e-6)


def test_numbers_are_set_in_their_unit_and_scaled() -> None:
    assert apply(plain(), [parse("pitch=2.5")]).pitch == pytest.approx(np.radians(2.5), rel=1e-15)
    assert apply(plain(), [parse("hub_radius=*2")]).hub_radius == 2.0
    assert apply(plain(), [parse("hub_radius=3"), parse("hub_radius=*2")]).hub_radius == 6.0


@pytest.mark.parametrize(
    ("text", "phrase"),
    [
        ("EI_flap", "not NAME=*FACTOR or NAME=VALUE"),
        ("EI_flap=*1..2", "not NAME=*FACTOR"),
        ("pitch=.", "not NAME=*FACTOR"),
        ("EI_flap=1.1", "varies along the blade: give a factor, as in EI_flap=*1.1"),
        ("EI_flp=*1.1", "did you mean EI_flap?"),
        ("mass=*0", "a factor is positive"),
        ("mass=*-1", "a factor is positive"),
        ("twist=*2", "is zero in this blade"),
        ("tip_mass=*2", "is zero in this blade"),
        ("hub_radius=-1", "hub_radius"),
    ],
)
def test_a_change_that_cannot_be_made_is_refused_by_name(text: str, phrase: str) -> None:
    with pytest.raises(CaseError, match="--set") as raised:
        apply(plain(), [parse(text)])
    assert phrase in str(raised.value)
    assert "\n" not in str(raised.value)


def test_a_rigid_stiffness_is_not_silently_left_alone() -> None:
    stiffness = plain().stiffness.copy()
    stiffness[:, 3, 3] = np.inf
    with pytest.raises(CaseError, match="GJ is rigid"):
        apply(replace(plain(), stiffness=stiffness), [parse("GJ=*2")])
