"""Strain measures and beam pencils: every analytic derivative against difference quotients; energies against statics."""

import numpy as np
import pytest
from scipy.integrate import trapezoid

from southwell.core.blade import uniform_blade
from southwell.core.element import beams as bm
from southwell.core.element import measures
from southwell.core.element.discretize import discretize
from southwell.core.space import spatial as sp
from southwell.tests.support.beams import curved

MEASURES: list[measures.Measure] = ["corotational", "body_fixed"]


@pytest.fixture(scope="module", params=MEASURES)
def law(request) -> measures.StrainLaw:
    """Five elements whose strain varies along them arbitrarily."""
    rng = np.random.default_rng(4)
    undeformed = sp.exp(rng.normal(size=(5, 6)) * [1, 0.2, 0.2, 0.1, 0.1, 0.1])
    g, mean, slope = rng.normal(size=(5, 6, 6)), rng.normal(size=(5, 6, 6)), rng.normal(size=(5, 6, 12))
    return measures.StrainLaw(request.param, undeformed, g + np.swapaxes(g, -1, -2), mean, slope)


@pytest.fixture(scope="module")
def bent(law) -> tuple[np.ndarray, np.ndarray]:
    """Displaced poses, and internal coordinates."""
    rng = np.random.default_rng(6)
    return sp.exp(0.3 * rng.normal(size=(5, 6))) @ law.undeformed, 0.3 * rng.normal(size=(5, 6))


def differences(value) -> np.ndarray:
    """Central differences of a function of a step (12,) in (ρ, β), as columns."""
    h = 1e-6
    return np.stack([(value(h * e) - value(-h * e)) / (2 * h) for e in np.eye(12)], axis=-1)


def test_strain_rate_is_the_derivative_of_the_strain(law, bent) -> None:
    x, beta = bent
    result = differences(lambda step: measures.response(law, sp.exp(step[:6]) @ x, beta + step[6:]).strain)
    np.testing.assert_allclose(measures.response(law, x, beta).rate, result, atol=1e-7)


def test_geometric_stiffness_is_the_derivative_of_the_wrench(law, bent) -> None:
    x, beta = bent
    s = np.random.default_rng(5).normal(size=(5, 6))

    def wrench(step: np.ndarray) -> np.ndarray:
        return np.einsum("nij,ni->nj", measures.response(law, sp.exp(step[:6]) @ x, beta + step[6:]).rate, s)

    curvature = measures.response(law, x, beta, s).curvature
    np.testing.assert_allclose(curvature, differences(wrench), atol=1e-6 * np.abs(curvature).max())


def test_tension_stiffens_like_the_cubic_beam_element() -> None:
    """Stretch of an end moved across by d and turned by θ: ½ [d θ] (1/30l) [36, −3l; −3l, 4l²] [d θ]ᵀ, in both planes.

    Times the tension this is the cubic element's geometric stiffness (Przemieniecki 1968, eq. 15.36).
    """
    length, h = 2.0, 1e-3
    beam = uniform_blade("b", length, 0.0, EA=1e6, GJ=1.0, EI_y=3.0, EI_z=5.0, mass=1.0)
    b = discretize(beam, 1).beams
    cubic = np.array([[36, -3 * length], [-3 * length, 4 * length**2]]) / (30 * length)
    for axis, place, sign in ((2, 1, 1.0), (1, 2, -1.0)):
        for d, theta in ((1.0, 0.0), (0.0, 1.0), (0.7, -0.4)):
            position = np.array([length, 0.0, 0.0])
            position[place] = h * d
            x = sp.pose(sp.rotation(axis, np.array(sign * h * theta)), position)[None]
            stretch = measures.response(b.law, x, np.zeros((1, 6))).strain[0, 0]
            z = np.array([d, theta])
            assert stretch / h**2 == pytest.approx(0.5 * z @ cubic @ z, rel=2e-6)


@pytest.mark.parametrize("measure", MEASURES)
@pytest.mark.parametrize("mass", ["consistent", "half_end"])
def test_pencil_stiffness_is_the_derivative_of_the_residual(measure, mass) -> None:
    """Elastic, geometric, centrifugal and gravity terms, of curved coupled elements in a bent state."""
    beams = discretize(curved(), 4, mass, measure).beams
    rng = np.random.default_rng(6)
    small = rng.normal(size=(4, 6)) * [0.2, 0.2, 0.2, 0.05, 0.05, 0.05]
    a, h = sp.exp(rng.normal(size=(4, 6))), 1e-6
    b = a @ beams.undeformed @ sp.exp(small)
    frame, fall = np.array([0.3, -0.2, 5.0, 0.4, -0.3, 1.2]), np.array([1.0, 2.0, -9.0, 0, 0, 0])

    inner = 0.3 * rng.normal(size=(4, beams.internal_count))

    def pencil(a: np.ndarray, b: np.ndarray, inner: np.ndarray) -> bm.Pencil:
        to_a = sp.adjoint(sp.inverse(a))
        return bm.pencil(bm.relative_pencil(beams, sp.inverse(a) @ b, inner, to_a @ frame, to_a @ fall))

    def residual(step: np.ndarray) -> np.ndarray:
        """Components in each end's axes, so that the difference is the variation that follows the body."""
        a_, b_ = a @ sp.exp(step[:6]), b @ sp.exp(step[6:12])
        r = pencil(a_, b_, inner + step[12:]).residual.copy()
        r[:, 6:12] = (np.swapaxes(sp.adjoint(sp.inverse(a_) @ b_), -1, -2) @ r[:, 6:12, None])[..., 0]
        return r

    d = 12 + beams.internal_count
    to_a = np.zeros((4, d, d))
    to_a[:, range(d), range(d)] = 1.0
    to_a[:, 6:12, 6:12] = sp.adjoint(sp.inverse(a) @ b)
    analytic = np.swapaxes(to_a, -1, -2) @ pencil(a, b, inner).K @ to_a
    quotient = np.stack([(residual(h * e) - residual(-h * e)) / (2 * h) for e in np.eye(d)], axis=-1)
    for rows in (slice(0, 12), slice(12, d)):  # forces on the ends and on β differ in size
        scale = np.abs(quotient[:, rows]).max(axis=(1, 2), keepdims=True, initial=1e-300)
        np.testing.assert_allclose(analytic[:, rows] / scale, quotient[:, rows] / scale, atol=3e-8)


def test_the_points_have_the_mass_of_the_blade() -> None:
    """A rigid translation of both ends moves the whole mass of the blade, for any shape functions."""
    blade = curved()
    beams = discretize(blade, 3).beams
    n = len(beams.undeformed)
    zero = np.zeros((n, 6))
    M = bm.pencil(bm.relative_pencil(beams, beams.undeformed, zero, zero, zero)).M[:, :12, :12]
    along = np.tile(np.eye(6)[:, 2:3], (2, 1))
    total = sum(float((along.T @ m @ along)[0, 0]) for m in M)
    s = blade.stations
    assert total == pytest.approx(trapezoid(blade.mass[:, 0, 0], s), rel=1e-12)
