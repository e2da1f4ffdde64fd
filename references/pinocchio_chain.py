"""Pinocchio: core's own lumped discretisation as a chain of joints, moved and differentiated by another code.

Core gives the nodes, the bodies at them and the elements' stiffness, all as plain numbers (``half_end`` masses, stiffness
linear in the parent body's frame: the discretisation of Park et al. 2010). Each body then hangs on the one before by a
translation and rotations about x, y, z, whose coordinates are the element's six strains; kinematics, dynamics and the
derivatives of the inertial forces are Pinocchio's (J. Carpentier, N. Mansard, "Analytical derivatives of rigid body
dynamics algorithms", Robotics: Science and Systems 14, 2018). Agreement to rounding shows that core solves its model, not
that the model is right.

One joint of six coordinates would be shorter, but the derivatives of Pinocchio's composite joint are wrong where it
translates and rotates; hence four joints a body, and the symmetries are checked.
"""

import time
from importlib import metadata
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.linalg import block_diag

from ..core.blade import Blade, clamped
from ..core.discretize import Chain, discretize
from ..core.model import FULL
from ..core.modes import STATIONS, Modes
from .interface import CodeError, Shares
from .quadratic import gyroscopic_modes

Array = NDArray[np.float64]

MOST = 60
"""Elements: Pinocchio's workspace holds four arrays of (6·elements + 1)³ numbers, 1.5 GB for 60."""

STEPS, SMALLEST_RAMP = 40, 2.0**-8
"""Of Newton's method for the steady state; of the load, where Newton fails with all of it at once."""

SYMMETRIC = 1e-9
"""Relative departure from symmetry of Pinocchio's derivatives that counts as rounding."""


class PinocchioChain:
    """See the module; every blade that core can discretise, coupled and curved ones too."""

    name = "pinocchio"
    title = "Pinocchio, chain of joints"
    shares: Shares = "discretisation"
    model = FULL
    levels = (10, 20, 40)
    order = 2
    hint = "pip install 'southwell[codes]'"

    def version(self) -> str | None:
        """Version of Pinocchio, without importing it."""
        try:
            return metadata.version("pin")
        except metadata.PackageNotFoundError:
            return None

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if the inertias are not those of rigid bodies."""
        if not clamped(blade):
            return "the root is not clamped: the chain begins at the hub"
        for name, inertia in (("mass", blade.mass), ("tip_mass", blade.tip_mass[None])):
            if not _rigid(inertia):
                return f"{name} is not a rigid body's: one mass in all directions, antisymmetric in its offset"
        return None

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.Code``.

        Raises:
            CodeError: an unsupported blade, more than ``MOST`` elements, or no stable steady state at this speed.
        """
        if reason := self.unsupported(blade):
            raise CodeError(f"{blade.name}: {reason}")
        if elements > MOST:
            raise CodeError(f"elements: {elements}: Pinocchio's workspace grows as their cube; at most {MOST}")
        begun = time.perf_counter()
        chain = discretize(blade, elements, "half_end", "parent")
        model = plant(chain)
        data = model.createData()
        elastic = cast(Array, block_diag(*chain.beams.stiffness))
        q = steady(model, data, elastic, omega, chain.scale)
        M, C, K = linearize(model, data, elastic, omega, q)
        frequencies, vectors = gyroscopic_modes(M, C, K, count)
        shapes = _shapes(model, data, q, vectors, elements)
        return Modes(omega, frequencies, shapes, elements, seconds=time.perf_counter() - begun)


def _pinocchio() -> Any:
    import pinocchio

    return pinocchio


def _rigid(inertia: Array) -> bool:
    """Whether inertias (k, 6, 6) have the form [[m, −m c×], [m c×, J]]."""
    linear, offset = inertia[:, :3, :3], inertia[:, :3, 3:]
    wrong = [
        linear - inertia[:, :1, :1] * np.eye(3),
        offset + np.swapaxes(offset, 1, 2),
        inertia - np.swapaxes(inertia, 1, 2),
    ]
    return max(np.abs(w).max() for w in wrong) <= 1e-12 * np.abs(inertia).max()


def plant(chain: Chain) -> Any:
    """Pinocchio's model: a hub turning about z, then a body on four joints for every node but the clamped one."""
    pin = _pinocchio()
    model = pin.Model()
    model.gravity.setZero()
    here = pin.SE3.Identity()
    link = model.addJoint(0, pin.JointModelRZ(), here, "hub")
    places = [chain.nodes[1], *chain.beams.rest[1:]]
    for k, (place, lump) in enumerate(zip(places, chain.lumps[1:], strict=True), 1):
        link = model.addJoint(link, pin.JointModelTranslation(), pin.SE3(place), f"{k} x y z")
        for axis, turn in (("x", pin.JointModelRX), ("y", pin.JointModelRY), ("z", pin.JointModelRZ)):
            link = model.addJoint(link, turn(), here, f"{k} about {axis}")
        model.appendBodyToJoint(link, pin.Inertia.FromDynamicParameters(_parameters(lump)), here)
    return model


