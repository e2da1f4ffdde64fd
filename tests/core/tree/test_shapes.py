"""Mode shapes: ElastoDyn's polynomials against closed forms, their conventions, figures and CSV."""

import csv
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.text import Text

from southwell.cases.campbell.diagram import Campbell, CampbellRequest, campbell
from southwell.cases.input import library
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers.openfast import elastodyn
from southwell.cases.input.readers.source import Mount
from southwell.cases.writers.elastodyn_shapes import DIGITS, POWERS, Polynomial, as_it_is, fit, polynomials, principal
from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.modes import STATIONS
from southwell.core.solve import mesh_modes
from southwell.core.space import spatial as sp
from southwell.reports.campbell.shapes import coefficients, draw, scaled, write_csv
from southwell.reports.shared.units import RPM

from ...support.analytic import ROOTS, shape
from ...support.veering import BLADE, oscillators

SOME = st.floats(-3.0, 3.0)
BEAM = uniform_blade("beam", 6.0, 0.3, EA=1e8, GJ=1e5, EI_y=1e4, EI_z=3e4, mass=1.2)


@given(first=st.tuples(SOME, SOME, SOME, SOME), scale=st.sampled_from([-7.0, 0.02, 1.0]))
def test_a_polynomial_is_fitted_as_itself_whatever_its_scale_and_sign(first: tuple[float, ...], scale: float) -> None:
    exact = np.append(first, 1.0 - sum(first))
    polynomial = fit("flapwise 1", 1.0, scale * (np.power.outer(STATIONS, POWERS) @ exact))
    np.testing.assert_allclose(polynomial.coefficients, exact, atol=2 * 10.0**-DIGITS)
    assert polynomial.largest < 1e-5


@given(values=st.lists(SOME, min_size=20, max_size=20))
def test_coefficients_add_up_to_one_as_printed(values: list[float]) -> None:
    polynomial = fit("flapwise 1", 1.0, np.array([*values, 1.0]))
    printed = [float(f"{c:.{DIGITS}f}") for c in polynomial.coefficients]
    assert sum(printed) == pytest.approx(1.0, abs=1e-9)


def test_the_condition_number_is_of_the_problem_solved_and_large() -> None:
    """It is the largest ratio of the relative errors of coefficients and shape."""
    polynomial = fit("flapwise 1", 1.0, STATIONS**2)
    basis = np.stack([STATIONS**k - STATIONS**6 for k in (2, 3, 4, 5)], axis=1)
    sizes = np.linalg.svd(basis, compute_uv=False)
    assert polynomial.condition == pytest.approx(sizes[0] / sizes[-1], rel=1e-9)
    assert 1e3 < polynomial.condition < 1e4


def test_errors_are_those_at_the_stations() -> None:
    wavy = STATIONS**2 + 0.1 * np.sin(9 * np.pi * STATIONS)
    polynomial = fit("flapwise 1", 1.0, wavy)
    deviation = polynomial.at(STATIONS) - wavy
    assert polynomial.largest == pytest.approx(np.abs(deviation).max(), rel=1e-12)
    assert polynomial.rms == pytest.approx(np.sqrt(np.mean(deviation**2)), rel=1e-12)
    assert 0.03 < polynomial.rms < polynomial.largest < 0.3


def test_a_tip_that_stands_still_is_refused() -> None:
    with pytest.raises(CaseError, match="flapwise 2: its tip does not move"):
        fit("flapwise 2", 1.0, STATIONS * (1.0 - STATIONS))


