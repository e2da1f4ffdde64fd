"""A blade on scikit-fem's line elements: mesh, fields, configuration, and the matrices and forces there.

Displacement and rotation are quadratic in each element, the strains are taken at its two Gauss points (reduced
integration), and section forces are separate fields, linear and discontinuous. Weak forms: ``reissner_forms``.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from ...core.blade import Blade
from ..sampling import mass_at, stiffness_at
from ..theories.reference_line import line, moments, root_axes
from . import reissner_forms as forms
from .assembly import bilinear, skfem

Array = NDArray[np.float64]

STRAIN, INERTIA = 3, 7
"""Degrees integrated exactly: by two points, to avoid locking; of products of quadratics with linear properties."""


@dataclass(frozen=True)
class Part:
    """A part with inertia: the line, with properties per length, or the tip, lumped; arrays (elements, points, …).

    Attributes:
        basis: of the displacements and rotations, at these points.
        position: (…, 3) m, undeformed.
        axes: (…, 3, 3) the section's axes, undeformed.
        moments: (…, 4, 4) ∫ Y Yᵀ dm in the section's axes; see ``theories.reference_line.moments``.
    """

    basis: Any
    position: Array
    axes: Array
    moments: Array


@dataclass(frozen=True)
class Beam:
    """A blade on a mesh.

    Attributes:
        blade: the blade.
        basis: of (w, φ), quadratic, at the strains' points.
        forces: of the section forces, linear and discontinuous, at the same points.
        parts: the parts with inertia.
        slope, axes: (e, q, 3), (e, q, 3, 3) of the undeformed line, at the strains' points.
        compliance: of the sections; rigid strains have zero rows.
        gram: of the fields of section forces.
        rigid: (6,) whether each strain is rigid.
        to_free: (all, free) from the free coordinates (the root's in its axes, without the clamped ones) to all.
        springs: (free,) stiffness of the root's springs at its coordinates, zero elsewhere.
    """

    blade: Blade
    basis: Any
    forces: Any
    parts: tuple[Part, ...]
    slope: Array
    axes: Array
    compliance: Any
    gram: Any
    rigid: NDArray[np.bool_]
    to_free: Any
    springs: Array

    @property
    def elements(self) -> int:
        """Number of elements."""
        return int(self.basis.mesh.nelements)


@dataclass(frozen=True)
class State:
    """A configuration, at the points of each basis.

    Attributes:
        slope, axes, curvature: (e, q, …) at the strains' points; curvature is the change from the undeformed one.
        position, part_axes: per part (e, q, 3) and (e, q, 3, 3).
        force: coefficients of the section forces.
        root: (free,) the root's displacements and rotations, in its axes, zero elsewhere.
    """

    slope: Array
    axes: Array
    curvature: Array
    position: tuple[Array, ...]
    part_axes: tuple[Array, ...]
    force: Array
    root: Array


def beam_of(blade: Blade, ends: Array) -> Beam:
    """The blade on elements that end at arc lengths ``ends`` (n+1,)."""
    fem = skfem()
    sides = {"root": lambda x: x[0] == ends[0], "tip": lambda x: x[0] == ends[-1]}
    mesh = fem.MeshLine(ends).with_boundaries(sides)
    basis = fem.Basis(mesh, fem.ElementVector(fem.ElementLineP2(), 6), intorder=STRAIN)
    forces = basis.with_element(fem.ElementVector(fem.ElementLineP1DG(), 6))
    s = np.array(basis.global_coordinates())[0]
    at_rest = line(blade, s)
    rigid = np.array(np.isinf(blade.stiffness).any(axis=(0, 2)))
    within = fem.Basis(mesh, forces.elem, intorder=INERTIA)
    compliance = bilinear(forms.quadratic, within, on=forms.for_fem(_compliance(blade, within, ~rigid), 2))
    parts = [_part(blade, fem.Basis(mesh, basis.elem, intorder=INERTIA), None)]
    if blade.tip_mass.any():
        parts.append(_part(blade, basis.boundary("tip"), blade.tip_mass))
    root = np.array(basis.get_dofs("root").flatten())
    free_root = np.flatnonzero(np.isfinite(blade.root))
    beyond_root = np.setdiff1d(np.arange(basis.N), root)
    to_root_axes = np.kron(np.eye(2), root_axes(blade))[:, free_root]
    count = len(free_root) + len(beyond_root)
    to_free = sp.lil_array((basis.N, count))
    to_free[root, : len(free_root)] = to_root_axes
    to_free[beyond_root, np.arange(len(free_root), count)] = 1.0
    springs = np.zeros(count)
    springs[: len(free_root)] = blade.root[free_root]
    return Beam(
        blade=blade,
        basis=basis,
        forces=forces,
        parts=tuple(parts),
        slope=at_rest.slope,
        axes=at_rest.axes,
        compliance=compliance,
        gram=bilinear(forms.quadratic, forces, on=forms.for_fem(np.broadcast_to(np.eye(6), (*s.shape, 6, 6)), 2)),
        rigid=rigid,
        to_free=to_free.tocsc(),
        springs=springs,
    )


def _compliance(blade: Blade, basis: Any, soft: NDArray[np.bool_]) -> Array:
    """Compliance (e, q, 6, 6) of the sections at the points of a basis, zero for rigid strains."""
    s = np.array(basis.global_coordinates())[0]
    stiffness = stiffness_at(blade, s.ravel()).reshape(*s.shape, 6, 6)
    out = np.zeros_like(stiffness)
    soft_block = (..., np.flatnonzero(soft)[:, None], np.flatnonzero(soft))
    out[soft_block] = np.linalg.inv(stiffness[soft_block])
    return out


def _part(blade: Blade, basis: Any, lump: Array | None) -> Part:
    s = np.array(basis.global_coordinates())[0]
    at_rest = line(blade, s)
    mass = mass_at(blade, s.ravel()).reshape(*s.shape, 6, 6) if lump is None else lump[None, None]
    return Part(basis, at_rest.position, at_rest.axes, moments(mass))


def at_rest(beam: Beam) -> State:
    """The undeformed configuration, without section forces."""
    shape = beam.slope.shape
    return State(
        slope=beam.slope,
        axes=beam.axes,
        curvature=np.zeros(shape),
        position=tuple(part.position for part in beam.parts),
        part_axes=tuple(part.axes for part in beam.parts),
        force=np.zeros(beam.forces.N),
        root=np.zeros(len(beam.springs)),
    )


def after_step(beam: Beam, state: State, step: Array, force: Array) -> State:
    """The state after a motion ``step`` of the free coordinates, with section forces ``force``."""
    q = beam.to_free @ step
    u = beam.basis.interpolate(q)
    w_s, phi, phi_s = (np.moveaxis(f, 0, -1) for f in (u.grad[:3, 0], np.asarray(u)[3:], u.grad[3:, 0]))
    to_section = np.swapaxes(state.axes, -1, -2)
    position, part_axes = [], []
    for part, at, axes in zip(beam.parts, state.position, state.part_axes, strict=True):
        value = np.moveaxis(np.asarray(part.basis.interpolate(q)), 0, -1)
        position.append(at + value[..., :3])
        part_axes.append(forms.exponential(value[..., 3:]) @ axes)
    return State(
        slope=state.slope + w_s,
        axes=forms.exponential(phi) @ state.axes,
        curvature=state.curvature + (to_section @ forms.bending_rate(phi, phi_s)[..., None])[..., 0],
        position=tuple(position),
        part_axes=tuple(part_axes),
        force=force,
        root=state.root + np.where(np.arange(len(step)) < np.isfinite(beam.blade.root).sum(), step, 0.0),
    )


def spatial(part: Part, axes: Array) -> Array:
    """(e, q, 4, 4) the moments of the mass in the hub's axes."""
    rotation = np.zeros((*axes.shape[:-2], 4, 4))
    rotation[..., :3, :3], rotation[..., 3, 3] = axes, 1.0
    return rotation @ part.moments @ np.swapaxes(rotation, -1, -2)


def strain_rate(beam: Beam, state: State) -> Any:
    """B: section forces times the first variation of the strains by all coordinates."""
    on = forms.for_fem(forms.strain_rate(state.slope, state.axes), 2)
    return bilinear(forms.mixed, beam.basis, beam.forces, on=on)


def stiffening(beam: Beam, state: State, omega: float) -> Any:
    """Stiffness of all coordinates due to the steady section forces and the change of the centrifugal force."""
    force = np.moveaxis(np.asarray(beam.forces.interpolate(state.force)), 0, -1)
    on = forms.for_fem(forms.geometric(state.slope, state.axes, force), 2)
    K = bilinear(forms.quadratic_local, beam.basis, on=on)
    for part, position, axes in zip(beam.parts, state.position, state.part_axes, strict=True):
        on = forms.for_fem(forms.centrifugal(position, spatial(part, axes)), 2)
        K = K + omega**2 * bilinear(forms.quadratic, part.basis, on=on)
    return K


def centrifugal_force(beam: Beam, state: State, omega: float) -> Array:
    """Centrifugal force on all coordinates."""
    fem = skfem()
    force = np.zeros(beam.basis.N)
    for part, position, axes in zip(beam.parts, state.position, state.part_axes, strict=True):
        on = forms.for_fem(forms.centrifugal_force(position, spatial(part, axes)), 1)
        force = force + omega**2 * fem.LinearForm(forms.linear).assemble(part.basis, on=on)
    return force


def strain(beam: Beam, state: State) -> Array:
    """Strains Γ and κ, (e, q, 6)."""
    gamma = np.swapaxes(state.axes, -1, -2) @ state.slope[..., None]
    undeformed = np.swapaxes(beam.axes, -1, -2) @ beam.slope[..., None]
    return np.concatenate([(gamma - undeformed)[..., 0], state.curvature], axis=-1)
