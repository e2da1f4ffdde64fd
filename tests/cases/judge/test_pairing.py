"""Modes find their partners by shape: whatever the order, scale, phase, or basis of a degenerate space."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from southwell.cases.judge.pairing import aligned, groups, mac, pair, weights
from southwell.cases.judge.spectrum import Spectrum, of_blade
from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.modes import STATIONS, Modes
from southwell.core.participation import families, participation

BLADE = uniform_blade("beam", 6.0, 0.3, EA=1e7, GJ=1e3, EI_y=1e4, EI_z=1.4e4, mass=1.2, I_y=1e-3, I_z=2e-3)
WEIGHT = weights(BLADE)
AXIAL, CHORD, FLAP, TORSION = range(4)
TURN = st.floats(0.0, 2 * np.pi)


def shape(column: int, waves: float) -> np.ndarray:
    """Something orthogonal to the same with another odd number of quarter waves."""
    out = np.zeros((21, 4), complex)
    out[:, column] = np.sin(waves * np.pi / 2 * STATIONS)
    return out


def blade_modes(frequencies: list[float], shapes: list[np.ndarray]) -> Modes:
    return Modes(10.0, np.array(frequencies), np.array(shapes), 10)


def modes(frequencies: list[float], shapes: list[np.ndarray]) -> Spectrum:
    return of_blade(blade_modes(frequencies, shapes), WEIGHT)


REFERENCE = modes([10.0, 15.0, 70.0, 71.0], [shape(CHORD, 1), shape(FLAP, 1), shape(CHORD, 3), shape(FLAP, 3)])


def test_weights_add_up_to_the_blades_mass_and_inertia() -> None:
    total = WEIGHT.sum(0)
    np.testing.assert_allclose(np.diag(total), [7.2, 7.2, 7.2, 6 * 3e-3], rtol=1e-12)


def test_weights_integrate_a_tapered_blade_and_its_tip_mass() -> None:
    tip = np.diag([2.0, 2.0, 2.0, 0.1, 0.05, 0.05])
    blade = Blade(
        "tapered",
        stations=np.array([0.0, 4.0]),
        stiffness=np.repeat(section_stiffness(1.0, 1.0, 1.0, 1.0), 2, axis=0),
        mass=section_mass([3.0, 1.0]),
        twist=np.zeros(2),
        tip_mass=tip,
    )
    assert weights(blade)[:, 2, 2].sum() == pytest.approx(8.0 + 2.0)


def test_weights_turn_an_offset_mass_with_twist_and_pitch() -> None:
    """Mass 1 kg/m, its centre at y = 0.5 m in section axes: rotation about x moves it along z; turned by 90°, along −y."""
    mass = section_mass([1.0, 1.0])
    mass[:, 2, 3] = mass[:, 3, 2] = 0.5
    mass[:, 0, 5] = mass[:, 5, 0] = -0.5
    mass[:, 3, 3] = mass[:, 5, 5] = 0.25
    for twist, pitch in ((np.pi / 2, 0.0), (0.0, np.pi / 2)):
        total = weights(replace(BLADE, mass=mass, twist=np.full(2, twist), pitch=pitch)).sum(0)
        np.testing.assert_allclose(total[3], [0.0, -3.0, 0.0, 1.5], atol=1e-12)


@given(st.permutations(range(4)), st.tuples(TURN, TURN, TURN, TURN))
def test_order_scale_and_phase_do_not_matter(order: list[int], phases: tuple[float, ...]) -> None:
    shapes = [3.0 * np.exp(1j * phases[k]) * REFERENCE.shapes[k] for k in order]
    other = modes([1.0, 2.0, 3.0, 4.0], shapes)
    pairs = pair(REFERENCE, other, range(4))
    assert [order[p.mode] for p in pairs if p.mode is not None] == [0, 1, 2, 3]
    assert all(p.mac == pytest.approx(1.0) and not p.note for p in pairs)


def test_the_index_of_a_mode_does_not_matter_however_close_the_choice_is() -> None:
    """Two modes exchanged and mixed by 43°: MAC 0.535 with the partner, 0.465 with the mode of the same index."""
    c, s, (a, b, *_) = np.cos(np.radians(43.0)), np.sin(np.radians(43.0)), REFERENCE.shapes
    pairs = pair(
        modes([10.0, 15.0], [a, b]), modes([10.0, 15.0], [c * b - s * a, c * a + s * b]), range(2), min_mac=0.5
    )
    assert [p.mode for p in pairs] == [1, 0]


def test_the_lag_of_a_gyroscopic_mode_counts() -> None:
    lead = REFERENCE.shapes[0] + 1j * shape(AXIAL, 1)
    assert mac(np.array([lead]), np.array([lead.conj()]), WEIGHT)[0, 0] == pytest.approx(0.0, abs=1e-12)


def test_metres_and_radians_are_weighed_by_mass() -> None:
    """A metre of flap with a whole radian of twist is still flapping: I/ρA = 0.0025 m²."""
    both, flap = np.array([shape(FLAP, 1) + shape(TORSION, 1)]), np.array([shape(FLAP, 1)])
    assert mac(both, flap, WEIGHT)[0, 0] == pytest.approx(1 / 1.0025)


def test_mass_between_two_common_stations_counts() -> None:
    """A body of 10 kg in 0.02 m of 2 m, at 0.725 of the length: half of it belongs to each neighbour's shape."""
    stations = np.array([0.0, 1.439, 1.44, 1.46, 1.461, 2.0])
    mass = section_mass([1.0, 1.0, 500.0, 500.0, 1.0, 1.0])
    k = np.repeat(section_stiffness(1.0, 1.0, 1.0, 1.0), 6, axis=0)
    weight = weights(Blade("body", stations, k, mass, np.zeros(6)))[:, 2, 2]
    body = 0.02 * 500.0 + 2 * 0.001 * 0.5 * 499.0 - 0.02
    np.testing.assert_allclose(weight[14:16], body / 2 + 0.1, rtol=1e-2)
    assert weight.sum() == pytest.approx(2.0 + body)


