"""Matrix Market files of real square matrices: coordinate or array; general, symmetric or skew-symmetric.

Read here, line by line, since a parser in C may crash where a file was cut off inside a number, and allocates what a
header of two numbers asks for. Source: R. Boisvert, R. Pozo, K. Remington, *The Matrix Market exchange formats*, NISTIR
5935 (1996).
"""

import numpy as np
import scipy.sparse as ss

from .exported import Exported, MatrixFileError
from .matrix_words import real, whole

MOST_ROWS = 1_000_000
"""Of a matrix of entries; one that is written whole has as many as the file's length allows."""

SIGN = {"general": 0.0, "symmetric": 1.0, "skew-symmetric": -1.0}
"""Of the entries' counterparts; 0: the file has them itself."""


def read(name: str, text: str) -> Exported:
    """The matrix (n, n) in the text of a file; no freedoms are named.

    Args:
        name: of the file.
        text: all of it.

    Raises:
        MatrixFileError: another kind of matrix, not square, broken off, or with an entry that it has no place for.
    """
    lines = text.splitlines()
    words = lines[0].lower().split()
    if len(words) != 5 or words[2] not in ("coordinate", "array") or words[3] not in ("real", "integer", "double"):
        raise MatrixFileError(f"{name}: not a Matrix Market file of real numbers: its first line is {lines[0][:80]!r}")
    if words[4] not in SIGN:
        raise MatrixFileError(f"{name}: {words[4][:40]!r}: general, symmetric and skew-symmetric matrices are read")
    rest = [(k, line.split()) for k, line in enumerate(lines, 1) if line.strip() and not line.startswith("%")]
    sparse = words[2] == "coordinate"
    if not rest or len(rest[0][1]) != (3 if sparse else 2):
        raise MatrixFileError(f"{name}: not a Matrix Market file: no line with its size: broken off?")
    number, size = rest[0]
    rows, columns, *_ = (whole(name, number, word) for word in size)
    if rows != columns:
        raise MatrixFileError(f"{name}: a matrix of {rows} × {columns}: a stiffness is square")
    if not 0 < rows <= MOST_ROWS:
        raise MatrixFileError(f"{name}, line {number}: {rows} rows: 1 to {MOST_ROWS} are read")
    sign = SIGN[words[4]]
    if sparse:
        return _entries(name, rest[1:], rows, whole(name, number, size[2]), sign)
    return _whole(name, rest[1:], rows, sign)


def _entries(name: str, lines: list[tuple[int, list[str]]], n: int, count: int, sign: float) -> Exported:
    if len(lines) != count:
        raise MatrixFileError(f"{name}: {len(lines)} entries, expected {count}: broken off?")
    at, values = np.zeros((count, 2), dtype=np.intp), np.zeros(count)
    for k, (number, words) in enumerate(lines):
        if len(words) != 3:
            raise MatrixFileError(f"{name}, line {number}: {len(words)} columns: row, column, value: broken off?")
        at[k], values[k] = [whole(name, number, word) for word in words[:2]], real(name, number, words[2])
        if not (1 <= at[k, 0] <= n and 1 <= at[k, 1] <= n):
            raise MatrixFileError(
                f"{name}, line {number}: entry {at[k].tolist()} of a matrix with {n} rows: correct it"
            )
    i, j = at.T - 1
    if len(np.unique(i * n + j)) != count:
        raise MatrixFileError(f"{name}: an entry is given twice: two matrices in one file?")
    other = np.flatnonzero(i != j) if sign else np.zeros(0, dtype=np.intp)
    if sign and len(np.unique(np.minimum(i, j) * n + np.maximum(i, j))) != count:
        raise MatrixFileError(f"{name}: both triangles, though its first line announces one: correct that line")
    values = np.concatenate([values, sign * values[other]])
    rows, columns = np.concatenate([i, j[other]]), np.concatenate([j, i[other]])
    return Exported(name, ss.csr_array((values, (rows, columns)), shape=(n, n)))


def _whole(name: str, lines: list[tuple[int, list[str]]], n: int, sign: float) -> Exported:
    """Column by column; of one triangle the lower, without the diagonal of a skew-symmetric one."""
    count = n * n if not sign else n * (n + 1) // 2 if sign > 0 else n * (n - 1) // 2
    if len(lines) != count:
        raise MatrixFileError(f"{name}: {len(lines)} values, expected {count} for {n} rows: broken off?")
    if wrong := next((k for k, words in lines if len(words) != 1), None):
        raise MatrixFileError(f"{name}, line {wrong}: one value in each line of an array: correct it")
    values = [real(name, k, words[0]) for k, words in lines]
    matrix = np.zeros((n, n))
    if not sign:
        return Exported(name, ss.csr_array(np.array(values).reshape(n, n).T))
    columns, rows = np.triu_indices(n, 0 if sign > 0 else 1)  # the lower triangle, column by column
    matrix[rows, columns] = values
    matrix[columns, rows] = sign * np.array(values)
    return Exported(name, ss.csr_array(matrix))