def test_a_uniform_beams_shapes_are_rayleighs() -> None:
    """Clamped-free beam (Rayleigh 1877): five powers follow mode 1 to 1e-4 and mode 2 to 3e-3 of the tip."""
    by_name = {p.mode: p for p in polynomials(BEAM, 0.0, 20)}
    for name, k, within in (("flapwise 1", 0, 1e-4), ("edgewise 1", 0, 1e-4), ("flapwise 2", 1, 3e-3)):
        exact = shape(ROOTS[k]) / shape(ROOTS[k])[-1]
        np.testing.assert_allclose(by_name[name].shape, exact, atol=2e-5)
        np.testing.assert_allclose(by_name[name].at(STATIONS), exact, atol=within)
        stiffness = 3e4 if name == "edgewise 1" else 1e4
        assert by_name[name].frequency == pytest.approx(ROOTS[k] ** 2 * np.sqrt(stiffness / 1.2) / 36.0, rel=1e-6)


def test_torsion_of_one_element_is_ritzs_parabola() -> None:
    """Clamped-free bar with θ = a s + b s² (Ritz 1909): the second term is that of the internal coordinates."""
    soft = uniform_blade("soft", 6.0, 0.0, EA=1e9, GJ=4.0, EI_y=1e4, EI_z=1.4e4, mass=1.2, I_y=1e-3, I_z=1e-3)
    solution = mesh_modes(soft, 0.0, 1, 4)
    torsion = solution.shapes[np.abs(solution.shapes[:, -1, 3]).argmax(), :, 3]
    K, M = np.array([[1.0, 1.0], [1.0, 4.0 / 3.0]]), np.array([[1.0 / 3.0, 0.25], [0.25, 0.2]])
    a, b = scipy.linalg.eigh(K, M)[1][:, 0]
    np.testing.assert_allclose(torsion / torsion[-1], (a * STATIONS + b * STATIONS**2) / (a + b), atol=1e-9)


def twisted(blade: Blade, angle: float) -> Blade:
    """The same blade with section axes rotated by ``angle``, which is subtracted from the twist."""
    turn = np.kron(np.eye(2), sp.rotation(0, np.array(angle)))
    return replace(blade, stiffness=turn @ blade.stiffness @ turn.T, twist=blade.twist - angle)


def soft(GJ: float = 2e3) -> Blade:
    return uniform_blade("soft", 6.0, 0.3, EA=1e7, GJ=GJ, EI_y=1e4, EI_z=3e4, GA_y=1e7, GA_z=1e7, mass=1.2)


@pytest.mark.parametrize("angle", [0.2, -0.7])
def test_principal_stiffnesses_of_sections_with_rotated_axes(angle: float) -> None:
    plain = principal(twisted(soft(), angle))
    np.testing.assert_allclose(plain.stiffness[:, 4, 4], 1e4, rtol=1e-9)
    np.testing.assert_allclose(plain.stiffness[:, 5, 5], 3e4, rtol=1e-9)
    assert not plain.twist.any()
    assert np.isinf(plain.stiffness[:, range(4), range(4)]).all()


def test_principal_stiffnesses_do_not_depend_on_the_reference_axis() -> None:
    shift = sp.adjoint(sp.pose(np.eye(3), np.array([0.0, 0.4, -0.1])))
    moved = replace(soft(), stiffness=shift.T @ soft().stiffness @ shift)
    np.testing.assert_allclose(principal(moved).stiffness[:, range(4, 6), range(4, 6)], [[1e4, 3e4]] * 2, rtol=1e-9)


def test_shapes_for_elastodyn_exclude_twist() -> None:
    """ElastoDyn rotates the curvatures by the twist itself: shapes with twist would include it twice."""
    s = np.linspace(0.0, 6.0, 4)
    straight = Blade(
        "plain",
        stations=s,
        stiffness=np.repeat(section_stiffness(1e8, 1e5, 1e4, 9e4), 4, axis=0),
        mass=np.repeat(section_mass(1.2), 4, axis=0),
        twist=np.zeros(4),
    )
    blade = replace(straight, twist=np.array([0.6, 0.3, 0.1, 0.0]))
    for p, q in zip(polynomials(blade, 2.0, 20), polynomials(straight, 2.0, 20), strict=True):
        np.testing.assert_allclose(p.coefficients, q.coefficients, atol=3e-5)
    real = {p.mode: p for p in as_it_is(blade, mesh_modes(blade, 2.0, 20, 8))}
    (edge,) = (p for p in polynomials(blade, 2.0, 20) if p.mode == "edgewise 1")
    assert np.abs(real["edgewise 1"].shape - edge.shape).max() > 0.01


