"""Mechanisms with closed loops, for codes that return forces and derivatives: steady state, matrices, modes.

A code gives the forces of a tree in its n coordinates, their derivatives, and the c equations of its loops (``Model``).
The equations of motion are reduced by an orthonormal basis of the null space of the constraint Jacobian (J. García de Jalón
and E. Bayo 1994, ch. 5; E. J. Haug 1989, ch. 11), not by core's partition into independent and dependent coordinates.
The stiffness includes the curvature of the constraints under their reactions, without which a pendulum that hangs on a
loop's joint has none.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ...core.mechanism.description import Mechanism
from ..protocol.interface import CodeError, MechanismModes
from . import rotating
from .quadratic import damped_modes

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Matrices = tuple[Array, Array, Array]

RANK = 1e-9
"""Singular values of the constraint Jacobian below this fraction of the largest belong to redundant equations."""

STEPS = 100
"""Largest number of Newton steps."""

OPEN = 1e-2
"""Gap of a loop, in units of the mechanism's length or rad, above which the loops are closed before forces are balanced."""

AZIMUTH = 1.9
"""Displacement of the fastest motion, rad or m, after which the matrices are compared."""


class Tangent(Protocol):
    """A tree at one configuration, its motions at their rates.

    Attributes:
        force: (n,) to be balanced by the reactions of the loops, ``J.T @ multipliers``.
        M, C, K: (n, n) mass matrix, and the derivatives of ``force`` by velocity and coordinate.
        gap: (c,) values of the loops' equations; ``J`` (c, n): their gradients.
    """

    @property
    def force(self) -> Array: ...  # noqa: D102 - see the class
    @property
    def M(self) -> Array: ...  # noqa: D102
    @property
    def C(self) -> Array: ...  # noqa: D102
    @property
    def K(self) -> Array: ...  # noqa: D102
    @property
    def gap(self) -> Array: ...  # noqa: D102
    @property
    def J(self) -> Array: ...  # noqa: D102

    def curvature(self, multipliers: Array) -> Array:
        """(n, n) stiffness of the loops' reactions: −Σ λ ∂²φ/∂q²."""
        ...

    def misclosed(self) -> str:
        """Name of a loop joint whose axes are opposed; empty if there is none."""
        ...


class Model(Protocol):
    """A mechanism in a code.

    Attributes:
        mechanism: as described.
        names: (n) of the coordinates.
        rates: (n,) of its motions, in the order of the coordinates.
        rounding: relative error of its matrices.
    """

    mechanism: Mechanism
    names: tuple[str, ...]
    rates: Array
    rounding: float

    def at(self, q: Array) -> Tangent:
        """The tree at coordinates ``q`` (n,)."""
        ...


@dataclass(frozen=True)
class Linearized:
    """The equations of motion about the steady state.

    Attributes:
        q: (n,) coordinates.
        free: (f,) indices of those that are not prescribed.
        null: (f, i) orthonormal directions in which these can move.
        M, C, K: (i, i) in these directions.
    """

    q: Array
    free: Index
    null: Array
    M: Array
    C: Array
    K: Array


def modes(model: Model, guess: Mapping[str, float]) -> MechanismModes:
    """The modes of a mechanism about the steady state near a guess.

    Raises:
        CodeError: no steady state near the guess, loops that move in it, or matrices that change with the azimuth.
    """
    if model.mechanism.equal_blades and any(m.rate for m in model.mechanism.motions):
        return _whirling(model, guess)
    linear = linearize(model, guess)
    _check_constant(model, linear)
    values, x = damped_modes(linear.M, linear.C, linear.K)
    return _answer(model, linear.q, linear.free, values, linear.null @ x)


def linearize(model: Model, guess: Mapping[str, float]) -> Linearized:
    """The steady state near a guess, and the equations of motion about it.

    Raises:
        CodeError: no steady state near the guess, or loops that move in it.
    """
    q, free = steady_coordinates(model, guess), _free(model)
    tangent = model.at(q)
    if joint := tangent.misclosed():
        raise CodeError(f"joint {joint!r} closes with opposed axes: give a better guess")
    if np.abs(tangent.J @ model.rates).max(initial=0.0) > RANK * np.abs(model.rates).max(initial=0.0):
        raise CodeError("the loops move in the steady state: only mechanisms that rotate as a whole are supported")
    null = null_space(tangent.J[:, free])
    return Linearized(q, free, null, *along(tangent, free, null))


def along(tangent: Tangent, free: Index, directions: Array) -> Matrices:
    """M, C, K (i, i) along directions (f, i) of the free coordinates; K includes the stiffness of the reactions."""
    multipliers = _least_squares(tangent.J[:, free].T, tangent.force[free])
    pick = np.ix_(free, free)
    matrices = (tangent.M, tangent.C, tangent.K + tangent.curvature(multipliers))
    M, C, K = (directions.T @ a[pick] @ directions for a in matrices)
    return M, C, K


def null_space(J: Array) -> Array:
    """(f, i) orthonormal basis of the null space of the equations J (c, f)."""
    return scipy.linalg.null_space(J, rcond=RANK) if len(J) else np.eye(J.shape[1])


