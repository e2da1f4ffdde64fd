"""A beam as lumped bodies on elastic joints, whose compliance is integrated over each element."""

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade
from ...core.space.spatial import skew
from ..protocol.interface import CodeError
from ..sampling import points, stiffness_at
from ..theories.reference_line import frames, lumps
from ..theories.turbine_tree import NOTHING, Body, Chain

Array = NDArray[np.float64]

SOFT = 1e-14
"""Smallest compliance of a joint, relative to the largest of its kind, that has a coordinate."""


def chain(blade: Blade, elements: int) -> Chain:
    """A beam as lumped bodies on elastic joints at the ends of equal elements."""
    arc = np.linspace(0.0, blade.length, elements + 1)
    position, axes = frames(blade, arc)
    begins = np.concatenate([[0.0], 0.5 * (arc[1:] + arc[:-1])])
    mass, centre, moments = lumps(blade, begins, position, axes)
    compliance = _compliance(blade, arc, position, axes)
    sizes = np.diagonal(compliance, axis1=1, axis2=2)
    largest = np.repeat([sizes[:, :3].max(), sizes[:, 3:].max()], 3)
    soft = np.flatnonzero((sizes > SOFT * largest).all(0))
    if not len(soft):
        raise CodeError(f"{blade.name}: rigid: nothing vibrates")
    per, zero, unit = len(soft), np.zeros(3), np.eye(3)
    offset, rotations, bodies = [], [], []
    stiffness = np.zeros((elements * per, elements * per))
    for k in range(elements):
        to = axes[k].T if k else np.eye(3)
        arm = position[k + 1] - position[k] if k else position[1]
        offset += [to @ arm, *[zero] * (per - 1)]
        rotations += [to @ axes[k + 1], *[unit] * (per - 1)]
        bodies += [*[NOTHING] * (per - 1), Body(mass[k + 1], centre[k + 1], moments[k + 1])]
        own = slice(k * per, (k + 1) * per)
        stiffness[own, own] = np.linalg.inv(compliance[k][np.ix_(soft, soft)])
    return Chain(
        strain=np.tile(soft, elements),
        stiffness=stiffness,
        offset=np.array(offset),
        axes=np.array(rotations),
        bodies=tuple(bodies),
        root=Body(mass[0], centre[0], moments[0]).moved(position[0], axes[0]),
        base=position[0],
        nodes=np.arange(1, elements + 1) * per - 1,
        reach=np.zeros((elements, 3)),
        arc=arc[1:],
        tip=(zero, unit),
    )


def _compliance(blade: Blade, arc: Array, position: Array, axes: Array) -> Array:
    """(e, 6, 6) displacement and rotation of the outer end of each element under forces and moments there, in its axes."""
    pieces = np.union1d(arc, blade.stations)
    s, weight = (part.ravel() for part in points(pieces, 6))
    element = np.searchsorted(arc, s) - 1
    at, section = frames(blade, s)
    end = axes[element + 1]
    local = np.swapaxes(section, 1, 2) @ end
    G = np.zeros((len(s), 6, 6))
    G[:, :3, :3] = G[:, 3:, 3:] = local
    arm = (np.swapaxes(end, 1, 2) @ (position[element + 1] - at)[..., None])[..., 0]
    G[:, 3:, :3] = local @ skew(arm)
    stiffness = stiffness_at(blade, s)
    strains = np.flatnonzero(np.isfinite(np.diagonal(blade.stiffness[0])))
    c = np.zeros((len(s), 6, 6))
    c[:, strains[:, None], strains] = np.linalg.inv(stiffness[:, strains[:, None], strains])
    out = np.zeros((len(arc) - 1, 6, 6))
    np.add.at(out, element, weight[:, None, None] * (np.swapaxes(G, 1, 2) @ c @ G))
    return out
