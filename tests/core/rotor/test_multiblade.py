"""Multi-blade coordinates: inverse, rate, and equations in which a rotor has constant coefficients."""

import numpy as np
import pytest
from scipy.linalg import expm

from southwell.core.rotor import multiblade as mb


@pytest.mark.parametrize("blades", [3, 4, 5, 6])
def test_inverse_and_rate(blades: int) -> None:
    psi, h = 0.7, 1e-6
    T = mb.transformation(psi, blades)
    np.testing.assert_allclose(mb.inverse(psi, blades) @ T, np.eye(blades), atol=1e-14)
    slope = (mb.transformation(psi + h, blades) - mb.transformation(psi - h, blades)) / (2 * h)
    np.testing.assert_allclose(T @ mb.rate(blades), slope, atol=1e-9)
    assert len(mb.names(blades)) == blades


def test_a_wave_around_the_rotor_is_a_cosine_and_a_sine() -> None:
    """q_k = cos(ψ_k − φ): the blade at the azimuth φ moves most."""
    psi, phi = 0.4, 1.1
    q = np.cos(psi + 2 * np.pi * np.arange(3) / 3 - phi)
    np.testing.assert_allclose(mb.inverse(psi, 3) @ q, [0.0, np.cos(phi), np.sin(phi)], atol=1e-15)


def test_first_and_second_order_give_the_same_state_matrix() -> None:
    rng = np.random.default_rng(44)
    M, C, K = (rng.normal(size=(4, 4)) + 5 * np.eye(4) for _ in range(3))
    blades, psi, omega = mb.blades_of(4, [[1, 2, 3]]), 0.9, 1.3

    def state(M: np.ndarray, C: np.ndarray, K: np.ndarray) -> np.ndarray:
        lower = -np.linalg.solve(M, np.hstack([K, C]))
        return np.vstack([np.hstack([np.zeros((4, 4)), np.eye(4)]), lower])

    states = mb.blades_of(8, [[1, 2, 3]])
    rates = np.column_stack([np.arange(4), np.arange(4) + 4])
    A = mb.first_order(state(M, C, K), psi, omega, states, rates)
    np.testing.assert_allclose(A, state(*mb.second_order(M, C, K, psi, omega, blades)), rtol=1e-12, atol=1e-12)


def test_uncoupled_blades_seen_from_the_support() -> None:
    """Equal oscillators on blades have the frequencies ω and ω ± Ω; the free motion is that of the blades."""
    omega, nature = 0.8, 3.0
    A = np.asarray(np.kron(np.array([[0.0, 1.0], [-(nature**2), 0.0]]), np.eye(3)), float)
    rates = np.column_stack([np.arange(3), np.arange(3) + 3])
    observed = mb.first_order(A, 0.3, omega, mb.blades_of(6, [[0, 1, 2]]), rates)
    result = np.sort(np.abs(np.linalg.eigvals(observed).imag))[::2]
    np.testing.assert_allclose(result, [nature - omega, nature, nature + omega], rtol=1e-12)
    start, time = np.array([0.3, -0.2, 0.5, 0.0, 0.1, 0.7]), 2.1
    T = [mb.transformation(0.3 + omega * t, 3) for t in (0.0, time)]
    z = np.linalg.solve(T[0], start[:3])
    z = expm(observed * time) @ np.concatenate([z, np.linalg.solve(T[0], start[3:]) - omega * mb.rate(3) @ z])
    np.testing.assert_allclose(T[1] @ z[:3], (expm(A * time) @ start)[:3], rtol=1e-10)


def test_invalid_arguments_are_refused() -> None:
    with pytest.raises(ValueError, match="at least 3"):
        mb.blades_of(2, [[0, 1]])
    with pytest.raises(ValueError, match="two groups"):
        mb.blades_of(5, [[0, 1, 2], [2, 3, 4]])