@given(TURN, TURN)
def test_a_degenerate_pair_is_compared_as_a_subspace(angle: float, phase: float) -> None:
    reference = modes([10.0, 10.0, 70.0], [shape(CHORD, 1), shape(FLAP, 1), shape(CHORD, 3)])
    c, s, e = np.cos(angle), np.sin(angle), np.exp(1j * phase)
    a, b = reference.shapes[0], reference.shapes[1]
    other = modes([10.001, 10.002, 70.0], [c * a + e * s * b, -s * a + e * c * b, reference.shapes[2]])
    first, second, third = pair(reference, other, range(3))
    assert {first.mode, second.mode} == {0, 1}
    assert third.mode == 2
    for answer in (first, second):  # at every angle, also where the shapes alone are alike
        assert "subspace of 2" in answer.note
        assert answer.mac == pytest.approx(1.0)


def test_a_subspace_that_is_not_the_same_has_no_partner() -> None:
    reference = modes([10.0, 10.0], [shape(CHORD, 1), shape(FLAP, 1)])
    mixed = (shape(CHORD, 1) + shape(FLAP, 1)) / np.sqrt(2)
    other = modes([10.0, 10.0], [mixed, shape(TORSION, 1)])
    for result in pair(reference, other, range(2)):
        assert result.mode is None
        assert "no partner: its most similar mode, at 10 rad/s, has MAC" in result.note


def test_shapes_that_are_one_and_the_same_twice_are_no_pair() -> None:
    reference = modes([10.0, 10.0], [shape(CHORD, 1), shape(FLAP, 1)])
    mixed = shape(CHORD, 1) + shape(FLAP, 1)
    assert [p.mode for p in pair(reference, modes([10.0, 10.0], [mixed, mixed]), range(2))] == [None, None]