def steady_coordinates(model: Model, guess: Mapping[str, float]) -> Array:
    """Coordinates (n,) near a guess: Newton's method closes the loops and balances the forces in their null space.

    Raises:
        CodeError: it does not converge.
    """
    q = np.array([guess.get(name, 0.0) for name in model.names])
    for m in model.mechanism.motions:
        if m.position is not None:
            q[model.names.index(m.coordinate)] = m.position
    prescribed = [model.names.index(m.coordinate) for m in model.mechanism.motions]
    free, last_change = np.setdiff1d(np.arange(len(q)), prescribed), np.inf
    for _ in range(STEPS):
        tangent = model.at(q)
        J, force, gap = tangent.J[:, free], tangent.force[free], tangent.gap
        close = _least_squares(J, -gap)
        step, null = close, null_space(J)
        if np.abs(gap).max(initial=0.0) < OPEN:
            multipliers = _least_squares(J.T, force)
            K = (tangent.K + tangent.curvature(multipliers))[np.ix_(free, free)]
            step = close - null @ _least(null.T @ K @ null, null.T @ (force + K @ close))
        change = float(np.abs(step).max(initial=0.0))
        q = q.copy()
        q[free] += step * min(1.0, 0.3 / max(change, 0.3))
        if change < 1e-13 or (change < 1e-9 and change > 0.3 * last_change):
            _check_balance(model.at(q), free)
            return q
        last_change = change
    raise CodeError("no steady state near the guess: give a better guess")


def _free(model: Model) -> Index:
    prescribed = [model.names.index(m.coordinate) for m in model.mechanism.motions if m.prescribed]
    return np.setdiff1d(np.arange(len(model.names)), prescribed)


def _answer(model: Model, q: Array, free: Index, values: rotating.Complex, x: rotating.Complex) -> MechanismModes:
    """Modes from shapes (f, m) of the free coordinates."""
    shapes = np.zeros((len(values), len(q)), np.complex128)
    shapes[:, free] = x.T
    return MechanismModes(model.names, q, values, shapes)


def _whirling(model: Model, guess: Mapping[str, float]) -> MechanismModes:
    """The modes of a rotor with equal blades on a support, in Fourier coordinates of the blades.

    Raises:
        CodeError: loops, no steady state near the guess, or matrices that change with the azimuth.
    """
    spin, free = int(np.abs(model.rates).argmax()), _free(model)
    q = steady_coordinates(model, {**guess, model.names[spin]: 0.0})
    if len(model.at(q).gap):
        raise CodeError("loops in a rotor with equal blades: not supported")

    def at(psi: float) -> Matrices:
        rotated = q.copy()
        rotated[spin] = psi
        tangent, pick = model.at(rotated), np.ix_(free, free)
        return tangent.M[pick], tangent.C[pick], tangent.K[pick]

    column = {model.names[j]: k for k, j in enumerate(free)}
    groups = [[column[name] for name in group] for group in model.mechanism.equal_blades]
    return _answer(model, q, free, *rotating.modes(at, float(model.rates[spin]), groups))


def _least_squares(A: Array, b: Array) -> Array:
    """The x (n,) of least norm that minimises |A x − b|; either size may be 0."""
    return np.asarray(np.linalg.lstsq(A, b, rcond=RANK)[0], np.float64) if A.size else np.zeros(A.shape[1])


def _least(K: Array, force: Array) -> Array:
    """The step of least norm that balances the forces, each direction scaled by its stiffness."""
    size = np.sqrt(np.maximum(np.abs(K).max(axis=1, initial=0.0), np.finfo(float).tiny))
    return np.linalg.lstsq(K / size / size[:, None], force / size, rcond=1e-12)[0] / size


def _check_balance(tangent: Tangent, free: Index) -> None:
    """Check that the unbalanced forces are small compared with the stiffness.

    Raises:
        CodeError: they are not, as for a mass in free fall.
    """
    unbalanced = np.abs(null_space(tangent.J[:, free]).T @ tangent.force[free]).max(initial=0.0)
    if unbalanced > 1e-8 * np.abs(tangent.force[free]).max(initial=0.0) + 1e-12 * np.abs(tangent.K).max(initial=0.0):
        raise CodeError("no steady state near the guess: unbalanced forces remain")


def _check_constant(model: Model, linear: Linearized) -> None:
    """Compare the reduced matrices with those at another azimuth.

    Raises:
        CodeError: they differ: the equations are periodic.
    """
    fastest = float(np.abs(model.rates).max(initial=0.0))
    if not fastest or not linear.null.shape[1]:
        return
    later_tangent = model.at(linear.q + model.rates * (AZIMUTH / fastest))
    gap = np.abs(later_tangent.gap).max(initial=0.0)
    slip = np.abs(later_tangent.J[:, linear.free] @ linear.null).max(initial=0.0)
    first, second = (linear.M, linear.C, linear.K), along(later_tangent, linear.free, linear.null)
    scale = (fastest**2, fastest, 1.0)
    size = max(float(np.abs(s * a).max()) for s, a in zip(scale, first, strict=True))
    change = max(float(np.abs(s * (a - b)).max()) for s, a, b in zip(scale, first, second, strict=True))
    if change > model.rounding * size or max(gap, slip) > model.rounding:
        raise CodeError("periodic: the matrices change with the azimuth; this adapter needs constant ones")
