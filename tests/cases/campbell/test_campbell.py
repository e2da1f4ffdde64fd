"""The Campbell diagram's numbers against closed forms; its figures and tables say what the numbers do."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from scipy.special import jn_zeros

from southwell.cases.campbell import confirmation
from southwell.cases.campbell.diagram import Campbell, CampbellRequest, campbell
from southwell.cases.campbell.lines import line_of
from southwell.cases.campbell.margins import margins
from southwell.cases.campbell.prestress import STANDARD_GRAVITY, gravity
from southwell.cases.campbell.required import RequiredMargin, required_margin
from southwell.cases.campbell.sweep import sweep
from southwell.cases.campbell.tracked import tracked
from southwell.cases.input import library
from southwell.cases.input.errors import CaseError
from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.modes import STATIONS, Modes
from southwell.core.solve import mesh_modes, modes
from southwell.reports.campbell import csv_tables, encounters
from southwell.reports.campbell.figure import draw
from southwell.reports.campbell.marks import blend
from southwell.reports.campbell.tables import sheets, verdict
from southwell.reports.shared.sheets import markdown
from southwell.reports.shared.style import save
from southwell.reports.shared.units import RAD_S, RPM

from ...support.veering import BLADE, EDGE, FLAP, oscillators

RPM_TO = np.pi / 30


def southwell(omega: float) -> Modes:
    """A flap mode ``ω² = 4 + 1.5 Ω²`` and an edge mode ``ω² = 9 + 0.5 Ω²``, exactly."""
    shapes = np.zeros((2, 21, 4), complex)
    shapes[0, :, 2] = shapes[1, :, 1] = STATIONS**2
    squares = np.array([4.0 + 1.5 * omega**2, 9.0 + 0.5 * omega**2])
    order = np.argsort(squares)
    return Modes(omega, np.sqrt(squares[order]), shapes[order], 10, uncertainty=np.zeros(2))


def diagram(**changes: object) -> Campbell:
    request = CampbellRequest(tuple(np.linspace(0.0, 4.0, 17)), modes=2, per_rev=(1, 2, 3), operating=(1.0, 2.0))
    return campbell(BLADE, replace(request, **changes), southwell)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def veering() -> Campbell:
    request = CampbellRequest(tuple(np.linspace(0.0, 6.0, 13)), modes=3, per_rev=(1, 2, 3), operating=(1.5, 5.0))
    return campbell(BLADE, request, oscillators(1.5))


def test_southwells_coefficients_are_those_the_modes_were_made_with() -> None:
    flap, edge = diagram().southwell
    assert flap is not None
    assert edge is not None
    assert (flap.at_rest, flap.coefficient) == (pytest.approx(2.0, rel=1e-12), pytest.approx(1.5, rel=1e-12))
    assert (edge.at_rest, edge.coefficient) == (pytest.approx(3.0, rel=1e-12), pytest.approx(0.5, rel=1e-12))
    assert max(flap.residual, edge.residual) < 1e-12


def test_a_fits_residual_is_its_largest_deviation() -> None:
    """ω² = 4 + Ω⁴ at Ω = 0, 1, 2: least squares gives a = 10/3…, by hand: Ω² = (0, 1, 4), ω² = (4, 5, 20)."""
    bent = lambda omega: replace(southwell(omega), frequencies=np.sqrt([4.0 + omega**4, 400.0 + omega**2]))  # noqa: E731
    result = campbell(BLADE, CampbellRequest((0.0, 1.0, 2.0), modes=2), bent).southwell[0]
    x, y = np.array([0.0, 1.0, 4.0]), np.array([4.0, 5.0, 20.0])
    slope = ((x - x.mean()) * (y - y.mean())).sum() / ((x - x.mean()) ** 2).sum()
    rest = y.mean() - slope * x.mean()
    assert result is not None
    assert result.coefficient == pytest.approx(slope, rel=1e-12)
    assert result.residual == pytest.approx(np.abs(np.sqrt((rest + slope * x) / y) - 1).max(), rel=1e-9)


def test_resonances_are_where_the_closed_form_says() -> None:
    """ω₀² + φ Ω² = n² Ω² at Ω = ω₀ / √(n² − φ): flap never meets 1P; within 4 rad/s edge meets 1P not."""
    result = {(r.track, r.per_rev): r for r in diagram().resonances}
    expected = {(0, n): 2.0 / np.sqrt(n**2 - 1.5) for n in (2, 3)} | {(1, n): 3.0 / np.sqrt(n**2 - 0.5) for n in (2, 3)}
    assert set(result) == set(expected)
    for key, omega in expected.items():
        assert result[key].omega == pytest.approx(omega, rel=1e-9)
        assert result[key].frequency == pytest.approx(key[1] * omega, rel=1e-9)


def test_a_resonances_distance_from_the_operating_range_is_to_its_nearer_end() -> None:
    result = {(r.track, r.per_rev): r.distance for r in diagram(operating=(0.8, 1.0)).resonances}
    assert result[0, 3] == pytest.approx(2.0 / np.sqrt(7.5) / 0.8 - 1)  # 0.730 rad/s: below
    assert result[1, 2] == pytest.approx(3.0 / np.sqrt(3.5) / 1.0 - 1)  # 1.604 rad/s: above
    inside = {(r.track, r.per_rev): r.distance for r in diagram(operating=(0.7, 2.0)).resonances}
    assert inside[0, 3] == inside[1, 2] == 0.0
    assert all(r.distance is None for r in diagram(operating=None).resonances)


def test_the_uncertainty_of_a_coefficient_and_of_a_margin_is_that_of_the_frequencies() -> None:
    """Relative u: the slope's is Σ |x − x̄| 2 u ω²/Σ (x − x̄)² over x = Ω², a margin's is u ω/(n Ω)."""
    u = 1e-4
    doubtful = lambda omega: replace(southwell(omega), uncertainty=np.full(2, u))  # noqa: E731
    speeds = (0.0, 1.0, 2.0, 3.0)
    request = CampbellRequest(speeds, modes=2, per_rev=(1,), operating=(1.0, 2.0))
    result = campbell(BLADE, request, doubtful)
    x = np.array(speeds) ** 2
    weight = np.abs(x - x.mean()) / ((x - x.mean()) ** 2).sum()
    (flap, _) = result.southwell
    assert flap is not None
    assert flap.uncertainty == pytest.approx((weight * 2.0 * u * (4.0 + 1.5 * x)).sum(), rel=1e-9)
    margin = next(m for m in result.margins if m.track == 0)
    assert margin.uncertainty == pytest.approx(u * np.sqrt(10.0) / 2.0, rel=1e-6)


def test_a_line_that_does_not_span_the_operating_range_has_no_margin() -> None:
    request = CampbellRequest((1.0, 1.5, 2.0), modes=1, per_rev=(1,))
    line = line_of(campbell(BLADE, request, southwell).tracks, 0)
    for low, high, count in ((1.0, 2.0, 1), (0.5, 2.0, 0), (1.0, 2.5, 0)):
        assert len(margins([line], (), (1,), (low, high), RequiredMargin(0.1))) == count


def test_margins_at_the_ends_and_the_least_are_those_of_the_closed_form() -> None:
    result = {(m.track, m.per_rev): m for m in diagram().margins}
    assert len(result) == 6
    for (t, n), m in result.items():
        square = (lambda o: 4 + 1.5 * o**2, lambda o: 9 + 0.5 * o**2)[t]
        ends = [np.sqrt(square(o)) / (n * o) - 1 for o in (1.0, 2.0)]
        assert (m.low, m.high) == (pytest.approx(ends[0], rel=1e-9), pytest.approx(ends[1], rel=1e-9))
        meets = ends[0] * ends[1] < 0
        assert m.smallest == pytest.approx(0.0 if meets else min(ends, key=abs), rel=1e-9)
        assert m.kept == (abs(m.smallest) >= 0.1)
    assert not result[0, 2].kept
    assert result[0, 2].uncertainty == 0.0
    assert result[0, 2].omega == pytest.approx(2.0 / np.sqrt(2.5), rel=1e-9)


def test_a_margin_is_judged_by_what_the_user_asks() -> None:
    """Flap at 2 rad/s is √10 rad/s, 58 % above 1P."""
    exact = np.sqrt(10.0) / 2.0 - 1.0
    for margin, is_kept in ((exact - 1e-6, True), (exact + 1e-6, False)):
        (result,) = (m for m in diagram(margin=RequiredMargin(margin), per_rev=(1,)).margins if m.track == 0)
        assert result.kept is is_kept


def test_a_margin_in_hertz_is_the_distance_itself() -> None:
    """Flap √(4 + 1.5 Ω²) at 1 and 2 rad/s: 1.3452 and 1.1623 rad/s above 1P, 0.18498 Hz at the nearer end."""
    ends = [np.sqrt(4 + 1.5 * o**2) - o for o in (1.0, 2.0)]
    exact = ends[1] / (2 * np.pi)
    for text, is_kept in ((f"{exact - 1e-6}Hz", True), (f"{exact + 1e-6} Hz", False), (f"{ends[1] - 1e-6}rad/s", True)):
        result = diagram(margin=required_margin(text), per_rev=(1,))
        (flap,) = (m for m in result.margins if m.track == 0)
        assert (flap.low, flap.high) == pytest.approx(ends, rel=1e-9)
        assert flap.kept is is_kept
    assert "stays at least 0.1 Hz away" in verdict(diagram(margin=required_margin("0.1Hz"), per_rev=(1,)), RAD_S)
    margins = next(s for s in sheets(result, RAD_S) if s.title.startswith("Margins"))
    assert margins.rows[0][1] == "+1.35…+1.16"
    assert "in rad/s" in margins.note


def test_lines_are_confirmed_at_the_stated_ends_of_the_operating_range() -> None:
    """With 6.9:12.1 rpm they once were confirmed at 6.6 rpm, the nearest requested speed."""
    result = diagram(operating=(1.03, 1.97))
    assert confirmation.speeds(result) == (1.03, 1.97)
    assert {1.03, 1.97} <= set(result.tracks.omega.tolist())
    assert confirmation.speeds(diagram(operating=None)) == (0.0, 4.0)
    nearly = diagram(operating=(1.0 + 1e-12, 2.0 - 1e-12))
    assert confirmation.speeds(nearly) == (1.0, 2.0)
    assert len(set(nearly.tracks.omega.tolist())) == len(set(np.round(nearly.tracks.omega, 9)))


def test_an_operating_range_from_rest_and_one_of_a_single_speed() -> None:
    from_rest = {(m.track, m.per_rev): m for m in diagram(operating=(0.0, 2.0)).margins}
    assert from_rest[0, 1].low > 1e6
    assert from_rest[0, 1].smallest == pytest.approx(np.sqrt(10.0) / 2.0 - 1.0)
    at_one = {(m.track, m.per_rev): m for m in diagram(operating=(2.0, 2.0)).margins}
    assert at_one[0, 1].low == at_one[0, 1].high == pytest.approx(np.sqrt(10.0) / 2.0 - 1.0)


@pytest.mark.parametrize(
    ("changes", "phrase"),
    [
        ({"speeds": (1.0,)}, "speeds: 1 given: a diagram needs at least two"),
        ({"operating": (1.0, 4.5)}, "operating range: 1 to 4.5 rad/s is not within the speeds, 0 to 4 rad/s"),
        ({"speeds": (1.0, 3.0), "operating": (0.5, 2.0)}, "not within the speeds"),
    ],
)
def test_invalid_requests_are_reported(changes: dict[str, object], phrase: str) -> None:
    with pytest.raises(CaseError, match=phrase):
        diagram(**changes)


def test_a_veering_mode_has_its_names_before_and_after(veering: Campbell) -> None:
    labels = veering.labels
    assert [labels[t] for t in range(3)] == ["flapwise 1 → edgewise", "edgewise 1 → flapwise", "flapwise 2"]
    assert labels.names == ("flapwise 1", "edgewise 1", "flapwise 2")
    assert [labels.at(0, omega) for omega in (0.1, 5.9)] == ["flapwise 1", "flapwise 1 (edgewise)"]
    assert labels.over(0, 0.0, 1.0) == "flapwise 1"
    assert labels.over(0, 1.0, 5.0) == "flapwise 1 → edgewise"
    assert labels.over(0, 5.0, 5.9) == "flapwise 1 (edgewise)"


def test_a_speed_without_steady_state_is_reported() -> None:
    blade = library.load("park-cantilever").variants[0].blade
    with pytest.raises(
        CaseError, match=r"speed: 100000 rad/s: .*unstable, with an axial or shear strain of \d+%.*lower the speed"
    ):
        campbell(blade, CampbellRequest((0.0, 1e5), modes=2, elements=8))


@pytest.mark.slow
def test_core_has_the_modes_at_n_per_revolution_where_the_diagram_says() -> None:
    blade = library.load("park-blade").variants[0].blade
    result = campbell(blade, CampbellRequest(tuple(np.arange(0.0, 31.0, 5.0) * RPM_TO), modes=3, elements=15))
    assert len(result.resonances) >= 4
    for r in result.resonances:
        solved = modes(blade, r.omega, 15, 3).frequencies
        assert np.abs(solved / (r.per_rev * r.omega) - 1).min() < 2e-5


@pytest.mark.slow
def test_frequencies_of_the_surrogate_rise_as_the_papers_do() -> None:
    """Park et al. (2010), Fig. 3: by at most 8 % at 20 rpm and 16.5 % at 30 rpm, in the first mode.

    Their blade is unpublished. The surrogate has its rise, converged and with the paper's discretisation.
    """
    case = library.load("park-blade")
    lumping = case.text.discretisation
    assert lumping is not None
    for variant in case.variants[1:]:

        def lumped(omega: float, blade: Blade = variant.blade) -> Modes:
            options = {"mass": lumping.mass, "stiffness": lumping.stiffness, "effects": lumping.effects}
            return mesh_modes(blade, omega, lumping.elements, 9, **options)

        request = CampbellRequest((0.0, 20 * RPM_TO, 30 * RPM_TO), modes=5, per_rev=(), elements=20)
        for solver in (None, lumped):
            frequencies = campbell(variant.blade, request, *([solver] if solver else [])).tracks.frequencies
            rises = frequencies[1:] / frequencies[0] - 1.0
            assert rises.argmax(1).tolist() == [0, 0]
            np.testing.assert_allclose(rises[:, 0], [0.08, 0.165], atol=0.01)


def test_gravity_stiffens_a_hanging_blade_like_a_chain() -> None:
    """A heavy chain, ω = ½ j₀ₖ √(g/L) (Bernoulli 1733; Routh 1905); bending adds about √(EI/mgL³), here 2e-3 and less."""
    length, mass = 10.0, 5.0
    stiff = 1e-6 * mass * STANDARD_GRAVITY * length**3
    rope = uniform_blade("rope", length, 0.0, EA=1e8, GJ=1e3, EI_y=stiff, EI_z=4 * stiff, mass=mass, I_y=1e-3, I_z=1e-3)
    frequencies = modes(rope, 0.0, 60, 4, gravity=gravity(np.pi)).frequencies
    exact = 0.5 * jn_zeros(0, 2) * np.sqrt(STANDARD_GRAVITY / length)
    np.testing.assert_allclose(frequencies, np.repeat(exact, 2), rtol=1.2e-2)


def test_gravity_turns_against_the_rotation_and_with_the_tilt() -> None:
    """In the hub's axes, which turn from the vertical (x) towards the direction of motion (y)."""
    g = STANDARD_GRAVITY
    np.testing.assert_allclose(gravity(0.0), [-g, 0, 0], atol=1e-12)
    np.testing.assert_allclose(gravity(0.5 * np.pi), [0, g, 0], atol=1e-12)
    np.testing.assert_allclose(gravity(np.pi), [g, 0, 0], atol=1e-12)
    np.testing.assert_allclose(gravity(1.0, 0.5 * np.pi), [0, 0, g], atol=1e-12)


