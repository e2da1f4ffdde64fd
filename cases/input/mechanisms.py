"""Reading and validation of a mechanism in a TOML file (``mechanism_schema``), and its conversion to core."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from ...core import multibody as mb
from ...core.mechanism.description import at_time
from ...core.space import spatial as sp
from ...core.spectrum.eigen import EigenError
from ...core.tree.spanning import compile_tree
from .errors import CaseError, located, nearest
from .mechanism_schema import BodyData, CoordinateSpringData, Frame, JointData, MechanismFile, MotionData
from .toml import OR_A_NAME, convert, document, finite

Array = NDArray[np.float64]
T = TypeVar("T")


@dataclass(frozen=True)
class Described:
    """A mechanism's file, read.

    Attributes:
        path: path of the file, for messages.
        text: the file's contents.
        mechanism: mechanism as passed to core.
        guess: initial coordinates, by name.
    """

    path: str
    text: MechanismFile
    mechanism: mb.Mechanism
    guess: dict[str, float]

    def solve(self, count: int | None = None, time: float = 0.0, allow_large_strain: bool = False) -> mb.Solution:
        """Steady state and the lowest ``count`` modes, motions frozen at ``time`` (s); accepts strains above 20 % if allowed.

        Raises:
            CaseError: if core cannot assemble, balance or partition it, or the time is not finite.
        """
        if not np.isfinite(time):
            raise CaseError(f"{self.path}: time: {time}: give a finite instant, in seconds")
        try:
            return mb.solve(
                self.mechanism,
                self.guess,
                count=count,
                independent=self.text.independent or None,
                time=time,
                allow_large_strain=allow_large_strain,
            )
        except (mb.MechanismError, EigenError) as error:
            raise CaseError(f"{self.path}: {error}") from error


def matches_format(path: Path) -> bool:
    """Whether a TOML file describes a mechanism, i.e. has bodies.

    Raises:
        CaseError: if the file does not exist or is not TOML.
    """
    return "bodies" in document(path, OR_A_NAME)


def read(path: Path) -> Described:
    """Read the mechanism in a TOML file.

    Raises:
        CaseError: one line with file, field, value, cause and remedy.
    """
    return decode(document(path), str(path))


def decode(data: Mapping[str, Any], path: str) -> Described:
    """Build the mechanism from a decoded TOML document.

    Raises:
        CaseError: one line with file, field, value, cause and remedy.
    """
    finite(data, path)
    text = convert(data, MechanismFile, path)
    springs = _by_coordinate(text.coordinate_springs, CoordinateSpringData, path, "coordinate_springs")
    mechanism = mb.Mechanism(
        bodies=_bodies(text, path),
        joints=_joints(text, path),
        motions=_motions(text, path),
        coordinate_springs=tuple(mb.CoordinateSpring(c, s.stiffness, s.damping, s.neutral) for c, s in springs),
        springs=tuple(
            mb.Spring(
                s.body_a, s.body_b, np.array(s.point_a), np.array(s.point_b), s.stiffness, s.damping, s.free_length
            )
            for s in text.springs
        ),
        beams=(*_bushings(text, path), *_beams(text, path)),
        gravity=text.gravity,
        equal_blades=text.equal_blades,
    )
    guess = {f"{joint}.{name}": value for joint, rows in text.guess.items() for name, value in rows.items()}
    _check_names(text, mechanism, guess, path)
    return Described(path, text, mechanism, guess)


def _bodies(text: MechanismFile, path: str) -> tuple[mb.Body, ...]:
    out = []
    for name, data in text.bodies.items():
        field = f"bodies.{name}"
        b = convert(data, BodyData, path, field)
        moments = _moments(b.moments, f"{path}: {field}.moments") if isinstance(b.moments, list) else b.moments
        out.append(mb.Body(name, mb.inertia(b.mass, moments, b.centre)))
    return tuple(out)


def _joints(text: MechanismFile, path: str) -> tuple[mb.Joint, ...]:
    out = []
    for name, data in text.joints.items():
        field = f"joints.{name}"
        j = convert(data, JointData, path, field)
        ends = (_pose(f, f"{path}: {field}.{end}") for f, end in ((j.at_parent, "at_parent"), (j.at_child, "at_child")))
        out.append(mb.Joint(name, j.kind, j.parent, j.child, *ends, cut=j.cut))
    return tuple(out)


def _motions(text: MechanismFile, path: str) -> tuple[mb.Motion, ...]:
    out = []
    for name, m in _by_coordinate(text.motions, MotionData, path, "motions"):
        laws = [Polynomial(m.polynomial)] if m.polynomial else []
        laws += [mb.Harmonic(h.amplitude, h.frequency, h.phase, h.mean) for h in m.harmonics]
        if laws and (m.position is not None or m.rate or m.acceleration):
            raise CaseError(
                f"{path}: motions.{name}: both numbers (position, rate, acceleration) and a function of time (polynomial, "
                "harmonics): give one of them"
            )
        law = mb.Sum(tuple(laws)) if laws else None
        out.append(mb.Motion(name, m.position, m.rate, m.acceleration, m.prescribed, law))
    return tuple(out)


def _bushings(text: MechanismFile, path: str) -> list[mb.Beam]:
    out = []
    for k, b in enumerate(text.bushings):
        where = f"{path}: bushings[{k}]"
        if len(b.preload) != 6:
            raise CaseError(f"{where}.preload: {len(b.preload)} numbers: give 6, forces first")
        stiffness = _matrix(b.stiffness, 6, f"{where}.stiffness")
        damping = np.zeros((6, 6)) if b.damping is None else _matrix(b.damping, 6, f"{where}.damping")
        with located(f"{where}.", ValueError):
            law = mb.bushing(np.eye(4), stiffness, np.array(b.preload))
        out.append(mb.Beam(b.body_a, b.body_b, law, damping, *_ends(b.at_a, b.at_b, where)))
    return out


def _beams(text: MechanismFile, path: str) -> list[mb.Beam]:
    out = []
    for k, b in enumerate(text.beams):
        names = ("EA", "GJ", "EI_y", "EI_z", "GA_y", "GA_z", "mass", "I_y", "I_z")
        section = {n: v for n in names if (v := getattr(b, n)) is not None}
        at_a, at_b = _ends(b.at_a, b.at_b, f"{path}: beams[{k}]")
        with located(f"{path}: beams[{k}]."):
            beam = mb.straight_beam(b.length, **section)
        out.append(mb.Beam(b.body_a, b.body_b, beam, at_a=at_a, at_b=at_b))
    return out


def _ends(at_a: Frame, at_b: Frame, where: str) -> tuple[Array, Array]:
    return _pose(at_a, f"{where}.at_a"), _pose(at_b, f"{where}.at_b")


def _pose(frame: Frame, where: str) -> Array:
    if frame.turn is None:
        with located(f"{where}.", ValueError):
            return mb.at(*frame.point, axis=frame.axis if isinstance(frame.axis, str) else np.array(frame.axis))
    if frame.axis != "z":
        raise CaseError(f"{where}: both axis and turn are given: give one of them")
    pose = sp.exp(np.array([0.0, 0.0, 0.0, *frame.turn]))
    pose[:3, 3] = frame.point
    return pose


def _moments(value: list[float | list[float]], where: str) -> Array:
    """An inertia tensor (3, 3); no principal moment may exceed the sum of the others."""
    out = _matrix(value, 3, where)
    smallest, middle, largest = np.linalg.eigvalsh(out).tolist()
    if smallest < -1e-6 * largest or largest > (smallest + middle) * (1 + 1e-6):
        raise CaseError(
            f"{where}: {largest:g} is more than {smallest:g} and {middle:g} together: "
            "not physically possible; check the moments"
        )
    return out


def _matrix(value: list[float | list[float]], side: int, where: str) -> Array:
    """A square matrix from its rows, or from its diagonal."""
    rows = {len(row) if isinstance(row, list) else None for row in value}
    if len(value) != side or rows not in ({None}, {side}):
        raise CaseError(f"{where}: {value}: give {side} numbers or {side} rows of {side}")
    out = np.array(value, dtype=float)
    return np.diag(out) if rows == {None} else out


def _by_coordinate(table: Mapping[str, Mapping[str, Any]], kind: type[T], path: str, field: str) -> list[tuple[str, T]]:
    return [
        (f"{joint}.{name}", convert(data, kind, path, f"{field}.{joint}.{name}"))
        for joint, rows in table.items()
        for name, data in rows.items()
    ]


def _check_names(text: MechanismFile, mechanism: mb.Mechanism, guess: Mapping[str, float], path: str) -> None:
    """Reject coordinates without a joint, and anything core rejects before it has a state."""
    with located(f"{path}: ", mb.MechanismError):
        coordinates = compile_tree(at_time(mechanism, 0.0)).coordinates
    references = [("motions", m.coordinate) for m in mechanism.motions]
    references += [("coordinate_springs", s.coordinate) for s in mechanism.coordinate_springs]
    references += [("guess", name) for name in guess] + [("independent", name) for name in text.independent]
    for field, name in references:
        if name not in coordinates:
            raise CaseError(f"{path}: {field}: {name!r}: no joint has this coordinate: {nearest(name, coordinates)}")
