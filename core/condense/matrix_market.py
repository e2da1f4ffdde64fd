"""Matrix Market files of real square matrices: coordinate or array; general, symmetric or skew-symmetric.

Files are parsed in Python: a parser in C may crash at a number that was cut off, and allocates whatever size a header
states. Source: R. Boisvert, R. Pozo, K. Remington, *The Matrix Market exchange formats*, NISTIR 5935 (1996).
"""

import numpy as np
import scipy.sparse as ss

from .exported import Exported, MatrixFileError
from .matrix_words import integer, integers, reals

MOST_ROWS = 1_000_000
"""Largest number of rows; the length of the file limits a dense matrix further."""

SIGN = {"general": 0.0, "symmetric": 1.0, "skew-symmetric": -1.0}
"""Sign of the mirrored entries; 0: the file contains all entries."""


def read_matrix_market(name: str, text: str) -> Exported:
    """The matrix (n, n) in the text of a file; the format does not name freedoms.

    Args:
        name: of the file, for messages.
        text: its content.

    Raises:
        MatrixFileError: another kind of matrix, not square, truncated, or with an entry outside it.
    """
    lines = text.splitlines()
    words = lines[0].lower().split()
    if len(words) != 5 or words[2] not in ("coordinate", "array") or words[3] not in ("real", "integer", "double"):
        raise MatrixFileError(f"{name}: not a Matrix Market file of real numbers: its first line is {lines[0][:80]!r}")
    if words[4] not in SIGN:
        raise MatrixFileError(f"{name}: {words[4][:40]!r}: only general, symmetric or skew-symmetric matrices are read")
    numbers = [k for k, line in enumerate(lines, 1) if line.strip() and not line.startswith("%")]
    size = lines[numbers[0] - 1].split() if numbers else []
    sparse = words[2] == "coordinate"
    if len(size) != (3 if sparse else 2):
        raise MatrixFileError(f"{name}: not a Matrix Market file: no line with its size: the file may be truncated")
    number, *numbers = numbers
    rows, columns, *_ = (integer(name, number, word) for word in size)
    if rows != columns:
        raise MatrixFileError(f"{name}: a matrix of {rows} × {columns}: a stiffness is square")
    if not 0 < rows <= MOST_ROWS:
        raise MatrixFileError(f"{name}, line {number}: {rows} rows: only 1 to {MOST_ROWS} are read")
    sign, content = SIGN[words[4]], [lines[k - 1] for k in numbers]
    if sparse:
        return _entries(name, numbers, content, rows, integer(name, number, size[2]), sign)
    return _whole(name, numbers, content, rows, sign)


def _entries(name: str, numbers: list[int], lines: list[str], n: int, count: int, sign: float) -> Exported:
    if len(lines) != count:
        raise MatrixFileError(f"{name}: {len(lines)} entries, expected {count}: the file may be truncated")
    for number, line in zip(numbers, lines, strict=True):
        if (columns := len(line.split())) != 3:
            raise MatrixFileError(
                f"{name}, line {number}: {columns} columns, expected row, column, value: the line may be truncated"
            )
    words = " ".join(lines).split()
    i, j = integers(name, numbers, words[0::3]) - 1, integers(name, numbers, words[1::3]) - 1
    values = reals(name, numbers, words[2::3])
    for k in np.flatnonzero((np.minimum(i, j) < 0) | (np.maximum(i, j) >= n))[:1]:
        entry = [int(i[k]) + 1, int(j[k]) + 1]
        raise MatrixFileError(f"{name}, line {numbers[k]}: entry {entry} of a matrix with {n} rows: correct it")
    if len(np.unique(i * n + j)) != count:
        raise MatrixFileError(f"{name}: an entry is given twice: give one matrix per file")
    off_diagonal = np.flatnonzero(i != j) if sign else np.zeros(0, dtype=np.intp)
    if sign and len(np.unique(np.minimum(i, j) * n + np.maximum(i, j))) != count:
        raise MatrixFileError(f"{name}: both triangles, but its first line declares one: correct that line")
    values = np.concatenate([values, sign * values[off_diagonal]])
    rows, columns = np.concatenate([i, j[off_diagonal]]), np.concatenate([j, i[off_diagonal]])
    return Exported(name, ss.csr_array((values, (rows, columns)), shape=(n, n)))


def _whole(name: str, numbers: list[int], lines: list[str], n: int, sign: float) -> Exported:
    """A dense matrix column by column; of a symmetric one the lower triangle, of a skew-symmetric one without diagonal."""
    count = n * n if not sign else n * (n + 1) // 2 if sign > 0 else n * (n - 1) // 2
    if len(lines) != count:
        raise MatrixFileError(f"{name}: {len(lines)} values, expected {count} for {n} rows: the file may be truncated")
    for number, line in zip(numbers, lines, strict=True):
        if len(line.split()) != 1:
            raise MatrixFileError(f"{name}, line {number}: an array has one value per line: correct it")
    values = reals(name, numbers, [line.strip() for line in lines])
    matrix = np.zeros((n, n))
    if not sign:
        return Exported(name, ss.csr_array(values.reshape(n, n).T))
    columns, rows = np.triu_indices(n, 0 if sign > 0 else 1)  # the lower triangle, column by column
    matrix[rows, columns] = values
    matrix[columns, rows] = sign * values
    return Exported(name, ss.csr_array(matrix))