def test_a_positive_tilt_raises_the_upwind_end_of_the_rotor_axis() -> None:
    """The upwind rotor of the NREL 5-MW turbine has 5° uptilt (Jonkman et al. 2009, table 1-1): +z, downwind, points 5° below
    the horizontal, so that gravity has a component g sin 5° along it at every azimuth."""
    g, tilt = STANDARD_GRAVITY, np.radians(5.0)
    for azimuth in np.linspace(0.0, 6.0, 7):
        assert gravity(azimuth, tilt)[2] == pytest.approx(g * np.sin(tilt))
        assert np.linalg.norm(gravity(azimuth, tilt)) == pytest.approx(g)


def texts(figure: Figure) -> list[str]:
    return [t.get_text() for t in figure.findobj(Text) if t.get_text()]  # type: ignore[attr-defined]


def test_the_figure_names_modes_rays_the_range_and_the_veering(veering: Campbell) -> None:
    labels = texts(draw(veering, RPM, "oscillators"))
    assert {"1P", "2P", "3P", "operating"} <= set(labels)
    for label in ("flapwise 1 → edgewise", "edgewise 1 → flapwise", "flapwise 2"):
        assert any(text.startswith(f"{label}  ") for text in labels)
    gap = next(text for text in labels if text.startswith("veering\n"))
    exact = (np.sqrt(EDGE + 1.5) - np.sqrt(EDGE - 1.5)) / (2 * np.pi)
    assert gap == f"veering\ngap {exact:.2g} Hz"


