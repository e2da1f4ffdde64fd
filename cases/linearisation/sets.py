"""Sets of linearisations: the azimuths of one operating point, with their states in one order."""

import re
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..input.errors import CaseError
from .lin_file import LinFile
from .states import State

Array = NDArray[np.float64]

_NUMBERED = re.compile(r"(.*?)\.(\d+)((?:\.[A-Za-z]\w*)?)\.lin(?:\.gz)?", re.IGNORECASE)


@dataclass(frozen=True)
class BladeGroup:
    """One motion of all blades.

    Attributes:
        kind: the motion, see ``State.kind``.
        rate: whether it is the rate of the motion.
        members: index of the state of blades 1, 2, …
        derivative: indices of the rates of the members; None if the file has none.
    """

    kind: str
    rate: bool
    members: tuple[int, ...]
    derivative: tuple[int, ...] | None


@dataclass(frozen=True)
class AzimuthSet:
    """Linearisations of one operating point, by azimuth.

    Attributes:
        name: stem of the files' names.
        files: the files, by azimuth.
        states: the states in the order of all matrices; flags and values are those of the first file.
        A: state matrices (azimuth, row, column).
        half_unit: half a unit in the last digit of ``A``.
        values: operating points (azimuth, state).
        accelerations: derivatives of the states at the operating point; NaN where a file has none.
        order: for each file the indices that sort its states; all equal if the files have one order.
    """

    name: str
    files: tuple[LinFile, ...]
    states: tuple[State, ...]
    A: Array
    half_unit: Array
    values: Array
    accelerations: Array
    order: tuple[tuple[int, ...], ...]

    @cached_property
    def azimuths(self) -> Array:
        """Azimuths, rad."""
        return np.array([file.azimuth for file in self.files])

    @cached_property
    def blade_azimuths(self) -> Array:
        """Azimuths of blades 1, 2, 3 of the first file, then of the next, rad."""
        return np.asarray((self.azimuths[:, None] + 2 * np.pi / 3 * np.arange(3)).ravel(), dtype=np.float64)

    @cached_property
    def omega(self) -> float:
        """Mean rotor speed, rad/s."""
        return float(np.mean([file.rotor_speed for file in self.files]))

    @cached_property
    def index(self) -> dict[tuple[str, int | None, bool], int]:
        """Index of a state by its key."""
        return {state.key: i for i, state in enumerate(self.states)}

    @cached_property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Indices of displacements and their rates."""
        index = self.index
        return tuple(
            (i, index[state.kind, state.blade, True])
            for i, state in enumerate(self.states)
            if not state.rate and (state.kind, state.blade, True) in index
        )

    @cached_property
    def blades(self) -> int:
        """Number of blades that have states."""
        return max((state.blade or 0 for state in self.states), default=0)

    @cached_property
    def groups(self) -> tuple[BladeGroup, ...]:
        """The motions that every blade has."""
        index, n = self.index, self.blades
        out = []
        for kind, rate in dict.fromkeys((state.kind, state.rate) for state in self.states if state.blade):
            members = [index.get((kind, blade, rate)) for blade in range(1, n + 1)]
            rates = [index.get((kind, blade, True)) for blade in range(1, n + 1)] if not rate else [None]
            if None in members:
                continue
            derivative = None if None in rates else tuple(k for k in rates if k is not None)
            out.append(BladeGroup(kind, rate, tuple(k for k in members if k is not None), derivative))
        return tuple(out)


def first_azimuths(linearised: AzimuthSet, count: int) -> AzimuthSet:
    """A set with the first ``count`` of its files."""
    return replace(
        linearised,
        files=linearised.files[:count],
        A=linearised.A[:count],
        half_unit=linearised.half_unit[:count],
        values=linearised.values[:count],
        accelerations=linearised.accelerations[:count],
        order=linearised.order[:count],
    )


def stem(path: Path) -> str:
    """The part of a file's name that the azimuths of one operating point have in common."""
    match = _NUMBERED.fullmatch(path.name)
    return match[1] + match[3] if match else re.sub(r"\.lin(\.gz)?$", "", path.name, flags=re.IGNORECASE)


def collect(files: Sequence[LinFile]) -> tuple[AzimuthSet, ...]:
    """Group linearisations by the stems of their names, in order of rotor and wind speed.

    Raises:
        CaseError: if the files of a set have different states.
    """
    groups: dict[tuple[Path, str], list[LinFile]] = defaultdict(list)
    for file in files:
        groups[file.path.parent, stem(file.path)].append(file)
    sets = [azimuth_set(name, group) for (_, name), group in groups.items()]
    return tuple(sorted(sets, key=lambda point: (point.omega, np.nan_to_num(point.files[0].wind_speed), point.name)))


def azimuth_set(name: str, files: Sequence[LinFile]) -> AzimuthSet:
    """The set of files of one operating point.

    Raises:
        CaseError: if they have different states.
    """
    by_azimuth = sorted(files, key=lambda file: (np.mod(file.azimuth, 2 * np.pi), file.path.name))
    states = by_azimuth[0].states
    keys = [state.key for state in states]
    if len(set(keys)) < len(keys):
        twice = next(state for state in states if keys.count(state.key) > 1)
        raise CaseError(
            f"{by_azimuth[0].path}: state {twice.text[:80]!r}: two states have this description: give the file as OpenFAST "
            "wrote it"
        )
    order = []
    for file in by_azimuth:
        index = {state.key: i for i, state in enumerate(file.states)}
        if set(index) != set(keys):
            differing = next(iter(set(index) ^ set(keys)))
            raise CaseError(
                f"{file.path}: state {differing[0][:80]!r} is not in all files of {name}: they are of different models: give "
                "the files of one model"
            )
        order.append(tuple(index[key] for key in keys))
    sorted_by = [np.array(indices) for indices in order]
    several = list(zip(by_azimuth, sorted_by, strict=True))
    return AzimuthSet(
        name,
        tuple(by_azimuth),
        states,
        np.array([file.A[np.ix_(k, k)] for file, k in several]),
        np.array([file.half_unit[np.ix_(k, k)] for file, k in several]),
        np.array([[file.states[i].value for i in k] for file, k in several]),
        np.array(
            [
                [file.derivatives[i].value for i in k] if len(file.derivatives) == len(k) else np.full(len(k), np.nan)
                for file, k in several
            ]
        ),
        tuple(order),
    )
