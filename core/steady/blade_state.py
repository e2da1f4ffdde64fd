"""Steady state of a rotating tree by Newton's method, and its extrapolation from earlier speeds."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ..compiled import kernels
from ..effects import Effects
from ..element import beams as bm
from ..element import measures
from ..element.mesh import Mesh
from ..space import spatial as sp
from ..tree import elimination
from ..tree.links import twists
from ..tree.pencil import Shape, TreePencil, assembled, linearize, undeformed
from .continuation import extrapolated, follow
from .newton import newton

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_STALL_FACTOR, _CONVERGED_FACTOR = 10.0, 1e-4  # multiples of the rounding energy: of a stalled step; of the next one
_MIN_REDUCTION = 1e-2  # ratio of the energies of successive steps above which the iteration has stalled
_LONGEST_STEP, _DIVERGED = 0.5, 10.0  # rad or fractions of the length: a longer step is damped; ends the iteration


class SteadyStateError(ValueError):
    """No steady rotating state was found at this speed."""


class LargeStrainError(SteadyStateError):
    """The strains of the steady state are too large for linear elastic sections."""


@dataclass(frozen=True)
class Steady:
    """A steady state: its shape, and the pencil about it."""

    shape: Shape
    pencil: TreePencil


def steady_state(mesh: Mesh, omega: float, gravity: Array, start: Shape | None = None) -> Steady:
    """The steady state at ``omega`` (rad/s) under ``gravity`` (3,), m/s², in the hub's axes.

    Newton's method starts from ``start``, then from the undeformed shape. If both fail, it follows the state while Ω², gravity
    and the given loads grow together from zero.

    Raises:
        SteadyStateError: if none is found near the undeformed blade.
    """
    for shape in (start, undeformed(mesh)):
        if shape is not None and (state := _newton(mesh, shape, omega, gravity)):
            return state

    def solve(fraction: float, guess: Array) -> tuple[Steady, Array] | None:
        state = _newton(_loaded(mesh, fraction), _shape(mesh, guess), omega * fraction**0.5, gravity * fraction)
        return state and (state, coordinates(mesh, state.shape))

    reached, state = follow(solve, coordinates(mesh, undeformed(mesh)))
    if state is None or reached < 1.0:
        raise _no_state(mesh, omega, state, reached)
    return state


def _loaded(mesh: Mesh, fraction: float) -> Mesh:
    """The mesh with a fraction of its loads that do not depend on the speed."""
    points = mesh.beams.points
    if not (mesh.force.any() or points.force.any()):
        return mesh
    beams = replace(mesh.beams, points=replace(points, force=fraction * points.force))
    return replace(mesh, force=fraction * mesh.force, beams=beams)


def _no_state(mesh: Mesh, omega: float, state: Steady | None, reached: float) -> SteadyStateError:
    """The error of a continuation that ended at the fraction ``reached`` of the loads, in ``state``."""
    if state is None:
        return SteadyStateError(
            f"omega: no steady state at {omega:.6g} rad/s, nor at {reached:.0e} of its loads: check units"
        )
    strain = largest_strain(mesh, state.shape)
    end = f"omega: no steady state at {omega:.6g} rad/s; loads were raised up to {reached:.3g} of theirs, where the "
    if strain > measures.LARGEST_STRAIN:
        return SteadyStateError(
            f"{end}strain is {strain:.0%}: the blade is too soft in tension or shear; check units or lower the loads"
        )
    return SteadyStateError(f"{end}strain is {strain:.1%}: check bending and torsional stiffness, or lower the loads")


def _newton(mesh: Mesh, shape: Shape, omega: float, gravity: Array) -> Steady | None:
    """The steady state by Newton's method from a shape, with the pencil before the last step; None if it fails."""
    last = newton(Iterate(mesh, shape, omega, gravity))
    if last is None or measures.out_of_range(mesh.beams.law, last.shape.relative @ mesh.corner).any():
        return None
    return Steady(last.displaced(1.0), last.pencil)


@dataclass(frozen=True)
class Iterate:
    """A shape of a mesh with its residual; see ``newton.Iterate``."""

    mesh: Mesh
    shape: Shape
    omega: float
    gravity: Array

    @cached_property
    def pencil(self) -> TreePencil:
        """The residual and its derivative K."""
        return linearize(self.mesh, self.shape, self.omega, self.gravity)

    @cached_property
    def step(self) -> Array:
        """(dn,) Newton's step of the coordinates (ρ, β); infinite if K is singular."""
        try:
            return elimination.solution(self.pencil.factor, -self.pencil.residual)
        except np.linalg.LinAlgError:
            return np.full_like(self.pencil.residual, np.inf)

    @cached_property
    def node_step(self) -> Array:
        """(n, 6 or 12) the same step as twists of nodes 1 … n in their axes, and changes of β."""
        return twists(self.pencil.links, self.step[None])[0]

    @cached_property
    def length(self) -> float:
        """Longest displacement of a node in the step as a fraction of the mesh's length, or rotation in rad."""
        return float(np.abs(self.node_step[:, :6] / np.repeat([self.mesh.scale, 1.0], 3)).max())

    @property
    def energy(self) -> float:
        """Squared error in the energy norm, δᵀKδ of the step, J."""
        return abs(float(self.step @ self.pencil.residual))

    def converged(self, previous: Self | None) -> bool:
        """Whether the energy is that of rounding errors in the nodes' poses, below which a step is meaningless.

        The size of a step is not a criterion: the steps of an almost inextensible blade are tiny.
        """
        previous_energy = previous.energy if previous else np.nan
        return self.length <= _DIVERGED and _converged(
            self.energy, previous_energy, rounding_energy(self.pencil, self.shape)
        )

    def following(self) -> Self | None:
        """The shape after the step, or a part of it if it is long; None if it is too long.

        Steps need not contract: those of stiff blades may grow a hundredfold before they converge.
        """
        if not self.length <= _DIVERGED:
            return None
        return replace(self, shape=self.displaced(min(1.0, _LONGEST_STEP / max(self.length, _LONGEST_STEP))))

    def displaced(self, fraction: float) -> Shape:
        """The shape after a fraction of the step."""
        return displaced(self.mesh, self.shape, fraction * self.node_step, fraction * self.step)


