"""MuJoCo: core's lumped discretisation as a chain of joints (see ``joint_chain``), differentiated numerically.

E. Todorov, T. Erez and Y. Tassa, "MuJoCo: A physics engine for model-based control", IEEE/RSJ IROS 2012, 5026–5033. Its
recursive Newton–Euler algorithm gives the inertial forces. They are quadratic in the rates, so central differences by
the rates are exact. Differences by the coordinates use Richardson extrapolation, with steps so large that rounding
stays at 1e-12.
"""

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.element.mesh import Mesh
from ..protocol.interface import extra
from .joint_chain import JointChain, about_hub, bodies, from_core, places, require_symmetries, rigid

Array = NDArray[np.float64]

STEP = 2e-3
"""Step of a coordinate in a central difference, rad or element lengths; the truncation error is of fourth order in it."""


SYMMETRY_TOLERANCE = 1e-8
"""Largest relative asymmetry of the differences attributed to rounding."""


@dataclass(frozen=True)
class MujocoChain:
    """MuJoCo's model and state; see ``joint_chain.ChainModel``.

    Attributes:
        model, data: MuJoCo's; coordinate 0 is the hub's.
        step: (n,) of each coordinate in a difference, m or rad.
    """

    model: Any
    data: Any
    step: Array

    def inertial(self, q: Array, omega: float) -> tuple[Array, Array, Array]:
        """Force and derivatives by differences; see ``joint_chain.ChainModel``."""
        n, rates = len(q), np.append(omega, np.zeros(len(q)))
        unit = np.eye(n)
        stiffness, gyroscopic = np.empty((n, n)), np.empty((n, n))
        for k, h in enumerate(self.step):
            small_step, large_step = (
                (self._force(q + s * h * unit[k], rates) - self._force(q - s * h * unit[k], rates)) / (2 * s * h)
                for s in (1, 2)
            )
            stiffness[:, k] = (4 * small_step - large_step) / 3
        self._place(q)
        rate = max(abs(omega), 1.0)
        for k in range(n):
            change = np.append(0.0, rate * unit[k])
            gyroscopic[:, k] = (self._of_rates(rates + change) - self._of_rates(rates - change)) / (2 * rate)
        require_symmetries(stiffness, gyroscopic, SYMMETRY_TOLERANCE, "MuJoCo")
        return self._of_rates(rates), stiffness, gyroscopic

    def mass(self, q: Array) -> Array:
        """Mass matrix (n, n), by composite rigid bodies."""
        self._place(q)
        mujoco = _mujoco()
        mujoco.mj_crb(self.model, self.data)
        full = np.zeros((len(q) + 1, len(q) + 1))
        mujoco.mj_fullM(self.model, self.data, full)
        return full[1:, 1:]

    def inertia(self) -> Array:
        """(6, 6): of MuJoCo's bodies, the hub excepted."""
        self._place(np.zeros(self.model.nv - 1))
        out = np.zeros((6, 6))
        for k in range(2, self.model.nbody):
            axes, centre, mass = self.data.ximat[k].reshape(3, 3), self.data.xipos[k], float(self.model.body_mass[k])
            moments = axes @ np.diag(self.model.body_inertia[k]) @ axes.T
            out += about_hub(mass, centre, moments + mass * (centre @ centre * np.eye(3) - np.outer(centre, centre)))
        return out

    def jacobian(self, q: Array) -> Array:
        """(elements, 4, n)."""
        self._place(q)
        mujoco = _mujoco()
        out = np.zeros((self.model.nbody - 2, 6, len(q) + 1))
        for k, (translation, rotation) in enumerate(zip(out[:, :3], out[:, 3:], strict=True)):
            mujoco.mj_jacBody(self.model, self.data, translation, rotation, k + 2)
        return out[:, :4, 1:]

    def _force(self, q: Array, rates: Array) -> Array:
        self._place(q)
        return self._of_rates(rates)

    def _place(self, q: Array) -> None:
        mujoco = _mujoco()
        self.data.qpos[:] = np.append(0.0, q)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)

    def _of_rates(self, rates: Array) -> Array:
        mujoco = _mujoco()
        self.data.qvel[:] = rates
        mujoco.mj_comVel(self.model, self.data)
        force = np.zeros(len(rates))
        mujoco.mj_rne(self.model, self.data, 0, force)
        return force[1:]


def _mujoco() -> Any:
    return import_module("mujoco")


def build(chain: Mesh) -> MujocoChain:
    """A hub rotating about z, then a body on six joints for every node except the clamped one.

    MuJoCo's compiler requires inertias of solids. The chain may have point masses, so its inertias are set after
    compilation.
    """
    mujoco = _mujoco()
    spec = mujoco.MjSpec()
    spec.option.gravity = np.zeros(3)
    spec.compiler.degree = False
    body = spec.worldbody.add_body(name="hub", mass=1.0, inertia=np.ones(3))
    body.add_joint(type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 0, 1])
    for pose in places(chain):
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, pose[:3, :3].ravel())
        body = body.add_body(pos=pose[:3, 3], quat=quaternion, mass=1.0, inertia=np.ones(3))
        for kind in (mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE):
            for axis in np.eye(3):
                body.add_joint(type=kind, axis=axis)
    model = spec.compile()
    for k, lump in enumerate(bodies(chain), 2):
        mass, centre, moments = rigid(lump)
        moments, axes = np.linalg.eigh(moments - mass * (centre @ centre * np.eye(3) - np.outer(centre, centre)))
        axes[:, 0] *= np.sign(np.linalg.det(axes))
        model.body_mass[k], model.body_ipos[k], model.body_inertia[k] = mass, centre, moments
        mujoco.mju_mat2Quat(model.body_iquat[k], axes.ravel())
    model.body_simple[:] = 0
    model.body_sameframe[:] = 0
    model.body_subtreemass[:] = np.append(model.body_mass[1:].sum(), np.cumsum(model.body_mass[:0:-1])[::-1])
    lengths = np.linalg.norm(chain.beams.undeformed[:, :3, 3], axis=1)
    step = STEP * np.concatenate([np.repeat([length, 1.0], 3) for length in lengths])
    return MujocoChain(model, mujoco.MjData(model), step)


CODE = JointChain(
    name="mujoco",
    title="MuJoCo, chain of joints",
    hint=extra("more-codes"),
    independence=from_core("MuJoCo"),
    distribution="mujoco",
    max_elements=80,  # the time of the differences grows as its square, of the eigenproblem as its cube
    build=build,
)