def _parameters(inertia: Array) -> Array:
    """Mass, first and second moments (10,) of an inertia (6, 6), in Pinocchio's order; second moments about the node."""
    row, column = [0, 1, 2, 0, 3, 3, 4, 3, 4, 5], [0, 5, 3, 4, 3, 4, 4, 5, 5, 5]
    return inertia[row, column]


def inertial(model: Any, data: Any, q: Array, omega: float) -> tuple[Array, Array, Array]:
    """Generalised inertial force (n,) of steady turning, and its derivatives (n, n) by q and by q̇, the hub's row left out.

    Raises:
        CodeError: by q it is not symmetric, or by q̇ not skew, as both must be.
    """
    pin = _pinocchio()
    q, v = np.append(0.0, q), np.append(omega, np.zeros_like(q))
    pin.computeRNEADerivatives(model, data, q, v, np.zeros_like(v))
    force, stiffness, gyroscopic = data.tau[1:].copy(), data.dtau_dq[1:, 1:].copy(), data.dtau_dv[1:, 1:].copy()
    for name, matrix, sign in (("dtau_dq", stiffness, 1), ("dtau_dv", gyroscopic, -1)):
        wrong = np.abs(matrix - sign * matrix.T).max()
        if not wrong <= SYMMETRIC * np.abs(matrix).max():
            kind = "symmetric" if sign == 1 else "skew"
            raise CodeError(
                f"{name}: {wrong:.1e} from {kind}: Pinocchio's derivatives are wrong for some joint of the chain"
            )
    return force, stiffness, gyroscopic


def steady(model: Any, data: Any, elastic: Array, omega: float, length: float) -> Array:
    """Coordinates (n,) at which the elements' forces ``elastic @ q`` balance the steady inertial ones.

    The load, Ω², is raised in steps only if all of it at once is too much for Newton's method.

    Raises:
        CodeError: no steady state near the undeformed chain.
    """
    q, done, step = np.zeros(len(elastic)), 0.0, 1.0
    while done < 1.0:
        load = min(1.0, done + step)
        found = _newton(model, data, elastic, omega * load**0.5, q, length)
        if found is not None:
            q, done = found, load
        elif step > SMALLEST_RAMP:
            step /= 2
        else:
            raise CodeError(f"omega: {omega:g} rad/s: no steady state past {done:.0%} of Ω²; lower the speed")
    return q


def _newton(model: Any, data: Any, elastic: Array, omega: float, q: Array, length: float) -> Array | None:
    size = np.tile(np.repeat([length, 1.0], 3), len(q) // 6)
    before = np.inf
    for _ in range(STEPS):
        force, stiffness, _ = inertial(model, data, q, omega)
        try:
            step = np.linalg.solve(elastic + stiffness, -force - elastic @ q)
        except np.linalg.LinAlgError:
            return None
        change = np.abs(step / size).max()
        if not change < 1.0:
            return None
        q = q + step
        if change < 1e-10 or 0.1 * before < change < 1e-7:  # converged, or down to rounding
            return q
        before = change
    return None


def linearize(model: Any, data: Any, elastic: Array, omega: float, q: Array) -> tuple[Array, Array, Array]:
    """M, C, K (n, n) about the steady state ``q``."""
    pin = _pinocchio()
    _, stiffness, gyroscopic = inertial(model, data, q, omega)
    return pin.crba(model, data, np.append(0.0, q))[1:, 1:], gyroscopic, elastic + stiffness


def _shapes(model: Any, data: Any, q: Array, vectors: NDArray[np.complex128], elements: int) -> NDArray[np.complex128]:
    """(m, 21, 4) at the common stations: a spline through the nodes, moved as Pinocchio says."""
    pin = _pinocchio()
    pin.computeJointJacobians(model, data, np.append(0.0, q))
    moved = np.zeros((elements + 1, 4, vectors.shape[1]), complex)
    for k in range(1, elements + 1):
        jacobian = pin.getJointJacobian(model, data, 1 + 4 * k, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)
        moved[k] = jacobian[:4, 1:] @ vectors
    return CubicSpline(np.linspace(0.0, 1.0, elements + 1), moved)(STATIONS).transpose(2, 0, 1)


CODE = PinocchioChain()
