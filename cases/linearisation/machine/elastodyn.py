"""The structural equations of a turbine in ElastoDyn's coordinates, at an azimuth and an operating point, without aerodynamics.

A node of blade k is at p = B (r e_x + Σ φ_i q_i − ½ qᵀ S q e_x) in the axes of its hub, which turn with Ω; B is precone, φ and
S are those of ``nodes``. With a small twist ξ of the hub, its acceleration, and the forces m (a − g) on q and ξ, are linearised
exactly. The tower is core's, restricted to the assumed shapes of the deck. Blades are summed as in ``core.turbine.rotor``.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.space import spatial as sp
from ....core.turbine.rotor import RZ, turned_axes
from ..sets import AzimuthSet
from .deck import Deck
from .nodes import Nodes, of_blade
from .tower import Tower

Array = NDArray[np.float64]
Matrices = tuple[Array, Array, Array]


@dataclass(frozen=True)
class Blade:
    """Operating point of a blade: q, its first and second derivative, each (r,)."""

    q: Array
    rate: Array
    acceleration: Array


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

    def state_matrix(self, matrices: Matrices, each: AzimuthSet) -> Array:
        """A (s, s) with these equations; other states do not move."""
        M, C, K = matrices
        out = np.zeros((len(each.states), len(each.states)))
        out[self.coordinates, self.rates] = 1.0
        out[np.ix_(self.rates, self.coordinates)] = -np.linalg.solve(M, K)
        out[np.ix_(self.rates, self.rates)] = -np.linalg.solve(M, C)
        return out


def structure(deck: Deck, tower: Tower, each: AzimuthSet) -> Structure:
    """The equations of a deck in the states of a set, all of which are ElastoDyn's and in the deck."""
    rate_of = dict(each.pairs)
    at = {(state.family, state.blade): k for k, state in enumerate(each.states) if k in rate_of}
    families = tuple(name for name in (*tower.names, "generator", "drivetrain") if (name, None) in at)
    motions = [name for name in deck.blade_shapes if (name, 1) in at]
    shapes = {name: deck.blade_shapes[name] for name in motions}
    places = [at[name, None] for name in families]
    places += [at[name, blade] for blade in range(1, each.blades + 1) for name in motions]
    return Structure(
        deck,
        of_blade(deck.turbine.blade, shapes, deck.blade_nodes),
        tower,
        np.array(places, dtype=np.intp),
        np.array([rate_of[k] for k in places], dtype=np.intp),
        families,
        each.blades,
    )


def equations(model: Structure, psi: float, omega: float, gravity: float, at: tuple[Blade, ...]) -> Matrices:
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


def _rotor(model: Structure, psi: float, omega: float, weight: Array, at: tuple[Blade, ...]) -> Matrices:
    """M, C, K over the blades' coordinates and the hub's twist ξ_H; ``weight``: −g in the axes of the shaft."""
    r = len(model.nodes.stiffness)
    size = model.blades * r + 6
    out = [np.zeros((size, size)) for _ in range(3)]
    for k, point in enumerate(at):
        angle = psi + 2.0 * np.pi * k / max(model.blades, 1)
        turns = turned_axes(angle)
        M, C, K = _blade(model, omega, turns[0][:3, :3] @ weight, point)
        P = []
        for order, turn in enumerate(turns):
            part = np.zeros((r + 6, size))
            if not order:
                part[:r, k * r : (k + 1) * r] = np.eye(r)
            part[r:, -6:] = turn
            P.append(part)
        out[0] += P[0].T @ M @ P[0]
        out[1] += P[0].T @ (C @ P[0] + 2.0 * omega * M @ P[1])
        out[2] += P[0].T @ (K @ P[0] + omega * C @ P[1] + omega**2 * M @ P[2])
    hub = model.deck.turbine.hub
    out[0][-6:, -6:] += hub
    out[1][-6:, -6:] += -sp.coadjoint(hub @ (omega * RZ))
    return out[0], out[1], out[2]


def _blade(model: Structure, omega: float, weight: Array, at: Blade) -> Matrices:
    """M, C, K (r + 6, r + 6) over q and ξ of a blade; ``weight``: −g in the axes of its hub."""
    nodes, blade = model.nodes, model.deck.turbine.blade
    r, m = len(nodes.stiffness), nodes.mass
    c, s = np.cos(blade.precone), np.sin(blade.precone)
    cone = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])
    spin = omega * sp.skew(np.array([0.0, 0.0, 1.0]))
    bent = -np.einsum("a,ikn->naik", cone[:, 0], nodes.shortening)  # ∂²p/∂q²
    straight = np.einsum("ab,inb->nai", cone, nodes.deflection)
    D = straight + bent @ at.q
    p = np.outer(blade.hub_radius + nodes.along, cone[:, 0]) + straight @ at.q + 0.5 * bent @ at.q @ at.q
    moving, velocity = bent @ at.rate, D @ at.rate
    acceleration = D @ at.acceleration + moving @ at.rate
    load = p @ (spin @ spin).T + 2.0 * velocity @ spin.T + acceleration + weight  # force per mass
    J, rate, second = (np.zeros((len(m), 3, r + 6)) for _ in range(3))
    J[:, :, :r], J[:, :, r : r + 3], J[:, :, r + 3 :] = D, np.eye(3), -sp.skew(p)
    rate[:, :, :r], rate[:, :, r + 3 :] = moving, -sp.skew(velocity)
    second[:, :, :r], second[:, :, r + 3 :] = bent @ at.acceleration, sp.skew(load - acceleration)
    weighted = m[:, None, None] * J
    M = np.einsum("nai,nak->ik", weighted, J)
    C = np.einsum("nai,nak->ik", weighted, 2.0 * (spin @ J + rate))
    K = np.einsum("nai,nak->ik", weighted, spin @ spin @ J + 2.0 * spin @ rate + second)
    K[:r, :r] += np.einsum("n,na,naik->ik", m, load, bent)
    K[r + 3 :, :r] += np.einsum("n,nab,nbi->ai", m, -sp.skew(load), D)
    K[:r, :r] += nodes.stiffness
    C[:r, :r] += nodes.damping
    return M, C, K