def test_each_veering_and_crossing_has_a_panel_of_its_own(veering: Campbell) -> None:
    figure = encounters.draw(veering, RPM, "close")
    assert figure
    assert len(figure.axes) == len(veering.encounters) == 1
    assert figure.axes[0].get_title(loc="left") == f"veering, {np.sqrt((EDGE - FLAP) / 2) * 30 / np.pi:.4g} rpm"
    many = encounters.draw(replace(veering, encounters=veering.encounters * 12), RPM, "close")
    assert many
    assert len(many.axes) == encounters.MAX_PANELS
    assert any("3 more in the table" in text for text in texts(many))
    assert encounters.draw(replace(veering, encounters=()), RPM, "close") is None


def test_labels_at_the_ends_of_lines_do_not_overlap() -> None:
    close = lambda omega: replace(southwell(omega), frequencies=np.array([5.0, 5.01]))  # noqa: E731
    figure = draw(campbell(BLADE, CampbellRequest((0.0, 0.5, 1.0), modes=2), close), RAD_S, "close")
    figure.canvas.draw()
    labels = [t for t in figure.findobj(Text) if t.get_text().startswith(("flapwise 1 ", "edgewise 1 "))]  # type: ignore[attr-defined]
    boxes = [t.get_window_extent() for t in labels]
    assert len(boxes) == 2
    assert not boxes[0].overlaps(boxes[1])


