"""Strain measures and beam pencils: every analytic derivative against difference quotients; energies against statics."""

import numpy as np
import pytest

from southwell.core import beams as bm
from southwell.core import elements
from southwell.core import spatial as sp
from southwell.core.discretize import discretize
from southwell.tests.beams import curved

MEASURES = ["corotational", "parent"]


@pytest.fixture(scope="module")
def bent() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(4)
    rest = sp.exp(rng.normal(size=(5, 6)) * [1, 0.2, 0.2, 0.1, 0.1, 0.1])
    return rest, sp.exp(0.3 * rng.normal(size=(5, 6))) @ rest


@pytest.mark.parametrize("measure", MEASURES)
def test_strain_rate_is_the_derivative_of_the_strain(measure, bent) -> None:
    rest, x = bent
    h = 1e-6
    steps = [
        (elements.strain(measure, rest, sp.exp(h * e) @ x) - elements.strain(measure, rest, sp.exp(-h * e) @ x))
        / (2 * h)
        for e in np.eye(6)
    ]
    np.testing.assert_allclose(elements.strain_rate(measure, rest, x), np.stack(steps, axis=-1), atol=1e-8)


@pytest.mark.parametrize("measure", MEASURES)
def test_geometric_stiffness_is_the_derivative_of_the_wrench(measure, bent) -> None:
    rest, x = bent
    h, s = 1e-6, np.random.default_rng(5).normal(size=(5, 6))

    def wrench(x: np.ndarray) -> np.ndarray:
        return np.einsum("nij,ni->nj", elements.strain_rate(measure, rest, x), s)

    steps = [(wrench(sp.exp(h * e) @ x) - wrench(sp.exp(-h * e) @ x)) / (2 * h) for e in np.eye(6)]
    np.testing.assert_allclose(elements.wrench_derivative(measure, rest, x, s), np.stack(steps, axis=-1), atol=1e-8)


@pytest.mark.parametrize("measure", MEASURES)
@pytest.mark.parametrize("mass", ["consistent", "half_end"])
def test_pencil_stiffness_is_the_derivative_of_the_residual(measure, mass) -> None:
    """Elastic, geometric, centrifugal and gravity terms, of curved coupled elements in a bent state, taken along."""
    beams = discretize(curved(), 4, mass, measure).beams
    rng = np.random.default_rng(6)
    small = rng.normal(size=(4, 6)) * [0.2, 0.2, 0.2, 0.05, 0.05, 0.05]
    a, h = sp.exp(rng.normal(size=(4, 6))), 1e-6
    b = a @ beams.rest @ sp.exp(small)
    frame, fall = np.array([0.3, -0.2, 5.0, 0.4, -0.3, 1.2]), np.array([1.0, 2.0, -9.0, 0, 0, 0])

    def residual(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Components in each end's own axes, so that the difference is the variation taken along."""
        to_a = sp.adjoint(sp.inverse(a))
        r = bm.pencil(beams, sp.inverse(a) @ b, to_a @ frame, to_a @ fall).residual
        own_b = np.swapaxes(sp.adjoint(sp.inverse(a) @ b), -1, -2) @ r[:, 6:, None]
        return np.concatenate([r[:, :6], own_b[..., 0]], axis=-1)

    to_a = sp.adjoint(sp.inverse(a))
    K = bm.pencil(beams, sp.inverse(a) @ b, to_a @ frame, to_a @ fall).K
    lever = sp.adjoint(sp.inverse(a) @ b)
    own = np.zeros((4, 12, 12))
    own[:, :6, :6], own[:, 6:, 6:] = np.eye(6), lever
    analytic = np.swapaxes(own, -1, -2) @ K @ own
    columns = []
    for j in range(12):
        step = np.zeros(12)
        step[j] = h
        columns.append(
            (
                residual(a @ sp.exp(step[:6]), b @ sp.exp(step[6:]))
                - residual(a @ sp.exp(-step[:6]), b @ sp.exp(-step[6:]))
            )
            / (2 * h)
        )
    quotient = np.stack(columns, axis=-1)
    scale = np.abs(quotient).max(axis=(1, 2), keepdims=True)
    np.testing.assert_allclose(analytic / scale, quotient / scale, atol=2e-8)


def test_mass_points_weigh_what_the_blade_weighs() -> None:
    """A rigid translation of both ends meets the blade's whole mass, whatever the shape functions."""
    blade = curved()
    beams = discretize(blade, 3).beams
    n = len(beams.rest)
    M = bm.pencil(beams, beams.rest, np.zeros((n, 6)), np.zeros((n, 6))).M
    along = np.tile(np.eye(6)[:, 2:3], (2, 1))
    total = sum(float((along.T @ m @ along)[0, 0]) for m in M)
    s = blade.stations
    assert total == pytest.approx(np.trapezoid(blade.mass[:, 0, 0], s), rel=1e-12)
