"""scikit-fem: a geometrically exact beam with everything a section, a root and a tip can have.

Displacement and rotation are quadratic in each element, the strains are taken at its two Gauss points (reduced integration),
and section forces, linear and discontinuous, are fields of their own (E. Hellinger 1914, E. Reissner 1950): no strain locks,
and a rigid strain is an exact constraint, with no penalty. Weak forms are in ``reissner_forms``, their derivation in
docs/theory/reissner.md. First the steady state by Newton's method, down to rounding; then the matrices about it, in the
strains as coordinates, of which the rigid ones are left out. Frequencies converge with the fourth power of the element size.
scikit-fem: T. Gustafsson, G. D. McBain, Journal of Open Source Software 5 (2020) 2369.
"""

import time
from dataclasses import dataclass
from importlib import metadata
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse import linalg as spla

from ...core.blade import Blade, mass_at, stiffness_at
from ...core.effects import FULL
from ...core.modes import STATIONS, Modes
from ..protocol.interface import CodeError, Independence, Shares
from ..protocol.quadratic import gyroscopic_modes
from . import reissner_forms as forms
from .line import element_ends, line, moments, root_axes

Array = NDArray[np.float64]

COARSEST = 8
"""Elements of the coarsest level, and how many intervals between stations it can follow without more."""

MOST = 300
"""Elements: the matrices are dense, with up to 12 rows an element."""

STRAIN, INERTIA = 3, 7
"""Degrees integrated exactly: by two points, where the strains do not lock; products of quadratics with linear properties."""

NEWTON, CONVERGED, ROUNDING = 40, 1e-6, 1e-13
"""Steps allowed; a step (of the length, or rad) from which on it must only fall; one that is rounding."""

RAMPS = (1, 4, 16)
"""Numbers of steps in which the speed is raised, tried in turn."""

COMMUTE = 1e-8
"""rad²: product of steady rotations about two axes of the root's joint up to which their order does not matter."""


class ScikitFemReissner:
    """See the module; all blades but those whose mass matrix is not a rigid body's."""

    name = "scikit-fem-reissner"
    title = "scikit-fem, geometrically exact beam"
    shares: Shares = "nothing"
    independence = Independence(
        "scikit-fem", "references.scikit_fem.reissner_forms", "references.scikit_fem.reissner_forms"
    )
    model = FULL
    levels = (COARSEST, 2 * COARSEST, 3 * COARSEST)
    order = 4
    hint = "pip install 'southwell[codes]'"

    def version(self) -> str | None:
        """Version of scikit-fem, without importing it."""
        try:
            return metadata.version("scikit-fem")
        except metadata.PackageNotFoundError:
            return None

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if a section's mass matrix is not a rigid body's, or nothing can strain."""
        for name, mass in (("mass", blade.mass), ("tip_mass", blade.tip_mass)):
            body = moments(mass)
            again = np.einsum("ail,bij,...jl->...ab", forms.MOVE, forms.MOVE, body)
            scale = np.sqrt(np.abs(np.diagonal(mass, axis1=-2, axis2=-1)))
            if (np.abs(again - mass) > RIGID_BODY * scale[..., None] * scale[..., None, :]).any():
                return f"{name}: not a rigid body's matrix to {RIGID_BODY:g}: the weak form integrates over particles"
        if np.isinf(blade.stiffness).any(axis=(0, 2)).all():
            return "stiffness: all strains are rigid: strains are the coordinates here"
        return None

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.Code``.

        Every interval between stations where a property or the line has a kink is divided into the same number of elements:
        at least ``elements`` in all; ``Modes.elements`` says how many.

        Raises:
            CodeError: an unsupported blade, too many elements, or no stable steady state at this speed.
        """
        if reason := self.unsupported(blade):
            raise CodeError(f"{blade.name}: {reason}")
        begun = time.perf_counter()
        beam = _beam(blade, element_ends(blade, elements, COARSEST))
        state = _steady(beam, omega)
        coordinates = _coordinates(beam, state)
        M, C, K = _matrices(beam, state, omega, coordinates)
        frequencies, vectors = gyroscopic_modes(M, C, K, count)
        shapes = _shapes(beam, coordinates @ vectors)
        strain = _largest_strain(beam, state)
        return Modes(
            omega, frequencies, shapes, beam.elements, strain=strain, seconds=time.perf_counter() - begun
        )