def test_the_figures_bytes_depend_on_its_numbers_alone(veering: Campbell, tmp_path: Path) -> None:
    for name in ("a", "b"):
        save(draw(veering, RPM, "oscillators"), tmp_path / f"{name}.svg")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_the_same_figure_without_an_operating_range_judges_nothing() -> None:
    labels = texts(draw(diagram(operating=None), RPM, "plain"))
    assert "operating" not in labels
    assert "resonance in operation" not in labels
    assert "resonance" in labels


def test_colours_of_pure_motions_are_their_families_and_of_mixtures_between() -> None:
    flap, edge, half = blend([1, 0, 0, 0]), blend([0, 1, 0, 0]), blend([0.5, 0.5, 0, 0])
    assert half == pytest.approx((np.array(flap) + np.array(edge)) / 2)


def test_tables_have_the_values_of_the_diagram(veering: Campbell) -> None:
    page = {s.title: s for s in sheets(veering, RPM)}
    assert set(page) == {
        "Modes",
        "Margins in the operating range",
        "Crossings of n per revolution",
        "Modes that come close",
    }
    modes_ = page["Modes"].rows
    assert modes_[2][0] == "flapwise 2"
    assert float(modes_[2][2]) == pytest.approx(30.0 / (2 * np.pi), abs=5e-5)
    assert modes_[2][6:] == ("3.000", "< 0.0001 %")
    (met,) = page["Modes that come close"].rows
    assert met[0] == "veering"
    assert float(met[1]) == pytest.approx(np.sqrt((EDGE - FLAP) / 2) * 30 / np.pi, abs=1e-3)
    resonances = page["Crossings of n per revolution"].rows
    assert len(resonances) == len(veering.resonances)
    text = markdown(page["Crossings of n per revolution"])
    assert text.count("**✘ inside**") == sum(r.distance == 0 for r in veering.resonances) > 0


