"""A whole turbine in Pinocchio: lumped bodies on elastic elements whose compliance is integrated here.

Tower and blades are divided at equal distances. The body at a node is what lies between the middles of its elements; an element
is a joint with the element's whole compliance at its outer end, ``∫ Gᵀ c G ds`` with the compliance c of the sections and the
wrench G in them. This is a lumped model of second order. Nothing of core's discretisation is used.

Pinocchio computes inertia forces and their derivatives for the machine without blades, and for one blade on a hub with six
coordinates, at the azimuth of each blade. Inertia forces are sums over bodies, so these add up to the machine with all blades,
while the workspace, which has arrays of n³ numbers, is that of one blade. The tower moves the hub by its Jacobian; the change
of the Jacobian acts with the wrench of all blades on the hub, which is zero. Fourier coordinates of the blades remove the
azimuth (``matrices.rotating``).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.effects import ALL_EFFECTS
from ...core.turbine.turbine import Turbine
from ..matrices import rotating
from ..protocol.fingerprint import Fingerprint
from ..protocol.interface import CodeError, Independence, extra
from ..protocol.turbines import TurbineAdapter, TurbineModes
from ..theories import turbine_motion, turbine_tree
from ..theories.turbine_tree import NOTHING, PLACING, Body, TurbineTree
from .lumped_chain import chain

Array = NDArray[np.float64]
Index = NDArray[np.intp]

STEPS = 60
"""Largest number of Newton steps to a steady state."""


class PinocchioTurbine(TurbineAdapter):
    """See the module."""

    name = "pinocchio-turbine"
    title = "Pinocchio, lumped bodies of the turbine"
    independence = Independence(
        "Pinocchio",
        "lumped bodies on elements of integrated compliance, both made by the adapter",
        "Pinocchio, derivatives of recursive Newton-Euler",
        sections=PLACING,
        eigensolver="the adapters' own, in Fourier coordinates of the blades",
    )
    effects = ALL_EFFECTS
    levels = (20, 30, 40)
    order = 2
    finest = 56
    hint = extra("codes")
    distribution = "pin"

    def unsupported_turbine(self, turbine: Turbine) -> str | None:
        """A reason if ``turbine_tree.outside`` gives one."""
        return turbine_tree.outside(turbine)

    def turbine_modes(self, turbine: Turbine, omega: float, elements: int, count: int) -> TurbineModes:
        """The lowest modes; see ``protocol.turbines``.

        Raises:
            CodeError: no steady state at this speed, or equations that change with the azimuth.
        """
        tree = turbine_tree.build(turbine, chain(turbine.tower, elements), chain(turbine.blade, elements))
        q = np.zeros(len(tree.strain))
        q[tree.tower], weight = _standing(tree)
        parts = _parts(tree, q)
        q[tree.blades] = at_blade = _steady(tree, parts.single, omega)

        def at(psi: float) -> tuple[Array, Array, Array]:
            M, C, K = parts.linearized(q, omega, psi)
            K += tree.stiffness
            K[np.ix_(tree.tower, tree.tower)] += weight
            return turbine_motion.with_generator(tree, q, M, C, K)

        groups = [[int(k) - 1 for k in joint] for joint in tree.blades.T]  # without the azimuth
        scale = _frequency(tree, parts.single, at_blade, omega)
        values, x = rotating.lowest(at, omega, groups, count, scale, turbine.drivetrain.free)
        full = np.insert(x, tree.spin, 0.0, axis=0)[: len(q)]
        return TurbineModes(values, turbine_motion.shapes(tree, q, full), elements)

    def turbine_fingerprint(self, turbine: Turbine, elements: int) -> Fingerprint:
        """Of Pinocchio's mass matrix at rest."""
        turbine = turbine_tree.floating(turbine)
        tree = turbine_tree.build(turbine, chain(turbine.tower, elements), chain(turbine.blade, elements))
        q = np.zeros(len(tree.strain))
        return turbine_tree.weighed(tree, _parts(tree, q).linearized(q, 0.0, 0.0)[0], elements)


def _pinocchio() -> Any:
    import pinocchio

    return pinocchio