RIGID_BODY = 1e-6
"""Departure from a rigid body's mass matrix that is taken for rounding, of its masses and moments of inertia."""


@dataclass(frozen=True)
class Part:
    """What has inertia: the line, with properties per length, or the tip, with lumped ones; arrays (elements, points, …).

    Attributes:
        basis: of the displacements and rotations, at these points.
        place: (…, 3) m, at rest.
        axes: (…, 3, 3) the section's axes, at rest.
        moments: (…, 4, 4) ∫ Y Yᵀ dm in the section's axes; see ``line.moments``.
    """

    basis: Any
    place: Array
    axes: Array
    moments: Array


@dataclass(frozen=True)
class Beam:
    """A blade on a mesh.

    Attributes:
        blade: the blade.
        basis: of (w, φ), quadratic, at the strains' points.
        forces: of the section forces, linear and discontinuous, at the same points.
        parts: what has inertia.
        slope, axes: (e, q, 3), (e, q, 3, 3) of the line at rest, at the strains' points.
        compliance: of the sections; rigid strains have zero rows.
        gram: of the fields of section forces.
        rigid: (6,) whether the strain is.
        to_free: from the free coordinates (the root's in its own axes, and not those that are held) to all.
        springs: (free,) stiffness of the root's springs, in the root's own places.
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
        """How many."""
        return int(self.basis.mesh.nelements)


@dataclass(frozen=True)
class State:
    """A configuration, at the points of each basis.

    Attributes:
        slope, axes, curvature: (e, q, …) at the strains' points; curvature is what the rotation has added.
        place, turned: per part (e, q, 3) and (e, q, 3, 3).
        force: coefficients of the section forces.
        root: (free,) the root's displacements and rotations, in its axes, zero elsewhere.
    """

    slope: Array
    axes: Array
    curvature: Array
    place: tuple[Array, ...]
    turned: tuple[Array, ...]
    force: Array
    root: Array


def _skfem() -> Any:
    import skfem

    return skfem


def _beam(blade: Blade, ends: Array) -> Beam:
    if len(ends) - 1 > MOST:
        raise CodeError(f"elements: {len(ends) - 1}: the matrices are dense; at most {MOST}")
    fem = _skfem()
    sides = {"root": lambda x: x[0] == ends[0], "tip": lambda x: x[0] == ends[-1]}
    mesh = fem.MeshLine(ends).with_boundaries(sides)
    basis = fem.Basis(mesh, fem.ElementVector(fem.ElementLineP2(), 6), intorder=STRAIN)
    forces = basis.with_element(fem.ElementVector(fem.ElementLineP1DG(), 6))
    s = np.array(basis.global_coordinates())[0]
    at_rest = line(blade, s)
    rigid = np.isinf(blade.stiffness).any(axis=(0, 2))
    on_forces = fem.BilinearForm(forms.quadratic)
    within = fem.Basis(mesh, forces.elem, intorder=INERTIA)
    compliance = on_forces.assemble(within, on=forms.for_fem(_compliance(blade, within, ~rigid), 2))
    parts = [_part(blade, fem.Basis(mesh, basis.elem, intorder=INERTIA), None)]
    if blade.tip_mass.any():
        parts.append(_part(blade, basis.boundary("tip"), blade.tip_mass))
    root = basis.get_dofs("root").flatten()
    free_root = np.flatnonzero(np.isfinite(blade.root))
    inner = np.setdiff1d(np.arange(basis.N), root)
    turn = np.kron(np.eye(2), root_axes(blade))[:, free_root]
    to_free = sp.lil_array((basis.N, len(free_root) + len(inner)))
    to_free[root, : len(free_root)] = turn
    to_free[inner, len(free_root) + np.arange(len(inner))] = 1.0
    springs = np.zeros(to_free.shape[1])
    springs[: len(free_root)] = blade.root[free_root]
    return Beam(
        blade=blade,
        basis=basis,
        forces=forces,
        parts=tuple(parts),
        slope=at_rest.slope,
        axes=at_rest.axes,
        compliance=compliance,
        gram=on_forces.assemble(forces, on=forms.for_fem(np.broadcast_to(np.eye(6), (*s.shape, 6, 6)), 2)),
        rigid=rigid,
        to_free=to_free.tocsc(),
        springs=springs,
    )


def _compliance(blade: Blade, basis: Any, soft: NDArray[np.bool_]) -> Array:
    """(e, q, 6, 6) of the sections at a basis's points, zero in what is rigid."""
    s = np.array(basis.global_coordinates())[0]
    stiffness = stiffness_at(blade, s.ravel()).reshape(*s.shape, 6, 6)
    out = np.zeros_like(stiffness)
    both = (..., np.flatnonzero(soft)[:, None], np.flatnonzero(soft))
    out[both] = np.linalg.inv(stiffness[both])
    return out