def test_a_blade_without_the_modes_that_elastodyn_needs_is_reported() -> None:
    stiff = uniform_blade("stiff", 6.0, 0.3, EA=1e8, GJ=1e5, EI_y=1e4, EI_z=1e10, mass=1.2)
    with pytest.raises(CaseError, match="stiff, in ElastoDyn's terms: no edgewise 1 among the lowest modes"):
        polynomials(stiff, 0.0, 12)


@pytest.fixture(scope="module")
def diagram() -> Campbell:
    return campbell(BLADE, CampbellRequest((0.0, 2.0), modes=3), oscillators(1.5))


def test_shapes_are_scaled_to_a_largest_displacement_of_one(diagram: Campbell) -> None:
    order, shapes = scaled(diagram, 0)
    assert order == [0, 1, 2]
    np.testing.assert_allclose(np.abs(shapes[:, :, :3]).reshape(3, -1).max(1), 1.0, rtol=1e-12)
    assert shapes[0, -1, 2] == pytest.approx(1.0)  # flap's tip, real and positive
    assert shapes[1, -1, 1] == pytest.approx(1.0)


def test_shapes_are_in_the_blades_axes() -> None:
    """Precone and pitch turn a blade's flap out of the hub's z; in the blade's axes it remains flap."""
    for turned in (replace(BEAM, precone=0.3), replace(BEAM, pitch=0.5)):
        drawn = campbell(turned, CampbellRequest((0.0, 1.0), modes=2, elements=12))
        _, shapes = scaled(drawn, 0)
        assert np.abs(shapes[0, :, [0, 1]]).max() < 1e-6
        assert shapes[0, -1, 2] == pytest.approx(1.0)


def test_the_figure_has_one_panel_per_mode_with_name_frequency_and_energy_fractions(diagram: Campbell) -> None:
    figure = draw(diagram, 0, RPM, "oscillators: mode shapes")
    assert len(figure.axes) == 3
    texts = [t.get_text() for t in figure.findobj(Text)]  # type: ignore[attr-defined]
    for k, name in enumerate(("flapwise 1", "edgewise 1", "flapwise 2")):
        assert f"{name}   {diagram.tracks.frequencies[0, k] / (2 * np.pi):.4g} Hz" in texts
    assert "100 % flapwise" in texts
    assert "90° out of phase" in texts  # edge lags by 0.3 rad in these oscillators


def test_no_line_leaves_its_panel_and_torsion_has_an_axis_in_degrees() -> None:
    """A torsion mode moves its axis little: scaled by displacements alone, its rotation once left the panel."""
    blade = uniform_blade("torsion", 1.0, 0.1, EA=1e6, GJ=1.0, EI_y=1e4, EI_z=2e4, mass=1.0, I_y=1e-2, I_z=1e-2)
    drawn = campbell(blade, CampbellRequest((0.0, 1.0), modes=2, elements=12))
    figure = draw(drawn, 1, RPM, "torsion: mode shapes")
    assert drawn.labels.at(0, 1.0).startswith("torsion")
    for axes in figure.axes:
        low, high = axes.get_ylim()
        for line in axes.lines:
            values = np.asarray(line.get_ydata(), float)
            assert (values >= low).all()
            assert (values <= high).all()
    texts = [t.get_text() for t in figure.axes[0].findobj(Text)]  # type: ignore[attr-defined]
    degrees = np.degrees(1.0 / np.sqrt(2e-2))
    assert f"{degrees:+.2g}°" in texts
    axes, right = figure.axes[:2]
    np.testing.assert_allclose(right.get_ylim(), degrees * np.array(axes.get_ylim()))
    assert all(t.get_text().endswith("°") for t in right.get_yticklabels())


