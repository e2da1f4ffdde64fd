"""Common to the Exudyn codes: a silent system, its steady state, and its linearisation about it.

Exudyn: J. Gerstmayr, "Exudyn – a C++-based Python package for flexible multibody systems", Multibody System Dynamics
60 (2024) 533–561.
"""

import io
import sys
from collections.abc import Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ..protocol.interface import CodeError, extra

Array = NDArray[np.float64]

HINT = extra("codes")

DISTRIBUTION = "exudyn"


def system() -> tuple[Any, Any, Any]:
    """The Exudyn module without printing, a container, and an empty system in it (keep the container alive).

    Of its two compiled modules, the one without range checks is used if the processor supports it: it is a quarter faster.
    """
    if not hasattr(sys, "exudynFast"):  # read at its first import, which prints
        setattr(sys, "exudynFast", True)  # noqa: B010 - a type checker does not know it
    with redirect_stdout(io.StringIO()):
        import exudyn

    exudyn.config.printToConsole = False
    container = exudyn.SystemContainer()
    return exudyn, container, container.AddSystem()


@dataclass(frozen=True)
class Links:
    """Links of a kinematic tree, one joint each.

    Attributes:
        joints: (n) names of Exudyn's kinds of joint.
        parents: (n,) indices; −1 is the ground.
        axes, offset: (n, 3, 3), (n, 3) m, of each joint in its parent.
        mass, centre, moments: (n,) kg, (n, 3) m, (n, 3, 3) kg m² about the centre.
        springs, dampers, neutral: (n,) of the joints; none where they are None.
    """

    joints: Sequence[str]
    parents: NDArray[np.intp]
    axes: Array
    offset: Array
    mass: Array
    centre: Array
    moments: Array
    springs: Array | None = None
    dampers: Array | None = None
    neutral: Array | None = None


def add_tree(
    exu: Any, mbs: Any, links: Links, q: Array, rates: Array, gravity: Sequence[float] = (0.0, 0.0, 0.0)
) -> tuple[Any, Any]:
    """Add a kinematic tree with initial coordinates and rates (n,); return its node and its object."""
    items, zero = exu.itemInterface, np.zeros(len(q))
    node = mbs.AddNode(
        items.NodeGenericODE2(
            numberOfODE2Coordinates=len(q),
            referenceCoordinates=zero,
            initialCoordinates=q,
            initialCoordinates_t=rates,
        )
    )
    item = mbs.AddObject(
        items.ObjectKinematicTree(
            nodeNumber=node,
            gravity=list(gravity),
            jointTypes=[getattr(exu.JointType, joint) for joint in links.joints],
            linkParents=links.parents,
            jointTransformations=exu.Matrix3DList(list(links.axes)),
            jointOffsets=exu.Vector3DList(list(links.offset)),
            linkMasses=links.mass,
            linkCOMs=exu.Vector3DList(list(links.centre)),
            linkInertiasCOM=exu.Matrix3DList(list(links.moments)),
            jointPControlVector=zero if links.springs is None else links.springs,
            jointDControlVector=zero if links.dampers is None else links.dampers,
            jointPositionOffsetVector=zero if links.neutral is None else links.neutral,
            jointVelocityOffsetVector=zero,
        )
    )
    return node, item


def hold(exu: Any, mbs: Any, node: int, coordinates: list[int]) -> None:
    """Fix coordinates of a node to their reference values."""
    items = exu.itemInterface
    ground = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(items.NodePointGround()), coordinate=0))
    for coordinate in coordinates:
        marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
        mbs.AddObject(items.CoordinateConstraint(markerNumbers=[ground, marker]))


def settle(exu: Any, mbs: Any, omega: float, rounding: float = 0.0, full: bool = False) -> None:
    """Move an assembled system and its initial values to its static equilibrium.

    Exudyn linearises about the initial values. ``rounding`` (N or N m) is the rounding error of the stiffest forces:
    Newton's method cannot reduce the residual below it and would not end. ``full``: the Jacobian is a full matrix.

    Raises:
        CodeError: Newton's method did not converge.
    """
    try:
        settings = _settings(exu, full)
        settings.staticSolver.newton.absoluteTolerance = max(settings.staticSolver.newton.absoluteTolerance, rounding)
        mbs.SolveStatic(settings, updateInitialValues=True, showCausingItems=False)
    except exu.ExudynError as error:
        raise CodeError(f"omega: {omega:g} rad/s: Exudyn finds no steady state ({error}); lower the speed") from error


def sparse_matrix(exu: Any, matrix: Any) -> Any:
    """A matrix for Exudyn's objects; with a full one every column of a numerical derivative would cost n²."""
    container = exu.MatrixContainer()
    container.SetWithSparseMatrix(sparse.csr_matrix(matrix))
    return container


def linearized(exu: Any, mbs: Any, at_rest: bool = False, full: bool = False) -> tuple[Array, Array, Array]:
    """Mass, damping and gyroscopic, and stiffness matrix (n, n) about the initial values; constraints are not applied.

    ``at_rest``: nothing moves or damps, and the second matrix, which takes half of the time, is zero. ``full``: they are full.
    """
    settings = _settings(exu, full)
    if not at_rest:
        mass, stiffness, damping = mbs.ComputeLinearizedSystem(settings)[:3]
        return np.array(mass), np.array(damping), np.array(stiffness)
    solver = exu.MainSolverStatic()  # the same steps without the derivative by velocities
    solver.InitializeSolver(mbs, settings)
    solver.ComputeMassMatrix(mbs)
    solver.ComputeJacobianODE2RHS(mbs, scalarFactor_ODE2=-1.0, scalarFactor_ODE2_t=0.0, scalarFactor_ODE1=0.0)
    own = slice(solver.GetODE2size())
    mass, stiffness = (np.array(of())[own, own] for of in (solver.GetSystemMassMatrix, solver.GetSystemJacobian))
    solver.FinalizeSolver(mbs, settings)
    return mass, np.zeros_like(mass), stiffness


def forces(exu: Any, mbs: Any) -> tuple[Array, Array]:
    """Internal forces (n,) and their derivative (n, n) at the initial values, without inertia and constraints."""
    settings, solver = _settings(exu, False), exu.MainSolverStatic()
    solver.InitializeSolver(mbs, settings)
    own = slice(solver.GetODE2size())
    solver.ComputeODE2RHS(mbs)
    force = -np.array(solver.GetSystemResidual())[own]
    solver.ComputeJacobianODE2RHS(mbs, scalarFactor_ODE2=-1.0, scalarFactor_ODE2_t=0.0, scalarFactor_ODE1=0.0)
    stiffness = np.array(solver.GetSystemJacobian())[own, own]
    solver.FinalizeSolver(mbs, settings)
    return force, stiffness


def _settings(exu: Any, full: bool) -> Any:
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.staticSolver.verboseMode = 0
    settings.staticSolver.adaptiveStep = False  # it scales loads; here all forces are elastic or of inertia
    solvers = exu.LinearSolverType
    settings.linearSolver.solverType = solvers.EigenDense if full else solvers.EigenSparse
    settings.staticSolver.newton.useModifiedNewton = True  # a Jacobian takes far longer than an iteration
    # step of Exudyn's numerical differentiation: relativeEpsilon × max(|q|, this); 1e-7 rad or m instead of 1e-9
    # leaves a rounding error of 1e-10 in the matrices
    settings.staticSolver.newton.numericalDifferentiation.minimumCoordinateSize = 1.0
    return settings
