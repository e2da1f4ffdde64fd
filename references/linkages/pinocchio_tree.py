"""A mechanism's tree in Pinocchio: unbalanced forces and their derivatives, including springs and loads.

Pinocchio computes inertia and gyroscopic forces, gravity and their analytical derivatives (J. Carpentier, N. Mansard,
"Analytical derivatives of rigid body dynamics algorithms", Robotics: Science and Systems 14, 2018).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.mechanism.description import Mechanism
from ...core.space.spatial import skew
from .closure import equations, reversed_axes
from .points import Function, by, distance, frames
from .spanning import Spanning, spanning

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Tangent:
    """The tree at one configuration, in its n coordinates.

    Attributes:
        force: (n,) to be balanced by the reactions of the loops.
        M, C, K: (n, n) its derivatives by acceleration, velocity and coordinate.
        loops: (c) the equations of the loops.
        opposed: name of a loop joint whose axes are opposed; empty if there is none.
    """

    force: Array
    M: Array
    C: Array
    K: Array
    loops: tuple[Function, ...]
    opposed: str

    @property
    def gap(self) -> Array:
        """(c,) values of the loops' equations."""
        return np.array([f.value for f in self.loops])

    @property
    def J(self) -> Array:
        """(c, n) gradients of the loops' equations."""
        return np.array([f.gradient for f in self.loops]).reshape(len(self.loops), len(self.force))

    def curvature(self, multipliers: Array) -> Array:
        """(n, n) stiffness of the loops' reactions: −Σ λ ∂²φ/∂q²."""
        out = np.zeros_like(self.K)
        for f, value in zip(self.loops, multipliers, strict=True):
            out -= value * f.hessian
        return out

    def misclosed(self) -> str:
        """See ``matrices.null_space.Tangent``."""
        return self.opposed


def _pinocchio() -> Any:
    import pinocchio

    return pinocchio


class PinocchioTree:
    """A mechanism in Pinocchio (see ``matrices.null_space.Model``); ``tree`` is its spanning tree."""

    rounding = 1e-8

    def __init__(self, mechanism: Mechanism) -> None:
        pinocchio = _pinocchio()
        self.tree: Spanning = spanning(mechanism)
        self.mechanism = mechanism
        self.names = self.tree.names
        self._pin: Any = pinocchio
        self._model: Any = pinocchio.Model()
        self._model.gravity.linear = np.array(mechanism.gravity, dtype=float)
        for link in self.tree.links:
            pose = pinocchio.SE3(link.frame[:3, :3], link.frame[:3, 3])
            kind = pinocchio.JointModelRevoluteUnaligned if link.turns else pinocchio.JointModelPrismaticUnaligned
            self._model.addJoint(link.parent + 1, kind(link.axis), pose, link.name)
        for body in mechanism.bodies:
            link, pose = self.tree.bodies[body.name]
            if link >= 0 and body.inertia.any():
                at = pinocchio.SE3(pose[:3, :3], pose[:3, 3])
                self._model.appendBodyToJoint(link + 1, _inertia(pinocchio, body.inertia), at)
        self._ids: list[int] = []
        self._add_frames()
        self._data: Any = self._model.createData()
        self.rates: Array = np.zeros(len(self.tree.links))
        for m in mechanism.motions:
            self.rates[self.names.index(m.coordinate)] = m.rate

    def _add_frames(self) -> None:
        """Add frames of the loop joints, then of the springs, then of the loads, two each."""
        ends = [(b, at) for j in self.tree.loops for b, at in ((j.parent, j.at_parent), (j.child, j.at_child))]
        points = [(b, p) for s in self.mechanism.springs for b, p in ((s.body_a, s.point_a), (s.body_b, s.point_b))]
        points += [(b, np.zeros(3)) for f in self.mechanism.loads for b in (f.axes_of, f.body)]
        for body, point in points:
            pose = np.eye(4)
            pose[:3, 3] = point
            ends.append((body, pose))
        for number, (body, at) in enumerate(ends):
            link, pose = self.tree.bodies[body]
            pose = pose @ at
            se3 = self._pin.SE3(pose[:3, :3], pose[:3, 3])
            kind = self._pin.FrameType.OP_FRAME
            self._ids.append(self._model.addFrame(self._pin.Frame(f"end {number}", link + 1, 0, se3, kind)))

    def at(self, q: Array) -> Tangent:
        """The tree at coordinates q (n,), its motions at their rates."""
        pin, model, data, mechanism = self._pin, self._model, self._data, self.mechanism
        pin.computeRNEADerivatives(model, data, q, self.rates, np.zeros_like(q))
        n = len(q)
        force, K, C = np.array(data.tau), *(np.reshape(a, (n, n)).copy() for a in (data.dtau_dq, data.dtau_dv))
        M = np.reshape(pin.crba(model, data, q), (n, n))
        M = np.triu(M) + np.triu(M, 1).T
        for s in mechanism.coordinate_springs:
            j = self.names.index(s.coordinate)
            force[j] += s.stiffness * (q[j] - s.neutral) + s.damping * self.rates[j]
            K[j, j] += s.stiffness
            C[j, j] += s.damping
        poses = frames(pin, model, data, q, self._ids)
        pairs = list(zip(poses[::2], poses[1::2], strict=True))
        first, second = len(self.tree.loops), len(self.tree.loops) + len(mechanism.springs)
        for s, (a, b) in zip(mechanism.springs, pairs[first:second], strict=True):
            line = distance(a, b)
            rate, rate_of_gradient = line.gradient @ self.rates, line.hessian.T @ self.rates
            tension = s.stiffness * (line.value - s.free_length) + s.damping * rate
            force += tension * line.gradient
            K += tension * line.hessian + np.outer(
                line.gradient, s.stiffness * line.gradient + s.damping * rate_of_gradient
            )
            C += s.damping * np.outer(line.gradient, line.gradient)
        for load, (axes, point) in zip(mechanism.loads, pairs[second:], strict=True):
            pushed = axes.R @ np.asarray(load.force, float)  # its axes rotate by prescribed coordinates only
            force -= point.V.T @ pushed
            K -= by(point.V1, pushed)
        closing = list(zip(self.tree.loops, pairs[:first], strict=True))
        loops = [f for joint, (p, c) in closing for f in equations(joint, p, c)]
        opposed = next((joint.name for joint, (p, c) in closing if reversed_axes(joint, p, c)), "")
        return Tangent(force, M, C, K, tuple(loops), opposed)


def _inertia(pin: Any, about_origin: Array) -> Any:
    """Pinocchio's inertia from one (6, 6) about the body's origin, forces before moments."""
    mass = float(about_origin[0, 0])
    centre = np.array([about_origin[1, 5], about_origin[2, 3], about_origin[0, 4]]) / (mass or 1.0)
    lever = skew(centre)
    moments, axes = np.linalg.eigh(about_origin[3:, 3:] + mass * lever @ lever)
    return pin.Inertia(mass, centre, (axes * np.maximum(moments, 0.0)) @ axes.T)  # rounding may make a moment negative
