"""A task of a study and its rows. A task is one sample of one blade at all speeds, so that its meshes are made once."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import isfinite, pi

import msgspec
from msgspec import Struct
from msgspec.structs import replace

from ...core.blade import Blade
from ...references.protocol.process import raised
from ..campbell.sweep import NamedMode, sweep
from ..input.changes import PropertyChange, apply
from ..input.errors import CaseError
from .schema import StudyFile

INTERNAL = "internal error of southwell: "
"""Beginning of the reason of a row that a defect of this package has cost."""


@dataclass(frozen=True)
class Task:
    """One sample of one blade.

    Attributes:
        blade: the nominal blade.
        sample: number of the sample, from 0.
        changes: the sampled properties.
        speeds: rotor speeds, rad/s.
        text: the study file, which says how modes are solved.
    """

    blade: Blade
    sample: int
    changes: tuple[PropertyChange, ...]
    speeds: tuple[float, ...]
    text: StudyFile


class Row(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """One line of a study: a frequency, or the reason why there is none at this speed.

    Attributes:
        blade: name of the blade.
        sample: number of the sample, from 0.
        properties: sampled values, by property.
        omega_rad_s: rotor speed.
        mode: 1 for the lowest; None without a frequency, as the following fields.
        name: family and number within the family, ``flapwise 2``.
        frequency_rad_s, frequency_hz: the frequency.
        relative_uncertainty: numerical; None if unknown.
        steady_strain: largest steady strain at this speed.
        reason: why there is no frequency; None if there is one.
        rows_left: number of rows of the same task that follow.
    """

    blade: str
    sample: int
    properties: dict[str, float]
    omega_rad_s: float
    mode: int | None = None
    name: str | None = None
    frequency_rad_s: float | None = None
    frequency_hz: float | None = None
    relative_uncertainty: float | None = None
    steady_strain: float | None = None
    reason: str | None = None
    rows_left: int = 0


def solve(task: Task) -> bytes:
    """Solve a task; return its rows, one JSON object per line. Every speed has a row; no exception is raised."""
    values = {change.name: change.value for change in task.changes}
    rows: list[Row] = []
    for omega, answer in _answers(task):
        empty = Row(blade=task.blade.name, sample=task.sample, properties=values, omega_rad_s=omega)
        if isinstance(answer, str):
            rows.append(replace(empty, reason=answer))
        else:
            rows += [_filled(empty, mode) for mode in answer]
    return encoded(rows)


def encoded(rows: Sequence[Row]) -> bytes:
    """The rows of one task as lines, with ``rows_left``."""
    following = range(len(rows) - 1, -1, -1)
    return b"".join(
        msgspec.json.encode(replace(row, rows_left=k)) + b"\n" for row, k in zip(rows, following, strict=True)
    )


def _filled(row: Row, mode: NamedMode) -> Row:
    return replace(
        row,
        mode=mode.mode,
        name=mode.name,
        frequency_rad_s=mode.frequency,
        frequency_hz=mode.frequency / (2 * pi),
        relative_uncertainty=mode.uncertainty if isfinite(mode.uncertainty) else None,
        steady_strain=mode.strain if isfinite(mode.strain) else None,
    )


def _answers(task: Task) -> Iterator[tuple[float, list[NamedMode] | str]]:
    """The modes at each speed, or the reason why there are none. The sweep begins again after a speed without modes."""
    try:
        blade = apply(task.blade, task.changes)
    except Exception as error:
        yield from ((omega, _reason(error, task)) for omega in task.speeds)
        return
    solutions, text = None, task.text
    for k, omega in enumerate(task.speeds):
        solutions = solutions or sweep(
            blade, task.speeds[k:], text.elements, text.modes, text.accuracy, text.allow_large_strain
        )
        try:
            answer = next(solutions)
        except Exception as error:
            solutions, answer = None, _reason(error, task)
        yield omega, answer


def _reason(error: Exception, task: Task) -> str:
    """Why there is no answer; a defect costs rows, not the study."""
    if isinstance(error, CaseError):
        return str(error).removeprefix("--set ").removeprefix(f"{task.blade.name}: ")
    return f"{INTERNAL}{raised(error)}"