def test_distinct_frequencies_are_not_excused_as_a_subspace() -> None:
    turned = [(shape(CHORD, 1) + shape(FLAP, 1)) / np.sqrt(2), (shape(CHORD, 1) - shape(FLAP, 1)) / np.sqrt(2)]
    pairs = pair(REFERENCE, modes([10.0, 15.0], turned), [0])
    assert pairs[0].mode is None


def test_a_missing_mode_has_no_partner_and_does_not_take_another_ones() -> None:
    other = modes([10.0, 70.0, 71.0], [REFERENCE.shapes[k] for k in (0, 2, 3)])
    pairs = pair(REFERENCE, other, range(4))
    assert [p.mode for p in pairs] == [0, None, 1, 2]


def test_a_rival_is_mentioned() -> None:
    rival = 0.75 * REFERENCE.shapes[0] + 0.6 * shape(AXIAL, 1)
    pairs = pair(REFERENCE, modes([10.0, 12.0], [REFERENCE.shapes[0], rival]), [0])
    assert pairs[0].mode == 0
    assert pairs[0].note.startswith("ambiguous: MAC 0.61 with 12 rad/s")
    assert pairs[0].ambiguous


def test_modes_as_alike_as_those_of_the_reference_are_no_rivals() -> None:
    """Two modes of a turbine may differ mostly in what is not compared; a third one as alike, which core lacks, is a rival."""
    mostly = 0.75 * shape(FLAP, 1) + 0.6 * shape(AXIAL, 1)
    reference = modes([10.0, 19.0], [shape(FLAP, 1), mostly])
    answer = modes([10.0, 19.0], list(reference.shapes))
    assert [(p.mode, p.note) for p in pair(reference, answer, range(2))] == [(0, ""), (1, "")]
    ghost = 0.75 * shape(FLAP, 1) + 0.6 * shape(CHORD, 1)
    (first, _) = pair(reference, modes([10.0, 12.0, 19.0], [shape(FLAP, 1), ghost, mostly]), range(2))
    assert first.mode == 0
    assert first.ambiguous


def test_a_rival_of_nearly_the_same_frequency_is_not_ambiguous() -> None:
    """Two modes 0.1 % apart may be any combination of two shapes."""
    rival = 0.75 * REFERENCE.shapes[0] + 0.6 * shape(AXIAL, 1)
    (partner,) = pair(REFERENCE, modes([10.0, 10.01], [REFERENCE.shapes[0], rival]), [0])
    assert partner.note
    assert not partner.ambiguous


def test_without_modes_there_is_no_partner() -> None:
    empty = of_blade(Modes(0.0, np.zeros(0), np.zeros((0, 21, 4), complex), 1))
    assert pair(REFERENCE, empty, [0])[0].mode is None


def test_motion_without_mass_matches_no_mode() -> None:
    massless = uniform_blade("beam", 6.0, 0.3, EA=1e7, GJ=1e3, EI_y=1e4, EI_z=1.4e4, mass=1.2)
    twisting = np.array([shape(TORSION, 1)])
    assert mac(twisting, twisting, weights(massless))[0, 0] == 0.0


@given(TURN)
def test_equal_frequencies_are_turned_to_one_motion_each(angle: float) -> None:
    c, s = np.cos(angle), np.sin(angle)
    a, b = shape(CHORD, 1), shape(FLAP, 1)
    turned = aligned(blade_modes([10.0, 10.0], [c * a + s * b, -s * a + c * b]), WEIGHT)
    energies = participation(turned, BLADE)
    assert sorted(families(energies)) == ["edgewise", "flapwise"]
    assert energies.max(1) == pytest.approx([1.0, 1.0])


def test_groups_chain_close_neighbours() -> None:
    assert groups(np.array([1.0, 1.001, 1.002, 2.0, 3.0, 3.0])) == [[0, 1, 2], [3], [4, 5]]
