"""The rotating chain: its steady state, and the Cartesian pencil M ξ̈ + C ξ̇ + K ξ about it.

With elastic connections only, every node moves freely: the velocity transformation B of the general solver is square and
invertible, so modes may be had from the bodies' own twists, where the matrices are block-tridiagonal. Twists and wrenches
of node k are in its own axes.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from . import beams as bm
from . import blocks, inertia
from . import spatial as sp
from .blocks import Tridiagonal
from .discretize import Chain
from .model import FULL, Model

Array = NDArray[np.float64]

_STEPS = 40
_SMALLEST_RAMP = 2.0**-8


class SteadyStateError(ValueError):
    """No steady rotating state was found at this speed."""


@dataclass(frozen=True)
class Linear:
    """Residual (6n,) and block-tridiagonal M, C, K of the free nodes 1 … n; K = ``rest`` + Σ of ``spring`` on ρ = Ad ξ_b − ξ_a.

    ``spring`` is (n, 6, 6) and ``lever`` the Ad (n, 6, 6) of the relative poses.
    """

    residual: Array
    M: Tridiagonal
    C: Tridiagonal
    rest: Tridiagonal
    spring: Array
    lever: Array

    @property
    def K(self) -> Tridiagonal:
        """The whole stiffness."""
        on_b = np.swapaxes(self.lever, -1, -2) @ self.spring
        diagonal = self.rest.diagonal + on_b @ self.lever
        diagonal[:-1] += self.spring[1:]
        upper = self.rest.upper - self.spring[1:] @ self.lever[1:]
        return Tridiagonal(diagonal, upper, self.rest.lower - on_b[1:])


def spin(omega: float) -> Array:
    """The hub's twist (6,) at rotor speed ``omega`` about z."""
    return np.array([0.0, 0.0, 0.0, 0.0, 0.0, omega])


def linearize(chain: Chain, nodes: Array, omega: float, gravity: Array, model: Model = FULL) -> Linear:
    """Residual and pencil at node poses ``nodes`` (n+1, 4, 4).

    Args:
        chain: the blade.
        nodes: poses in the hub's axes.
        omega: rotor speed, rad/s.
        gravity: (3,) free-fall acceleration in the hub's axes, turning with it.
        model: effects kept.
    """
    to_node = sp.adjoint(sp.inverse(nodes))
    frame = to_node @ spin(omega)
    fall = to_node @ np.concatenate([gravity, np.zeros(3)])
    x = sp.inverse(nodes[:-1]) @ nodes[1:]
    p = bm.pencil(chain.beams, x, frame[:-1], fall[:-1], model)
    g, C, K = inertia.carried(chain.lumps, frame, fall, follow=model.geometric)
    own = np.zeros((len(x), 12, 12))  # snapshot twists from the nodes' own
    own[:, :6, :6] = np.eye(6)
    own[:, 6:, 6:] = sp.adjoint(x)
    back = np.swapaxes(own, -1, -2)
    residual = (back @ p.residual[..., None])[..., 0]
    r = g[1:] + residual[:, 6:]
    r[:-1] += residual[1:, :6]
    coriolis = 1.0 if model.coriolis else 0.0
    return Linear(
        r.ravel(),
        blocks.from_elements(back @ p.M @ own, chain.lumps),
        blocks.from_elements(coriolis * (back @ p.C @ own), coriolis * C),
        blocks.from_elements(back @ p.rest @ own, K),
        p.spring,
        own[:, 6:, 6:],
    )


def strain_energy(linear: Linear, x: NDArray[np.complex128]) -> Array:
    """x*Kx (m,) of nodal twists (6n, m), from the elements' own strains: exact to rounding however stiff they are."""
    twist = x.reshape(-1, 6, x.shape[-1])
    rho = linear.lever @ twist
    rho[1:] -= twist[:-1]
    springs = (rho.conj() * (linear.spring @ rho)).sum((0, 1))
    return np.real(springs + (x.conj() * (blocks.sparse(linear.rest) @ x)).sum(0))


def steady(chain: Chain, omega: float, gravity: Array, start: Array | None = None) -> Array:
    """Node poses (n+1, 4, 4) of the steady state, by Newton; the speed is ramped up only if that fails at once.

    Raises:
        SteadyStateError: if there is none near the undeformed blade.
    """
    nodes = chain.nodes if start is None else start
    done, step = 0.0, 1.0
    while done < 1.0:
        load = min(1.0, done + step)
        try:
            nodes = _newton(chain, nodes, omega * load**0.5, gravity * load)
            done = load
        except SteadyStateError:
            step *= 0.5
            if step < _SMALLEST_RAMP:
                raise SteadyStateError(
                    f"omega: no steady state at {omega:.6g} rad/s; the loads were followed up to {done:.0%} of Ω²: the "
                    "centrifugal force outgrows the axial stiffness there, or the blade is far too soft; check units or lower "
                    "the speed"
                ) from None
    return nodes


def _newton(chain: Chain, nodes: Array, omega: float, gravity: Array) -> Array:
    size = np.repeat([chain.scale, 1.0], 3)
    before = np.inf
    for _ in range(_STEPS):
        p = linearize(chain, nodes, omega, gravity)
        try:
            step = -blocks.solve(p.K, p.residual).reshape(-1, 6)
        except np.linalg.LinAlgError:
            raise SteadyStateError("singular stiffness") from None
        change = float(np.abs(step / size).max())
        if not np.isfinite(change) or change > 10.0:
            raise SteadyStateError("diverged")
        nodes = np.concatenate([nodes[:1], nodes[1:] @ sp.exp(step * min(1.0, 0.5 / max(change, 0.5)))])
        if change < 1e-9 or (change < 1e-6 and change > 0.1 * before):  # converged quadratically, or to rounding
            return nodes
        before = change
    raise SteadyStateError("no convergence")


def prestress_at_rest(chain: Chain, omega: float, gravity: Array) -> Chain:
    """The undeformed chain carrying the internal forces of a linear static analysis: Yoo and Shin's linear theory."""
    rest = linearize(chain, chain.nodes, omega, gravity, Model(geometric=False))
    bare = replace(chain, lumps=np.zeros_like(chain.lumps), beams=bm.massless(chain.beams))
    elastic = linearize(bare, chain.nodes, 0.0, np.zeros(3), Model(geometric=False)).K
    step = np.concatenate([np.zeros((1, 6)), -blocks.solve(elastic, rest.residual).reshape(-1, 6)])
    x = chain.beams.rest
    rho = (sp.adjoint(x) @ step[1:, :, None])[..., 0] - step[:-1]
    return replace(chain, beams=bm.prestressed(chain.beams, bm.linear_force(chain.beams, rho)))