def _converged(energy: float, previous_energy: float, rounding: float) -> bool:
    """Whether a step with this energy is the last one; ``previous_energy``: that of the last step, nan for the first one.

    A step is the last one if its energy is at most ``rounding``, the bound of that of rounding errors, and if it is the first
    step, or hardly smaller than the last one, or the next one would be negligible by quadratic convergence. The latter two are
    needed since rounding errors may be far below their bound.
    """
    if np.isnan(previous_energy):
        return energy <= rounding
    ratio = energy / previous_energy
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
    nodes = kernels.displaced(mesh.parent, np.ascontiguousarray(shape.relative), np.ascontiguousarray(step))
    rho = relative.reshape(step.shape)[:, :6]
    joints = shape.joints + np.array([joint.rate @ rho[joint.link] for joint in mesh.joints])
    return assembled(mesh, nodes, shape.beta + step[:, 6:], joints)


def coordinates(mesh: Mesh, shape: Shape) -> Array:
    """(n, 6 or 12) twists that take the undeformed relative poses to those of a shape, or coordinates of joints; and β."""
    out = np.concatenate([sp.log(sp.inverse(mesh.between) @ shape.relative), shape.beta], axis=1)
    for joint, q in zip(mesh.joints, shape.joints, strict=True):
        out[joint.link, :6] = q, 0.0, 0.0, 0.0, 0.0, 0.0
    return out


def extrapolate(mesh: Mesh, earlier: Mapping[float, Array], omega: float) -> Shape | None:
    """Extrapolate the shape to ``omega`` (rad/s) from the ``coordinates`` at known values of Ω²; None if there are none.

    The polynomial in Ω² is fitted by least squares, which amplifies rounding errors less than one through all points. With
    poses in the hub's axes, of which strains are small differences, these errors would be far larger.
    """
    return _shape(mesh, extrapolated(earlier, omega**2)) if earlier else None


def _shape(mesh: Mesh, values: Array) -> Shape:
    """The shape with given ``coordinates``."""
    relative = mesh.between @ sp.exp(np.ascontiguousarray(values[:, :6]))
    return assembled(mesh, relative, values[:, 6:], values[[joint.link for joint in mesh.joints], 0])


def carried_over(mesh: Mesh, shape: Shape, finer: Mesh) -> Shape:
    """An initial guess on a finer mesh of the same blade: the nodes' motions in the hub's axes, interpolated along the blade.

    Args:
        mesh: the coarser mesh.
        shape: its shape.
        finer: the finer mesh.
    """
    first = len(mesh.joints)  # without the joint at the root, whose links have no length
    twists = sp.log(shape.nodes[first:] @ sp.inverse(mesh.nodes[first:]))
    at = CubicSpline(_lengths(mesh)[first:], twists)(_lengths(finer)[first:])
    nodes = finer.nodes.copy()
    nodes[first:] = sp.exp(at) @ finer.nodes[first:]
    relative = sp.inverse(nodes[finer.parent]) @ nodes[1:]
    return assembled(finer, relative, np.zeros((len(nodes) - 1, finer.beams.internal_count)), shape.joints)


def _lengths(mesh: Mesh) -> Array:
    """(n+1,) positions of the nodes along the chords between them, as fractions of the sum."""
    steps = np.linalg.norm(mesh.between[:, :3, 3], axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()


def prestress_at_rest(mesh: Mesh, omega: float, gravity: Array) -> Mesh:
    """The undeformed mesh with the internal forces of a linear static analysis: Yoo and Shin's linear theory."""
    effects = Effects(geometric=False)
    residual = linearize(mesh, undeformed(mesh), omega, gravity, effects).residual.reshape(len(mesh.nodes) - 1, -1)
    bare = replace(mesh, lumps=np.zeros_like(mesh.lumps), beams=bm.massless(mesh.beams))
    elastic = linearize(bare, undeformed(bare), 0.0, np.zeros(3), effects).factor
    rho = elimination.solution(elastic, -residual[:, :6].ravel()).reshape(-1, 6)
    loaded = replace(mesh.beams, preload=bm.linear_force(mesh.beams, rho))
    return replace(mesh, beams=replace(loaded, internal_preload=-residual[:, 6:]))
