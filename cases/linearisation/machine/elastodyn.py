"""The structural equations of a turbine in ElastoDyn's coordinates, at an azimuth and an operating point, without aerodynamics.

The equations of a blade and a small twist of the hub are those of ``cases.diagnosis.elastodyn_blade``. The tower is core's,
restricted to the assumed shapes of the deck. Blades are summed as in ``core.turbine.rotor``.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.space import spatial as sp
from ....core.turbine.rotor import RZ, turned_axes
from ...diagnosis.elastodyn_blade import Nodes, OperatingPoint, blade_equations, nodes_of
from ..sets import AzimuthSet
from .deck import Deck
from .tower import Tower

Array = NDArray[np.float64]
Matrices = tuple[Array, Array, Array]


@dataclass(frozen=True)
class Structure:
    """The structural equations of a deck in the displacements of a linearisation.

    Attributes:
        deck: the deck.
        nodes: of each of the blades.
        tower: the tower in its assumed shapes, with the yaw bearing.
        coordinates: index of the state of each coordinate: tower, yaw, generator, drivetrain, blades one by one.
        rates: index of the state of their rates.
        families: motion of each coordinate before the blades'.
    """

    deck: Deck
    nodes: Nodes
    tower: Tower
    coordinates: NDArray[np.intp]
    rates: NDArray[np.intp]
    families: tuple[str, ...]
    blades: int

    def state_matrix(self, matrices: Matrices, azimuth_set: AzimuthSet) -> Array:
        """A (s, s) with these equations; other states do not move."""
        M, C, K = matrices
        out = np.zeros((len(azimuth_set.states), len(azimuth_set.states)))
        out[self.coordinates, self.rates] = 1.0
        out[np.ix_(self.rates, self.coordinates)] = -np.linalg.solve(M, K)
        out[np.ix_(self.rates, self.rates)] = -np.linalg.solve(M, C)
        return out


def structure(deck: Deck, tower: Tower, azimuth_set: AzimuthSet) -> Structure:
    """The equations of a deck in the states of a set, all of which are ElastoDyn's and in the deck."""
    rate_of = dict(azimuth_set.pairs)
    at = {(state.family, state.blade): k for k, state in enumerate(azimuth_set.states) if k in rate_of}
    families = tuple(name for name in (*tower.names, "generator", "drivetrain") if (name, None) in at)
    motions = [name for name in deck.blade_shapes if (name, 1) in at]
    shapes = {name: deck.blade_shapes[name] for name in motions}
    places = [at[name, None] for name in families]
    places += [at[name, blade] for blade in range(1, azimuth_set.blades + 1) for name in motions]
    return Structure(
        deck,
        nodes_of(deck.turbine.blade, shapes, deck.blade_nodes),
        tower,
        np.array(places, dtype=np.intp),
        np.array([rate_of[k] for k in places], dtype=np.intp),
        families,
        azimuth_set.blades,
    )


def equations(model: Structure, psi: float, omega: float, gravity: float, at: tuple[OperatingPoint, ...]) -> Matrices:
    """M, C, K over the coordinates at the azimuth ψ, rad, of blade 1, the speed, rad/s, and the blades' operating points."""
    deck, turbine = model.deck, model.deck.turbine
    t, r = len(model.families), len(model.nodes.stiffness)
    size = t + model.blades * r
    J = np.zeros((model.blades * r + 6, size))
    J[: model.blades * r, t:] = np.eye(model.blades * r)
    J[model.blades * r :, :t] = _hub(model)
    tilt = deck.tilt
    weight = gravity * np.array([np.cos(tilt), 0.0, np.sin(tilt)])
    total = _rotor(model, psi, omega, weight, at)
    M, C, K = (J.T @ part @ J for part in total)
    fixed = [k for k, name in enumerate(model.families) if name in model.tower.names]
    if fixed:  # the tower's stiffness contains the weight that it carries
        light = J.T @ _rotor(model, psi, omega, 0.0 * weight, at)[2] @ J
        K[np.ix_(fixed, fixed)] = light[np.ix_(fixed, fixed)]
        rows = np.array([model.tower.names.index(model.families[k]) for k in fixed])
        for out, part in zip((M, C, K), (model.tower.M, model.tower.C, model.tower.K), strict=True):
            out[np.ix_(fixed, fixed)] += part[np.ix_(rows, rows)]
    drive = turbine.drivetrain
    generator = np.zeros(size)
    generator[:t] = J[model.blades * r + 5, :t] / drive.gear_ratio
    for k, name in enumerate(model.families):
        generator[k] = {"generator": 1.0, "drivetrain": 0.0}.get(name, generator[k])
        if name == "drivetrain":
            K[k, k] += deck.shaft_stiffness
            C[k, k] += deck.shaft_damping
    M += drive.generator * drive.gear_ratio**2 * np.outer(generator, generator)
    return M, C, K


def _hub(model: Structure) -> Array:
    """(6, t) twist of the hub that does not turn, in each coordinate before the blades'."""
    nacelle = sp.adjoint(sp.inverse(model.deck.turbine.shaft)) @ model.tower.tip
    columns = [
        RZ if name in ("generator", "drivetrain") else nacelle[:, model.tower.names.index(name)]
        for name in model.families
    ]
    return np.array(columns).reshape(-1, 6).T


def _rotor(model: Structure, psi: float, omega: float, weight: Array, at: tuple[OperatingPoint, ...]) -> Matrices:
    """M, C, K over the blades' coordinates and the hub's twist ξ_H; ``weight``: −g in the axes of the shaft."""
    r = len(model.nodes.stiffness)
    size = model.blades * r + 6
    out = [np.zeros((size, size)) for _ in range(3)]
    for k, point in enumerate(at):
        angle = psi + 2.0 * np.pi * k / max(model.blades, 1)
        turns = turned_axes(angle)
        M, C, K = blade_equations(model.nodes, model.deck.turbine.blade, omega, turns[0][:3, :3] @ weight, point)
        P = []
        for order, derivative in enumerate(turns):
            part = np.zeros((r + 6, size))
            if not order:
                part[:r, k * r : (k + 1) * r] = np.eye(r)
            part[r:, -6:] = derivative
            P.append(part)
        out[0] += P[0].T @ M @ P[0]
        out[1] += P[0].T @ (C @ P[0] + 2.0 * omega * M @ P[1])
        out[2] += P[0].T @ (K @ P[0] + omega * C @ P[1] + omega**2 * M @ P[2])
    hub = model.deck.turbine.hub
    out[0][-6:, -6:] += hub
    out[1][-6:, -6:] += -sp.coadjoint(hub @ (omega * RZ))
    return out[0], out[1], out[2]
