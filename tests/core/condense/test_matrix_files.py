"""Matrices exported by other codes: a file written by CalculiX, and every other format written and read back."""

from pathlib import Path

import numpy as np
import pytest
import scipy.io
import scipy.sparse as ss

from southwell.core.condense import condensation, exported, ties
from southwell.core.condense.exported import Exported, MatrixFileError
from southwell.core.condense.matrix_files import read_matrix, stored
from southwell.core.condense.matrix_words import integers, real, reals
from southwell.core.condense.segments import between
from southwell.core.condense.ties import FiniteElements
from southwell.tests.support.solids import at

Array = np.ndarray

NODES = np.repeat([12, 7, 105], 6)
FREEDOMS = np.tile(np.arange(1, 7), 3)
RNG = np.random.default_rng(7)
ROOT = RNG.normal(size=(18, 18)) * 10.0 ** RNG.integers(-2, 3, size=18)
MATRIX = ROOT @ ROOT.T
MATRIX[np.abs(MATRIX) < 0.5] = 0.0


def ordered(e: Exported) -> Array:
    """The matrix with freedoms in the order of NODES and FREEDOMS."""
    where = {key: k for k, key in enumerate(zip(e.nodes.tolist(), (e.directions + 1).tolist(), strict=True))}
    pick = [where[key] for key in zip(NODES.tolist(), FREEDOMS.tolist(), strict=True)]
    return e.matrix.toarray()[np.ix_(pick, pick)]


def entries(kind: str):
    """Index pairs of the given triangle (or all), shuffled, without zeros."""
    i, j = np.indices(MATRIX.shape).reshape(2, -1)
    keep = (MATRIX[i, j] != 0) & {"lower": i >= j, "upper": i <= j, "full": i >= 0}[kind]
    return RNG.permutation(np.column_stack([i, j])[keep])


# CalculiX


def brick() -> FiniteElements:
    """The 0.2 × 0.1 × 0.1 m brick of which CalculiX 2.20 wrote the file, one C3D8I of E = 7e10, ν = 0.3."""
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    corners = [(0.2 * x, 0.1 * y - 0.05, 0.1 * z - 0.05) for z in (0, 1) for x, y in square]
    return exported.model(
        read_matrix(Path(__file__).parents[2] / "data" / "calculix_substructure.mtx"), dict(enumerate(corners, 1))
    )


def test_calculix_substructure_file() -> None:
    """Node by node; six rigid motions without force, and E A/l for pulling (one linear brick locks when bent)."""
    model = brick()
    np.testing.assert_array_equal(model.directions, np.tile([0, 1, 2], 8))
    K = model.stiffness.toarray()
    assert np.abs(K @ ties.motion(model.points, model.directions, np.eye(4))).max() < 1e-12 * np.abs(K).max()
    assert (np.linalg.eigvalsh(K)[6:] > 1e-3 * K.max()).all()
    ends = [
        ties.average(model, np.flatnonzero(model.points[:, 0] == x), at(x), f"{x} m", np.ones(12)) for x in (0.0, 0.2)
    ]
    k = between(condensation.condense(model, ends).stiffness, ties.relative_pose(*ends), "brick")
    f = np.linalg.inv(k)
    assert 0.2 / f[0, 0] == pytest.approx(7e10 * 0.01, rel=1e-9)


def user_element(kinds: tuple[str, ...]) -> str:
    """As Abaqus documents it: freedoms 1–6 of the first node given once, none after."""
    lines = ["** GENERATION OF SUBSTRUCTURE", "*USER ELEMENT, NODES=3, LINEAR", "** ELEMENT NODES", "**    12,     7,"]
    lines += ["**   105", "1, 2, 3, 4, 5, 6"]
    for k, kind in enumerate(kinds):
        lines += [f"*MATRIX, TYPE={kind}"]
        for row in range(18):
            values = [f"{(k + 1) * v:.15e}" for v in MATRIX[row, : row + 1]]
            lines += [", ".join(values[c : c + 4]) for c in range(0, len(values), 4)]
    return "\n".join(lines)


def test_user_element_with_two_matrices(tmp_path: Path) -> None:
    path = tmp_path / "part.mtx"
    path.write_text(user_element(("STIFFNESS", "MASS")))
    np.testing.assert_allclose(ordered(read_matrix(path)), MATRIX, rtol=1e-14)
    np.testing.assert_allclose(ordered(read_matrix(path, "mass")), 2 * MATRIX, rtol=1e-14)


def test_calculix_stored_matrices(tmp_path: Path) -> None:
    """``row column value`` of the upper triangle, with the freedoms in a second file."""
    lines = [f"{i + 1} {j + 1}  {MATRIX[i, j]:.13e}" for i, j in entries("upper")]
    (tmp_path / "part.sti").write_text("\n".join(lines) + "\n")
    (tmp_path / "part.dof").write_text("".join(f"{n}.{d}\n" for n, d in zip(NODES, FREEDOMS, strict=True)))
    np.testing.assert_allclose(ordered(stored(tmp_path / "part.sti")), MATRIX, rtol=1e-12)


