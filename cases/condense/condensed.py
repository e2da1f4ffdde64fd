"""A compressed model: its segments and the pose of its root, stored as JSON, and its named modes."""

from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from ...core.condense.compressed import segment_modes
from ...core.condense.matrix_words import LARGEST_ENTRY
from ...core.condense.segments import Segment
from ...core.condense.ties import FARTHEST
from ...core.modes import STATIONS, Modes
from ...core.participation import families, numbered
from ...core.regular_files import LARGEST_DATA, read_bytes
from ...core.space.inertia import about_centre
from ..input import atomic, files
from ..input.errors import NO_STATE, CaseError, unsteady
from ..input.names import Name

Array = NDArray[np.float64]

CHANGED = "condense again if the file was edited"


@dataclass(frozen=True)
class Condensed:
    """A blade as rigid bodies and complex stiffness elements.

    Attributes:
        name: of the blade.
        root: (4, 4) pose of the first frame, clamped to the hub, in the hub's axes.
        segments: from the root to the tip.
    """

    name: str
    root: Array
    segments: list[Segment]


def modes(blade: Condensed, omega: float, count: int, allow_large_strain: bool = False) -> Modes:
    """The lowest modes at ``omega`` rad/s, with their relative uncertainties; see ``core.condense.compressed.segment_modes``.

    Raises:
        CaseError: if there is no stable steady state at this speed, or its strain is large.
    """
    try:
        return segment_modes(blade.segments, blade.root, omega, count, allow_large_strain=allow_large_strain)
    except NO_STATE as error:
        raise unsteady(blade.name, omega, error) from error


def names(segments: list[Segment], modes: Modes) -> tuple[str, ...]:
    """The family of each mode and its number in it, from the fractions of kinetic energy; see ``core.participation``.

    Each body is assumed to move like the sample beside it, and the sections' frames to be parallel to the hub's.
    """
    ends = np.append(0.0, np.cumsum([np.linalg.norm(s.undeformed[:3, 3]) for s in segments]))
    at = 0.5 * (ends[:-1] + ends[1:]) / ends[-1]
    k = np.clip(np.searchsorted(STATIONS, at) - 1, 0, len(STATIONS) - 2)
    t = ((at - STATIONS[k]) / (STATIONS[k + 1] - STATIONS[k]))[:, None]
    sample = modes.shapes[:, k] * (1 - t) + modes.shapes[:, k + 1] * t
    mass, centre, tensor = (np.array(v) for v in zip(*(body(s) for s in segments), strict=True))
    lever = np.cross([1.0, 0.0, 0.0], centre)
    energy = mass[:, None] * np.abs(sample[..., :3] + sample[..., 3:] * lever) ** 2
    turning = tensor[:, :1, 0] * np.abs(sample[..., 3:]) ** 2
    fractions = np.concatenate([energy[..., [2, 1]], turning, energy[..., :1]], axis=2).sum(axis=1)
    return numbered(families(fractions / fractions.sum(axis=1, keepdims=True)))


def body(s: Segment) -> tuple[float, Array, Array]:
    """A segment's mass, its centre (3,) in frame a, and its moments of inertia (3, 3) about the centre."""
    mass, centre, moments = about_centre(s.inertia)
    return float(mass), centre, moments


def write(path: Path, blade: Condensed) -> None:
    """Write a compressed model as JSON, matrices row by row, SI units."""
    pieces = [{key: value.tolist() for key, value in vars(s).items()} for s in blade.segments]
    record = {"name": blade.name, "root": blade.root.tolist(), "segments": pieces}
    atomic.write(path, msgspec.json.format(msgspec.json.encode(record)) + b"\n")


class _Piece(msgspec.Struct, forbid_unknown_fields=True):
    undeformed: list[list[float]]
    stiffness: list[list[float]]
    inertia: list[list[float]]
    body_twist: list[list[float]]


class _Kept(msgspec.Struct, forbid_unknown_fields=True):
    name: Name
    root: list[list[float]]
    segments: list[_Piece]


def read(path: Path) -> Condensed:
    """Read a file written by ``write``.

    Raises:
        CaseError: if the file does not exist, its format is invalid, or a matrix has the wrong size.
    """
    with files.readable(path):
        content = read_bytes(path, LARGEST_DATA)
    try:
        record = msgspec.json.decode(content, type=_Kept)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise CaseError(f"{path}: {error}: not written by `southwell condense`; condense again") from error
    sizes = {"undeformed": 4, "stiffness": 6, "inertia": 6, "body_twist": 6}
    pieces = []
    for k, piece in enumerate(record.segments):
        matrices = {
            field: _square(path, f"segments[{k}].{field}", getattr(piece, field), n) for field, n in sizes.items()
        }
        for field in ("stiffness", "inertia"):
            if not _positive(matrices[field]):
                raise CaseError(f"{path}: segments[{k}].{field}: not symmetric and positive definite: {CHANGED}")
        if not _is_pose(matrices["undeformed"]):
            raise CaseError(f"{path}: segments[{k}].undeformed: not a rotation and a displacement: {CHANGED}")
        pieces.append(Segment(**matrices))
    root = _square(path, "root", record.root, 4)
    if not _is_pose(root):
        raise CaseError(f"{path}: root: not a rotation and a displacement: {CHANGED}")
    return Condensed(record.name, root, pieces)


def _positive(matrix: Array) -> bool:
    """Whether a matrix (6, 6) is symmetric and positive definite, each to 1e-6 of its diagonal."""
    diagonal = np.diagonal(matrix)
    if not (diagonal > 0).all() or np.abs(matrix).max() > LARGEST_ENTRY:
        return False
    size = np.sqrt(diagonal)
    unit = matrix / size[:, None] / size
    return bool(np.abs(unit - unit.T).max() < 1e-6 and np.linalg.eigvalsh(unit + unit.T)[0] > 0)


def _is_pose(x: Array) -> bool:
    """Whether a matrix (4, 4) is a rotation, to 1e-9, and a displacement within the limits of a blade."""
    R = x[:3, :3]
    turns = np.abs(x).max() <= FARTHEST and np.abs(R.T @ R - np.eye(3)).max() < 1e-9 and np.linalg.det(R) > 0
    return bool(turns and (x[3] == [0, 0, 0, 1]).all())


def _square(path: Path, field: str, rows: list[list[float]], n: int) -> Array:
    if {len(rows), *(len(row) for row in rows)} != {n}:
        raise CaseError(f"{path}: {field}: not {n} × {n}: {CHANGED}")
    return np.array(rows)
