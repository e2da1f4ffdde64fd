"""The exported matrices and node tables that a file for ``southwell condense`` names, as a model in SI units."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy.sparse as ss
from numpy.typing import NDArray

from ...core.condense import exported, matrix_files, ties
from ...core.condense.exported import Exported, MatrixFileError
from ...core.condense.ties import CondensationError, FiniteElements
from ..input import files
from ..input.blades import read_table
from ..input.errors import CaseError
from .schema import Matrix, Model

Array = NDArray[np.float64]

NODES = ("id", "x", "y", "z")
FREEDOMS = ("node", "freedom")

ROUNDING = 1e-9
"""Negative diagonal entries up to this fraction of the largest entry count as zero."""

LARGEST_ID = 2**31
"""Of a node."""

METRES = {"m kg s": 1.0, "mm t s": 1e-3}
"""Metres per unit of length. In mm t s forces are still in N: stiffness (N/mm) and mass (t) are both multiplied by 1000."""


@dataclass(frozen=True)
class Whole:
    """A model as exported.

    Attributes:
        model: to condense.
        mass: (n, n) in the order of its freedoms; None where there is none.
        resisted: the largest part of the forces in it that a rigid motion of the whole leaves unbalanced.
    """

    model: FiniteElements
    mass: ss.csr_array | None
    resisted: float


def read(path: Path, field: str, spec: Model, common: Model, units: str) -> Whole:
    """The model in ``spec``, with missing keys from ``common``.

    Args:
        path: the file with the model; other paths are relative to its folder.
        field: position in the file, for messages.
        spec: the model.
        common: defaults for all segments.
        units: of nodes and matrices.

    Raises:
        CaseError: naming the file and field at fault.
    """
    if spec.stiffness is None:
        raise CaseError(f"{path}: {field}stiffness: missing: name the file of a stiffness matrix")
    nodes = spec.nodes or common.nodes
    if nodes is None:
        raise CaseError(f"{path}: {field}nodes: missing: name a CSV of {', '.join(NODES)}")
    positions = _places(path.parent / nodes)
    listed = spec.freedoms if spec.freedoms is not None else common.freedoms
    mass = None
    try:
        stiffness = _named(_load(path.parent, spec.stiffness, "stiffness"), listed, positions, path, field)
        if spec.mass is not None:
            mass = _named(_load(path.parent, spec.mass, "mass"), listed, positions, path, field)
        for quantity, matrix in (("stiffness", stiffness), ("mass", mass)):
            if matrix is not None:
                _no_negative(f"{path}: {field}{quantity}", matrix)
        model = exported.model(stiffness, positions, mass)
    except (MatrixFileError, CondensationError) as error:
        raise CaseError(f"{path}: {field}{error}") from error
    model = _si(model, METRES[units])
    resisted = _unsupported(path, field, model)
    if mass is None:
        return Whole(model, None, resisted)
    unit = _unit(model.directions, METRES[units])
    return Whole(model, ss.csr_array(unit @ _in_order(mass, stiffness) @ unit), resisted)


def _load(folder: Path, spec: str | Matrix, quantity: str) -> Exported:
    name, matrix = (spec.file, spec.matrix) if isinstance(spec, Matrix) else (spec, quantity)
    path = folder / name
    with files.readable(path, "paths are relative to the file that names them; correct the name"):
        if os.path.isfile(path.with_suffix(".dof")):
            return matrix_files.stored(path)
        return matrix_files.read_matrix(path, matrix)


def _no_negative(where: str, matrix: Exported) -> None:
    """Reject negative diagonal entries, which no finite element model has."""
    diagonal = matrix.matrix.diagonal()
    if diagonal.size and diagonal.min() < -ROUNDING * np.abs(diagonal).max():
        k = int(diagonal.argmin())
        freedom = f"node {matrix.nodes[k]}, freedom {matrix.directions[k] + 1}"
        raise CaseError(f"{where}: {matrix.name}: {diagonal[k]:g} on the diagonal at {freedom}: negative: correct it")


def _places(path: Path) -> dict[int, Array]:
    columns = read_table(path, NODES)
    ids = _integers(path, "id", columns["id"])
    values, times = np.unique(ids, return_counts=True)
    if (times > 1).any():
        raise CaseError(f"{path}: id: {values[times.argmax()]} is given {times.max()} times: a node has one position")
    return dict(zip(ids.tolist(), np.column_stack([columns[c] for c in NODES[1:]]), strict=True))


def _integers(path: Path, column: str, values: Array) -> NDArray[np.intp]:
    invalid = (values != np.round(values)) | (np.abs(values) >= LARGEST_ID)
    if invalid.any():
        raise CaseError(f"{path}: {column}: {values[invalid.argmax()]:g}: labels are whole numbers: correct it")
    return values.astype(np.intp)


def _named(
    matrix: Exported, listed: str | Sequence[int] | None, positions: dict[int, Array], path: Path, field: str
) -> Exported:
    if len(matrix.nodes):
        if listed is not None:
            raise CaseError(f"{path}: {field}freedoms: {matrix.name} names its own freedoms: remove this key")
        return matrix
    if listed is None:
        raise CaseError(
            f"{path}: {field}freedoms: missing: {matrix.name} does not name its freedoms: give those of each node as in "
            f"[1, 2, 3], or a CSV of {', '.join(FREEDOMS)}"
        )
    rows = int(matrix.matrix.diagonal().size)
    if isinstance(listed, str):
        table = read_table(path.parent / listed, FREEDOMS)
        at = path.parent / listed
        pairs, spec = (
            np.column_stack([_integers(at, c, table[c]) for c in FREEDOMS]),
            f"{listed} lists {len(table['node'])}",
        )
    else:
        pairs = np.array([(n, f) for n in positions for f in listed])
        spec = f"{len(positions)} nodes with {len(listed)} each are {len(pairs)}"
    if len(pairs) != rows:
        raise CaseError(
            f"{path}: {field}freedoms: {spec}, {matrix.name} has {rows} rows: both must be of the same unconstrained model"
        )
    return exported.labelled(matrix.name, matrix.matrix, pairs)


def _in_order(mass: Exported, stiffness: Exported) -> ss.csr_array:
    """The mass matrix in the order of the stiffness matrix's freedoms, which must be the same."""
    keys = [list(zip(e.nodes.tolist(), e.directions.tolist(), strict=True)) for e in (mass, stiffness)]
    where = {key: k for k, key in enumerate(keys[0])}
    pick = np.array([where[key] for key in keys[1]])
    permutation = ss.csr_array((np.ones(len(pick)), (np.arange(len(pick)), pick)))
    return ss.csr_array(permutation @ (mass.matrix @ permutation.T))


