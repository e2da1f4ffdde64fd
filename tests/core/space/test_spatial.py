"""SE(3): exponential, logarithm and tangents against scipy's matrix exponential and difference quotients."""

import numpy as np
import pytest
from scipy.linalg import expm

from southwell.core.space import spatial as sp


def twists(angle: float) -> np.ndarray:
    z = np.random.default_rng(0).normal(size=(6, 6))
    z[:, 3:] *= angle / np.linalg.norm(z[:, 3:], axis=1, keepdims=True)
    return z


def hat(t: np.ndarray) -> np.ndarray:
    out = np.zeros((4, 4))
    out[:3, :3], out[:3, 3] = sp.skew(t[3:]), t[:3]
    return out


ANGLES = [0.0, 1e-9, 1e-3, 0.1, 1.0, 2.9]


@pytest.mark.parametrize("angle", ANGLES)
def test_exponential_is_the_matrix_exponential(angle: float) -> None:
    z = twists(angle)
    np.testing.assert_allclose(sp.exp(z), np.array([expm(hat(t)) for t in z]), atol=1e-13)


@pytest.mark.parametrize("angle", ANGLES)
def test_logarithm_undoes_the_exponential(angle: float) -> None:
    z = twists(angle)
    np.testing.assert_allclose(sp.log(sp.exp(z)), z, atol=1e-12)


@pytest.mark.parametrize("angle", ANGLES)
def test_tangent_is_its_defining_series_and_inverts(angle: float) -> None:
    z = twists(angle)
    total, term = np.zeros((6, 6, 6)), np.broadcast_to(np.eye(6), (6, 6, 6))
    for k in range(60):
        total, term = total + term, term @ sp.ad(z) / (k + 2)
    np.testing.assert_allclose(sp.tangent(z), total, atol=1e-13)
    np.testing.assert_allclose(sp.tangent(z) @ sp.tangent_inverse(z), np.broadcast_to(np.eye(6), (6, 6, 6)), atol=1e-11)


def test_adjoint_transforms_twists_and_cross_is_dual_to_ad() -> None:
    rng = np.random.default_rng(2)
    x, a, f = sp.exp(rng.normal(size=6)), rng.normal(size=6), rng.normal(size=6)
    np.testing.assert_allclose(x @ hat(a) @ sp.inverse(x), hat(sp.adjoint(x) @ a), atol=1e-13)
    np.testing.assert_allclose(sp.ad(a).T @ f, sp.coadjoint(f) @ a, atol=1e-14)
