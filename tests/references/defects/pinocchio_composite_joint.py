"""Pinocchio: computeRNEADerivatives is wrong for a JointModelComposite that translates and rotates.

Two bodies, each on a translation followed by rotations about x, y, z: once as one composite joint, once as four joints.
The inverse dynamics agree; the derivative by q of the composite joint does not agree with its central difference.
Needs: pin, numpy.
"""

# pyright: reportAttributeAccessIssue=false
from importlib.metadata import version

import numpy as np
import pinocchio as pin


def chain(composite):
    model, link = pin.Model(), 0
    model.gravity.setZero()
    place = pin.SE3(np.eye(3), np.array([1.0, 0.0, 0.0]))
    joints = [pin.JointModelTranslation(), pin.JointModelRX(), pin.JointModelRY(), pin.JointModelRZ()]
    for body in range(2):
        if composite:
            whole = pin.JointModelComposite()
            for joint in joints:
                whole.addJoint(joint)
            link = model.addJoint(link, whole, place, f"{body}")
        else:
            for k, joint in enumerate(joints):
                link = model.addJoint(link, joint, pin.SE3.Identity() if k else place, f"{body} {k}")
        model.appendBodyToJoint(link, pin.Inertia(2.0, np.zeros(3), np.diag([0.1, 0.2, 0.3])), pin.SE3.Identity())
    return model


def main():
    print(f"pin {version('pin')}")
    n = 12
    q, v, a = 0.1 * np.sin(np.arange(1.0, n + 1)), np.cos(np.arange(1.0, n + 1)), np.zeros(n)
    altered, force = {}, {}
    for composite in (False, True):
        model = chain(composite)
        data = model.createData()
        force[composite] = pin.rnea(model, data, q, v, a).copy()
        pin.computeRNEADerivatives(model, data, q, v, a)
        analytic, h = data.dtau_dq.copy(), 1e-6
        pairs = (
            (pin.rnea(model, data, q + h * e, v, a).copy(), pin.rnea(model, data, q - h * e, v, a)) for e in np.eye(n)
        )
        difference = np.array([(up - down) / (2 * h) for up, down in pairs]).T
        altered[composite] = np.abs(analytic - difference).max() / np.abs(difference).max()
    print(f"torques, composite against four joints: {np.abs(force[True] - force[False]).max():.1e} apart")
    print(f"dtau_dq against central differences, four joints:   {altered[False]:.1e} (expected: rounding)")
    print(f"dtau_dq against central differences, one composite: {altered[True]:.1e} (expected: rounding)")
    print("defect:", "present" if altered[True] > 1e-6 else "gone")


if __name__ == "__main__":
    main()
