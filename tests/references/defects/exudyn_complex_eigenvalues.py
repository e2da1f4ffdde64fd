"""Exudyn: ComputeODE2Eigenvalues with computeComplexEigenvalues raises if constrainedCoordinates are given.

Two damped oscillators side by side. In solver.py the zero blocks have nODE2 rows although constrained rows have been
deleted; it should be len(Kode2), there and where the eigenvectors are allocated. Damping is also left out by default.
Needs: exudyn, numpy.
"""

import exudyn as exu
import numpy as np
from exudyn.itemInterface import NodeGenericODE2, ObjectGenericODE2


def main():
    exu.config.printToConsole = False
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    node = mbs.AddNode(
        NodeGenericODE2(
            numberOfODE2Coordinates=2,
            referenceCoordinates=[0, 0],
            initialCoordinates=[0, 0],
            initialCoordinates_t=[0, 0],
        )
    )
    mbs.AddObject(
        ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=np.eye(2),
            stiffnessMatrix=np.diag([4.0, 9.0]),
            dampingMatrix=np.diag([0.4, 0.6]),
        )
    )
    mbs.Assemble()
    print(f"exudyn {exu.__version__}")
    both = mbs.ComputeODE2Eigenvalues(computeComplexEigenvalues=True, useAbsoluteValues=False)[0]
    print("both free:", np.round(both, 6))
    print("second fixed, expected: [-0.2-1.989975j -0.2+1.989975j]")
    try:
        result = mbs.ComputeODE2Eigenvalues(
            computeComplexEigenvalues=True, useAbsoluteValues=False, constrainedCoordinates=[1]
        )[0]
    except ValueError as error:
        print(f"second fixed: ValueError: {error}")
        print("defect: present")
    else:
        print("second fixed:", np.round(result, 6))
        right = len(result) == 2 and np.allclose(
            np.sort_complex(result), [-0.2 - 1.989975j, -0.2 + 1.989975j], atol=1e-5
        )
        print("defect:", "gone" if right else "present")


if __name__ == "__main__":
    main()
