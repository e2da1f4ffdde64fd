"""The frequencies of a model under the labels of another program's modes, and the effect of each hypothesis on them."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade
from ...core.modes import Modes
from ...core.participation import families, numbered, participation
from ..judge.pairing import aligned, pair, weights
from ..judge.spectrum import of_blade
from . import model
from .hypotheses import ALL, Hypothesis
from .model import ELEMENTS, Model

Array = NDArray[np.float64]

Label = int | str
"""A mode: its number among all modes of the blade, from 1, or its family and ordinal, as ``flapwise 1``."""

FINE = 3 * ELEMENTS
"""Elements of the solution without a hypothesis that the numbers are compared with."""

EXTRA = 4
"""Modes solved above the highest label."""

LEAST_MAC = 0.5
"""Smallest MAC of a mode with and without a hypothesis; a wrong model may change shapes."""

Change = tuple[str, float]
"""A hypothesis by its name, and its factor (1 if it is not fitted)."""


@dataclass(frozen=True, eq=False)
class Problem:
    """A blade, speeds and modes, under which numbers of another program are known; compared by identity.

    Attributes:
        blade: the blade.
        speeds: (S,) rad/s.
        labels: (M,) of the modes.
        by_shape: whether labels are of the solver's modes, to which the other program's were paired by shape.
        hypotheses: by name.
    """

    blade: Blade
    speeds: tuple[float, ...]
    labels: tuple[Label, ...]
    by_shape: bool = False
    hypotheses: dict[str, Hypothesis] = field(
        default_factory=lambda: {hypothesis.name: hypothesis for hypothesis in ALL}
    )

    @property
    def count(self) -> int:
        """Number of modes to solve."""
        numbers = [label if isinstance(label, int) else 2 * int(label.split()[1]) for label in self.labels]
        return max(*numbers, len(self.labels)) + EXTRA


@lru_cache(maxsize=64)
def reference(problem: Problem) -> Array:
    """(S, M) frequencies of the blade without a hypothesis, rad/s; nan for a mode or speed without an answer."""
    return labelled(problem, solved(problem, (), FINE), problem.blade)


def effect(problem: Problem, changes: tuple[Change, ...]) -> Array:
    """(S, M) natural logarithm of the ratio of the frequencies with and without some hypotheses; nan without an answer."""
    return _effect(problem, changes)


@lru_cache(maxsize=4096)
def _effect(problem: Problem, changes: tuple[Change, ...]) -> Array:
    altered_model = changed_model(problem, changes)
    if altered_model is None:
        return np.full((len(problem.speeds), len(problem.labels)), np.nan)
    if _unchanged(altered_model, Model(problem.blade)):
        return np.zeros((len(problem.speeds), len(problem.labels)))
    base = reference(problem) if altered_model.elements else _plain(problem)
    frequencies = labelled(problem, model.solve(altered_model, problem.speeds, problem.count), altered_model.blade)
    with np.errstate(all="ignore"):
        return np.log(frequencies / base)


def _unchanged(a: Model, b: Model) -> bool:
    """Whether two models are equal."""
    fields_a, fields_b = vars(a) | vars(a.blade), vars(b) | vars(b.blade)
    same_values = (np.array_equal(fields_a[name], fields_b[name]) for name in fields_a if name != "blade")
    return all(same_values)


@lru_cache(maxsize=64)
def _plain(problem: Problem) -> Array:
    return labelled(problem, solved(problem, (), ELEMENTS), problem.blade)


def changed_model(problem: Problem, changes: Sequence[Change]) -> Model | None:
    """The model with some hypotheses, one after the other; None if the blade is then invalid."""
    out = Model(problem.blade)
    try:
        with np.errstate(all="ignore"):
            for name, factor in changes:
                out = problem.hypotheses[name].change(out, factor)
    except model.NO_ANSWER:
        return None
    return out


@lru_cache(maxsize=64)
def solved(problem: Problem, changes: tuple[Change, ...], elements: int) -> list[Modes | None]:
    """The modes at each speed."""
    altered_model = changed_model(problem, changes)
    assert altered_model is not None
    return model.solve(altered_model, problem.speeds, problem.count, elements)


@lru_cache(maxsize=64)
def names(problem: Problem) -> list[tuple[str, ...]]:
    """Names of the solver's modes at each speed, as ``flapwise 1``; empty at a speed without an answer."""
    return [_named(spectrum, problem.blade) if spectrum else () for spectrum in solved(problem, (), FINE)]


def _named(modes: Modes, blade: Blade) -> tuple[str, ...]:
    return numbered(families(participation(aligned(modes, weights(blade)), blade)))


def labelled(problem: Problem, answers: Sequence[Modes | None], blade: Blade) -> Array:
    """(S, M) frequencies of answers under the problem's labels; ``blade`` is the one that was solved."""
    out = np.full((len(problem.speeds), len(problem.labels)), np.nan)
    by_name = any(isinstance(label, str) for label in problem.labels)
    for row, own in enumerate(answers):
        if own is None:
            continue
        if problem.by_shape:
            places = _partners(problem, row, own)
        else:
            places = _places(problem.labels, _named(own, blade) if by_name else ())
        for column, index in enumerate(places):
            if index is not None and index < len(own.frequencies):
                out[row, column] = own.frequencies[index]
    return out


def _places(labels: Sequence[Label], mode_names: Sequence[str]) -> list[int | None]:
    """Indices of labels among modes with these names; None for a name that does not occur."""
    return [
        label - 1 if isinstance(label, int) else mode_names.index(label) if label in mode_names else None
        for label in labels
    ]


def _partners(problem: Problem, row: int, own: Modes) -> list[int | None]:
    """Index of the partner of each label's mode of the solver."""
    base = solved(problem, (), FINE)[row]
    if base is None:
        return [None] * len(problem.labels)
    indices = _places(problem.labels, names(problem)[row])
    in_range = [index for index in indices if index is not None and index < len(base.frequencies)]
    base_spectrum, own_spectrum = of_blade(base, weights(problem.blade)), of_blade(own)
    partner = dict(zip(in_range, pair(base_spectrum, own_spectrum, in_range, LEAST_MAC), strict=True))
    return [partner[index].mode if index in partner else None for index in indices]
