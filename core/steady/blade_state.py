"""Steady state of a rotating tree by Newton's method, and its extrapolation from earlier speeds."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ..compiled import kernels
from ..effects import Effects
from ..element import beams as bm
from ..element import measures
from ..element.mesh import Mesh
from ..space import spatial as sp
from ..tree import elimination, joint_links
from ..tree.links import twists
from ..tree.pencil import Shape, TreePencil, assembled, linearize, undeformed
from . import extrapolation

Array = NDArray[np.float64]

_MAX_STEPS = 40
_EPS = float(np.finfo(float).eps)
_STALL_FACTOR, _CONVERGED_FACTOR = 10.0, 1e-4  # multiples of the rounding energy: of a stalled step; of the next one
_MIN_REDUCTION = 1e-2  # ratio of the energies of successive steps above which the iteration has stalled
LATEST = 8  # number of speeds from which the next steady state is extrapolated
_FIRST_STEP = 0.5  # of continuation, as a fraction of the loads
_MIN_STEP, _SMALLEST_LOAD = 1e-3, 1e-9  # smallest step, as a fraction of the loads reached and of all
_MAX_STATES = 300  # number of states that continuation tries


class SteadyStateError(ValueError):
    """No steady rotating state was found at this speed."""


class LargeStrainError(SteadyStateError):
    """The strains of the steady state are too large for linear elastic sections."""


@dataclass(frozen=True)
class Steady:
    """A steady state: its shape, and the pencil about it."""

    shape: Shape
    pencil: TreePencil


def steady(mesh: Mesh, omega: float, gravity: Array, start: Shape | None = None) -> Steady:
    """The steady state at ``omega`` (rad/s) under ``gravity`` (3,), m/s², in the hub's axes.

    Newton's method starts from ``start``, then from the undeformed shape; if both fail, the loads are raised from zero.

    Raises:
        SteadyStateError: if none is found near the undeformed blade.
    """
    for shape in (start, undeformed(mesh)):
        if shape is not None:
            try:
                return _newton(mesh, shape, omega, gravity)
            except SteadyStateError:
                pass  # the start is too far away
    return _continued(mesh, omega, gravity)


def _continued(mesh: Mesh, omega: float, gravity: Array) -> Steady:
    """The steady state by continuation: Ω², gravity and the given loads grow together from zero.

    Each state starts from an extrapolation of the previous ones. A success doubles the step, a failure halves it.
    """
    state, known = None, {0.0: coordinates(mesh, undeformed(mesh))}
    done, step = 0.0, _FIRST_STEP
    for _ in range(_MAX_STATES):
        fraction = min(1.0, done + step)
        try:
            guess = _shape(mesh, _extrapolated(known, fraction))
            state = _newton(_loaded(mesh, fraction), guess, omega * fraction**0.5, gravity * fraction)
        except SteadyStateError:
            step *= 0.5
            if step < _MIN_STEP * done or step < _SMALLEST_LOAD:
                break
            continue
        if fraction == 1.0:
            return state
        known = dict([*known.items(), (fraction, coordinates(mesh, state.shape))][-LATEST:])
        done, step = fraction, 2.0 * step
    raise _no_state(mesh, omega, state, done)


def _loaded(mesh: Mesh, fraction: float) -> Mesh:
    """The mesh with a fraction of its loads that do not depend on the speed."""
    points = mesh.beams.points
    if not (mesh.force.any() or points.force.any()):
        return mesh
    beams = replace(mesh.beams, points=replace(points, force=fraction * points.force))
    return replace(mesh, force=fraction * mesh.force, beams=beams)


def _no_state(mesh: Mesh, omega: float, state: Steady | None, done: float) -> SteadyStateError:
    """The error of a continuation that ended at the fraction ``done`` of the loads, in ``state``."""
    if state is None:
        return SteadyStateError(
            f"omega: no steady state at {omega:.6g} rad/s, nor at {done:.0e} of its loads: check units"
        )
    strain = largest_strain(mesh, state.shape)
    end = f"omega: no steady state at {omega:.6g} rad/s; the loads were raised up to {done:.3g} of theirs, where the "
    if strain > measures.LARGEST_STRAIN:
        return SteadyStateError(
            f"{end}strain is {strain:.0%}: the blade is too soft in tension or shear; check units or lower the loads"
        )
    return SteadyStateError(f"{end}strain is {strain:.1%}: check bending and torsional stiffness, or lower the loads")


def _newton(mesh: Mesh, shape: Shape, omega: float, gravity: Array) -> Steady:
    """Newton's method, converged to rounding.

    The squared error in the energy norm is that of the step, δᵀKδ. It is compared with the energy of rounding errors in the
    nodes' poses, below which a step is meaningless. The size of a step is not a criterion: the steps of an almost
    inextensible blade are tiny.
    """
    size = np.repeat([mesh.scale, 1.0], 3)
    before = np.nan  # energy of the last step
    for _ in range(_MAX_STEPS):
        p = linearize(mesh, shape, omega, gravity)
        try:
            relative = elimination.solution(p.factor, -p.residual)
        except np.linalg.LinAlgError:
            raise SteadyStateError("singular stiffness") from None
        step = twists(p.links, relative[None])[0]
        change = float(np.abs(step[:, :6] / size).max())
        if not np.isfinite(change) or change > 10.0:
            raise SteadyStateError("diverged")
        energy = abs(float(relative @ p.residual))
        if _converged(energy, before, rounding_energy(p, shape)):
            if measures.out_of_range(mesh.beams.law, shape.relative @ mesh.corner).any():
                raise SteadyStateError("elements are deformed beyond the range of their strain measure")
            return Steady(displaced(mesh, shape, step, relative), p)
        damping = min(1.0, 0.5 / max(change, 0.5))
        shape, before = displaced(mesh, shape, damping * step, damping * relative), energy
    raise SteadyStateError("no convergence")


def _converged(energy: float, before: float, rounding: float) -> bool:
    """Whether a step is the last one.

    It is if its energy is that of rounding errors, and it is the first step or hardly smaller than the last one, or if the next
    one would be negligible by quadratic convergence: rounding may be much less than its bound.

    Args:
        energy: of the step.
        before: of the last step; nan for the first one.
        rounding: bound of the energy of rounding errors.
    """
    if np.isnan(before):
        return energy <= rounding
    ratio = energy / before
    if ratio > _MIN_REDUCTION:
        return energy <= _STALL_FACTOR * rounding
    following = energy * ratio * ratio  # of the next step: it is proportional to the square of this one's
    return energy <= rounding and following <= _CONVERGED_FACTOR * rounding


def rounding_energy(p: TreePencil, shape: Shape) -> float:
    """Energy Σ ρᵀ S ρ of rounding errors ρ in the relative poses, J: a step with less energy is rounding."""
    stiffness = np.diagonal(p.K[:, 6:12, 6:12], axis1=1, axis2=2)
    force, moment = stiffness[:, :3].sum(1), stiffness[:, 3:].sum(1)
    squared_length = (shape.relative[:, :3, 3] ** 2).sum(1)
    return _EPS**2 * abs(float(squared_length @ force + moment.sum()))


def largest_strain(mesh: Mesh, shape: Shape) -> float:
    """Largest steady strain of the reference curve (see ``measures.relative_strain``)."""
    return float(measures.relative_strain(mesh.beams.law, shape.relative @ mesh.corner, shape.beta).max(initial=0.0))


def displaced(mesh: Mesh, shape: Shape, step: Array, relative: Array) -> Shape:
    """The shape after a step.

    Args:
        mesh: the nodes and elements.
        shape: before the step.
        step: (n, 6 or 12) twists of nodes 1 … n in their axes, and changes of β.
        relative: (dn,) the same step by the coordinates (ρ, β).
    """
    moved = kernels.displaced(mesh.parent, np.ascontiguousarray(shape.relative), np.ascontiguousarray(step))
    rho = relative.reshape(step.shape)[:, :6]
    joints = shape.joints.copy()
    for q, joint in zip(joints, mesh.joints, strict=True):
        free = ~joint.clamped
        q[free] += np.linalg.lstsq(joint_links.twists(joint, q)[:, free], rho[joint.link], rcond=None)[0]
    return assembled(mesh, moved, shape.beta + step[:, 6:], joints)


def coordinates(mesh: Mesh, shape: Shape) -> Array:
    """(n, 6 or 12) twists that take the undeformed relative poses to those of a shape, or coordinates of joints; and β."""
    out = np.concatenate([sp.log(sp.inverse(mesh.between) @ shape.relative), shape.beta], axis=1)
    out[[joint.link for joint in mesh.joints], :6] = shape.joints
    return out


def extrapolate(mesh: Mesh, known: Mapping[float, Array], omega: float) -> Shape | None:
    """Extrapolate the shape to ``omega`` (rad/s) from the ``coordinates`` at known values of Ω²; None if there are none.

    The polynomial in Ω² is fitted by least squares, which amplifies rounding errors less than one through all points. With
    poses in the hub's axes, of which strains are small differences, these errors would be far larger.
    """
    return _shape(mesh, _extrapolated(known, omega**2)) if known else None


def _extrapolated(known: Mapping[float, Array], at: float) -> Array:
    """The coordinates at ``at`` from those at known values of the same parameter."""
    if at in known:
        return known[at]
    return extrapolation.at_zero(np.array(list(known)) - at, np.array(list(known.values())))


def _shape(mesh: Mesh, values: Array) -> Shape:
    """The shape with given ``coordinates``."""
    relative = mesh.between @ sp.exp(np.ascontiguousarray(values[:, :6]))
    return assembled(mesh, relative, values[:, 6:], values[[joint.link for joint in mesh.joints], :6])


def carried_over(mesh: Mesh, shape: Shape, finer: Mesh) -> Shape:
    """An initial guess on a finer mesh of the same blade: the nodes' motions in the hub's axes, interpolated along the blade.

    Args:
        mesh: the coarser mesh.
        shape: its shape.
        finer: the finer mesh.
    """
    first = len(mesh.joints)  # without the joint at the root, which has no length
    twists = sp.log(shape.nodes[first:] @ sp.inverse(mesh.nodes[first:]))
    at = CubicSpline(_lengths(mesh)[first:], twists)(_lengths(finer)[first:])
    nodes = finer.nodes.copy()
    nodes[first:] = sp.exp(at) @ finer.nodes[first:]
    relative = sp.inverse(nodes[finer.parent]) @ nodes[1:]
    return assembled(finer, relative, np.zeros((len(nodes) - 1, finer.beams.inner)), shape.joints)


def _lengths(mesh: Mesh) -> Array:
    """(n+1,) positions of the nodes along the chords between them, as fractions of the sum."""
    steps = np.linalg.norm(mesh.between[:, :3, 3], axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()


def prestress_at_rest(mesh: Mesh, omega: float, gravity: Array) -> Mesh:
    """The undeformed mesh with the internal forces of a linear static analysis: Yoo and Shin's linear theory."""
    still = Effects(geometric=False)
    residual = linearize(mesh, undeformed(mesh), omega, gravity, still).residual.reshape(len(mesh.nodes) - 1, -1)
    bare = replace(mesh, lumps=np.zeros_like(mesh.lumps), beams=bm.massless(mesh.beams))
    elastic = linearize(bare, undeformed(bare), 0.0, np.zeros(3), still).factor
    rho = elimination.solution(elastic, -residual[:, :6].ravel()).reshape(-1, 6)
    loaded = replace(mesh.beams, preload=bm.linear_force(mesh.beams, rho))
    return replace(mesh, beams=replace(loaded, inner_preload=-residual[:, 6:]))
