"""Modes followed along speed: crossings and veerings told apart by closed forms, doubts kept."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import simpson
from scipy.interpolate import CubicSpline

from southwell.cases.campbell import tracking
from southwell.cases.campbell.encounters import Encounter, encounters
from southwell.cases.campbell.tracking import Tracks, track
from southwell.cases.judge.pairing import weights
from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.modes import STATIONS, Modes
from southwell.core.participation import participation
from southwell.core.solve import mesh_modes

from ...support.veering import BLADE, EDGE, FLAP, MEETING, oscillators

WEIGHT = weights(BLADE)
SPEEDS = np.linspace(0.0, 6.0, 13)


def met(tracks: Tracks) -> tuple[Encounter, ...]:
    return encounters(tracks, by_track(tracks, BLADE), WEIGHT)


def by_track(tracks: Tracks, blade: Blade) -> np.ndarray:
    """Shares (n, t, 4) of tracks that are there at every speed."""
    shares = [participation(solved, blade) for solved in tracks.solved]
    return np.stack([share[place] for share, place in zip(shares, tracks.mode_index, strict=True)])


@settings(max_examples=25, deadline=None)
@given(coupling=st.floats(0.05, 6.0), first=st.floats(0.0, 0.4))
def test_coupled_oscillators_veer_where_and_as_closely_as_in_closed_form(coupling: float, first: float) -> None:
    tracks = track(oscillators(coupling), SPEEDS + first, WEIGHT, 2)
    (e,) = met(tracks)
    upper, lower = np.sqrt(EDGE + coupling), np.sqrt(EDGE - coupling)
    assert e.kind == "veering"
    assert e.omega == pytest.approx(MEETING, rel=1e-6)
    assert e.gap == pytest.approx(upper - lower, rel=2e-3)  # 2κ in squares, halved by the mean frequency
    assert e.frequency == pytest.approx(np.sqrt(EDGE), rel=1e-3)
    np.testing.assert_array_equal(tracks.mode_index, np.tile([0, 1], (len(tracks.omega), 1)))
    assert not tracks.doubts


def test_a_veering_exchanges_the_shapes_the_closed_form_says() -> None:
    """Flap's share of the lower mode is cos² of half the angle whose tangent is 2κ/δ; past the veering it is edge's."""
    coupling = 1.5
    tracks = track(oscillators(coupling), SPEEDS, WEIGHT, 2)
    (e,) = met(tracks)
    for omega, shares in zip(e.window, (e.before, e.after), strict=True):
        delta = EDGE - FLAP - 2.0 * omega**2
        flap = np.cos(0.5 * np.arctan2(2 * coupling, delta)) ** 2
        np.testing.assert_allclose(shares[:, 0], [flap, 1 - flap], atol=1e-9)
    half = [0.5 * np.arctan2(2 * coupling, EDGE - FLAP - 2.0 * omega**2) for omega in e.window]
    assert e.exchanged == pytest.approx(np.sin(half[1] - half[0]) ** 2, abs=1e-9)
    assert e.exchanged > 0.8
    assert e.complete


def test_uncoupled_oscillators_cross_without_a_step_more_than_asked_for() -> None:
    calls: list[float] = []
    tracks = track(oscillators(0.0, calls), SPEEDS, WEIGHT, 2)
    (e,) = met(tracks)
    assert (e.kind, e.tracks) == ("crossing", (0, 1))
    assert e.omega == pytest.approx(MEETING, rel=1e-9)
    assert e.gap < 1e-9
    assert e.exchanged < 1e-12
    assert calls == list(SPEEDS)
    np.testing.assert_allclose(tracks.frequencies[:, 0], np.sqrt(FLAP + 2 * SPEEDS**2), rtol=1e-12)
    np.testing.assert_allclose(tracks.frequencies[:, 1], np.sqrt(EDGE), rtol=1e-12)


def test_modes_that_coincide_at_a_speed_asked_for_cross_there() -> None:
    tracks = track(oscillators(0.0), [0.0, float(MEETING), 5.0], WEIGHT, 2)
    (e,) = met(tracks)
    assert (e.kind, e.exchanged < 1e-12) == ("crossing", True)
    assert e.omega == pytest.approx(MEETING, rel=1e-6)


@pytest.mark.parametrize("coupling", [0.3, 1e-2])
def test_a_veering_much_narrower_than_the_steps_is_found_by_halving_them(coupling: float) -> None:
    """Between 2.5 and 3 rad/s shapes swap with MAC above 0.99: as they stand, a crossing."""
    coarse = [oscillators(coupling)(omega) for omega in (2.5, 3.5)]
    overlap = tracking.mac(coarse[0].shapes[:1], coarse[1].shapes[1:2], WEIGHT)
    assert overlap.item() > 0.98
    calls: list[float] = []
    tracks = track(oscillators(coupling, calls), SPEEDS, WEIGHT, 2)
    (e,) = met(tracks)
    assert e.kind == "veering"
    assert e.gap == pytest.approx(coupling / np.sqrt(EDGE), rel=2e-3)
    assert len(SPEEDS) < len(calls) < len(SPEEDS) + 30
    assert np.diff(tracks.omega).min() >= tracks.smallest * (1 - 1e-9)


def test_an_unresolved_encounter_is_a_crossing_with_a_bounded_gap() -> None:
    coupling = 1e-4
    tracks = track(oscillators(coupling), SPEEDS, WEIGHT, 2)
    (e,) = met(tracks)
    assert e.kind == "crossing"
    true = coupling / np.sqrt(EDGE)
    assert true * 0.9 < e.gap < 1.5 * true
    assert e.omega == pytest.approx(MEETING, abs=tracks.smallest)


def test_an_ambiguous_succession_is_reported() -> None:
    """No smaller steps allowed: up to the veering's middle the shapes have turned by 45° less what they were turned at rest."""
    coupling = 2.0
    tracks = track(oscillators(coupling), [0.0, float(MEETING), 6.0], WEIGHT, 2, smallest_step=1.0)
    turned = np.pi / 4 - 0.5 * np.arctan2(2 * coupling, EDGE - FLAP)
    first = [d for d in tracks.doubts if d.omega[0] == 0.0]
    assert {d.track for d in first} == {0, 1}
    for d in first:
        assert (d.mac, d.rival) == (pytest.approx(np.cos(turned) ** 2), pytest.approx(np.sin(turned) ** 2))