def _unit(directions: NDArray[np.intp], metres: float) -> ss.csr_array:
    """Square roots of what stiffness and mass scale by: 1/metres between displacements, metres between rotations."""
    return ss.csr_array(ss.diags_array(np.where(directions < 3, metres**-0.5, metres**0.5)))


def _si(model: FiniteElements, metres: float) -> FiniteElements:
    unit = _unit(model.directions, metres)
    stiffness = ss.csr_array(unit @ model.stiffness @ unit)
    return FiniteElements(
        model.name, metres * model.points, model.directions, stiffness, unit.diagonal() ** 2 * model.mass
    )


def _unsupported(path: Path, field: str, model: FiniteElements) -> float:
    """The largest relative force against a rigid motion of the whole, which must vanish.

    Raises:
        CaseError: naming the motion.
    """
    R = ties.motion(model.points - model.points.mean(axis=0), model.directions, np.eye(4))
    scale = (abs(model.stiffness) @ np.abs(R)).max(
        axis=0
    )  # none at all where nothing resists the motion, nor any part of it
    residual = np.abs(model.stiffness @ R).max(axis=0) / np.where(scale > 0, scale, 1.0)
    if residual.max() > ties.ASYMMETRY:
        k = int(residual.argmax())
        motion = f"{'translation along' if k < 3 else 'rotation about'} {'xyz'[k % 3]}"
        raise CaseError(
            f"{path}: {field}stiffness: {model.name} resists the {motion} of the whole as a rigid body ({residual[k]:.1e} of "
            "the forces in it): export it without supports, and check the node positions (order, units)"
        )
    return float(residual.max())