def test_an_ambiguous_encounter_is_in_tables_and_figure() -> None:
    def jump(omega: float) -> Modes:
        shapes = np.zeros((2, 21, 4), complex)
        shapes[0, :, 2] = STATIONS
        shapes[1, :, 1 if omega < 1.2 else 0] = STATIONS
        return Modes(omega, np.array([5.0, 9.0]), shapes, 10, uncertainty=np.zeros(2))

    result = campbell(BLADE, CampbellRequest((0.0, 1.0, 2.0), modes=2), jump)
    phrase = verdict(replace(result, request=replace(result.request, operating=(0.5, 1.5))), RAD_S)
    assert "Not judged, because not tracked over the whole range: " in phrase
    (sheet,) = (s for s in sheets(result, RAD_S) if s.title == "Ambiguous tracking")
    assert sheet.rows[0][0] == "edgewise 1"
    assert sheet.rows[0][3] == "none"
    assert "?" in texts(draw(result, RAD_S, "jump"))


def test_the_verdict_is_one_line() -> None:
    assert verdict(diagram(margin=RequiredMargin(0.05), per_rev=(1,)), RAD_S) == (
        "Every mode stays at least 5 % away from every n per revolution at 1 to 2 rad/s."
    )
    phrase = verdict(diagram(operating=(1.1, 2.0)), RAD_S)  # edge at 1.1 rad/s: 3.099, 6 % below 3P
    assert phrase == "✘ At 1.1 to 2 rad/s, flapwise 1 crosses 2P; edgewise 1 crosses 2P and comes within 10 % of 3P."
    assert "no margin is judged" in verdict(diagram(operating=None), RAD_S)


