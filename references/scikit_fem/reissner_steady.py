"""The steady state of a geometrically exact beam at a rotor speed: Newton's method on virtual work, to rounding."""

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse import linalg as spla

from ..protocol.interface import CodeError
from . import reissner_forms as forms
from .assembly import skfem
from .reissner_beam import Beam, State, after_step, at_rest, centrifugal_force, stiffening, strain, strain_rate

Array = NDArray[np.float64]

NEWTON, CONVERGED, ROUNDING = 40, 1e-6, 1e-13
"""Largest number of steps; step size (relative to the length, or rad) below which steps must decrease; size of rounding."""

RAMPS = (1, 4, 16)
"""Numbers of equal increments of the squared speed, tried in turn."""

COMMUTE = 1e-8
"""Largest product of steady rotations about two axes of the root joint for which their order does not matter, rad²."""


def steady_state(beam: Beam, omega: float) -> State:
    """The steady state at ``omega`` (rad/s), reached from zero speed in as few steps as suffice.

    Raises:
        CodeError: none was found, or the root joint is rotated about two axes, whose order is undefined.
    """
    state = at_rest(beam)
    if not omega:
        return state
    for ramp in RAMPS:
        balanced = _raised(beam, omega, ramp)
        if balanced is not None:
            break
    else:
        raise CodeError(f"omega: {omega:g} rad/s: no steady state found in {RAMPS[-1]} steps from zero speed; lower it")
    joint = np.flatnonzero(np.isfinite(beam.blade.root))
    turns = np.sort(np.abs(balanced.root[: len(joint)][joint >= 3]))
    if len(turns) > 1 and turns[-1] * turns[-2] > COMMUTE:
        raise CodeError(
            f"{beam.blade.name}: the root rotates about two axes, by {turns[-1]:.2g} and {turns[-2]:.2g} rad: "
            "the weak form does not define their order"
        )
    return balanced


def _raised(beam: Beam, omega: float, steps: int) -> State | None:
    """The steady state at ``omega`` after ``steps`` equal increments of the squared speed; None if one fails."""
    state = at_rest(beam)
    for k in range(1, steps + 1):
        speed = omega * np.sqrt(k / steps)
        if k == 1:
            state = after_step(beam, state, 0 * state.root, _statics(beam, state, speed))
        balanced = _equilibrium(beam, state, speed)
        if balanced is None:
            return None
        state = balanced
    return state


def _statics(beam: Beam, state: State, omega: float) -> Array:
    """Section forces that balance the centrifugal force on the undeformed, clamped blade: a stiff initial guess."""
    beyond_root = np.setdiff1d(np.arange(beam.basis.N), beam.basis.get_dofs("root").flatten())
    B = strain_rate(beam, state).tocsc()[:, beyond_root]
    return spla.splu(B.T.tocsc()).solve(centrifugal_force(beam, state, omega)[beyond_root])


def _equilibrium(beam: Beam, state: State, omega: float) -> State | None:
    """Newton's method on virtual work, ``δq · (Bᵀσ − f) + δσ · (ε − cσ)``, to rounding; None if it does not converge."""
    fem, n, last = skfem(), len(beam.springs), np.inf
    for _ in range(NEWTON):
        B = strain_rate(beam, state) @ beam.to_free
        K = beam.to_free.T @ stiffening(beam, state, omega) @ beam.to_free + sp.diags_array(beam.springs)
        geometry = forms.for_fem(strain(beam, state), 1)
        out_of_balance = np.concatenate(
            [
                beam.to_free.T @ centrifugal_force(beam, state, omega) - B.T @ state.force - beam.springs * state.root,
                beam.compliance @ state.force - fem.LinearForm(forms.linear).assemble(beam.forces, on=geometry),
            ]
        )
        matrix = sp.block_array([[K, B.T], [B, -beam.compliance]], format="csc")
        with np.errstate(all="ignore"):
            try:
                change = spla.splu(matrix).solve(out_of_balance)
            except RuntimeError:  # singular
                return None
        size = _size(beam, change[:n])
        if not np.isfinite(size) or size > 1e3:
            return None
        largest = max(1.0, size / 0.5)  # at most half a radian, or half the length, per step
        state = after_step(beam, state, change[:n] / largest, state.force + change[n:] / largest)
        if size < ROUNDING or (size < CONVERGED and size > 0.5 * last):
            return state
        last = size
    return None


def _size(beam: Beam, step: Array) -> float:
    """Size of a step: the largest displacement over the length, or the largest rotation."""
    q = np.abs(beam.to_free @ step)
    first = beam.basis.nodal_dofs[:3].ravel(), beam.basis.interior_dofs[:3].ravel()
    after_step = np.concatenate([q[i] for i in first]).max() / beam.blade.length
    return float(max(after_step, q[beam.basis.nodal_dofs[3:]].max(), q[beam.basis.interior_dofs[3:]].max()))