# Abaqus


@pytest.mark.parametrize("kind", ["lower", "upper", "full"])
@pytest.mark.parametrize("comma", [", ", " "])
def test_abaqus_matrix_input(tmp_path: Path, kind: str, comma: str) -> None:
    path = tmp_path / "part_STIF1.mtx"
    rows = [[NODES[i], FREEDOMS[i], NODES[j], FREEDOMS[j], f"{MATRIX[i, j]:.15e}"] for i, j in entries(kind)]
    path.write_text("** comment\n" + "\n".join(comma.join(map(str, row)) for row in rows))
    np.testing.assert_allclose(ordered(read_matrix(path)), MATRIX, rtol=1e-14)


@pytest.mark.parametrize("kind", ["lower", "full"])
def test_abaqus_coordinate_names_no_freedoms(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "part_STIF1.mtx"
    path.write_text("\n".join(f"{i + 1} {j + 1} {MATRIX[i, j]:.15e}" for i, j in entries(kind)))
    content = read_matrix(path)
    np.testing.assert_allclose(content.matrix.toarray(), MATRIX, rtol=1e-14)
    assert not len(content.nodes)
    with pytest.raises(MatrixFileError, match="does not name its freedoms"):
        exported.model(content, {})


# Nastran


def nastran_real(value: float, width: int) -> str:
    """The most digits that fit, exponent without E, as Nastran writes in small fields: 1.234+5."""
    for digits in range(width, -1, -1):
        mantissa, exponent = f"{value:.{digits}e}".split("e")
        text = f"{mantissa}{int(exponent):+d}"
        if len(text) <= width:
            return text.rjust(width)
    raise AssertionError(value)


def dmig(name: str, wide: bool, form: int, kind: str) -> list[str]:
    lines = [f"DMIG    {name:8}{0:8d}{form:8d}{2:8d}{0:8d}{'':16}{18:8d}"]
    pairs = entries(kind)
    for j in np.unique(pairs[:, 1]):
        rows = [(NODES[i], FREEDOMS[i], float(MATRIX[i, j])) for i in pairs[pairs[:, 1] == j, 0]]
        if wide:
            lines += [f"DMIG*   {name:16}{NODES[j]:16d}{FREEDOMS[j]:16d}"]
            lines += [f"*       {n:16d}{d:16d}{v:16.9E}".replace("E", "D") for n, d, v in rows]
        else:
            fields = [f"{n:8d}{d:8d}{nastran_real(v, 8)}{'':8}" for n, d, v in rows]
            lines += [f"DMIG    {name:8}{NODES[j]:8d}{FREEDOMS[j]:8d}{'':8}{fields[0]}"]
            lines += ["+       " + "".join(fields[k : k + 2]) for k in range(1, len(fields), 2)]
    return lines


@pytest.mark.parametrize(("wide", "digits"), [(True, 1e-9), (False, 6e-3)], ids=["large field", "small field"])
@pytest.mark.parametrize(("form", "kind"), [(6, "lower"), (6, "upper"), (1, "full")])
def test_nastran_dmig(tmp_path: Path, wide: bool, digits: float, form: int, kind: str) -> None:
    """Read from a file with another matrix and a comment; eight columns hold three digits of a negative number."""
    path = tmp_path / "part.pch"
    other = [
        "$ stiffness",
        "DMIG    MAAX           0       6       2       0",
        "DMIG*   MAAX                           7",
    ]
    other[-1] = f"DMIG*   {'MAAX':16}{7:16d}{1:16d}"
    lines = [*dmig("KAAX", wide, form, kind), *other, f"*       {7:16d}{1:16d}{3.5:16.9E}"]
    path.write_text("\n".join(lines))
    np.testing.assert_allclose(ordered(read_matrix(path, "kaax")), MATRIX, rtol=digits)
    mass = read_matrix(path, "MAAX")
    assert (mass.matrix.toarray(), mass.nodes, mass.directions) == ([[3.5]], [7], [0])


def test_nastran_numbers_that_touch(tmp_path: Path) -> None:
    """A line as MSC Nastran punches it: the negative value fills its field up to the component before it."""
    path = tmp_path / "touch.pch"
    head = f"DMIG    {'KAAX':8}{0:8d}{6:8d}{2:8d}\nDMIG*   {'KAAX':16}{2:16d}{1:16d}\n"
    path.write_text(head + "*                      1               1-1.866666647D+07\n")
    assert read_matrix(path).matrix.toarray()[0, 1] == -1.866666647e7


# Matrix Market


@pytest.mark.parametrize("form", ["symmetric", "general"])
def test_matrix_market(tmp_path: Path, form: str) -> None:
    path = tmp_path / "part.mtx"
    scipy.io.mmwrite(path, ss.coo_array(MATRIX), symmetry=form, precision=17)
    np.testing.assert_allclose(read_matrix(path).matrix.toarray(), MATRIX, rtol=1e-14)


# Models


def test_mass_is_matched_by_freedom_and_summed_by_direction() -> None:
    stiffness = Exported("K", ss.csr_array(np.eye(4)), np.array([1, 1, 2, 2]), np.array([0, 1, 0, 1]))
    order = [3, 0, 2, 1]
    full = np.array([[4.0, 0.5, 1, 0], [0.5, 5, 0, 2], [1, 0, 6, 0.25], [0, 2, 0.25, 7]])
    mass = Exported("M", ss.csr_array(full[np.ix_(order, order)]), stiffness.nodes[order], stiffness.directions[order])
    model = exported.model(stiffness, {1: (0, 0, 0), 2: (1, 2, 3)}, mass)
    np.testing.assert_array_equal(model.mass, [5, 7, 7, 9])
    np.testing.assert_array_equal(model.points[:, 2], [0, 0, 3, 3])
    with pytest.raises(MatrixFileError, match="node 2 has no coordinates"):
        exported.model(stiffness, {1: (0, 0, 0)})
    with pytest.raises(MatrixFileError, match="freedoms are not those of K"):
        exported.model(
            stiffness, {1: (0, 0, 0), 2: (1, 2, 3)}, Exported("M", mass.matrix, mass.nodes + 1, mass.directions)
        )


HEADER = f"DMIG    {'KAAX':8}{0:8d}"


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("", "no matrix found"),
        ("1, 1, 1, 1, 2.0\n1, 1, 2, 1", "line 2: 4 columns"),
        ("hello world", "line 1: 2 columns"),
        ("1 1 2.0\n1 one 2.0", "line 2: 'one' is not a whole number"),
        ("1 1 2.0\n1 2 2.0.0", "line 2: '2.0.0' is not a number"),
        ("1 1 2.0\n1 1 3.0", "is given twice"),
        ("1 1 2.0\n3 3 3.0", "not all from 1 to the last"),
        ("1, 0, 1, 0, 2.0", "freedom 0 of node 1: only 1 to 6"),
        ("%%MatrixMarket matrix coordinate real general\n2 3 1\n1 1 1.0\n", "2 × 3: a stiffness is square"),
        (
            "%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 1.0\n",
            "1 entries, expected 2: the file may be truncated",
        ),
        (
            user_element(("STIFFNESS",))[:-40],
            "values, expected 171 for the triangle of 18 freedoms: the file may be truncated",
        ),
        (user_element(()), "no .MATRIX, TYPE found"),
        (user_element(("MASS", "DAMPING")), "TYPE STIFFNESS not found; there are MASS, DAMPING"),
        (HEADER + f"{2:8d}{2:8d}", "DMIG KAAX has form 2, type 2"),
        (HEADER + f"{6:8d}{4:8d}", "DMIG KAAX has form 6, type 4"),
        (f"DMIG*   {'KAAX':16}{2:16d}{1:16d}", "column of KAAX before its header"),
    ],
)
def test_files_that_are_not_matrices_are_refused(tmp_path: Path, text: str, match: str) -> None:
    path = tmp_path / "bad.mtx"
    path.write_text(text)
    with pytest.raises(MatrixFileError, match=f"bad.mtx.*{match}"):
        read_matrix(path)


