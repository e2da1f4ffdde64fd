"""Basis of the closed forms: polynomials, quadrature, convergence, shapes; and the blades that each declines."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import newton_cotes, quad

from southwell.core.blade import Blade, section_stiffness
from southwell.core.mechanism.description import inertia as body
from southwell.core.modes import STATIONS
from southwell.core.sampling import mass_at
from southwell.references.protocol.interface import CodeError
from southwell.references.theories import (
    assumed_modes,
    exact_beam,
    ritz,
    southwell_equation,
    spectral,
    straight_beam,
    yoo_shin,
)

from ...support.straight_blades import kinked, park, slender

ASSUMED, YOO_SHIN, SOUTHWELL, EXACT = assumed_modes.CODE, yoo_shin.CODE, southwell_equation.CODE, exact_beam.CODE
CODES = (ASSUMED, YOO_SHIN, SOUTHWELL, EXACT)
FINE = 32


def ids(code) -> str:
    return code.name


@pytest.mark.parametrize("code", [ASSUMED, YOO_SHIN, EXACT], ids=ids)
@pytest.mark.parametrize("blade", [park(1.08e4), kinked()], ids=["uniform", "kinked"])
def test_spectral_convergence(code, blade: Blade) -> None:
    """Exponential: four more terms reduce the error by at least two digits, until only rounding is left."""
    f = np.array([code.solve(blade, 5.0, n, 4).frequencies[:3] for n in (3, 7, 11, 15, 40)])
    error = np.abs(f[:-1] / f[-1] - 1).max(1)
    assert error[0] > 1e-5
    assert (error[1:] < np.maximum(0.01 * error[:-1], 1e-12)).all()


@pytest.mark.parametrize("ends", [[0.0, 1.0], [0.0, 0.3, 0.5, 1.0]], ids=["one interval", "three"])
@pytest.mark.parametrize(
    ("functions", "terms"),
    [
        (spectral.clamped_functions, 2),
        (spectral.clamped_functions, 9),
        (spectral.pinned_functions, 1),
        (spectral.pinned_functions, 7),
    ],
)
def test_polynomials(ends: list[float], functions, terms: int) -> None:
    """The right number, independent, zero at the root, smooth as documented, and with correct derivatives."""
    ends_, smooth = np.array(ends), 2 if functions is spectral.clamped_functions else 1
    s, _ = spectral.gauss(ends_, 20)
    value, slope, second = functions(ends_, terms, s)
    assert np.linalg.matrix_rank(value) == value.shape[1] == terms * (len(ends) - 1)
    assert np.abs(functions(ends_, terms, np.zeros(1))[:smooth]).max() < 1e-13
    for node in ends[1:-1]:
        low, high = (functions(ends_, terms, np.array([node + d]))[:smooth] for d in (-1e-12, 1e-12))
        np.testing.assert_allclose(low, high, atol=1e-8)
    h = 1e-6
    before, after = (functions(ends_, terms, s + d) for d in (-h, h))
    np.testing.assert_allclose((after[0] - before[0]) / (2 * h), slope, atol=1e-6)
    np.testing.assert_allclose((after[1] - before[1]) / (2 * h), second, atol=1e-4)


@pytest.mark.parametrize("code", [YOO_SHIN, EXACT], ids=ids)
def test_sparse_and_dense_solutions_agree(code, monkeypatch: pytest.MonkeyPatch) -> None:
    result = []
    for size in (0, 10**9):
        monkeypatch.setattr(ritz, "DENSE", size)
        result.append(code.solve(kinked(), 5.0, 16, 8))
    np.testing.assert_allclose(result[1].frequencies, result[0].frequencies, rtol=1e-11)
    overlap = np.abs(np.einsum("msi,msi->m", result[0].shapes.conj(), result[1].shapes))
    size = [np.linalg.norm(f.shapes.reshape(8, -1), axis=1) for f in result]
    np.testing.assert_allclose(overlap, size[0] * size[1], rtol=1e-9)


def test_stations_without_a_kink_make_no_intervals() -> None:
    blade = kinked()
    many = kinked(stations=6)
    np.testing.assert_allclose(spectral.intervals(many), blade.stations)
    np.testing.assert_allclose(
        EXACT.solve(many, 5.0, 16, 6).frequencies, EXACT.solve(blade, 5.0, 16, 6).frequencies, rtol=1e-11
    )


def test_tension_is_the_centrifugal_force_outboard() -> None:
    blade = kinked(tip=1.0)
    for s in (0.0, 0.3, 0.4, 0.9):
        force = (
            quad(lambda x: float(mass_at(blade, x)[0, 0, 0]) * (0.2 + x), s, 1.0, points=[max(0.4, s)])[0] + 0.3 * 1.2
        )
        assert straight_beam.tension(blade, np.array([s]))[0] == pytest.approx(force, rel=1e-12)


@pytest.mark.parametrize("blade", [slender(70.0, 0.1, 0.3), kinked(0.8, 0.0, stations=41)], ids=["uniform", "twisted"])
def test_shapes_are_orthogonal_in_mass(blade: Blade) -> None:
    solution = ASSUMED.solve(blade, 6.0, FINE, 5)
    assert np.abs(solution.shapes.imag).max() == 0
    weights, _ = newton_cotes(4)
    quadrature = np.zeros(21)
    for k in range(5):
        quadrature[4 * k : 4 * k + 5] += weights * 0.05
    metric = quadrature * mass_at(blade, STATIONS)[:, 0, 0]
    gram = np.einsum("isk,s,jsk->ij", solution.shapes.real, metric, solution.shapes.real)
    size = np.sqrt(np.diag(gram))
    np.testing.assert_allclose(gram / np.outer(size, size), np.eye(5), atol=2e-4)


# -------------------------------------------------------------------------------------------------------------- as codes


@pytest.mark.parametrize("code", CODES, ids=ids)
def test_a_code_follows_the_rules(code) -> None:
    first, second = (code.solve(park(), 10.0, 12, 7) for _ in range(2))
    assert len(first.frequencies) == 7
    assert (np.diff(first.frequencies) >= 0).all()
    np.testing.assert_array_equal(first.frequencies, second.frequencies)
    np.testing.assert_array_equal(first.shapes, second.shapes)
    assert code.version().startswith("southwell ")
    assert code.hint == ""
    assert code.order == 0
    assert all(b >= 1.4 * a for a, b in zip(code.levels, code.levels[1:], strict=False))
    assert code.unsupported(park()) is None
    assert len(first.uncertainty) == (7 if code is SOUTHWELL else 0)


BENT = np.array([[0.0, 0.0, 0.0], [np.sqrt(0.99), 0.0, 0.1]])
OFFSET = np.array(slender().mass)
OFFSET[:, 1, 3] = OFFSET[:, 3, 1] = 0.01
OFFSET[:, 0, 4] = OFFSET[:, 4, 0] = -0.01
OFFSET[:, range(3, 6), range(3, 6)] += 0.001
SHEARING = section_stiffness([4900.0] * 2, 1.0, 1.0, 1.0, GA_y=100.0, GA_z=100.0)
RIGID_AXIAL = section_stiffness([np.inf] * 2, 1.0, 1.0, 1.0)
RIGID_EDGE = section_stiffness([4900.0] * 2, 1.0, 1.0, np.inf)
HEAVY = np.diag([1.0, 1.0, 1.0, 0.1, 0.05, 0.05])
ASIDE = body(1.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.1))
EVERY = {"assumed-modes", "yoo-shin", "southwell-equation", "exact-beam"}


@pytest.mark.parametrize(
    ("change", "word", "by"),
    [
        ({"mass": OFFSET}, "couple", EVERY),
        ({"curve": BENT}, "prebent", EVERY),
        ({"precone": 0.05}, "precone 0.05 rad", EVERY),
        ({"stiffness": SHEARING}, "shear", EVERY),
        ({"stiffness": RIGID_EDGE}, "bending stiffness is infinite", EVERY),
        ({"tip_mass": ASIDE}, "off the axis", EVERY),
        ({"twist": np.array([0.1, 0.0])}, "twisted", {"yoo-shin", "exact-beam"}),
        ({"pitch": 0.1}, "pitch 0.1 rad", {"yoo-shin", "exact-beam"}),
        ({"stiffness": RIGID_AXIAL}, "axial stiffness is infinite", {"yoo-shin", "exact-beam"}),
        ({"tip_mass": HEAVY}, "moments of inertia", EVERY - {"exact-beam"}),
    ],
)
@pytest.mark.parametrize("code", CODES, ids=ids)
def test_an_unsupported_blade_is_declined_with_a_reason(code, change: dict, word: str, by: set[str]) -> None:
    blade = replace(slender(), **change)
    if code.name not in by:
        assert code.unsupported(blade) is None
        code.solve(blade, 1.0, 6, 2)
        return
    assert word in str(code.unsupported(blade))
    with pytest.raises(CodeError, match=word):
        code.solve(blade, 1.0, 6, 2)
