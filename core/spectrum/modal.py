"""Linearisation of a mechanism about its steady state, and its modes."""

from collections.abc import Mapping

import numpy as np

from ..mechanism.description import Mechanism, MechanismError, at_time
from ..rank import NotFiniteError
from ..steady import periodic
from ..steady.equilibrium import null_motions, steady_state
from ..tree.closure import assemble
from ..tree.kinematics import kinematics
from ..tree.linearization import Linearization, about
from ..tree.partition import freedom
from ..tree.scales import coordinate_units, length_at
from ..tree.spanning import compile_tree
from ..tree.state import driven_by_loops
from . import eigen

_NUDGE = 1e-3  # distance of the nearby configuration, rad or fraction of the mechanism's length


def linearize(
    mechanism: Mechanism,
    guess: Mapping[str, float] | None = None,
    independent: tuple[str, ...] | None = None,
    time: float = 0.0,
) -> Linearization:
    """Find the steady state and linearise about it.

    If a motion follows a law of time, this is a frozen-time linearisation: the free coordinates are in equilibrium, and
    vibrate, as if positions, rates and accelerations were constant at their values at ``time``. Its modes are meaningful if
    the motion changes little within their periods; stability of a periodic motion requires Floquet theory. Motions given by
    numbers must give a steady state: the mechanism is refused if M̂, Ĉ, K̂ or the balance change along them (``periodic``).

    Args:
        mechanism: the mechanism.
        guess: coordinates to start from, by name.
        independent: coordinates to use as q_I; chosen numerically if not given.
        time: instant of the linearisation, s; used if motions follow laws.

    Raises:
        MechanismError: the mechanism cannot be assembled, balanced or partitioned, or is not steady.
    """
    tree = compile_tree(at_time(mechanism, time))
    try:
        state = steady_state(tree, guess)
        linear = about(tree, state, independent)
        _check_regular(linear)
        if all(m.law is None for m in mechanism.motions):
            periodic.check_constant(linear)
    except NotFiniteError as error:
        raise MechanismError(str(error)) from error
    return linear


def _check_regular(linear: Linearization) -> None:
    """Check that the number of degrees of freedom is the same in a nearby assembled configuration."""
    tree, state, part = linear.tree, linear.state, linear.partition
    if not tree.welds:
        return
    units = coordinate_units(tree, length_at(tree, state.kinematics.poses))
    count = len(part.independent)
    nudge = part.R @ (units[part.independent] * np.random.default_rng(1921).normal(size=count))
    q = state.q.copy()
    q[part.free] += _NUDGE * nudge / max(float(np.abs(nudge / units[part.free]).max(initial=0.0)), _NUDGE)
    q_nearby = assemble(tree, dict(zip(tree.coordinates, q.tolist(), strict=True)))
    freedom_nearby = freedom(tree, kinematics(tree, q_nearby, state.v, state.a))
    if freedom_nearby < count:
        raise MechanismError(
            f"joints {', '.join(tree.weld_names)}: singular configuration: {count} degrees of freedom here but "
            f"{freedom_nearby} nearby, so no linear model is valid; start the assembly from another guess"
        )


def modes(linear: Linearization, count: int | None = None) -> eigen.Eigen | eigen.Damped:
    """Modes over the independent coordinates: gyroscopic where nothing damps and K̂ is positive definite, else damped.

    Raises:
        MechanismError: a coordinate without mass, damping and stiffness.
        EigenError: if the eigenvalue solver fails.
    """
    M, C, K = 0.5 * (linear.M + linear.M.T), linear.C, linear.K
    if not len(M):  # everything is prescribed
        return eigen.Eigen(np.zeros(0), np.zeros((0, 0), np.complex128))
    idle = ~(M.any(axis=1) | C.any(axis=1) | linear.K.any(axis=1))
    if idle.any():
        raise MechanismError(
            f"coordinate {linear.names[int(idle.argmax())]!r}: it has no mass, stiffness or damping: give its body mass, or "
            "prescribe its motion"
        )
    rigid = null_motions(linear)
    if not _conservative(linear):
        return eigen.damped(M, C, K, count, rigid)
    C, K = 0.5 * (C - C.T), 0.5 * (K + K.T)
    if not rigid[0].shape[1]:
        try:
            return eigen.gyroscopic(M, C, K, count)
        except eigen.UnstableError:
            pass  # stable by gyroscopic forces alone, or unstable: the general solver decides
    return eigen.damped(M, C, K, count, rigid)


def _conservative(linear: Linearization) -> bool:
    """Whether C is skew and K symmetric by nature: no dampers, and a motion that is steady."""
    mechanism = linear.tree.mechanism
    dampers = [*mechanism.coordinate_springs, *mechanism.springs, *mechanism.beams]
    at_rest = not linear.state.a.any() and not driven_by_loops(linear.tree, linear.state).any()
    return at_rest and not any(np.any(d.damping) for d in dampers)