def test_flap_and_edge_of_a_uniform_beam_cross() -> None:
    """Square beam, hub ratio 0, rotated: from rest flap rises above edge. EI_z smaller: the two cross, and do not couple.

    With the edgewise motion's softening ω_c² = ω_f² − Ω² (Schilhansl 1958) at equal stiffness; here edge starts higher.
    """
    beam = uniform_blade("beam", 6.0, 0.3, EA=2.8e7, GJ=1.2e4, EI_y=1.4e4, EI_z=1.8e4, mass=1.2, I_y=6e-4, I_z=6e-4)
    speeds = np.linspace(0.0, 20.0, 6)
    weight = weights(beam)
    tracks = track(lambda omega: mesh_modes(beam, omega, 12, 6), speeds, weight, 4)
    np.testing.assert_array_equal(tracks.omega, speeds)
    shares = by_track(tracks, beam)
    result = encounters(tracks, shares, weight)
    assert {e.kind for e in result} == {"crossing"}
    first = next(e for e in result if e.tracks == (0, 1))
    assert first.gap < 1e-6
    pair = mesh_modes(beam, first.omega, 12, 2).frequencies
    assert pair[1] / pair[0] - 1 < 1e-3
    assert pair.mean() == pytest.approx(first.frequency, rel=1e-3)
    for t in range(4):
        assert np.ptp(shares[:, t, 0]) < 1e-6  # each keeps its motion


def test_a_mode_that_dives_among_the_lowest_is_followed_from_the_start() -> None:
    def solve(omega: float) -> Modes:
        squares = np.array([10.0 + omega**2, 50.0, 90.0 - 2 * omega**2])
        shapes = np.zeros((3, 21, 4), complex)
        for k, column in enumerate((2, 1, 0)):
            shapes[k, :, column] = STATIONS
        order = np.argsort(squares)
        return Modes(omega, np.sqrt(squares[order]), shapes[order], 10)

    tracks = track(solve, np.linspace(0.0, 6.0, 7), WEIGHT, 2)
    assert tracks.count == 3
    np.testing.assert_allclose(tracks.frequencies[-1] ** 2, [46.0, 50.0, 18.0], rtol=1e-12)