def test_freedoms_of_another_run_are_refused(tmp_path: Path) -> None:
    (tmp_path / "part.sti").write_text("1 1 2.0\n")
    (tmp_path / "part.dof").write_text("1.1\n1.2\n")
    with pytest.raises(MatrixFileError, match=r"part\.sti: 1 rows, but 2 freedoms"):
        stored(tmp_path / "part.sti")


def test_many_words_at_once_are_read_as_one_alone() -> None:
    plain, odd = ["1", "-2.5", "+.5e-3", "7."], ["1.5D+03", "1.5+3", "2.-1"]
    assert (
        reals("x", [1, 2, 3, 4], plain).tolist() == [real("x", 1, word) for word in plain] == [1.0, -2.5, 0.0005, 7.0]
    )
    assert reals("x", [*range(7)], plain + odd).tolist() == [1.0, -2.5, 0.0005, 7.0, 1500.0, 1500.0, 0.2]
    assert integers("x", [1, 2, 3], ["1", "-2", "+30"]).tolist() == [1, -2, 30]
    for invalid in ("1e31", "1e999", "nan", "1_0", "e5", "1e", "--1", ""):
        with pytest.raises(MatrixFileError, match="x, line 8: "):
            reals("x", [7, 8], ["1.0", invalid])
    for invalid in ("2147483648", "99999999999999999999999", "1.0", "1_0", "1-2", ""):
        with pytest.raises(MatrixFileError, match="x, line 8: "):
            integers("x", [7, 8], ["1", invalid])