def _part(blade: Blade, basis: Any, lump: Array | None) -> Part:
    s = np.array(basis.global_coordinates())[0]
    at_rest = line(blade, s)
    mass = mass_at(blade, s.ravel()).reshape(*s.shape, 6, 6) if lump is None else lump[None, None]
    return Part(basis, at_rest.place, at_rest.axes, moments(mass))


def _at_rest(beam: Beam) -> State:
    shape = beam.slope.shape
    return State(
        slope=beam.slope,
        axes=beam.axes,
        curvature=np.zeros(shape),
        place=tuple(part.place for part in beam.parts),
        turned=tuple(part.axes for part in beam.parts),
        force=np.zeros(beam.forces.N),
        root=np.zeros(len(beam.springs)),
    )


def _moved(beam: Beam, state: State, step: Array, force: Array) -> State:
    """The state after a motion of the free coordinates, ``step``, and with section forces ``force``."""
    q = beam.to_free @ step
    u = beam.basis.interpolate(q)
    w_s, phi, phi_s = (np.moveaxis(f, 0, -1) for f in (u.grad[:3, 0], u.value[3:], u.grad[3:, 0]))
    back = np.swapaxes(state.axes, -1, -2)
    place, turned = [], []
    for part, at, axes in zip(beam.parts, state.place, state.turned, strict=True):
        value = np.moveaxis(part.basis.interpolate(q).value, 0, -1)
        place.append(at + value[..., :3])
        turned.append(forms.exponential(value[..., 3:]) @ axes)
    return State(
        slope=state.slope + w_s,
        axes=forms.exponential(phi) @ state.axes,
        curvature=state.curvature + (back @ forms.bending_rate(phi, phi_s)[..., None])[..., 0],
        place=tuple(place),
        turned=tuple(turned),
        force=force,
        root=state.root + np.where(np.arange(len(step)) < np.isfinite(beam.blade.root).sum(), step, 0.0),
    )


def _spatial(part: Part, axes: Array) -> Array:
    """(e, q, 4, 4) the moments of the mass in the hub's axes."""
    turn = np.zeros((*axes.shape[:-2], 4, 4))
    turn[..., :3, :3], turn[..., 3, 3] = axes, 1.0
    return turn @ part.moments @ np.swapaxes(turn, -1, -2)


def _strain_rate(beam: Beam, state: State) -> Any:
    """B: section forces times the strain's rate by all coordinates."""
    on = forms.for_fem(forms.strain_rate(state.slope, state.axes), 2)
    return _skfem().BilinearForm(forms.mixed).assemble(beam.basis, beam.forces, on=on)


