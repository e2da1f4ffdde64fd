"""A finite element model from matrices that another code exported with named freedoms.

Such codes name a freedom by its node and a component: 1–3 displacement along x, y, z, 4–6 rotation about them.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as ss
from numpy.typing import ArrayLike, NDArray

from .ties import FiniteElements

Array = NDArray[np.float64]
Index = NDArray[np.intp]


class MatrixFileError(ValueError):
    """A file that cannot be read as a matrix: the message names it, the line, the likely cause and the remedy."""


@dataclass(frozen=True)
class Exported:
    """A matrix (n, n) and its freedoms.

    Attributes:
        name: of the file.
        matrix: with both triangles.
        nodes: (n,) labels; empty if the file does not name its freedoms.
        directions: (n,) 0–5, see ``ties.FiniteElements``; empty if the file does not name them.
    """

    name: str
    matrix: ss.csr_array
    nodes: Index = field(default_factory=lambda: np.zeros(0, dtype=np.intp))
    directions: Index = field(default_factory=lambda: np.zeros(0, dtype=np.intp))


def model(
    stiffness: Exported, coordinates: Mapping[int, ArrayLike], mass: Exported | None = None, name: str = ""
) -> FiniteElements:
    """A finite element model from exported matrices and the places of their nodes.

    Args:
        stiffness: with named freedoms.
        coordinates: node label → (3,) coordinates, m.
        mass: in the same freedoms, in any order; its row sums over each direction are the lumped mass.
        name: label in messages; by default that of the file.

    Raises:
        MatrixFileError: freedoms not named, a node without a place, or a mass with other freedoms.
    """
    if not len(stiffness.nodes):
        raise MatrixFileError(
            f"{stiffness.name}: does not name its freedoms: set nodes and directions, in the order of the file's rows"
        )
    missing = [n for n in stiffness.nodes.tolist() if n not in coordinates]
    if missing:
        raise MatrixFileError(f"{stiffness.name}: node {missing[0]} has no coordinates: give those of all its nodes")
    lumped = np.zeros(len(stiffness.nodes))
    if mass is not None:
        at = {key: k for k, key in enumerate(zip(mass.nodes.tolist(), mass.directions.tolist(), strict=True))}
        keys = list(zip(stiffness.nodes.tolist(), stiffness.directions.tolist(), strict=True))
        if set(at) != set(keys):
            raise MatrixFileError(
                f"{mass.name}: its freedoms are not those of {stiffness.name}: export both with the same freedoms"
            )
        along = mass.directions[:, None] == np.arange(6)
        sums = (mass.matrix @ along.astype(float))[np.arange(len(at)), mass.directions]
        lumped = sums[[at[key] for key in keys]]
    points = np.array([coordinates[n] for n in stiffness.nodes.tolist()], float)
    return FiniteElements(name or stiffness.name, points, stiffness.directions, stiffness.matrix, lumped)


def assembled(name: str, rows: Index, columns: Index, values: Array, mirror: bool | None = None) -> Exported:
    """Assemble entries at ``rows`` and ``columns`` (e, 2), each node and component; freedoms in ascending order.

    Args:
        name: of the file.
        rows: (e, 2) freedoms.
        columns: (e, 2) freedoms.
        values: (e,).
        mirror: whether to mirror entries without a counterpart; None: only if no entry has one (a single triangle).

    Raises:
        MatrixFileError: an entry given twice, or a component that is not a motion of a point.
    """
    freedoms, where = np.unique(np.concatenate([rows, columns]), axis=0, return_inverse=True)
    n = len(freedoms)
    i, j = where.reshape(2, -1)
    code, mirrored = i * n + j, j * n + i
    entries, times = np.unique(code, return_counts=True)
    if (times > 1).any():
        k = int(np.argmax(code == entries[times.argmax()]))
        raise MatrixFileError(
            f"{name}: the entry of {rows[k].tolist()} and {columns[k].tolist()} is given twice: give one matrix per file"
        )
    unpaired = ~np.isin(mirrored, code)
    if mirror or (mirror is None and (unpaired | (i == j)).all()):
        i, j = np.append(i, j[unpaired]), np.append(j, i[unpaired])
        values = np.append(values, values[unpaired])
    return labelled(name, ss.csr_array((values, (i, j)), shape=(n, n)), freedoms)


def labelled(name: str, matrix: ss.csr_array, freedoms: Index) -> Exported:
    """A matrix with its freedoms (n, 2), node and component.

    Raises:
        MatrixFileError: a component that is not a motion of a point.
    """
    nodes, components = freedoms.T
    invalid = (components < 1) | (components > 6)
    if invalid.any():
        raise MatrixFileError(
            f"{name}: freedom {components[invalid][0]} of node {nodes[invalid][0]}: only 1 to 6 are motions of a point; "
            "export a static (Guyan) reduction, without modes or other unknowns"
        )
    return Exported(name, matrix, nodes, components - 1)
