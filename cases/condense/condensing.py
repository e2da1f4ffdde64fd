"""A blade's exported matrices, as a TOML file names them, condensed to rigid bodies and complex stiffness elements."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
import scipy.sparse as ss
from numpy.typing import NDArray

from ...core.condense import condensation, ties
from ...core.condense.segments import Segment, segment_from_matrix
from ...core.condense.ties import CondensationError, FiniteElements, Tie
from ...core.mechanism.description import inertia
from ...core.space import spatial as sp
from ..input import files
from ..input.errors import CaseError
from ..input.toml import convert, document, finite
from .condensed import Condensed
from .models import METRES, Whole, read
from .schema import At, Axis, Body, CondenseFile, Piece

Array = NDArray[np.float64]

TOLERANCE = ties.ON_SECTION


@dataclass(frozen=True)
class Condensation:
    """Result of the condensation of a file.

    Attributes:
        spec: content of the file.
        blade: the compressed model.
        freedoms: of the finite element models.
        resisted: the largest part of the forces in a model that one of its rigid motions leaves unbalanced.
    """

    spec: CondenseFile
    blade: Condensed
    freedoms: int
    resisted: float


def condense(path: Path) -> Condensation:
    """Condense the matrices that a file references.

    Raises:
        CaseError: naming the file and the invalid field.
    """
    with files.reading(path):
        return _condense(path)


def _condense(path: Path) -> Condensation:
    data = document(path)
    finite(data, str(path))
    spec = convert(data, CondenseFile, str(path))
    if spec.segments and len(spec.segments) != len(spec.sections) - 1:
        raise CaseError(
            f"{path}: segments: {len(spec.segments)} for {len(spec.sections)} sections: give {len(spec.sections) - 1}, one "
            "between each two sections"
        )
    if spec.segments and (spec.stiffness is not None or spec.mass is not None):
        raise CaseError(f"{path}: stiffness: given for the whole and for segments: give one model, or one per segment")
    frames = _frames(path, spec)
    try:
        models, pieces = _apart(path, spec, frames) if spec.segments else _in_place(path, spec, frames)
    except CondensationError as error:
        raise CaseError(f"{path}: {error}") from error
    blade = Condensed(spec.name, _root(path, spec, frames[0]), pieces)
    return Condensation(spec, blade, sum(len(m.model.directions) for m in models), max(m.resisted for m in models))


def _in_place(path: Path, spec: CondenseFile, frames: Sequence[Array]) -> tuple[list[Whole], list[Segment]]:
    blade_model = read(path, "", spec, spec, spec.units)
    if blade_model.mass is None:
        raise CaseError(f"{path}: mass: missing: name the file of a mass matrix")
    sections = [_tie(spec, blade_model, frames, k) for k in range(len(frames))]
    return [blade_model], condensation.segments_in_place(
        blade_model.model, sections, _shares(path, blade_model.model, blade_model.mass, frames)
    )


def _apart(path: Path, spec: CondenseFile, frames: Sequence[Array]) -> tuple[list[Whole], list[Segment]]:
    models, out = [], []
    for k, piece in enumerate(spec.segments):
        field = f"segments[{k}]."
        piece_model = read(path, field, piece, spec, spec.units)
        a, b = (_tie(spec, piece_model, frames, i) for i in (k, k + 1))
        models.append(piece_model)
        out.append(_one(path, field, spec, piece, piece_model, a, b))
    return models, out


def _one(path: Path, field: str, spec: CondenseFile, piece: Piece, piece_model: Whole, a: Tie, b: Tie) -> Segment:
    """A segment from its own model; by ``segment_from_matrix`` if it has no nodes between its ends, or its mass is given."""
    name = f"{a.name} to {b.name}"
    boundary = np.union1d(a.freedoms, b.freedoms)
    if piece.body is not None:
        if piece_model.mass is not None:
            raise CaseError(f"{path}: {field}body: the mass is also given as a matrix: give one of them")
        J = _body(path, field, piece.body, METRES[spec.units], a.frame)
    elif piece_model.mass is None:
        raise CaseError(f"{path}: {field}mass: missing: name the file of a mass matrix, or give body")
    elif len(boundary) < len(piece_model.model.directions):
        return condensation.segment(piece_model.model, a, b)
    else:
        R = ties.motion(piece_model.model.points, piece_model.model.directions, a.frame)
        J = R.T @ (piece_model.mass @ R)
    return segment_from_matrix(
        condensation.condense(piece_model.model, (a, b)).stiffness, ties.relative_pose(a, b), J, name
    )


def _body(path: Path, field: str, body: Body, metres: float, frame: Array) -> Array:
    """Inertia (6, 6) of a body given in the model's axes, about ``frame`` and in its axes."""
    kilograms = 1.0 / metres
    sizes = [len(row) if isinstance(row, list) else 1 for row in body.moments]
    if sizes not in ([1, 1, 1], [3, 3, 3]):
        raise CaseError(f"{path}: {field}body.moments: {body.moments}: neither three numbers nor three rows of three")
    moments = np.array(body.moments, float) * kilograms * metres**2
    principal = np.linalg.eigvalsh(moments if moments.ndim == 2 else np.diag(moments))
    if principal[0] <= 0 or 2 * principal[2] > (1 + 1e-6) * principal.sum():
        raise CaseError(
            f"{path}: {field}body.moments: {body.moments}: not physically possible (each must be positive and at most the "
            "sum of the other two): give them about the centre, in the file's units"
        )
    free = inertia(kilograms * body.mass, moments, metres * np.array(body.centre))
    lever = sp.adjoint(frame)
    return lever.T @ free @ lever


