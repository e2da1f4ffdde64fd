"""Check that M̂, Ĉ, K̂ stay constant along the motion; periodic equations have no steady modes."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..mechanism.description import MechanismError
from ..mechanism.motion import Motion
from ..tree.linearization import Linearization, about
from . import equilibrium

Array = NDArray[np.float64]

ADVANCES = (0.7, 1.9, 3.3, 5.1)
"""Distances (rad or m) that each moving coordinate advances; no two are related by the symmetry of a rotor."""

MAX_CHANGE = 1e-8
"""Largest change, relative to the size of each coordinate's terms, that counts as zero."""


def check(linear: Linearization) -> None:
    """Compare M̂, Ĉ, K̂ and the balance with those at later instants of the same motion.

    All motions advance together, so that each in turn covers every distance in ``ADVANCES``; free coordinates do not move,
    and dependent ones follow. The message names the coordinate whose motion alone causes the largest change.

    Raises:
        MechanismError: if any of them changes.
    """
    moving = [m for m in linear.tree.mechanism.motions if m.rate or m.acceleration]
    if not len(linear.M) or not moving:
        return
    times = [turn / (abs(m.rate) + np.sqrt(abs(m.acceleration))) for m in moving for turn in ADVANCES]
    change, what = max((_change(linear, moving, t) for t in times), key=lambda found: found[0])
    if change <= MAX_CHANGE:
        return
    alone = [max(_change(linear, [m], t)[0] for t in times) for m in moving]
    name = moving[int(np.argmax(alone))].coordinate
    raise MechanismError(
        f"coordinate {name!r}: {what} changes as it moves (by {min(100 * change, 999.0):.3g} % of its size): the equations "
        "are periodic and have no steady modes; describe the mechanism in a frame that turns with the rotor"
    )


def _change(linear: Linearization, moving: list[Motion], time: float) -> tuple[float, str]:
    """The largest relative change after these motions alone have continued for ``time`` (s), and the name of what changes."""
    tree, here = linear.tree, linear.state
    if any(m.acceleration for m in moving):
        later = {m.coordinate: replace(m, rate=m.rate + m.acceleration * time) for m in moving}
        motions = tuple(later.get(m.coordinate, m) for m in tree.mechanism.motions)
        tree = replace(tree, mechanism=replace(tree.mechanism, motions=motions))
    q = here.q.copy()
    for m in moving:
        q[tree.coordinate(m.coordinate)] += m.rate * time + 0.5 * m.acceleration * time**2
    follow = np.setdiff1d(linear.partition.dependent, [tree.coordinate(m.coordinate) for m in moving])
    try:
        state, reduced, size = equilibrium.left_over(tree, q, follow, linear.names)
        then = about(tree, state, linear.names)
    except MechanismError:  # a loop that cannot follow, or goes through a singularity
        return np.inf, "a loop"
    omega = max(max(abs(m.rate), np.sqrt(abs(m.acceleration))) for m in moving)
    scale = np.abs(np.diagonal(linear.K)) + omega * np.abs(np.diagonal(linear.C)) + omega**2 * np.diagonal(linear.M)
    root = np.sqrt(np.maximum(scale, 1e-6 * size))
    root = np.where(root > 0, root, 1.0)
    changes = {"the balance": float((np.abs(reduced) / np.where(size > 0, size, 1.0)).max())}
    for name, power in (("M", 2), ("C", 1), ("K", 0)):
        difference = np.abs(getattr(then, name) - getattr(linear, name)) / root / root[:, None]
        changes[WORDS[name]] = float(omega**power * difference.max())
    what = max(changes, key=lambda k: changes[k])
    return changes[what], what


WORDS = {"M": "the mass matrix", "C": "the gyroscopic and damping matrix", "K": "the stiffness matrix"}