class _Links:
    """Some links of a tree in Pinocchio, in ascending order, each after its parent."""

    def __init__(self, tree: TurbineTree, links: Index, bodies: Sequence[Body], gravity: float = 0.0) -> None:
        pinocchio = self.pin = _pinocchio()
        self.spin = tree.spin
        kinds = (
            pinocchio.JointModelPX,
            pinocchio.JointModelPY,
            pinocchio.JointModelPZ,
            pinocchio.JointModelRX,
            pinocchio.JointModelRY,
            pinocchio.JointModelRZ,
        )
        self.model: Any = pinocchio.Model()
        self.model.gravity.linear = np.array([-gravity, 0.0, 0.0])
        joint_of = {-1: 0}
        for k in links.tolist():
            pose = pinocchio.SE3(tree.axes[k], tree.offset[k])
            joint = self.model.addJoint(joint_of[int(tree.parent[k])], kinds[tree.strain[k]](), pose, f"{k}")
            joint_of[k] = joint
            body = bodies[k]
            if body.mass or body.moments.any():
                inertia = pinocchio.Inertia(body.mass, body.centre, body.moments)
                self.model.appendBodyToJoint(joint, inertia, pinocchio.SE3.Identity())
        self.data: Any = self.model.createData()

    def forces(self, q: Array, omega: float, psi: float) -> tuple[Array, Array, Array]:
        """Inertia forces (n,) in steady rotation, and their derivatives (n, n) by coordinates and rates."""
        at, v = q.copy(), np.zeros_like(q)
        at[self.spin], v[self.spin] = psi, omega
        self.pin.computeRNEADerivatives(self.model, self.data, at, v, np.zeros_like(v))
        return self.data.tau.copy(), self.data.dtau_dq.copy(), self.data.dtau_dv.copy()

    def weight(self, q: Array) -> tuple[Array, Array]:
        """Gradient (n,) and Hessian (n, n) of the potential of the weight."""
        gradient = self.pin.computeGeneralizedGravity(self.model, self.data, q).copy()
        return gradient, self.pin.computeGeneralizedGravityDerivatives(self.model, self.data, q).copy()

    def linearized(self, q: Array, omega: float, psi: float) -> tuple[Array, Array, Array]:
        """M, C, K (n, n) of the inertia forces."""
        _, K, C = self.forces(q, omega, psi)
        at = q.copy()
        at[self.spin] = psi
        M = np.triu(self.pin.crba(self.model, self.data, at))
        return M + np.triu(M, 1).T, C, K


@dataclass(frozen=True)
class _Parts:
    """The machine without blades, one blade on its hub, and the motion of this hub by the tree's coordinates."""

    tree: TurbineTree
    bare: _Links
    single: _Links
    moved: Array

    def linearized(self, q: Array, omega: float, psi: float) -> tuple[Array, Array, Array]:
        """M, C, K (n, n) of the inertia forces of the machine with all blades."""
        base = np.arange(self.tree.hub + 1)
        M, C, K = (np.zeros((len(q), len(q))) for _ in range(3))
        for total, part in zip((M, C, K), self.bare.linearized(q[base], omega, psi), strict=True):
            total[np.ix_(base, base)] += part
        for k, joints in enumerate(self.tree.blades):
            index = np.append(base, joints)
            azimuth = psi + 2.0 * np.pi * k / len(self.tree.blades)
            at_hub = np.append(np.zeros(len(self.moved) - len(joints)), q[joints])
            for total, part in zip((M, C, K), self.single.linearized(at_hub, omega, azimuth), strict=True):
                total[np.ix_(index, index)] += self.moved.T @ part @ self.moved
        return M, C, K


def _parts(tree: TurbineTree, q: Array) -> _Parts:
    """The parts of a tree with the tower at the coordinates q (n,)."""
    on_hub = _on_hub(tree, q)
    bare = _Links(tree, np.arange(tree.hub + 1), tree.bodies)
    single = _Links(on_hub, np.arange(len(on_hub.strain)), on_hub.bodies)
    return _Parts(tree, bare, single, _by_tower(tree, q, len(on_hub.strain)))


