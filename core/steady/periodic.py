"""Check that M̂, Ĉ, K̂ stay constant along the motion; equations that vary with time have no constant modes."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..mechanism.description import MechanismError
from ..mechanism.motion import Motion
from ..tree import dynamics
from ..tree.linearization import Linearization, about
from ..tree.scales import coordinate_units, length_at
from ..tree.state import driven_by_loops
from ..tree.topology import Tree
from .balance import balance_at, rounding_at
from .equilibrium import residual_closed_by

Array = NDArray[np.float64]

ADVANCES = (0.7, 1.9, 3.3, 5.1)
"""Distances, rad or lengths of the mechanism, that each moving coordinate advances; unrelated by the symmetry of a rotor."""

MAX_CHANGE = 1e-8
"""Largest change, relative to the size of each coordinate's terms, that counts as zero."""


def check_constant(linear: Linearization) -> None:
    """Compare M̂, Ĉ, K̂ and the balance with those at later instants of the same motion.

    All motions advance together, so that each in turn covers every distance in ``ADVANCES``. Dependent coordinates and those
    that move because their loop does follow; the others do not move. The message names the coordinate whose motion alone
    causes the largest change, and gravity if nothing changes without it.

    Raises:
        MechanismError: if any of them changes.
    """
    moving = [m for m in linear.tree.mechanism.motions if m.rate or m.acceleration]
    if not len(linear.M) or not moving:
        return
    change, term = _largest_change(linear, moving)
    if change <= MAX_CHANGE:
        return
    changes = [_largest_change(linear, moving, [m])[0] for m in moving]
    name = moving[int(np.argmax(changes))].coordinate
    cause = "gravity, which is not along its axis" if _varies_by_gravity(linear, moving) else "its motion"
    raise MechanismError(
        f"coordinate {name!r}: {term} changes by {min(100 * change, 999.0):.3g} % of its size as it moves: the equations "
        f"vary with time because of {cause}, and have no constant modes; to linearise at one instant, give the motion as a law "
        "of time"
    )


def _varies_by_gravity(linear: Linearization, moving: list[Motion]) -> bool:
    """Whether the equations without gravity are constant, at the same coordinates."""
    mechanism = linear.tree.mechanism
    if not any(mechanism.gravity):
        return False
    tree = replace(linear.tree, mechanism=replace(mechanism, gravity=(0.0, 0.0, 0.0)))
    state = balance_at(tree, linear.state.q, independent=linear.names).state
    return _largest_change(about(tree, state, linear.names), moving)[0] <= MAX_CHANGE


def _largest_change(
    linear: Linearization, moving: list[Motion], advancing: list[Motion] | None = None
) -> tuple[float, str]:
    """The largest relative change as some motions (all by default) advance, and the name of what changes."""
    units = dict(zip(linear.tree.coordinates, _units(linear), strict=True))
    rates = [(abs(m.rate) / units[m.coordinate], abs(m.acceleration) / units[m.coordinate]) for m in moving]
    times = {advance / (rate + np.sqrt(acceleration)) for rate, acceleration in rates for advance in ADVANCES}
    omega = max(max(rate, np.sqrt(acceleration)) for rate, acceleration in rates)
    forces = _independent_forces(linear)
    changes = (_change(linear, forces, advancing or moving, time, omega) for time in times)
    return max(changes, key=lambda change: change[0])


def _independent_forces(linear: Linearization) -> Array:
    """(i,) unbalanced forces along the independent coordinates."""
    state = linear.state
    forces = dynamics.unbalanced(linear.tree, state.kinematics, state.cartesian, state.q, state.v)
    return linear.partition.onto(forces[linear.partition.free])


def _units(linear: Linearization) -> Array:
    return coordinate_units(linear.tree, length_at(linear.tree, linear.state.kinematics.poses))


def _change(linear: Linearization, forces: Array, moving: list[Motion], time: float, omega: float) -> tuple[float, str]:
    """The largest relative change after these motions alone have continued for ``time`` (s), and the name of what changes.

    ``forces`` (i,): the balance at the first instant.
    """
    state = linear.state
    tree = _after(linear.tree, moving, time)
    q = state.q.copy()
    for m in moving:
        q[tree.coordinate(m.coordinate)] += m.rate * time + 0.5 * m.acceleration * time**2
    carried = np.flatnonzero(driven_by_loops(linear.tree, state))
    q[carried] += state.v[carried] * time
    follow = np.setdiff1d(
        np.union1d(linear.partition.dependent, carried), [tree.coordinate(m.coordinate) for m in moving]
    )
    try:
        later_balance = residual_closed_by(tree, q, follow, linear.names)
        later_linear = about(tree, later_balance.state, p=later_balance.part)
    except MechanismError:  # a loop that cannot follow, or goes through a singularity
        return np.inf, "a loop"
    size = rounding_at(tree, later_balance.state, later_balance.part)
    unbalanced = later_balance.independent_forces - forces
    scale = np.abs(np.diagonal(linear.K)) + omega * np.abs(np.diagonal(linear.C)) + omega**2 * np.diagonal(linear.M)
    root = np.sqrt(np.maximum(scale, 1e-6 * size / _units(linear)[linear.partition.independent]))
    root = np.where(root > 0, root, 1.0)
    changes = {"the balance": float((np.abs(unbalanced) / np.where(size > 0, size, 1.0)).max())}
    for name, power in (("M", 2), ("C", 1), ("K", 0)):
        difference = np.abs(getattr(later_linear, name) - getattr(linear, name)) / root / root[:, None]
        changes[WORDS[name]] = float(omega**power * difference.max())
    term = max(changes, key=lambda k: changes[k])
    return changes[term], term


def _after(tree: Tree, moving: list[Motion], time: float) -> Tree:
    """The tree with the rates that accelerating motions have after ``time`` (s)."""
    if not any(m.acceleration for m in moving):
        return tree
    later_motions = {m.coordinate: replace(m, rate=m.rate + m.acceleration * time) for m in moving}
    motions = tuple(later_motions.get(m.coordinate, m) for m in tree.mechanism.motions)
    return replace(tree, mechanism=replace(tree.mechanism, motions=motions))


WORDS = {"M": "the mass matrix", "C": "the gyroscopic and damping matrix", "K": "the stiffness matrix"}
