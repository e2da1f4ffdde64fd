"""Modes of a linearisation as motions at the stations of a turbine, in the form of ``core.turbine.stations``, at azimuth 0."""

import numpy as np
from numpy.typing import NDArray

from ....core.modes import STATIONS
from ....core.space import spatial as sp
from ....core.turbine.rotor import RZ, turned_axes
from ....core.turbine.stations import positions
from ...diagnosis.elastodyn_blade import field_of
from ..modes import Mode
from ..multiblade import states_of_components
from ..sets import AzimuthSet
from ..states import State
from .deck import Deck
from .fields import bent

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


def motions(deck: Deck, azimuth_set: AzimuthSet, modes: tuple[Mode, ...]) -> Complex:
    """(m, 21 (1 + N), 4) displacement and rotation about x of tower and blades in modes, which are in the fixed frame."""
    P, _ = states_of_components(azimuth_set, 0.0, azimuth_set.omega)
    return np.einsum("kzc,mk->mzc", of_states(deck, azimuth_set), np.array([P @ mode.shape for mode in modes]))


def of_states(deck: Deck, azimuth_set: AzimuthSet) -> Array:
    """(s, 21 (1 + N), 4) motions by a unit of each state at azimuth 0; none of rates and of other states."""
    rate_of, n = dict(azimuth_set.pairs), len(STATIONS)
    out = np.zeros((len(azimuth_set.states), n * (1 + deck.turbine.blades), 4))
    for k, state in enumerate(azimuth_set.states):
        if k not in rate_of:
            continue
        if state.blade:
            own = out[k, n * state.blade : n * (state.blade + 1)]
            own[:, :3] = bent(deck, state, STATIONS * deck.turbine.blade.length) @ _axes(deck).T
            continue
        tower, hub = _carried(deck, state)
        out[k, :n, :3] = tower
        for blade in range(deck.turbine.blades):
            root = turned_axes(2.0 * np.pi * blade / deck.turbine.blades)[0] @ hub
            own = out[k, n * (blade + 1) : n * (blade + 2)]
            own[:, :3] = root[:3] + np.cross(root[3:], positions(deck.turbine.blade))
            own[:, 3] = root[3]
    return out


def _axes(deck: Deck) -> Array:
    """(3, 3) axes of a blade without twist in those of its hub."""
    blade = deck.turbine.blade
    return np.asarray(sp.rotation(1, np.array(-blade.precone)) @ sp.rotation(0, np.array(blade.pitch)))


def _carried(deck: Deck, state: State) -> tuple[Array, Array]:
    """(21, 3) displacements of the tower, and the twist (6,) of the hub that does not turn."""
    tower, blade_motion = deck.turbine.tower, np.zeros((len(STATIONS), 3))
    if state.family in ("generator", "drivetrain"):
        return blade_motion, RZ
    top = np.zeros(6)
    if state.family == "yaw":
        top[3] = 1.0
    elif state.family in deck.tower_shapes:
        displacements, rotations = field_of(tower, {state.family: deck.tower_shapes[state.family]})(
            STATIONS * tower.length
        )
        blade_motion, top = displacements[0], np.concatenate([displacements[0, -1], rotations[0, -1]])
    return blade_motion, sp.adjoint(sp.inverse(deck.turbine.shaft)) @ top
