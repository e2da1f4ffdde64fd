"""Block-tridiagonal matrices against dense ones, and the cache of compiled code."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from southwell.core import compiled, compiled_files, regular_files
from southwell.core.chain import blocks
from southwell.core.chain.blocks import Tridiagonal

SIZES = [(1, 6), (2, 12), (7, 12), (7, 6)]


def random(n: int, d: int) -> tuple[Tridiagonal, np.ndarray]:
    """A matrix, far from symmetric, and the same matrix dense."""
    rng = np.random.default_rng(n * d)
    t = Tridiagonal(
        rng.normal(size=(n, d, d)) + 8 * np.eye(d), rng.normal(size=(n - 1, 6, d)), rng.normal(size=(n - 1, d, 6))
    )
    full = np.zeros((n * d, n * d))
    for k in range(n):
        at, end = d * k, d * (k + 1)
        full[at:end, at:end] = t.diagonal[k]
        if k + 1 < n:
            full[end - 6 : end, end : end + d] = t.upper[k]
            full[end : end + d, end - 6 : end] = t.lower[k]
    return t, full


@pytest.mark.parametrize(("n", "d"), SIZES)
@pytest.mark.parametrize("vectors", [1, 2, 5])
def test_products_and_solutions_are_those_of_the_dense_matrix(n: int, d: int, vectors: int) -> None:
    t, full = random(n, d)
    np.testing.assert_array_equal(blocks.dense(t), full)
    x = np.random.default_rng(1).normal(size=(vectors, n * d))
    product = np.empty_like(x)
    blocks.times(blocks.transposed(t), x, product)
    np.testing.assert_allclose(product, x @ full.T, rtol=1e-12, atol=1e-12)
    blocks.solve(blocks.factor(t), product)
    np.testing.assert_allclose(product, x, rtol=1e-10, atol=1e-12)


def symmetric(least: float) -> Tridiagonal:
    """A symmetric matrix with the given smallest eigenvalue."""
    rng = np.random.default_rng(3)
    a, upper = rng.normal(size=(4, 12, 12)), rng.normal(size=(3, 6, 12))
    t = Tridiagonal(a + np.swapaxes(a, -1, -2), upper, np.swapaxes(upper, -1, -2))
    shift = least - np.linalg.eigvalsh(blocks.dense(t))[0]
    return Tridiagonal(t.diagonal + shift * np.eye(12), t.upper, t.lower)


@pytest.mark.parametrize("least", [1.0, 1e-6, -1e-6, -1.0])
def test_the_factor_detects_a_positive_definite_matrix(least: float) -> None:
    assert blocks.factor(symmetric(least)).positive == (least > 0)


def test_a_singular_matrix_is_refused() -> None:
    t, _ = random(3, 6)
    t.diagonal[0] = 0.0
    with pytest.raises(np.linalg.LinAlgError, match="singular"):
        blocks.factor(t)


def test_compiled_code_is_invalidated_by_a_change(tmp_path: Path) -> None:
    """A compiled function calls one of another file; when that changes, the caller must be compiled again."""
    package = tmp_path / "loops"
    package.mkdir()
    for module in (compiled, compiled_files, regular_files):
        shutil.copy(str(module.__file__), package)
    (package / "__init__.py").touch()
    (package / "outer.py").write_text(
        "from . import inner\nfrom .compiled import compiled\n\n@compiled\ndef outer(x):\n    return inner.inner(x) + 1.0\n"
    )

    def found(expression: str) -> float:
        (package / "inner.py").write_text(
            f"from .compiled import compiled\n\n@compiled\ndef inner(x):\n    return {expression}\n"
        )
        code = "from loops.outer import outer; print(outer(3.0))"
        run = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
        return float(run.stdout)

    assert [found("2.0 * x"), found("5.0 * x")] == [7.0, 16.0]
    assert len(list((package / "__pycache__").glob("compiled-*"))) == 1  # the old one is deleted
