"""A finite element model of beams, one node a section: what `southwell condense` makes of it is known in closed form."""

import re
from pathlib import Path

import numpy as np
import pytest
import scipy.io as sio
import scipy.sparse as ss

from southwell.cases.condense.condensing import condense
from southwell.cases.input.errors import CaseError

EA, GJ, EI, MASS, SPAN, NODES = 1e9, 1e7, 2e7, 50.0, 8.0, 9

PAGE = (Path(__file__).parents[3] / "docs" / "condense.md").read_text(encoding="utf-8")

(FILE,) = (block for block in re.findall(r"^```toml\n(.*?)^```", PAGE, re.M | re.S) if "stiffness =" in block)
"""The example on the site."""


def matrices() -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and consistent mass of Euler and Bernoulli's elements along x: Przemieniecki (1968), ch. 5 and 11."""
    h = SPAN / (NODES - 1)
    K, M = np.zeros((2, 6 * NODES, 6 * NODES))
    bar, halves = np.array([[1, -1], [-1, 1]]), np.array([[2, 1], [1, 2]]) / 6
    for a in range(0, 6 * (NODES - 1), 6):
        for k, stiff, heavy in ((0, EA, MASS), (3, GJ, 0.5)):
            at = np.ix_([a + k, a + 6 + k], [a + k, a + 6 + k])
            K[at] += stiff / h * bar
            M[at] += heavy * h * halves
        for moves, turns, sign in ((1, 5, 1.0), (2, 4, -1.0)):
            scale = np.diag([1.0, sign * h, 1.0, sign * h])
            k = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
            m = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]])
            at = np.ix_(
                [a + moves, a + turns, a + 6 + moves, a + 6 + turns],
                [a + moves, a + turns, a + 6 + moves, a + 6 + turns],
            )
            K[at] += EI / h**3 * scale @ k @ scale
            M[at] += MASS * h / 420 * scale @ m @ scale
    return K, M


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name, matrix in zip("KM", matrices(), strict=True):
        sio.mmwrite(tmp_path / f"{name}.mtx", ss.coo_array(matrix), symmetry="symmetric")
    rows = "".join(f"{k + 1},{k * SPAN / (NODES - 1)},0,0\n" for k in range(NODES))
    (tmp_path / "nodes.csv").write_text(f"id,x,y,z\n{rows}")
    (tmp_path / "bar.toml").write_text(FILE)
    return tmp_path


def test_a_section_of_one_node_is_that_node(folder: Path) -> None:
    """Sections two elements apart: a beam of twice the length, both stiffness and mass about its first end."""
    length = 2.0
    exact = [EA / length, 12 * EI / length**3, 12 * EI / length**3, GJ / length, 4 * EI / length, 4 * EI / length]
    segments = condense(folder / "bar.toml").blade.segments
    assert len(segments) == 4
    for segment in segments:
        np.testing.assert_allclose(np.diagonal(segment.stiffness), exact, rtol=1e-9)
        np.testing.assert_allclose(segment.stiffness[1, 5], 6 * EI / length**2, rtol=1e-9)
        np.testing.assert_allclose(segment.inertia[0, 0], MASS * length, rtol=1e-9)


@pytest.mark.parametrize(
    ("content", "phrase"),
    [
        (b"\x89HDF\r\n\x1a\n\x00\x00", "K.mtx: not a text file"),
        ("%%MatrixMarket".encode("utf-16"), "K.mtx: not a text file"),
        (b"", "no matrix found"),
    ],
)
def test_a_matrix_that_is_no_text_is_reported(folder: Path, content: bytes, phrase: str) -> None:
    (folder / "K.mtx").write_bytes(content)
    with pytest.raises(CaseError, match=phrase) as caught:
        condense(folder / "bar.toml")
    assert "\n" not in str(caught.value)


def test_a_node_with_displacements_alone_cannot_be_a_section(folder: Path) -> None:
    keep = np.arange(6 * NODES) % 6 < 3
    across = np.arange(3 * NODES) % 3 > 0
    for name, matrix in zip("KM", matrices(), strict=True):
        bars = matrix[np.ix_(keep, keep)]
        if name == "K":  # a chain of bars: without rotations there is no bending
            bars[across] = bars[:, across] = 0.0
        sio.mmwrite(folder / f"{name}.mtx", ss.coo_array(bars), symmetry="symmetric")
    (folder / "bar.toml").write_text(FILE.replace("[1, 2, 3, 4, 5, 6]", "[1, 2, 3]"))
    with pytest.raises(CaseError, match="in a beam model, the six freedoms of the node"):
        condense(folder / "bar.toml")