def _stiffening(beam: Beam, state: State, omega: float) -> Any:
    """Stiffness of all coordinates by the steady section forces and by the centrifugal force's change."""
    fem = _skfem()
    force = np.moveaxis(beam.forces.interpolate(state.force).value, 0, -1)
    on = forms.for_fem(forms.geometric(state.slope, state.axes, force), 2)
    K = fem.BilinearForm(forms.quadratic_local).assemble(beam.basis, on=on)
    for part, place, axes in zip(beam.parts, state.place, state.turned, strict=True):
        on = forms.for_fem(forms.centrifugal(place, _spatial(part, axes)), 2)
        K = K + omega**2 * fem.BilinearForm(forms.quadratic).assemble(part.basis, on=on)
    return K


def _centrifugal_force(beam: Beam, state: State, omega: float) -> Array:
    """On all coordinates."""
    fem = _skfem()
    force = np.zeros(beam.basis.N)
    for part, place, axes in zip(beam.parts, state.place, state.turned, strict=True):
        on = forms.for_fem(forms.centrifugal_force(place, _spatial(part, axes)), 1)
        force = force + omega**2 * fem.LinearForm(forms.linear).assemble(part.basis, on=on)
    return force


def _steady(beam: Beam, omega: float) -> State:
    """The steady state at ``omega``, raised from rest in as few steps as suffice.

    Raises:
        CodeError: none was found, or the root's joint turned about two axes, of which the order is not told.
    """
    state = _at_rest(beam)
    if not omega:
        return state
    for ramp in RAMPS:
        found = _raised(beam, omega, ramp)
        if found is not None:
            break
    else:
        raise CodeError(f"omega: {omega:g} rad/s: no steady state found in {RAMPS[-1]} steps from rest; lower the speed")
    turns = np.sort(np.abs(found.root[: np.isfinite(beam.blade.root).sum()][np.flatnonzero(np.isfinite(beam.blade.root)) >= 3]))
    if len(turns) > 1 and turns[-1] * turns[-2] > COMMUTE:
        raise CodeError(
            f"{beam.blade.name}: the root turns steadily about two axes, by {turns[-1]:.2g} and {turns[-2]:.2g} rad: "
            "the weak form does not say about which first"
        )
    return found


def _raised(beam: Beam, omega: float, steps: int) -> State | None:
    """The steady state at ``omega`` by way of ``steps`` equal increments of the speed's square; None if one fails."""
    state = _at_rest(beam)
    for k in range(1, steps + 1):
        speed = omega * np.sqrt(k / steps)
        if k == 1:
            state = _moved(beam, state, 0 * state.root, _statics(beam, state, speed))
        found = _equilibrium(beam, state, speed)
        if found is None:
            return None
        state = found
    return state


def _statics(beam: Beam, state: State, omega: float) -> Array:
    """Section forces that balance the centrifugal force on the undeformed blade as if clamped: a start that is stiff."""
    inner = np.setdiff1d(np.arange(beam.basis.N), beam.basis.get_dofs("root").flatten())
    B = _strain_rate(beam, state).tocsc()[:, inner]
    return spla.spsolve(B.T.tocsc(), _centrifugal_force(beam, state, omega)[inner])