def _frames(path: Path, spec: CondenseFile) -> list[Array]:
    """(4, 4) poses of the sections in the model's axes, m: x along the span or the section's axis, z by the rotor's."""
    span, rotor = _axis(path, "span", spec.span), _axis(path, "rotor", spec.rotor)
    metres = METRES[spec.units]
    out = []
    for k, at in enumerate(spec.sections):
        point, along = (at.point, at.axis) if isinstance(at, At) else (at * span, None)
        x = span if along is None else _axis(path, f"sections[{k}].axis", along)
        z = rotor - x * (x @ rotor)
        if np.linalg.norm(z) < TOLERANCE:
            field = "rotor" if along is None else f"sections[{k}].axis"
            raise CaseError(
                f"{path}: {field}: parallel to {'the span' if along is None else 'the rotor axis'}: give another direction"
            )
        z /= np.linalg.norm(z)
        out.append(sp.pose(np.column_stack([x, np.cross(z, x), z]), metres * np.asarray(point, float)))
    for k, (a, b) in enumerate(pairwise(out)):
        if (b[:3, 3] - a[:3, 3]) @ a[:3, 0] <= 0:
            raise CaseError(
                f"{path}: sections[{k + 1}]: {_name(spec, k + 1)} is not beyond {_name(spec, k)}: "
                "sections go from the root to the tip along the span"
            )
    return out


def _axis(path: Path, field: str, spec: Axis) -> Array:
    if isinstance(spec, str):
        return (-1.0 if spec[0] == "-" else 1.0) * np.eye(3)["xyz".index(spec[-1])]
    vector = np.array(spec)
    length = np.linalg.norm(vector)
    if not length:
        raise CaseError(f"{path}: {field}: {list(spec)}: not a direction: give a vector, or x, y or z")
    return vector / length


def _root(path: Path, spec: CondenseFile, first: Array) -> Array:
    """The first section's pose in the hub's axes: x along the span, z along the rotor's axis."""
    x = _axis(path, "span", spec.span)
    z = _axis(path, "rotor", spec.rotor)
    if abs(x @ z) > TOLERANCE:
        raise CaseError(
            f"{path}: rotor: not perpendicular to the span: give the rotor axis; precone is part of the sections' positions"
        )
    hub = sp.inverse(sp.pose(np.column_stack([x, np.cross(z, x), z]), np.zeros(3)))
    out = hub @ first
    if spec.hub_radius is not None:
        out[0, 3] = spec.hub_radius
    return out


def _name(spec: CondenseFile, k: int) -> str:
    at, unit = spec.sections[k], spec.units.split()[0]
    return f"{list(at.point)} {unit}" if isinstance(at, At) else f"{at:g} {unit}"


def _tie(spec: CondenseFile, loaded_model: Whole, frames: Sequence[Array], k: int) -> Tie:
    at = spec.sections[k]
    kind = (at.tie if isinstance(at, At) else None) or (spec.root if k == 0 else spec.tie)
    name = _name(spec, k)
    if kind == "rigid" or spec.weights == "mass":
        return ties.section(loaded_model.model, frames[k], name, kind)
    on = ties.section(loaded_model.model, frames[k], name, "rigid").freedoms
    if spec.weights == "even":
        return ties.average(loaded_model.model, on, frames[k], name, np.ones(len(on)))
    if loaded_model.mass is None:
        raise CondensationError(
            f"weights: 'mass matrix': {loaded_model.model.name} has no mass matrix: give one, or use even weights"
        )
    return ties.average(loaded_model.model, on, frames[k], name, loaded_model.mass[on][:, on].toarray())


def _shares(path: Path, model: FiniteElements, mass: ss.csr_array, frames: Sequence[Array]) -> Array:
    """(m, n) lumped mass of each segment at the model's freedoms.

    The mass of a node on a section is divided between both sides in proportion to its entries of the mass matrix with
    nodes off the section, which is exact for prismatic elements; equally if there are none (a lumped mass matrix).

    Raises:
        CaseError: nodes beyond the first or last section.
    """
    size = TOLERANCE * float(np.ptp(model.points, axis=0).max())
    distance = np.stack([(model.points - f[:3, 3]) @ f[:3, 0] for f in frames])  # (sections, freedoms)
    passed = (distance > size).sum(axis=0)  # sections behind each freedom
    on = np.abs(distance) <= size
    for outside, end in (((passed == 0) & ~on[0], 0), (passed == len(frames), -1)):
        if outside.any():
            farthest = np.abs(distance[end, outside]).max()
            raise CaseError(
                f"{path}: sections[{end % len(frames)}]: {outside.sum()} freedoms of {model.name} lie up to {farthest:g} m "
                "beyond it: put the first and last sections at the model's ends"
            )
    out = np.zeros((len(frames) - 1, len(model.directions)))
    between = ~on.any(axis=0)
    out[passed[between] - 1, np.flatnonzero(between)] = model.mass[between]
    sizes = abs(mass)
    for k in range(len(frames)):
        on_section = np.flatnonzero(on[k])
        if k in (0, len(frames) - 1):
            out[0 if k == 0 else -1, on_section] = model.mass[on_section]
            continue
        before, after = (sizes[on_section] @ side.astype(float) for side in (distance[k] < -size, distance[k] > size))
        both = before + after
        share = np.where(both > 0, before / np.where(both > 0, both, 1.0), 0.5)
        out[k - 1, on_section], out[k, on_section] = (
            share * model.mass[on_section],
            (1 - share) * model.mass[on_section],
        )
    return out
