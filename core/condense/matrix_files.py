"""Stiffness (and mass) matrices that other codes export as text, with the freedoms they belong to.

Formats, recognised by content (the last by name):

* CalculiX and Abaqus ``*SUBSTRUCTURE MATRIX OUTPUT, OUTPUT FILE=USER DEFINED``: a ``*USER ELEMENT`` with its nodes in
  comments, lines of the freedoms that are active from each node on, and ``*MATRIX, TYPE=STIFFNESS`` or ``MASS`` with the
  lower triangle row by row. CalculiX 2.20 names a node once for each of its freedoms;
* Abaqus ``*MATRIX OUTPUT``: lines ``node, freedom, node, freedom, value`` (FORMAT=MATRIX INPUT) or ``row column value``
  (FORMAT=COORDINATE, no freedoms named), either triangle or both, commas or blanks between;
* Nastran ``DMIG`` in fixed fields, small (8) or large (16, ``DMIG*``), as punched by EXTSEOUT(DMIGPCH); real matrices that
  are square (1) or symmetric (6, either triangle), exponents with ``E``, ``D`` or a bare sign;
* Matrix Market, coordinate or array (no freedoms named), see ``matrix_market``;
* CalculiX ``*FREQUENCY, SOLVER=MATRIXSTORAGE`` by ``stored``: ``row column value`` in ``.sti`` and ``.mas``, with the freedoms
  ``node.component`` of the rows in ``.dof``.

Freedoms 1–3 are displacements along x, y, z and 4–6 rotations about them.
"""

import re
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as ss

from ..regular_files import LARGEST_DATA, read_bytes
from . import matrix_market
from .exported import Exported, MatrixFileError, assembled, labelled
from .matrix_words import integer, integers, real, reals

REAL = (1, 2)
SQUARE, SYMMETRIC = 1, 6


def read_matrix(path: Path, requested: str = "stiffness") -> Exported:
    """Read one matrix.

    Args:
        path: of the file, in one of the formats above.
        requested: the matrix, where the file has several: the TYPE of a user element's ``*MATRIX`` (stiffness, mass), or the
            name of a DMIG (KAAX, MAAX). A file with one matrix is read whatever its name.

    Raises:
        MatrixFileError: not one of these formats, truncated, or without that matrix.
        OSError: if there is no such file.
    """
    text = read_bytes(path, LARGEST_DATA).decode("utf-8-sig", errors="replace")
    if "\0" in text:
        raise MatrixFileError(
            f"{path.name}: not a text file in UTF-8: export the matrix as text, or convert a file in UTF-16"
        )
    if text.startswith("%%MatrixMarket"):
        return matrix_market.read_matrix_market(path.name, text)
    lines = text.upper().splitlines()
    if any(line.startswith("*USER ELEMENT") for line in lines):
        return _user_element(path.name, lines, requested.upper())
    if any(line.startswith("DMIG") for line in lines):
        return _dmig(path.name, lines, requested.upper())
    return _triplets(path.name, text.splitlines())


def stored(path: Path) -> Exported:
    """A matrix stored by CalculiX, with the freedoms from the ``.dof`` file in the same folder.

    Raises:
        MatrixFileError: as ``read_matrix``, or if the numbers of freedoms and rows differ.
        OSError: if either file is missing.
    """
    matrix: Any = read_matrix(path).matrix
    dof = path.with_suffix(".dof")
    words = [w.split(".") for w in read_bytes(dof, LARGEST_DATA).decode(errors="replace").split()]
    rows = matrix.shape[0]
    if len(words) != rows:
        raise MatrixFileError(
            f"{path.name}: {rows} rows, but {len(words)} freedoms in its .dof: use both files of one run"
        )
    if any(len(w) != 2 for w in words):
        raise MatrixFileError(f"{dof.name}: expected node.component on each line, as CalculiX writes it")
    freedoms = np.array([[integer(dof.name, k, v) for v in w] for k, w in enumerate(words, 1)])
    return labelled(path.name, matrix, freedoms)


