"""Floquet's and Hill's exponents against closed forms, charts and published values."""

import numpy as np
import pytest
from scipy.special import mathieu_a, mathieu_b

from southwell.core.rotor.comparison import compared
from southwell.core.rotor.floquet import floquet
from southwell.core.rotor.hill import hill
from southwell.core.rotor.periodic import Periodic, PeriodicError, constant, sampled
from southwell.core.rotor.stability import limits


def scalar(M, C, K, omega: float = 1.0) -> Periodic:
    """One coordinate, its mass, damping and stiffness functions of ψ."""

    def matrices(psi: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        m, c, k = (np.array([[float(f(psi))]]) for f in (M, C, K))
        return m, c, k

    return sampled(matrices, omega, ("x",))


def flapping(mu: float, gamma: float = 12.0, p: float = 1.0) -> Periodic:
    """A rigid blade's flapping in forward flight at the advance ratio μ."""
    return scalar(
        lambda psi: 1.0,
        lambda psi: gamma / 8 * (1 + 4 / 3 * mu * np.sin(psi)),
        lambda psi: p**2 + gamma / 8 * (4 / 3 * mu * np.cos(psi) + mu**2 * np.sin(2 * psi)),
    )


@pytest.mark.parametrize(
    ("mu", "real", "imaginary"), [(0.5, (-1.00331312, -0.49668688), 0.5), (1.5, (-1.59061361, 0.09061361), 0.0)]
)
def test_flapping_in_forward_flight(mu: float, real: tuple[float, float], imaginary: float) -> None:
    comparison = compared(flapping(mu))
    for exponents in (comparison.floquet, comparison.hill):
        np.testing.assert_allclose(np.sort(exponents.values.real), real, atol=5e-9)
        np.testing.assert_allclose(np.abs(exponents.values.imag), imaginary, atol=1e-9)
        assert exponents.values.real.sum() == pytest.approx(-12 / 8, abs=1e-10)
    assert comparison.difference < 1e-10


def mathieu(a: float, q: float) -> Periodic:
    """ẍ + (a − 2 q cos 2ψ) x = 0."""
    return scalar(lambda psi: 1.0, lambda psi: 0.0, lambda psi: a - 2 * q * np.cos(2 * psi))


def test_limits_of_mathieus_chart() -> None:
    q = 1.0
    result = limits(lambda a: mathieu(a, q), [-1.0, -0.2, 1.0, 3.0])
    exact = [mathieu_a(0, q), mathieu_b(1, q), mathieu_a(1, q)]
    assert len(result) == len(exact)
    for limit, value in zip(result, exact, strict=True):
        assert limit.at == pytest.approx(value, abs=1e-9)
        assert limit.uncertainty < 1e-9


def test_hill_and_floquet_agree_in_the_unstable_range() -> None:
    comparison = compared(mathieu(1.0, 1.0))
    assert comparison.floquet.growth > 0.1
    assert comparison.floquet.growth == pytest.approx(comparison.hill.growth, rel=1e-10)


def test_isotropic_springs_seen_from_the_rotating_frame() -> None:
    """A mass on equal springs has ω₀ ± Ω in a frame that rotates at Ω."""
    omega, nature = 1.3, 4.1
    J = np.array([[0.0, -1.0], [1.0, 0.0]])
    system = constant(np.eye(2), 2 * omega * J, (nature**2 - omega**2) * np.eye(2), omega, ("x", "y"))
    comparison = compared(system)
    for exponents in (comparison.floquet, comparison.hill):
        result = np.sort(np.abs(exponents.frequencies))[::2]
        np.testing.assert_allclose(result, [nature - omega, nature + omega], rtol=1e-10)
        assert not exponents.tied.any()


def test_unequal_springs_seen_from_the_rotating_frame_have_tied_frequencies() -> None:
    """A motion along one fixed line has ω − Ω and ω + Ω equally: no frequency is named, and the exponents remain."""
    omega, natures = 1.0, np.array([4.1, 5.3])
    J = np.array([[0.0, -1.0], [1.0, 0.0]])

    def matrices(psi: float):
        R = np.array([[np.cos(psi), -np.sin(psi)], [np.sin(psi), np.cos(psi)]])
        return np.eye(2), 2 * omega * J, R.T @ np.diag(natures**2) @ R - omega**2 * np.eye(2)

    comparison = compared(sampled(matrices, omega, ("x", "y")))
    for exponents in (comparison.floquet, comparison.hill):
        assert exponents.tied.all()
        assert np.isnan(exponents.frequencies).all()
        observed = np.sort(np.angle(exponents.multipliers))
        np.testing.assert_allclose(
            observed, np.sort(np.angle(np.exp(2j * np.pi * np.append(natures, -natures)))), atol=1e-9
        )


def test_the_stated_error_of_floquet_covers_the_error() -> None:
    system = flapping(0.5)
    exact = hill(system).values.real
    result = floquet(system)
    assert np.abs(np.sort(result.values.real) - np.sort(exact)).max() <= 1e-11 + result.error.max()


def test_invalid_arguments_are_refused() -> None:
    with pytest.raises(PeriodicError, match="0 rad/s"):
        floquet(constant(np.eye(1), np.zeros((1, 1)), np.eye(1), 0.0, ("x",)))
    with pytest.raises(PeriodicError, match="no mass"):
        floquet(constant(np.zeros((1, 1)), np.eye(1), np.eye(1), 1.0, ("x",)))
    with pytest.raises(PeriodicError, match="not smooth"):
        scalar(lambda psi: 1.0, lambda psi: 0.0, lambda psi: 1.0 + (psi > 1.0))
