"""Drake: core's lumped discretisation as a chain of joints (see ``joint_chain``), differentiated automatically.

R. Tedrake and the Drake Development Team, *Drake: Model-based design and verification for robotics*, 2019. Inverse
dynamics with automatic differentiation gives the derivatives of the inertial forces by coordinates and rates, to
rounding. Drake's joint of six coordinates rotates about z, y, x in this order, but the strain of the elements about x,
y, z. It is therefore replaced by six joints of one coordinate, on massless links.
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

SYMMETRY_TOLERANCE = 1e-9
"""Largest relative asymmetry of Drake's derivatives attributed to rounding."""


@dataclass(frozen=True)
class DrakeChain:
    """Drake's plant; see ``joint_chain.ChainModel``.

    Attributes:
        plant, context: in floating point.
        auto, auto_context: the same with automatic differentiation.
        bodies: (elements,) the last link of each node's joints.
        position, velocity: (n,) Drake's index of each coordinate and its rate; ``hub``: of the hub's rate.
    """

    plant: Any
    context: Any
    auto: Any
    auto_context: Any
    bodies: list[Any]
    position: NDArray[np.intp]
    velocity: NDArray[np.intp]
    hub: int

    def inertial(self, q: Array, omega: float) -> tuple[Array, Array, Array]:
        """Force and derivatives by inverse dynamics with zero acceleration; see ``joint_chain.ChainModel``."""
        ad = _drake("autodiffutils")
        n, state = len(q), self._state(q, omega)
        seeds = np.zeros((len(state), 2 * n))
        seeds[self.position, range(n)] = 1.0
        seeds[self.auto.num_positions() + self.velocity, range(n, 2 * n)] = 1.0
        self.auto.SetPositionsAndVelocities(self.auto_context, ad.InitializeAutoDiff(state, seeds).ravel())
        zeros = np.array([ad.AutoDiffXd(0.0)] * self.auto.num_velocities())
        no_forces = _drake("multibody.tree").MultibodyForces_[ad.AutoDiffXd](self.auto)
        force = self.auto.CalcInverseDynamics(self.auto_context, zeros, no_forces)[self.velocity].reshape(-1, 1)
        stiffness, gyroscopic = np.split(ad.ExtractGradient(force), 2, axis=1)
        require_symmetries(stiffness, gyroscopic, SYMMETRY_TOLERANCE, "Drake")
        return ad.ExtractValue(force).ravel(), stiffness, gyroscopic

    def mass(self, q: Array) -> Array:
        """Mass matrix (n, n), by composite rigid bodies."""
        self.plant.SetPositionsAndVelocities(self.context, self._state(q, 0.0))
        return self.plant.CalcMassMatrix(self.context)[np.ix_(self.velocity, self.velocity)]

    def inertia(self) -> Array:
        """(6, 6): Drake's composite inertia of all links."""
        self.plant.SetPositionsAndVelocities(self.context, self._state(np.zeros(len(self.position)), 0.0))
        links = [body.index() for body in self.bodies]
        total = self.plant.CalcSpatialInertia(self.context, self.plant.world_frame(), links)
        moments = total.CalcRotationalInertia().CopyToFullMatrix3()
        return about_hub(total.get_mass(), total.get_com(), moments)

    def jacobian(self, q: Array) -> Array:
        """(elements, 4, n); see ``joint_chain.ChainModel``."""
        rates = _drake("multibody.tree").JacobianWrtVariable.kV
        self.plant.SetPositionsAndVelocities(self.context, self._state(q, 0.0))
        world, origin = self.plant.world_frame(), np.zeros(3)
        jacobians = [
            self.plant.CalcJacobianSpatialVelocity(self.context, rates, body.body_frame(), origin, world, world)
            for body in self.bodies
        ]
        return np.array(jacobians)[:, [3, 4, 5, 0]][:, :, self.velocity]  # Drake has rotation first

    def _state(self, q: Array, omega: float) -> Array:
        state = np.zeros(self.plant.num_positions() + self.plant.num_velocities())
        state[self.position] = q
        state[self.plant.num_positions() + self.hub] = omega
        return state


def _drake(module: str) -> Any:
    return import_module(f"pydrake.{module}")


def build(chain: Mesh) -> DrakeChain:
    """A hub rotating about z, then six links on joints of one coordinate for every node except the clamped one."""
    tree, pose = _drake("multibody.tree"), _drake("math").RigidTransform
    plant = _drake("multibody.plant").MultibodyPlant(0.0)
    plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
    no_inertia = tree.SpatialInertia.Zero()
    link = plant.AddRigidBody("hub", no_inertia)
    hub = plant.AddJoint(tree.RevoluteJoint("hub", plant.world_frame(), link.body_frame(), [0, 0, 1]))
    joints, links = [], []
    for k, (frame_pose, lump) in enumerate(zip(places(chain), bodies(chain), strict=True), 1):
        frame = plant.AddFrame(tree.FixedOffsetFrame(f"{k}", link.body_frame(), pose(frame_pose)))
        for i, axis in enumerate(np.tile(np.eye(3), (2, 1))):
            link = plant.AddRigidBody(f"{k} {i}", _inertia(lump) if i == 5 else no_inertia)
            kind = tree.PrismaticJoint if i < 3 else tree.RevoluteJoint
            joints.append(plant.AddJoint(kind(f"{k} {i}", frame, link.body_frame(), axis)))
            frame = link.body_frame()
        links.append(link)
    plant.Finalize()
    auto = plant.ToAutoDiffXd()
    return DrakeChain(
        plant=plant,
        context=plant.CreateDefaultContext(),
        auto=auto,
        auto_context=auto.CreateDefaultContext(),
        bodies=links,
        position=np.array([j.position_start() for j in joints]),
        velocity=np.array([j.velocity_start() for j in joints]),
        hub=hub.velocity_start(),
    )


def _inertia(lump: Array) -> Any:
    """Drake's form of an inertia (6, 6): moments over mass about the node. Not validated, as it need not be that of a solid."""
    tree = _drake("multibody.tree")
    mass, centre, moments = rigid(lump)
    xx, yy, zz, xy, xz, yz = (moments / mass)[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    return tree.SpatialInertia(mass, centre, tree.UnitInertia(xx, yy, zz, xy, xz, yz), skip_validity_check=True)


CODE = JointChain(
    name="drake",
    title="Drake, chain of joints",
    hint=extra("more-codes"),
    independence=from_core("Drake"),
    distribution="drake",
    max_elements=80,  # each number in the recursion over 6·elements joints has 12·elements derivatives
    build=build,
)