def test_a_shape_that_has_no_successor_ends_its_track_and_another_begins() -> None:
    def solve(omega: float) -> Modes:
        shapes = np.zeros((2, 21, 4), complex)
        shapes[0, :, 2] = STATIONS
        shapes[1, :, 1 if omega < 2.2 else 0] = STATIONS
        return Modes(omega, np.array([5.0, 9.0]), shapes, 10)

    tracks = track(solve, [0.0, 1.0, 2.0, 3.0], WEIGHT, 2)
    assert tracks.count == 3
    assert np.isnan(tracks.frequencies[-1, 1])
    assert np.isnan(tracks.frequencies[0, 2])
    assert [(d.track, d.mac) for d in tracks.doubts] == [(1, 0.0)]
    low, high = tracks.doubts[0].omega
    assert low < 2.2 <= high
    assert high - low <= tracks.smallest * (1 + 1e-9)


def test_a_mode_of_another_shape_is_no_successor() -> None:
    """MAC 0.3: the mode of the next speed is nearest to the lost one, and still another."""

    def solve(omega: float) -> Modes:
        shapes = np.zeros((2, 21, 4), complex)
        shapes[0, :, 2] = shapes[1, :, 1] = STATIONS
        if omega > 2.2:
            shapes[1, :, 1], shapes[1, :, 0] = np.sqrt(0.3) * STATIONS, np.sqrt(0.7) * STATIONS
        return Modes(omega, np.array([5.0, 9.0]), shapes, 10)

    tracks = track(solve, [0.0, 1.0, 2.0, 3.0], WEIGHT, 2)
    assert tracks.count == 3
    assert [(d.track, d.mac) for d in tracks.doubts] == [(1, 0.0)]


def test_frequencies_without_a_stated_uncertainty_have_none_in_the_tracks() -> None:
    def solve(omega: float) -> Modes:
        return replace(oscillators(1.0)(omega), uncertainty=np.zeros(0))

    assert np.isinf(track(solve, SPEEDS, WEIGHT, 2).uncertainty).all()


def test_speeds_out_of_order_are_refused() -> None:
    with pytest.raises(ValueError, match="not ascending"):
        track(oscillators(0.0), [1.0, 0.5], WEIGHT, 2)


def test_modes_that_approach_without_exchange_are_no_encounter() -> None:
    """Flap at 8 rad/s, edge at 8.1 + (Ω − 3)²: nearest at 3 rad/s, uncoupled."""

    def solve(omega: float) -> Modes:
        shapes = np.zeros((2, 21, 4), complex)
        shapes[0, :, 2] = shapes[1, :, 1] = STATIONS
        return Modes(omega, np.array([8.0, 8.1 + (omega - 3.0) ** 2]), shapes, 10)

    assert met(track(solve, SPEEDS, WEIGHT, 2)) == ()


def test_a_slight_twist_opens_the_crossing_by_as_much_as_perturbation_theory_says() -> None:
    """κ = ∫ (EI_z − EI_y) θ φ_f″ φ_e″ ds of the untwisted blade's modes, and the gap is κ/ω (Leissa 1974)."""
    s = np.linspace(0.0, 20.0, 11)
    straight = Blade(
        "straight",
        stations=s,
        stiffness=np.repeat(section_stiffness(1e9, 4e7, 4e6, 9e6), 11, axis=0),
        mass=np.repeat(section_mass(40.0, 0.3, 0.3), 11, axis=0),
        twist=np.zeros(11),
        hub_radius=1.0,
    )
    speeds, weight = np.linspace(0.0, 8.0, 11), weights(straight)
    twisted = replace(straight, twist=np.radians(1.0 - s / 20.0))

    def met_by(blade: Blade) -> Encounter:
        tracks = track(lambda omega: mesh_modes(blade, omega, 20, 4), speeds, weight, 2)
        (e,) = encounters(tracks, by_track(tracks, blade), weight)
        return e

    crossing, veering = met_by(straight), met_by(twisted)
    assert (crossing.kind, veering.kind) == ("crossing", "veering")
    shapes = mesh_modes(straight, crossing.omega - 0.2, 20, 2).shapes
    fine = np.linspace(0.0, 20.0, 401)
    flap, edge = (CubicSpline(20.0 * STATIONS, shapes[k, :, column].real) for k, column in ((0, 2), (1, 1)))
    size = [40.0 * simpson(shape(fine) ** 2, x=fine) for shape in (flap, edge)]
    coupling = simpson(5e6 * np.radians(1.0 - fine / 20.0) * flap(fine, 2) * edge(fine, 2), x=fine)
    expected = abs(coupling) / np.sqrt(size[0] * size[1]) / crossing.frequency
    assert veering.gap == pytest.approx(expected, rel=0.01)
    assert veering.omega == pytest.approx(crossing.omega, rel=1e-3)
