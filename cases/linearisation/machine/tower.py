"""The tower in ElastoDyn's assumed shapes: core's matrices restricted to them, and what ElastoDyn's nodes change of them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.sampling import mass_at, stiffness_at
from ....core.turbine.assumed import restricted_motions
from ....core.turbine.component import with_strains
from ....core.turbine.machine import Machine
from ...diagnosis.elastodyn_blade import FINE, field_of
from ...input.readers.openfast.mode_shapes import Shape
from .deck import Deck

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Tower:
    """A tower without the rotor it carries, over its assumed motions and the angle of the yaw bearing, if it is free.

    Attributes:
        names: of the coordinates, as states are named.
        M, C, K: (t, t); K contains the effect of all the weight that the tower carries.
        tip: (6, t) twist of the tower's top in each motion.
    """

    names: tuple[str, ...]
    M: Array
    C: Array
    K: Array
    tip: Array


def tower(deck: Deck, turbine: Machine | None, shapes: dict[str, Shape], yaw: bool) -> Tower:
    """The tower of a machine that is restricted to these shapes, in their own coordinates, as ElastoDyn's nodes integrate it.

    Without a machine, or any motion, it is rigid.
    """
    names = (*shapes, *(("yaw",) if yaw else ()))
    if turbine is None or not names:
        return Tower((), np.zeros((0, 0)), np.zeros((0, 0)), np.zeros((0, 0)), np.zeros((6, 0)))
    part, beam = turbine.tower, turbine.turbine.tower
    rates = restricted_motions(beam, turbine.tower_mesh, field_of(beam, shapes))
    motions = with_strains(turbine.tower_mesh, turbine.tower_state, rates)
    U = np.linalg.lstsq(motions.T, part.vectors.T, rcond=None)[0]  # own coordinates are U times core's
    inverse = np.linalg.inv(U)
    M, C, K = (inverse.T @ azimuth_set @ inverse for azimuth_set in (part.M, part.C, part.K))
    n = len(shapes)
    exact, coarse = (_integrals(deck, shapes, count) for count in (FINE, deck.tower_nodes or FINE))
    tuner = np.sqrt([shape.tuner for shape in shapes.values()])
    M[:n, :n] += coarse[0] - exact[0]
    K[:n, :n] += coarse[1] * np.outer(tuner, tuner) - exact[1]
    C = C.copy()
    C[:n, :n] += coarse[2]
    return Tower(names, M, C, K, part.tip @ inverse)


def _integrals(deck: Deck, shapes: dict[str, Shape], count: int) -> tuple[Array, Array, Array]:
    """Mass, stiffness and damping (n, n) of the tower alone, by the rule of the middle over ``count`` elements."""
    beam = deck.turbine.tower
    x = (np.arange(count) + 0.5) / count
    step = beam.length / count
    mass = mass_at(beam, x * beam.length)[:, 0, 0] * step
    section = stiffness_at(beam, x * beam.length)
    plain = np.array([shape.at(x) for shape in shapes.values()]).reshape(-1, count)
    curvatures = np.array([shape.at(x, 2) / beam.length**2 for shape in shapes.values()]).reshape(-1, count)
    fore = np.array([name.startswith("tower fore-aft") for name in shapes], dtype=bool)
    M, K = np.zeros((len(shapes), len(shapes))), np.zeros((len(shapes), len(shapes)))
    for family, rigidity in ((fore, section[:, 4, 4]), (~fore, section[:, 5, 5])):
        for out, values, weight in ((M, plain, mass), (K, curvatures, rigidity * step)):
            own = np.where(family[:, None], values, 0.0)
            out += np.einsum("in,kn,n->ik", own, own, weight)
    ratio = np.array([2.0 * shape.damping for shape in shapes.values()])
    damping = K * ratio / np.sqrt(np.diagonal(K) / np.diagonal(M)) if len(shapes) else K
    return M, K, damping
