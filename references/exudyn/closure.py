"""A mechanism as Exudyn's kinematic tree, each loop closed by a generic joint; forces and matrices at any coordinates."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.mechanism.joints import SCREWS
from ...core.space import spatial as sp
from ...core.space.inertia import about_centre
from ...core.tree.topology import Tree
from . import system as ex

Array = NDArray[np.float64]

_STEP = 1e-3


class System:
    """An assembled Exudyn system with n coordinates and c constraint equations, evaluated at any coordinates."""

    def __init__(self, exu: Any, container: Any, mbs: Any, size: int) -> None:
        self.size = size
        self._exu, self._container, self._mbs = exu, container, mbs  # keeps the container alive
        self._settings = exu.SimulationSettings()
        self._settings.solution.file.write = False
        self._settings.staticSolver.verboseMode = 0
        self._settings.linearSolver.solverType = exu.LinearSolverType.EigenDense
        self._differences = self._settings.staticSolver.newton.numericalDifferentiation
        self._differences.minimumCoordinateSize = 1.0
        self._differences.forODE2Connectors = (
            True  # its internal derivatives treat the Jacobians of the markers as constant
        )

    def balance(self, q: Array) -> tuple[Array, Array, Array]:
        """Unbalanced forces (n,) without reactions, constraint residuals of the loops (c,), and constraint directions J
        (n, c)."""
        solver = self._at(q)
        solver.ComputeNewtonResidual(self._mbs, self._settings)
        residual = np.array(solver.GetSystemResidual())
        solver.ComputeJacobianODE2RHS(self._mbs, -1.0, 0.0, 0.0)
        solver.ComputeJacobianAE(self._mbs, 1.0, 0.0, 0.0, False)
        J = np.array(solver.GetSystemJacobian())[: self.size, self.size :]
        solver.FinalizeSolver(self._mbs, self._settings)
        return residual[: self.size], residual[self.size :], J

    def matrices(self, q: Array) -> tuple[Array, Array, Array]:
        """Mass, damping and gyroscopic, and stiffness matrix (n, n) of the tree.

        Exudyn uses forward differences. Richardson extrapolation removes their error: exactly for the velocities, in
        which the forces are quadratic, and to third order for the coordinates.
        """
        M = np.zeros((self.size, self.size))

        def slope(step: float, stiffness: float, damping: float) -> Array:
            nonlocal M
            self._differences.relativeEpsilon = step
            solver = self._at(q)
            solver.ComputeMassMatrix(self._mbs)
            M = np.array(solver.GetSystemMassMatrix())[: self.size, : self.size]
            solver.ComputeJacobianODE2RHS(self._mbs, stiffness, damping, 0.0, 1)
            out = np.array(solver.GetSystemJacobian())[: self.size, : self.size]
            solver.FinalizeSolver(self._mbs, self._settings)
            return out

        C = 2.0 * slope(0.05, 0.0, -1.0) - slope(0.1, 0.0, -1.0)
        h = 1e-4
        K = (8.0 * slope(h, -1.0, 0.0) - 6.0 * slope(2 * h, -1.0, 0.0) + slope(4 * h, -1.0, 0.0)) / 3.0
        return M, C, K

    def curvature(self, q: Array, multipliers: Array) -> Array:
        """−∂(J λ)/∂q (n, n) at fixed λ (c,)."""
        out = np.zeros((self.size, self.size))
        for j, e in enumerate(_STEP * np.eye(self.size) if len(multipliers) else ()):
            a, b, c, d = (self.balance(q + k * e)[2] @ multipliers for k in (-2, -1, 1, 2))
            out[:, j] = -(8.0 * (c - b) - (d - a)) / (12.0 * _STEP)
        return out

    def _at(self, q: Array) -> Any:
        """A static solver whose initial values are q."""
        self._mbs.systemData.SetODE2Coordinates(q, configuration=self._exu.ConfigurationType.Initial)
        solver = self._exu.MainSolverStatic()
        solver.InitializeSolver(self._mbs, self._settings)
        return solver


def system(tree: Tree) -> System:
    """Build a mechanism in Exudyn, with its motions at their rates."""
    exu, container, mbs = ex.system()
    item, rotations = _add_tree(exu, mbs, tree, velocity(tree))
    _add_joints_and_springs(exu, mbs, tree, item, rotations)
    mbs.Assemble()
    return System(exu, container, mbs, own_coordinates(tree))


def velocity(tree: Tree) -> Array:
    """(n,) rates of the coordinates of the tree's joints in the steady state."""
    out = np.zeros(own_coordinates(tree))
    for m in tree.mechanism.motions:
        out[tree.coordinate(m.coordinate)] = m.rate
    return out


