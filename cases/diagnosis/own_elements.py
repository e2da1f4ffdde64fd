"""Hypotheses on the elements of another program, whose nodes are known: properties that are constant or linear over each.

A mean of the mass over an element carries mass from the heavier to the lighter end, which lowers the frequencies of a tapering
blade. In HAWC2 the nodes of a body are the points of its c2_def.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ...core import curve
from ...core.blade import Blade
from ...core.sampling import mass_at, stiffness_at, twist_at
from ...core.space.inertia import about_centre
from ...core.space.spatial import skew
from .hypotheses import Hypothesis
from .model import Model

Array = NDArray[np.float64]

STEP = 1e-7
"""Length of a step of the properties, as a fraction of the blade's length."""

POINTS = np.polynomial.legendre.leggauss(20)
"""Points and weights of a mean over an element."""


def hypotheses(nodes: Sequence[float]) -> tuple[Hypothesis, ...]:
    """Hypotheses on elements between ``nodes``, arc lengths (n,) from the root to the tip, m; scaled to the blade's length.

    Raises:
        ValueError: fewer than two nodes, or nodes that do not ascend.
    """
    at = np.asarray(nodes, float)
    if at.ndim != 1 or len(at) < 2 or not (np.diff(at) > 0).all():
        raise ValueError(f"nodes: {at.tolist()}: give the arc lengths of at least two nodes, ascending")
    fractions = (at - at[0]) / (at[-1] - at[0])
    n = len(at) - 1
    return (
        _hypothesis(f"with the mass of each of its {n} elements spread evenly", fractions, _spread),
        _hypothesis(f"with mean properties in each of its {n} elements", fractions, _averaged),
        _hypothesis(f"with properties linear between its {n + 1} nodes", fractions, _linear),
    )


def _hypothesis(name: str, fractions: Array, alter: Callable[[Blade, Array], Blade]) -> Hypothesis:
    def change(model: Model, _: float) -> Model:
        return replace(model, blade=alter(model.blade, fractions * model.blade.length))

    return Hypothesis(name, change)


def _spread(blade: Blade, nodes: Array) -> Blade:
    """The mass per length constant over each element; mass centres and moments of inertia about them as they are."""
    fine = _with_nodes(blade, nodes)
    _, centre, inertia = about_centre(fine.mass)
    new = _mean(partial(_mass_per_length, blade), nodes, fine.stations)
    cross = skew(centre)
    mass = np.zeros_like(fine.mass)
    mass[:, range(3), range(3)] = new[:, None]
    mass[:, :3, 3:], mass[:, 3:, :3] = -new[:, None, None] * cross, new[:, None, None] * cross
    mass[:, 3:, 3:] = inertia - new[:, None, None] * cross @ cross
    return replace(fine, mass=mass)


def _mass_per_length(blade: Blade, s: Array) -> Array:
    return mass_at(blade, s)[:, 0, 0]


def _averaged(blade: Blade, nodes: Array) -> Blade:
    """Stiffness and mass constant over each element."""
    fine = _with_nodes(blade, nodes)
    rigid = np.isinf(blade.stiffness)
    finite = replace(blade, stiffness=np.where(rigid, 1.0, blade.stiffness))
    stiffness = _mean(partial(stiffness_at, finite), nodes, fine.stations)
    return replace(
        fine,
        stiffness=np.where(rigid.any(axis=0), fine.stiffness, stiffness),
        mass=_mean(partial(mass_at, blade), nodes, fine.stations),
    )


def _linear(blade: Blade, nodes: Array) -> Blade:
    """Only the properties at the nodes; the curve through the stations is kept."""
    fine = _with_nodes(blade, nodes)
    coarse = replace(
        blade,
        stations=nodes,
        stiffness=stiffness_at(blade, nodes),
        mass=mass_at(blade, nodes),
        twist=twist_at(blade, nodes),
        curve=np.zeros((0, 3)),
        kinks=(),
    )
    s = fine.stations
    return replace(fine, stiffness=stiffness_at(coarse, s), mass=mass_at(coarse, s), twist=twist_at(coarse, s))


def _with_nodes(blade: Blade, nodes: Array) -> Blade:
    """The blade with a station at either side of each node."""
    beyond = nodes[1:-1] + STEP * blade.length
    s = np.unique(np.concatenate([blade.stations, nodes, beyond]))
    near = np.abs(s[:, None] - np.concatenate([blade.stations, nodes[1:-1]])).min(axis=1)
    s = s[(near == 0) | (np.abs(s[:, None] - beyond).min(axis=1) == 0)] if len(beyond) else blade.stations
    s = s[np.concatenate([[True], np.diff(s) > 0.1 * STEP * blade.length])]
    s[-1] = blade.length
    return replace(
        blade,
        stations=s,
        stiffness=stiffness_at(blade, s),
        mass=mass_at(blade, s),
        twist=twist_at(blade, s),
        curve=curve.at(blade.stations, blade.curve, blade.kinks, s)[0],
    )


def _mean(values: Callable[[Array], Array], nodes: Array, s: Array) -> Array:
    """The mean of a property over the element in which each of ``s`` lies; a node belongs to the element before it."""
    x, w = POINTS
    half = 0.5 * np.diff(nodes)
    means = sum(0.5 * weight * values(nodes[:-1] + half * (1.0 + at)) for at, weight in zip(x, w, strict=True))
    element = np.clip(np.searchsorted(nodes, s, side="left") - 1, 0, len(nodes) - 2)
    return np.asarray(means)[element]