def _user_element(name: str, lines: list[str], requested: str) -> Exported:
    nodes: list[int] = []
    active: dict[int, list[int]] = {}  # position among the nodes → freedoms from there on
    triangles: dict[str, list[float]] = {}
    card = ""
    for number, line in enumerate(lines, 1):
        words = re.findall(r"[^\s,]+", line)
        if line.startswith("**"):
            if "ELEMENT NODES" in line:
                card = "nodes"
            elif card == "nodes" and re.fullmatch(r"[*\s\d,]+", line):
                nodes += [integer(name, number, v) for v in re.findall(r"\d+", line)]
        elif line.startswith("*"):
            kind = re.search(r"^\*MATRIX\s*,\s*TYPE\s*=\s*(\w+)", line)
            card = kind[1] if kind else ""
            if kind:
                triangles[card] = []
        elif card == "nodes":
            numbers = [integer(name, number, w) for w in words]
            if not numbers:
                continue
            active[numbers[0] if active else 1] = numbers[1:] if active else numbers
        elif card:
            triangles[card] += reals(name, [number] * len(words), words).tolist()
    key = _chosen(name, "*MATRIX, TYPE", list(triangles), requested)
    freedoms: list[tuple[int, int]] = []
    now: list[int] = []
    for position, node in enumerate(nodes, 1):
        now = active.get(position, now)
        freedoms += [(node, f) for f in now]
    n, values = len(freedoms), triangles[key]
    if len(values) != n * (n + 1) // 2:
        raise MatrixFileError(
            f"{name}: {len(values)} values, expected {n * (n + 1) // 2} for the triangle of {n} freedoms: the file may be "
            "truncated"
        )
    dense = np.zeros((n, n))
    dense[np.tril_indices(n)] = values
    return labelled(name, ss.csr_array(dense + np.tril(dense, -1).T), np.array(freedoms, dtype=np.intp).reshape(-1, 2))


def _triplets(name: str, lines: list[str]) -> Exported:
    numbers: list[int] = []
    rows: list[list[str]] = []
    for number, line in enumerate(lines, 1):
        words = line.replace(",", " ").split()
        if not words or words[0][0] in "*%#$":
            continue
        width = len(rows[0]) if rows else len(words)
        if len(words) != width or width not in (3, 5):
            raise MatrixFileError(
                f"{name}, line {number}: {len(words)} columns, expected row, column, value, or node, freedom, node, "
                "freedom, value: the file may be truncated or in another format"
            )
        numbers.append(number)
        rows.append(words)
    if not rows:
        raise MatrixFileError(f"{name}: no matrix found: docs/condense.md lists the formats")
    *labels, entries = zip(*rows, strict=True)
    at = np.column_stack([integers(name, numbers, column) for column in labels])
    values = reals(name, numbers, entries)
    if at.shape[1] == 4:
        return assembled(name, at[:, :2], at[:, 2:], values)
    component = np.ones(len(at), np.intp)
    by_number = assembled(name, np.column_stack([at[:, 0], component]), np.column_stack([at[:, 1], component]), values)
    if (by_number.nodes != 1 + np.arange(len(by_number.nodes))).any():
        raise MatrixFileError(
            f"{name}: rows {by_number.nodes.tolist()[:3]}…: not all from 1 to the last: some rows have no entries"
        )
    return Exported(name, by_number.matrix)


def _dmig(name: str, lines: list[str], requested: str) -> Exported:
    forms: dict[str, tuple[int, int]] = {}
    entries: dict[str, list[tuple[int, int, int, int]]] = {}
    values: dict[str, list[float]] = {}
    matrix, column = "", (0, 0)
    for number, line in enumerate(lines, 1):
        width = 16 if "*" in line[:8] else 8
        words = [line[k : k + width].strip() for k in range(8, max(len(line), 9), width)]
        words += [""] * (8 - len(words))
        if line.startswith("DMIG"):
            matrix = words[0]
            if words[1] == "0":
                forms[matrix] = integer(name, number, words[2]), integer(name, number, words[3])
                entries[matrix], values[matrix] = [], []
                continue
            if matrix not in forms:
                raise MatrixFileError(
                    f"{name}, line {number}: column of {matrix} before its header: the start of the file may be missing"
                )
            column = integer(name, number, words[1]), integer(name, number, words[2])
            words = words[4:] if width == 8 else []
        elif not matrix or line[:1] not in "+* " or not line.strip():
            matrix = matrix if not line.strip() or line.startswith("$") else ""
            continue
        for k in range(0, len(words) - 2, 4):
            if words[k]:
                row = integer(name, number, words[k]), integer(name, number, words[k + 1])
                entries[matrix].append((*row, *column))
                values[matrix].append(real(name, number, words[k + 2]))
    key = _chosen(name, "DMIG", list(entries), requested)
    form, numbers = forms[key]
    if form not in (SQUARE, SYMMETRIC) or numbers not in REAL:
        raise MatrixFileError(
            f"{name}: DMIG {key} has form {form}, type {numbers}: form 1 (square) or 6 (symmetric), type 1 or 2 (real) is read"
        )
    at = np.array(entries[key], dtype=np.intp).reshape(-1, 4)
    return assembled(name, at[:, :2], at[:, 2:], np.array(values[key]), mirror=form == SYMMETRIC)


def _chosen(name: str, kind: str, available: list[str], requested: str) -> str:
    if not available:
        raise MatrixFileError(f"{name}: no {kind} found: the file may be truncated")
    if requested not in available and len(available) > 1:
        raise MatrixFileError(f"{name}: {kind} {requested} not found; there are {', '.join(available)}")
    return requested if requested in available else available[0]