def own_coordinates(tree: Tree) -> int:
    """Number of coordinates of the tree's joints, which come first."""
    cut = {j.name for j in tree.mechanism.joints if j.name in tree.weld_names}
    return sum(name.rpartition(".")[0] not in cut for name in tree.coordinates)


def _add_tree(exu: Any, mbs: Any, tree: Tree, velocity: Array) -> tuple[Any, list[Array]]:
    """The tree, one link per coordinate with the inertia of the bodies on it, and the rotations of the links.

    Exudyn's joints are along positive axes; the rotation of a link aligns one of them with its screw.
    """
    n = len(velocity)
    kinds, rotations, steps = [], [], []
    for j in range(n):
        axis = int(np.abs(tree.screw[j]).argmax())
        flip = np.eye(4)
        if tree.screw[j, axis] < 0:  # a rotation by π about another axis reverses this one
            flip = sp.pose(sp.rotation((axis + 1) % 3, np.array(np.pi)), np.zeros(3))
        parent = tree.parent[j]
        start = sp.inverse(rotations[parent]) if parent >= 0 else np.eye(4)
        kinds.append(("Prismatic" if axis < 3 else "Revolute") + "XYZ"[axis % 3])
        steps.append(start @ tree.fixed[j] @ flip)
        rotations.append(flip)
    inertia = np.zeros((n, 6, 6))
    for link, pose, mass in zip(tree.link, tree.on_link, tree.inertia, strict=True):
        if 0 <= link < n:
            a = sp.adjoint(sp.inverse(sp.inverse(rotations[link]) @ pose))
            inertia[link] += a.T @ mass @ a
    mass, centre, moments = about_centre(inertia)
    spring, damper, neutral = np.zeros(n), np.zeros(n), np.zeros(n)
    for s in tree.mechanism.coordinate_springs:
        j = tree.coordinate(s.coordinate)
        load = spring[j] * neutral[j] + s.stiffness * s.neutral
        spring[j], damper[j] = spring[j] + s.stiffness, damper[j] + s.damping
        neutral[j] = load / spring[j] if spring[j] else 0.0
    links = ex.Links(
        kinds,
        tree.parent[:n],
        np.array([x[:3, :3] for x in steps]).reshape(n, 3, 3),
        np.array([x[:3, 3] for x in steps]).reshape(n, 3),
        mass,
        centre,
        moments,
        spring,
        damper,
        neutral,
    )
    _, item = ex.add_tree(exu, mbs, links, np.zeros(n), velocity, tree.mechanism.gravity)
    return item, rotations


def _add_joints_and_springs(exu: Any, mbs: Any, tree: Tree, item: Any, rotations: list[Array]) -> None:
    """Add loop joints, and springs between points."""
    items, mechanism = exu.itemInterface, tree.mechanism
    ground = mbs.AddObject(items.ObjectGround())

    def marker(body: str, at: Array) -> Any:
        index = tree.body(body)
        link = int(tree.link[index]) if index >= 0 else -1
        pose = tree.on_link[index] @ at if index >= 0 else at
        if link < 0:
            return mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=ground, localHT=pose))
        pose = sp.inverse(rotations[link]) @ pose
        return mbs.AddMarker(items.MarkerKinematicTreeRigid(objectNumber=item, linkNumber=link, localHT=pose))

    joints = [j for name in tree.weld_names for j in mechanism.joints if j.name == name]
    for joint in joints:
        open_ = {int(np.abs(screw).argmax()) for _, screw in SCREWS[joint.kind]}
        ends = [marker(joint.parent, joint.at_parent), marker(joint.child, joint.at_child)]
        locked = [int(axis not in open_) for axis in range(6)]
        mbs.AddObject(items.GenericJoint(markerNumbers=ends, constrainedAxes=locked))
    for s in mechanism.springs:
        ends = [marker(b, sp.pose(np.eye(3), p)) for b, p in ((s.body_a, s.point_a), (s.body_b, s.point_b))]
        mbs.AddObject(
            items.SpringDamper(
                markerNumbers=ends, referenceLength=s.free_length, stiffness=s.stiffness, damping=s.damping
            )
        )
