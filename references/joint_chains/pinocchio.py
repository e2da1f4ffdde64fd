"""Pinocchio: core's lumped discretisation as a chain of joints (see ``joint_chain``).

J. Carpentier, N. Mansard, "Analytical derivatives of rigid body dynamics algorithms", Robotics: Science and Systems 14,
2018. One joint of six coordinates would be simpler, but the derivatives of Pinocchio's composite joint are wrong if it
translates and rotates. Each body therefore has four joints, and the symmetries are checked.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.element.mesh import Mesh
from ..protocol.interface import extra
from .joint_chain import JointChain, bodies, from_core, places, require_symmetries

Array = NDArray[np.float64]

SYMMETRY_TOLERANCE = 1e-9
"""Largest relative asymmetry of Pinocchio's derivatives attributed to rounding."""


@dataclass(frozen=True)
class PinocchioChain:
    """Pinocchio's model and workspace; see ``joint_chain.ChainModel``."""

    model: Any
    data: Any
    elements: int

    def inertial(self, q: Array, omega: float) -> tuple[Array, Array, Array]:
        """See ``inertial``."""
        return inertial(self.model, self.data, q, omega)

    def mass(self, q: Array) -> Array:
        """Mass matrix (n, n), by composite rigid bodies."""
        return _pinocchio().crba(self.model, self.data, np.append(0.0, q))[1:, 1:]

    def inertia(self) -> Array:
        """(6, 6): from Pinocchio's composite rigid bodies."""
        pin, undeformed = _pinocchio(), np.zeros(self.model.nq)
        pin.ccrba(self.model, self.data, undeformed, np.zeros(self.model.nv))
        about_centre = np.array(self.data.Ig.matrix())
        x, y, z = self.data.com[0]
        to_hub = np.eye(6)
        to_hub[:3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
        return to_hub.T @ about_centre @ to_hub

    def jacobian(self, q: Array) -> Array:
        """(elements, 4, n)."""
        pin = _pinocchio()
        pin.computeJointJacobians(self.model, self.data, np.append(0.0, q))
        last = (1 + 4 * k for k in range(1, self.elements + 1))
        axes = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        return np.array([pin.getJointJacobian(self.model, self.data, k, axes)[:4, 1:] for k in last])


def build(chain: Mesh) -> PinocchioChain:
    """Build the chain in Pinocchio."""
    model = pinocchio_model(chain)
    return PinocchioChain(model, _workspace(model), chain.elements)


_LAST: dict[int, Any] = {}
"""The last workspace, by the number of joints."""


def _workspace(model: Any) -> Any:
    """Pinocchio's workspace for a model. Models with the same joints share it, since every computation fills it anew.

    It has four arrays of (6·elements)³ numbers: with 40 elements, making it takes longer than all computations in it.
    """
    if model.njoints not in _LAST:
        _LAST.clear()
        _LAST[model.njoints] = model.createData()
    return _LAST[model.njoints]


def _pinocchio() -> Any:
    import pinocchio

    return pinocchio


def pinocchio_model(chain: Mesh) -> Any:
    """Pinocchio's model: a hub rotating about z, then a body on four joints for every node except the clamped one."""
    pin = _pinocchio()
    model = pin.Model()
    model.gravity.setZero()
    origin = pin.SE3.Identity()
    link = model.addJoint(0, pin.JointModelRZ(), origin, "hub")
    for k, (pose, lump) in enumerate(zip(places(chain), bodies(chain), strict=True), 1):
        link = model.addJoint(link, pin.JointModelTranslation(), pin.SE3(pose), f"{k} x y z")
        for axis, kind in (("x", pin.JointModelRX), ("y", pin.JointModelRY), ("z", pin.JointModelRZ)):
            link = model.addJoint(link, kind(), origin, f"{k} about {axis}")
        model.appendBodyToJoint(link, pin.Inertia.FromDynamicParameters(_parameters(lump)), origin)
    return model


def _parameters(inertia: Array) -> Array:
    """Mass, first and second moments (10,) of an inertia (6, 6), in Pinocchio's order; second moments about the node."""
    row, column = [0, 1, 2, 0, 3, 3, 4, 3, 4, 5], [0, 5, 3, 4, 3, 4, 4, 5, 5, 5]
    return inertia[row, column]


def inertial(model: Any, data: Any, q: Array, omega: float) -> tuple[Array, Array, Array]:
    """Generalised inertial force (n,) in steady rotation, and its derivatives (n, n) by q and by q̇, without the hub's row.

    Raises:
        CodeError: the derivative by q is not symmetric, or that by q̇ not skew.
    """
    pin = _pinocchio()
    q, v = np.append(0.0, q), np.append(omega, np.zeros_like(q))
    pin.computeRNEADerivatives(model, data, q, v, np.zeros_like(v))
    force, stiffness, gyroscopic = data.tau[1:].copy(), data.dtau_dq[1:, 1:].copy(), data.dtau_dv[1:, 1:].copy()
    require_symmetries(stiffness, gyroscopic, SYMMETRY_TOLERANCE, "Pinocchio")
    return force, stiffness, gyroscopic


CODE = JointChain(
    name="pinocchio",
    title="Pinocchio, chain of joints",
    hint=extra("codes"),
    independence=from_core("Pinocchio"),
    distribution="pin",
    max_elements=60,  # its workspace has four arrays of (6·elements + 1)³ numbers, 1.5 GB for 60
    build=build,
)
