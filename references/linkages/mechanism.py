"""Mechanisms with closed loops in Pinocchio, reduced to the null space of the loops' equations.

Shared with core is only the description: bodies, joints with their coordinates, springs, loads. The spanning tree is
built here (``spanning``) and may cut other joints. Pinocchio computes inertia forces and their derivatives; the steady
state is found here. Loops are
closed by Haug's products of directions (``closure``), not by core's weld beyond a copy of the body. The equations of
motion are reduced by an orthonormal basis of the null space of the constraint Jacobian (E. J. Haug 1989, ch. 11), not
by core's partition into independent and dependent coordinates. The curvature of the constraints under their reactions
is analytical. The eigensolver is ``matrices.quadratic``, as for ``exudyn-loops``.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ...core.effects import ALL_EFFECTS
from ...core.mechanism.description import Mechanism
from ..matrices import rotating
from ..matrices.quadratic import damped_modes
from ..matrices.rescaling import in_own_length
from ..protocol.interface import CodeError, Independence, MechanismAdapter, MechanismModes, extra
from .pinocchio_tree import PinocchioTree, Tangent
from .spanning import spanning

Array = NDArray[np.float64]
Index = NDArray[np.intp]

RANK = 1e-9
"""Singular values of the constraint Jacobian below this fraction of the largest belong to redundant equations."""

PERIODIC = 1e-8
"""Largest relative change of the reduced matrices with the azimuth attributed to rounding."""

AZIMUTH = 1.9
"""Displacement of the fastest motion, rad or m, after which the matrices are compared."""


@dataclass(frozen=True)
class Reduced:
    """The equations of motion about the steady state.

    Attributes:
        names: (n) of the coordinates.
        q: (n,) their values.
        free: (f,) indices of those that are not prescribed.
        null: (f, i) orthonormal directions in which these can move.
        M, C, K: (i, i) in these directions.
    """

    names: tuple[str, ...]
    q: Array
    free: Index
    null: Array
    M: Array
    C: Array
    K: Array


class PinocchioMechanism(MechanismAdapter):
    """See the module: rigid bodies, any joints, springs, dampers, loads and gravity, in steady rotation."""

    name = "pinocchio-loops"
    title = "Pinocchio, loops by null space"
    effects = ALL_EFFECTS
    hint = extra("codes")
    distribution = "pin"
    independence = Independence(
        engine="Pinocchio",
        theory="tree of rigid bodies, loops by products of directions",
        rotation="Pinocchio, derivatives of recursive Newton-Euler",
        sections="the adapter's spanning tree",
        eigensolver="the adapters' own, with damping",
    )

    def unsupported_mechanism(self, mechanism: Mechanism) -> str | None:
        """A reason if there are beams, accelerations, or springs or motions on a joint that must close a loop."""
        if mechanism.beams:
            return "beams or bushings: this adapter supports rigid bodies only"
        if any(m.law or m.acceleration for m in mechanism.motions):
            return "an accelerating motion: no steady state"
        if odd := next((j for j in mechanism.joints if j.kind == "elastic"), None):
            return f"joint {odd.name!r}: elastic: this adapter supports rigid bodies only"
        try:
            names = spanning(mechanism).names
        except ValueError as error:
            return str(error)
        for what in (*mechanism.motions, *mechanism.coordinate_springs):
            if what.coordinate not in names:
                return f"{what.coordinate}: every joint of its loop has a spring or a motion: leave one without"
        return None

    def mechanism_modes(self, mechanism: Mechanism, guess: Mapping[str, float]) -> MechanismModes:
        """All modes; see ``interface.MechanismAdapter``.

        Raises:
            CodeError: a periodic mechanism, no steady state near the guess, or loops that move in it.
        """
        return in_own_length(mechanism, guess, _modes)


def _modes(mechanism: Mechanism, guess: Mapping[str, float]) -> MechanismModes:
    if mechanism.equal_blades and any(m.rate for m in mechanism.motions):
        return _whirling(mechanism, guess)
    linear = linearize(mechanism, guess)
    values, x = damped_modes(linear.M, linear.C, linear.K)
    shapes = np.zeros((len(values), len(linear.q)), np.complex128)
    shapes[:, linear.free] = (linear.null @ x).T
    return MechanismModes(linear.names, linear.q, values, shapes)


def _whirling(mechanism: Mechanism, guess: Mapping[str, float]) -> MechanismModes:
    """The modes of a rotor with equal blades on a support, in Fourier coordinates of the blades.

    Raises:
        CodeError: loops, or matrices that change with the azimuth.
    """
    model = PinocchioTree(mechanism)
    names = model.tree.names
    spin = int(np.abs(model.v).argmax())
    prescribed = [names.index(m.coordinate) for m in mechanism.motions if m.prescribed]
    free = np.setdiff1d(np.arange(len(names)), prescribed)
    q = np.array([guess.get(name, 0.0) for name in names])
    q[spin] = 0.0
    q = _steady_state(model, q, free)
    if len(model.at(q).J):
        raise CodeError("loops in a rotor with equal blades: not supported")

    def at(psi: float) -> tuple[Array, Array, Array]:
        turned = q.copy()
        turned[spin] = psi
        here = model.at(turned)
        pick = np.ix_(free, free)
        return here.M[pick], here.C[pick], here.K[pick]

    place = {names[j]: k for k, j in enumerate(free)}
    groups = [[place[name] for name in group] for group in mechanism.equal_blades]
    values, x = rotating.modes(at, float(model.v[spin]), groups)
    shapes = np.zeros((len(values), len(names)), np.complex128)
    shapes[:, free] = x.T
    return MechanismModes(names, q, values, shapes)


def linearize(mechanism: Mechanism, guess: Mapping[str, float]) -> Reduced:
    """The steady state near a guess, and the equations of motion about it.

    Raises:
        CodeError: no steady state near the guess, loops that move in it, or matrices that change with the azimuth.
    """
    model = PinocchioTree(mechanism)
    names = model.tree.names
    q = np.array([guess.get(name, 0.0) for name in names])
    for m in mechanism.motions:
        if m.position is not None:
            q[names.index(m.coordinate)] = m.position
    moved = [names.index(m.coordinate) for m in mechanism.motions]
    q = _steady_state(model, q, np.setdiff1d(np.arange(len(q)), moved))
    prescribed = [names.index(m.coordinate) for m in mechanism.motions if m.prescribed]
    free = np.setdiff1d(np.arange(len(q)), prescribed)
    here = model.at(q)
    if here.reversed:
        raise CodeError(f"joint {here.reversed!r} closes with opposed axes: give a better guess")
    if np.abs(here.J @ model.v).max(initial=0.0) > RANK * np.abs(model.v).max(initial=0.0):
        raise CodeError("the loops move in the steady state: only mechanisms that rotate as a whole are supported")
    null = null_space(here.J[:, free])
    out = Reduced(names, q, free, null, *reduced(here, free, null))
    _check_constant(model, out)
    return out


def reduced(here: Tangent, free: Index, null: Array) -> tuple[Array, Array, Array]:
    """M, C, K (i, i) along directions (f, i) of the free coordinates; K includes the stiffness of the reactions."""
    multipliers = _least_squares(here.J[:, free].T, here.force[free])
    pick = np.ix_(free, free)
    M, C, K = (null.T @ a[pick] @ null for a in (here.M, here.C, here.K + here.curvature(multipliers)))
    return M, C, K


def _least_squares(A: Array, b: Array) -> Array:
    """The x (n,) of least norm that minimises |A x − b|; either size may be 0."""
    return np.asarray(np.linalg.lstsq(A, b, rcond=RANK)[0], np.float64) if A.size else np.zeros(A.shape[1])


def null_space(J: Array) -> Array:
    """(f, i) orthonormal basis of the null space of the equations J (c, f)."""
    return scipy.linalg.null_space(J, rcond=RANK) if len(J) else np.eye(J.shape[1])


def _steady_state(model: PinocchioTree, q: Array, free: Index) -> Array:
    """Newton's method: close the loops and balance the forces in their null space.

    Raises:
        CodeError: it does not converge.
    """
    q, last_change = q.copy(), np.inf
    for _ in range(100):
        here = model.at(q)
        J, force = here.J[:, free], here.force[free]
        gap = np.array([f.value for f in here.loops])
        close = _least_squares(J, -gap)
        step, null = close, null_space(J)
        if np.abs(gap).max(initial=0.0) < 1e-2:
            multipliers = _least_squares(J.T, force)
            K = (here.K + here.curvature(multipliers))[np.ix_(free, free)]
            step = close - null @ _least(null.T @ K @ null, null.T @ (force + K @ close))
        change = float(np.abs(step).max(initial=0.0))
        q[free] += step * min(1.0, 0.3 / max(change, 0.3))
        if change < 1e-13 or (change < 1e-9 and change > 0.3 * last_change):
            _check_balance(model, q, free)
            return q
        last_change = change
    raise CodeError("no steady state near the guess: give a better guess")


def _least(K: Array, force: Array) -> Array:
    """The step of least norm that balances the forces, each direction scaled by its stiffness."""
    size = np.sqrt(np.maximum(np.abs(K).max(axis=1, initial=0.0), np.finfo(float).tiny))
    return np.linalg.lstsq(K / size / size[:, None], force / size, rcond=1e-12)[0] / size


def _check_balance(model: PinocchioTree, q: Array, free: Index) -> None:
    """Check that the unbalanced forces are small compared with the stiffness.

    Raises:
        CodeError: they are not, as for a mass in free fall.
    """
    here = model.at(q)
    unbalanced = np.abs(null_space(here.J[:, free]).T @ here.force[free]).max(initial=0.0)
    if unbalanced > 1e-8 * np.abs(here.force[free]).max(initial=0.0) + 1e-12 * np.abs(here.K).max(initial=0.0):
        raise CodeError("no steady state near the guess: unbalanced forces remain")


def _check_constant(model: PinocchioTree, linear: Reduced) -> None:
    """Compare the reduced matrices with those at another azimuth.

    Raises:
        CodeError: they differ: the equations are periodic.
    """
    fastest = float(np.abs(model.v).max(initial=0.0))
    if not fastest or not linear.null.shape[1]:
        return
    later = model.at(linear.q + model.v * (AZIMUTH / fastest))
    open_ = max((abs(f.value) for f in later.loops), default=0.0)
    moved = np.abs(later.J[:, linear.free] @ linear.null).max(initial=0.0)
    first, second = (linear.M, linear.C, linear.K), reduced(later, linear.free, linear.null)
    scale = (fastest**2, fastest, 1.0)
    size = max(float(np.abs(s * a).max()) for s, a in zip(scale, first, strict=True))
    change = max(float(np.abs(s * (a - b)).max()) for s, a, b in zip(scale, first, second, strict=True))
    if change > PERIODIC * size or max(open_, moved) > PERIODIC:
        raise CodeError("periodic: the matrices change with the azimuth; this adapter needs constant ones")


CODE = PinocchioMechanism()