def test_csv_holds_the_numbers(veering: Campbell, tmp_path: Path) -> None:
    csv_tables.write(veering, tmp_path)
    with (tmp_path / "campbell.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == veering.tracks.mode_index.size
    third = [r for r in rows if r["name"] == "flapwise 2"]
    np.testing.assert_allclose(
        [float(r["frequency_rad_s"]) for r in third],
        np.sqrt(900 + 3 * np.array([float(r["omega_rad_s"]) for r in third]) ** 2),
        rtol=1e-12,
    )
    assert sum(int(r["asked_for"]) for r in third) == 13
    assert all(float(r["flapwise"]) == pytest.approx(1.0) for r in third)
    with (tmp_path / "encounters.csv").open() as file:
        (met,) = csv.DictReader(file)
    assert met["kind"] == "veering"
    for name, count in (("resonances", len(veering.resonances)), ("margins", 9)):
        with (tmp_path / f"{name}.csv").open() as file:
            assert len(list(csv.DictReader(file))) == count


def test_a_mode_has_one_name_in_every_command() -> None:
    """A beam twisted by a quarter turn, of which some modes are mixed, and an offset mass between two of the 21 stations."""
    stations = np.array([0.0, 1.44, 1.442, 1.456, 1.458, 2.0])
    mass = section_mass([1.2, 1.2, 200.0, 200.0, 1.2, 1.2], [1e-3, 1e-3, 1.0, 1.0, 1e-3, 1e-3])
    stiffness = np.repeat(section_stiffness(1e7, 1e3, 1e4, 2e4), 6, axis=0)
    blade = Blade("twisted", stations, stiffness, mass, stations * np.pi / 4)
    speeds = (0.0, 10.0)
    result = campbell(blade, CampbellRequest(speeds, modes=8, elements=20))
    modes = tracked(blade, CampbellRequest(speeds, modes=8, elements=20))
    assert [mode.label for mode in modes] == [result.labels[t] for t in range(result.tracks.count)]
    for k, rows in enumerate(sweep(blade, speeds, 20, 8)):
        assert tuple(row.name.split()[0] for row in rows) == result.labels.families[k][: len(rows)]
        assert any(row.name.startswith("mixed") for row in rows)