def _equilibrium(beam: Beam, state: State, omega: float) -> State | None:
    """Newton's method on virtual work, ``δq · (Bᵀσ − f) + δσ · (ε − cσ)``, until rounding; None if it does not converge."""
    fem, n, last = _skfem(), len(beam.springs), np.inf
    for _ in range(NEWTON):
        B = _strain_rate(beam, state) @ beam.to_free
        K = beam.to_free.T @ _stiffening(beam, state, omega) @ beam.to_free + sp.diags_array(beam.springs)
        strain = forms.for_fem(_strain(beam, state), 1)
        out_of_balance = np.concatenate(
            [
                beam.to_free.T @ _centrifugal_force(beam, state, omega) - B.T @ state.force - beam.springs * state.root,
                beam.compliance @ state.force - fem.LinearForm(forms.linear).assemble(beam.forces, on=strain),
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
        largest = max(1.0, size / 0.5)  # no more than half a radian, or half the length, at once
        state = _moved(beam, state, change[:n] / largest, state.force + change[n:] / largest)
        if size < ROUNDING or size < CONVERGED and size > 0.5 * last:
            return state
        last = size
    return None


def _size(beam: Beam, step: Array) -> float:
    """Of a step: displacements as a share of the length, or rotations, whichever is larger."""
    q = np.abs(beam.to_free @ step)
    first = beam.basis.nodal_dofs[:3].ravel(), beam.basis.interior_dofs[:3].ravel()
    moved = np.concatenate([q[i] for i in first]).max() / beam.blade.length
    return float(max(moved, q[beam.basis.nodal_dofs[3:]].max(), q[beam.basis.interior_dofs[3:]].max()))


def _strain(beam: Beam, state: State) -> Array:
    """(e, q, 6) Γ and κ."""
    gamma = np.swapaxes(state.axes, -1, -2) @ state.slope[..., None]
    rest = np.swapaxes(beam.axes, -1, -2) @ beam.slope[..., None]
    return np.concatenate([(gamma - rest)[..., 0], state.curvature], axis=-1)


def _largest_strain(beam: Beam, state: State) -> float:
    return float(np.linalg.norm(_strain(beam, state)[..., :3], axis=-1).max())


def _coordinates(beam: Beam, state: State) -> Array:
    """(all, n) what motion each coordinate is: the root's free ones with no strain, then each strain that is not rigid.

    With the root given, the strains at the Gauss points determine the motion: B is square.
    """
    B = (_strain_rate(beam, state) @ beam.to_free).tocsc()
    roots = len(beam.springs) - B.shape[0]
    soft = np.flatnonzero(~beam.rigid[np.arange(beam.forces.N) % 6])
    wanted = np.hstack([-B[:, :roots].toarray(), beam.gram.tocsc()[:, soft].toarray()])
    inner = spla.splu(B[:, roots:].tocsc()).solve(wanted)
    first = np.hstack([np.eye(roots), np.zeros((roots, len(soft)))])
    return beam.to_free @ np.vstack([first, inner])


def _matrices(beam: Beam, state: State, omega: float, Z: Array) -> tuple[Array, Array, Array]:
    """M, C, K of the coordinates, whose motions are the columns of ``Z``."""
    fem = _skfem()
    M = C = sp.csr_array((beam.basis.N, beam.basis.N))
    for part, axes in zip(beam.parts, state.turned, strict=True):
        about, form = _spatial(part, axes), fem.BilinearForm(forms.quadratic)
        M = M + form.assemble(part.basis, on=forms.for_fem(forms.inertia(about), 2))
        C = C + omega * form.assemble(part.basis, on=forms.for_fem(forms.gyroscopic(about), 2))
    soft = np.flatnonzero(~beam.rigid[np.arange(beam.forces.N) % 6])
    roots = Z.shape[1] - len(soft)
    K = Z.T @ (_stiffening(beam, state, omega) @ Z)
    gram, compliance = (matrix.tocsc()[soft][:, soft] for matrix in (beam.gram, beam.compliance))
    K[roots:, roots:] += gram @ spla.splu(compliance).solve(gram.toarray())
    K[range(roots), range(roots)] += beam.springs[:roots]
    return Z.T @ (M @ Z), Z.T @ (C @ Z), K


def _shapes(beam: Beam, q: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """(m, 21, 4) from all coordinates (N, m)."""
    one = beam.basis.with_element(_skfem().ElementLineP2())
    read = one.probes(STATIONS[None] * beam.blade.length)
    out = np.empty((q.shape[1], len(STATIONS), 4), complex)
    for k in range(4):
        of = np.empty(one.N, dtype=np.intp)
        of[one.nodal_dofs[0]], of[one.interior_dofs[0]] = beam.basis.nodal_dofs[k], beam.basis.interior_dofs[k]
        out[:, :, k] = (read @ q[of]).T
    return out


CODE = ScikitFemReissner()