def test_csv_holds_the_shapes(diagram: Campbell, tmp_path: Path) -> None:
    with write_csv(diagram, 1, tmp_path).open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 3 * 21
    first = [r for r in rows if r["name"] == "flapwise 1"]
    np.testing.assert_allclose([float(r["flap_re"]) for r in first], np.sin(0.5 * np.pi * STATIONS), atol=1e-8)
    assert {float(r["omega_rad_s"]) for r in rows} == {2.0}


def test_the_table_of_coefficients_states_its_conventions() -> None:
    sheet = coefficients(polynomials(BEAM, 0.0, 12), (), RPM, 0.0)
    assert [row[0] for row in sheet.rows] == ["BldFl1Sh", "BldFl2Sh", "BldEdgSh"]
    for row in sheet.rows:
        assert sum(float(c.replace("−", "-")) for c in row[3:8]) == pytest.approx(1.0, abs=1e-9)
    for word in ("without twist", "φ(1) = 1", "Positive is", "condition"):
        assert word in sheet.note


def test_the_papers_blade_has_shapes_for_elastodyn() -> None:
    blade = library.load("park-blade").variants[0].blade
    fitted = polynomials(blade, 1.0, 20)
    assert [p.mode for p in fitted] == ["flapwise 1", "flapwise 2", "edgewise 1"]
    assert all(p.largest < 0.01 for p in fitted)


BLADES = os.environ.get("SOUTHWELL_BLADES")
real = pytest.mark.skipif(not BLADES, reason="set SOUTHWELL_BLADES to a folder of public blade files")

PUBLISHED = {
    "flapwise 1": (0.0622, 1.7254, -3.2452, 4.7131, -2.2555),
    "flapwise 2": (-0.5809, 1.2067, -15.5349, 29.7347, -13.8255),
    "edgewise 1": (0.3627, 2.5337, -3.5772, 2.376, -0.6952),
}
"""NREL 5-MW, in its ElastoDyn blade file (Jonkman et al., NREL/TP-500-38060, 2009); as printed, to 4 decimals."""


@real
def test_shapes_of_the_nrel_5mw_blade_are_the_published_ones_and_more_so_without_twist() -> None:
    file = Path(str(BLADES)) / "nrel5mw" / "NRELOffshrBsline5MW_Blade.dat"
    blade = elastodyn.read(file, Mount(length=61.5, hub_radius=1.5)).blade
    omega, x = 12.1 * np.pi / 30, np.linspace(0.0, 1.0, 51)

    def off(fitted: tuple[Polynomial, ...]) -> dict[str, float]:
        return {p.mode: np.abs(p.at(x) - np.power.outer(x, POWERS) @ PUBLISHED[p.mode]).max() for p in fitted}

    plain, twisted = off(polynomials(blade, omega)), off(as_it_is(blade, mesh_modes(blade, omega, 50, 8)))
    for name, within in (("flapwise 1", 5e-3), ("flapwise 2", 2e-2), ("edgewise 1", 2e-3)):
        assert plain[name] < within
        assert plain[name] < twisted[name]


@pytest.mark.slow
@real
def test_flap_and_edge_of_the_iea_15mw_blade_veer_near_0_8_hz() -> None:
    file = Path(str(BLADES)) / "iea15" / "IEA-15-240-RWT_ElastoDyn_blade.dat"
    blade = elastodyn.read(file, Mount(length=117.0, hub_radius=3.97)).blade
    drawn = campbell(blade, CampbellRequest(tuple(np.arange(0.0, 45.1, 2.5) * np.pi / 30), modes=3, elements=30))
    (met,) = drawn.encounters
    assert met.kind == "veering"
    assert met.frequency / (2 * np.pi) == pytest.approx(0.8, abs=0.03)
    assert met.exchanged > 0.8
    assert [drawn.labels[t] for t in (0, 1)] == ["flapwise 1 → edgewise", "edgewise 1 → flapwise"]
    assert not drawn.tracks.doubts
