"""What Park et al. (2010) leave open: the steady state, the linearisation of M̂ v̇_I = Q̂ about it, and the eigenproblem.

A tree of bodies comes in, its modes go out. ``park2010`` has the equations. Q̂ is differentiated by complex steps, exact to
rounding: K̂ contains the elastic, centrifugal and geometric terms and those of the multipliers, Ĉ the gyroscopic ones.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg

from .mechanism.description import MechanismError
from .park2010 import (
    Equations,
    Partition,
    constraints,
    cut_joints,
    equations,
    inertia_forces,
    partition,
    screw_rates,
    transformation,
)
from .park2010_input import Tree, poses
from .space import complex_step as cs
from .space import spatial as sp

Array = np.ndarray[Any, Any]

_AT_ONCE = 8  # complex steps
_CONVERGED, _ROUNDED = 1e-13, 1e-8  # Newton's last correction, and the largest that only rounding keeps from shrinking
_MOST, _MAX_STEP = 100, 0.2  # number of corrections, and the largest, rad or a fraction of the mechanism's length
_RANK = 1e-9  # relative size of a singular value that counts as zero
_RIGID = 1e-12  # 1/λ relative to the largest, below which a motion has no mass


@dataclass(frozen=True)
class Linear:
    """M̂ δv̇_I + Ĉ δv_I + K̂ δq_I = 0 about coordinates q (n,), each matrix (i, i)."""

    tree: Tree
    part: Partition
    q: Array
    at: Equations
    M: Array
    C: Array
    K: Array


def rates(t: Tree, q: Array) -> tuple[Array, Array]:
    """v and v̇ (n,) of the steady state at q: those of the motions, those that the loops impose, else 0."""
    v, dv = np.zeros((2, len(q)))
    prescribed = [t.coordinates.index(m.coordinate) for m in t.mechanism.motions]
    v[prescribed], dv[prescribed] = (
        [getattr(m, name) for m in t.mechanism.motions] for name in ("rate", "acceleration")
    )
    if t.cuts:
        _, J = poses(t, q)
        following = np.setdiff1d(np.arange(len(q)), prescribed)
        Phi_q = cut_joints(t) @ transformation(t, J).real
        pinv = np.linalg.pinv(Phi_q[:, following], rcond=_RANK)
        v[following] = -pinv @ Phi_q @ v
        gamma = cut_joints(t) @ (transformation(t, screw_rates(t, J, v)) @ v).real
        dv[following] = -pinv @ (Phi_q @ dv + gamma)
    return v, dv


def unbalanced(t: Tree, part: Partition, q: Array, v_I: Array, dv_I: Array) -> Array:
    """Q̂ − M̂ v̇_I (..., i)."""
    e = equations(t, q, v_I, part)
    return e.Q_hat - inertia_forces(e, dv_I)


def along_q(t: Tree, part: Partition, q: Array) -> Array:
    """Derivative (i, i) of Q̂ − M̂ v̇_I with respect to q_I, by complex steps δq = R δq_I that keep the loops closed."""
    v_I, dv_I = (a[part.I] for a in rates(t, q))
    R = equations(t, q, v_I, part).R.real
    return _slopes(lambda step: unbalanced(t, part, q + step, v_I, dv_I), R.T)


def along_v(t: Tree, part: Partition, q: Array) -> Array:
    """Derivative (i, i) of Q̂ with respect to v_I, by complex steps."""
    v_I = rates(t, q)[0][part.I]
    return _slopes(lambda step: equations(t, q, v_I + step, part).Q_hat, np.eye(len(v_I)))


def _slopes(f: Callable[[Array], Array], directions: Array) -> Array:
    """Derivatives (m, s) of a function (..., k) → (..., m) along directions (s, k)."""
    out = [np.zeros((0, directions.shape[0]))]
    out += [f(1j * cs.STEP * directions[k : k + _AT_ONCE]).imag / cs.STEP for k in range(0, len(directions), _AT_ONCE)]
    return np.concatenate(out).T


def linearize(t: Tree, q: Array, independent: Sequence[str] | None = None) -> Linear:
    """Linearise about coordinates q (n,) that close the loops."""
    part = partition(t, q, independent)
    e = equations(t, q, rates(t, q)[0][part.I], part)
    return Linear(t, part, q, e, e.M_hat.real, -along_v(t, part, q), -along_q(t, part, q))


def steady_state(t: Tree, guess: Mapping[str, float] | Array | None = None) -> Array:
    """Coordinates (n,) of the steady state Q̂ = 0, by Newton's method from a guess (0 for coordinates without one).

    The tangent is kept as long as corrections shrink tenfold.

    Raises:
        MechanismError: no convergence.
    """
    q = np.zeros(len(t.coordinates)) if not isinstance(guess, np.ndarray) else guess.copy()
    for name, value in guess.items() if isinstance(guess, Mapping) else ():
        q[t.coordinates.index(name)] = value
    for m in t.mechanism.motions:
        if m.position is not None:
            q[t.coordinates.index(m.coordinate)] = m.position
    last, tangent = np.inf, None
    for _ in range(_MOST):
        q = closed(t, q)
        if tangent is None:
            part = partition(t, q)
            tangent = scipy.linalg.lu_factor(along_q(t, part, q))
        v, dv = rates(t, q)
        e = equations(t, q, v[part.I], part)
        unbalanced = e.Q_hat - inertia_forces(e, dv[part.I])
        step = e.R.real @ scipy.linalg.lu_solve(tangent, -np.real(unbalanced))
        size = np.abs(step / unit(t, e)).max(initial=0.0)
        q = q + step * min(1.0, _MAX_STEP / size) if size else q
        if size < _CONVERGED or _ROUNDED > size > 0.5 * last:
            return closed(t, q)
        last, tangent = size, tangent if size < 0.1 * last else None
    raise MechanismError(
        f"steady state: Newton's last correction is {size:.1e} rad, or of the length: give a better guess"
    )


def unit(t: Tree, e: Equations) -> Array:
    """(n,) 1 rad for rotations; for displacements the largest distance of a body from the origin, m."""
    length = np.abs(e.X[:, :3, 3].real).max(initial=0.0)
    return np.where(t.screw[:, 3:].any(1), 1.0, length or 1.0)


def closed(t: Tree, q: Array) -> Array:
    """Coordinates (n,) that close the loops near q, with the same prescribed ones.

    Raises:
        MechanismError: no convergence.
    """
    if not t.cuts:
        return q
    body, copy = np.array(t.cuts).T
    free = np.setdiff1d(np.arange(len(q)), t.motions()[0])
    last = np.inf
    for _ in range(_MOST):
        X, J = (a.real for a in poses(t, q))
        gap = cs.times(sp.adjoint(X[copy]), sp.log(sp.inverse(X[copy]) @ X[body])).ravel()
        size = np.abs(gap).max() / max(np.abs(X[:, :3, 3]).max(), 1e-300)
        if size < _CONVERGED or _ROUNDED > size > 0.5 * last:
            return q
        q, last = q.copy(), size
        Phi_q = constraints(t, J, transformation(t, J)).real[: len(gap)]
        q[free] -= np.linalg.pinv(Phi_q[:, free], rcond=_RANK) @ gap
    raise MechanismError(f"loops: they do not close: the gap is {size:.1e} of the length: give a better guess")


def modes(linear: Linear) -> tuple[Array, Array]:
    """λ (m,) by modulus, one of each conjugate pair, and x (i, m), with (λ² M̂ + λ Ĉ + K̂) x = 0.

    With x = −λ K̂⁻¹ (Ĉ x + M̂ y) and y = λ x, the lowest modes have the largest eigenvalues 1/λ; M̂ may be singular.

    Raises:
        numpy.linalg.LinAlgError: K̂ is singular.
    """
    n = len(linear.K)
    upper_rows = -np.linalg.solve(linear.K, np.hstack([linear.C, linear.M]))
    mu, vectors = np.linalg.eig(np.vstack([upper_rows, np.eye(n, 2 * n)]))
    selected = np.flatnonzero((np.imag(mu) <= 0.0) & (np.abs(mu) > _RIGID * np.abs(mu).max(initial=0.0)))
    selected = selected[np.argsort(-np.abs(mu[selected]))]
    return 1.0 / mu[selected], vectors[:n, selected]
