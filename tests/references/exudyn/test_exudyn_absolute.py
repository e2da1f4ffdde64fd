"""Loops at zero speed against Exudyn's rigid bodies in absolute coordinates, with every joint a generic joint: no tree.

Nothing of core's compiled tree is used: six coordinates per body, all joints as constraints, and all stiffness of
gravity from the curvature of the constraints.
"""

import numpy as np
import pytest
import scipy.linalg

from southwell import multibody as mb
from southwell.core.mechanism.joints import SCREWS
from southwell.core.space import spatial as sp
from southwell.core.spectrum import modal
from southwell.references.exudyn import system as ex
from southwell.references.exudyn.closure import System
from southwell.references.exudyn.mechanism import CODE
from southwell.references.matrices.quadratic import damped_modes

pytestmark = pytest.mark.skipif(CODE.version() is None, reason=f"not installed: {CODE.hint}")

G = 9.81


def cardan(r: np.ndarray) -> list[float]:
    """Angles of R = R_x R_y R_z."""
    return [float(np.arctan2(-r[1, 2], r[2, 2])), float(np.arcsin(r[0, 2])), float(np.arctan2(-r[0, 1], r[0, 0]))]


def absolute(mechanism: mb.Mechanism, placed: dict[str, np.ndarray]) -> System:
    """The mechanism with its bodies at poses ``placed``."""
    exu, container, mbs = ex.system()
    items = exu.itemInterface
    bodies = {"ground": mbs.AddObject(items.ObjectGround())}
    for body in mechanism.bodies:
        x, m = placed[body.name], body.inertia
        node = mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=[*x[:3, 3], *cardan(x[:3, :3])]))
        turning = [m[3, 3], m[4, 4], m[5, 5], m[4, 5], m[3, 5], m[3, 4]]
        centre = np.array([m[5, 1], m[3, 2], m[4, 0]]) / m[0, 0]
        item = items.ObjectRigidBody(mass=m[0, 0], inertia=turning, centerOfMass=centre, nodeNumber=node)
        bodies[body.name] = mbs.AddObject(item)
        at = mbs.AddMarker(items.MarkerBodyMass(bodyNumber=bodies[body.name]))
        mbs.AddLoad(items.LoadMassProportional(markerNumber=at, loadVector=list(mechanism.gravity)))

    def marker(body: str, at: np.ndarray):
        return mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=bodies[body], localHT=at))

    for j in mechanism.joints:
        open_ = {int(np.abs(screw).argmax()) for _, screw in SCREWS[j.kind]}
        ends = [marker(j.parent, j.at_parent), marker(j.child, j.at_child)]
        mbs.AddObject(items.GenericJoint(markerNumbers=ends, constrainedAxes=[int(a not in open_) for a in range(6)]))
    for s in mechanism.springs:
        ends = [marker(b, sp.pose(np.eye(3), p)) for b, p in ((s.body_a, s.point_a), (s.body_b, s.point_b))]
        mbs.AddObject(
            items.SpringDamper(
                markerNumbers=ends, referenceLength=s.free_length, stiffness=s.stiffness, damping=s.damping
            )
        )
    mbs.Assemble()
    return System(exu, container, mbs, 6 * len(mechanism.bodies))


def box(name: str, mass: float, centre: tuple[float, float, float]) -> mb.Body:
    return mb.Body(
        name, mb.inertia(mass, np.array([[0.2, 0.01, 0], [0.01, 0.3, 0.02], [0, 0.02, 0.25]]) * mass, centre)
    )


def linkage(slant: float) -> tuple[mb.Mechanism, dict[str, float]]:
    """Crank, rod and rocker between non-parallel revolutes, a ball and a universal joint; two damped springs to the ground."""
    swept = mb.at(1.5, 0.2, 0.1, axis=np.array([slant, 0.2 * slant, 1.0]))
    m = mb.Mechanism(
        (box("crank", 1.5, (0.3, 0.1, 0)), box("rod", 0.8, (0.6, 0, 0.1)), box("rocker", 1.1, (0.4, 0, -0.1))),
        (
            mb.Joint("A", "revolute", "ground", "crank"),
            mb.Joint("B", "spherical", "crank", "rod", mb.at(0.6)),
            mb.Joint("D", "revolute", "ground", "rocker", swept),
            mb.Joint("C", "universal", "rod", "rocker", mb.at(1.3, axis="x"), mb.at(0.9, axis="y"), cut=True),
        ),
        springs=(
            mb.Spring("ground", "crank", np.array([0.2, 2.0, 0.3]), np.array([0.5, 0, 0]), 150.0, 3.0, 0.5),
            mb.Spring("ground", "rod", np.array([1.0, 2.0, -0.5]), np.array([0.6, 0.1, 0]), 80.0, 1.0, 0.4),
        ),
        gravity=(0.5, -G, 1.0),
    )
    return m, {"A.rz": 1.2, "B.rz": -0.8, "D.rz": 1.4, "B.ry": -1.4}


@pytest.mark.parametrize("slant", [0.0, 0.3, 0.6])
def test_a_spatial_linkage_at_zero_speed(slant: float) -> None:
    mechanism, guess = linkage(slant)
    linear = modal.linearize(mechanism, guess)
    tree, state = linear.tree, linear.state
    placed = {b.name: state.kinematics.poses[tree.body(b.name)] for b in mechanism.bodies}
    system = absolute(mechanism, placed)
    q = np.zeros(system.size)
    force, gap, J = system.balance(q)
    assert np.abs(gap).max() < 1e-11  # core's poses close every joint
    multipliers = np.asarray(np.linalg.lstsq(J, -force, rcond=1e-9)[0], np.float64)
    assert np.abs(force + J @ multipliers).max() < 1e-9 * np.abs(force).max()  # and balance all forces
    M, C, K = system.matrices(q)
    null = scipy.linalg.null_space(J.T, rcond=1e-9)
    assert null.shape[1] == len(linear.M)
    K = K + system.curvature(q, multipliers)
    values, _ = damped_modes(null.T @ M @ null, null.T @ C @ null, null.T @ K @ null)
    np.testing.assert_allclose(values, mb.solve(mechanism, guess).values, rtol=1e-9)
