"""The weight that a turbine's tower carries, in the adapter's equations: Exudyn's kinematic tree has no gravity stiffness."""

import numpy as np
from numpy.typing import NDArray

from ..protocol.interface import CodeError
from ..theories.turbine_motion import jacobian, placed
from ..theories.turbine_tree import TurbineTree

Array = NDArray[np.float64]

UP = np.array([1.0, 0.0, 0.0])

STEPS = 50
"""Largest number of Newton steps."""


def standing(tree: TurbineTree) -> tuple[Array, Array]:
    """Coordinates (t,) of the tower under the weight of all that it carries, and the stiffness (t, t) of that weight.

    Newton's method on the gradient of the potential Σ m g h; the rotor is rigid and carried by the nacelle. The weight does not
    displace the base.

    Raises:
        CodeError: Newton's method does not converge.
    """
    t, gravity = tree.tower[tree.foot :], tree.turbine.gravity
    own = np.ix_(t, t)
    q = np.zeros(len(tree.strain))
    elastic = tree.stiffness[own]
    for _ in range(STEPS):
        force, stiffness = _weight(tree, q)
        step = np.linalg.solve(elastic + gravity * stiffness[own], -(elastic @ q[t] + gravity * force[t]))
        q[t] += step
        if np.abs(step).max() < 1e-13:
            return q[tree.tower], gravity * _weight(tree, q)[1]
    raise CodeError("the tower finds no balance under the weight that it carries: check its stiffness")


def _weight(tree: TurbineTree, q: Array) -> tuple[Array, Array]:
    """Gradient (t,) and Hessian (t, t) of Σ m h over the tower's joints: ∂²p/∂q_i∂q_j = a_i × ∂p/∂q_j, i before j."""
    at, t = placed(tree, q), len(tree.tower)
    gradient, hessian = np.zeros(t), np.zeros((t, t))
    turns = tree.strain[:t] >= 3
    for link, body in [*((k, tree.bodies[k]) for k in range(t)), (tree.spin, tree.rotor)]:
        if not body.mass:
            continue
        J = jacobian(tree, at, link, body.centre)[:3, :t]
        gradient += body.mass * UP @ J
        swept = body.mass * np.einsum("a,iaj->ij", UP, np.cross(at.along[:t, None], J.T[None]).swapaxes(1, 2))
        upper = np.triu(swept * turns[:, None] * (np.abs(J).max(0) > 0))
        hessian += upper + np.triu(upper, 1).T
    return gradient, hessian