def _standing(tree: TurbineTree) -> tuple[Array, Array]:
    """Coordinates (t,) of the tower under the weight of all that it carries, and the stiffness (t, t) of that weight.

    The rotor is rigid, and the weight does not displace the base.

    Raises:
        CodeError: Newton's method does not converge.
    """
    t, links = tree.tower[tree.foot :], np.arange(tree.spin + 1)
    loaded = _Links(tree, links, [*tree.bodies[: tree.spin], tree.rotor], tree.turbine.gravity)
    elastic = tree.stiffness[np.ix_(t, t)]
    q = np.zeros(len(links))
    for _ in range(STEPS):
        gradient, hessian = loaded.weight(q)
        own = hessian[np.ix_(t, t)]
        step = np.linalg.solve(elastic + own, -(elastic @ q[t] + gradient[t]))
        q[t] += step
        if np.abs(step).max() < 1e-13:
            return q[tree.tower], loaded.weight(q)[1][np.ix_(tree.tower, tree.tower)]
    raise CodeError("the tower finds no balance under the weight that it carries: check its stiffness")


def _on_hub(tree: TurbineTree, q: Array) -> TurbineTree:
    """The tree of one blade on its hub, which moves in the ground's axes with six coordinates; its bodies are the blade's."""
    placement = turbine_motion.placed(tree, q)
    joints, angles = tree.blades[0], np.arange(tree.spin, tree.hub + 1)
    no_offset, unit = np.zeros((5, 3)), np.broadcast_to(np.eye(3), (6, 3, 3))
    count = 6 + len(angles) + len(joints)
    return replace(
        tree,
        strain=np.concatenate([np.arange(6), tree.strain[angles], tree.strain[joints]]),
        parent=np.arange(-1, count - 1),
        offset=np.concatenate(
            [placement.origin[tree.spin][None], no_offset, 0.0 * tree.offset[angles], tree.offset[joints]]
        ),
        axes=np.concatenate([unit, placement.axes[tree.spin][None], tree.axes[angles[1:]], tree.axes[joints]]),
        bodies=(*[NOTHING] * (6 + len(angles)), *(tree.bodies[k] for k in joints)),
        spin=6,
        hub=5 + len(angles),
    )


def _by_tower(tree: TurbineTree, q: Array, count: int) -> Array:
    """(count, n) rates of the joints of ``_on_hub`` due to those of tower, shaft and blade."""
    t = tree.spin
    out = np.zeros((count, t + count - 6))
    out[:6, :t] = turbine_motion.jacobian(tree, turbine_motion.placed(tree, q), t, np.zeros(3))[:, :t]
    out[6:, t:] = np.eye(count - 6)
    return out


def _steady(tree: TurbineTree, single: _Links, omega: float) -> Array:
    """Coordinates (b,) of a blade in balance at a speed, rad/s, on a hub that only spins.

    Raises:
        CodeError: Newton's method does not converge.
    """
    joints = tree.blades[0]
    first = single.model.nv - len(joints)
    elastic = tree.stiffness[np.ix_(joints, joints)]
    q = np.zeros(single.model.nv)
    last = np.inf
    for _ in range(STEPS):
        force, stiffness, _ = single.forces(q, omega, 0.0)
        residual = force[first:] + elastic @ q[first:]
        step = np.linalg.solve(elastic + stiffness[first:, first:], -residual)
        size = float(np.abs(step).max(initial=0.0))
        q[first:] += step * min(1.0, 0.3 / max(size, 0.3))
        if size < 1e-13 or (size < 1e-9 and size > 0.3 * last):
            return q[first:]
        last = size
    raise CodeError(f"omega: {omega:g} rad/s: the blade finds no steady state; lower the speed")


def _frequency(tree: TurbineTree, single: _Links, at_blade: Array, omega: float) -> float:
    """A typical frequency, rad/s: that of a blade under a uniform load, by Rayleigh's quotient."""
    joints = tree.blades[0]
    first = single.model.nv - len(joints)
    M, _, K = single.linearized(np.append(np.zeros(first), at_blade), omega, 0.0)
    M, K = M[first:, first:], K[first:, first:] + tree.stiffness[np.ix_(joints, joints)]
    deflection = np.linalg.solve(K, M @ np.ones(len(joints)))
    return float(np.sqrt(abs(deflection @ K @ deflection / (deflection @ M @ deflection))))


CODE = PinocchioTurbine()
