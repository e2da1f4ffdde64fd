"""scikit-fem: a geometrically exact beam that supports every property of a section, a root and a tip.

Displacement and rotation are quadratic in each element, the strains are taken at its two Gauss points (reduced
integration), and section forces are separate fields, linear and discontinuous (E. Hellinger 1914, E. Reissner 1950):
there is no locking, and a rigid strain is an exact constraint, without a penalty. The weak forms are in
``reissner_forms``, their derivation in docs/geometrically-exact-beam.md. The steady state is computed first, by
Newton's method to rounding, then the matrices about it, with the strains that are not rigid as coordinates. Frequencies
converge with the fourth power of the element size. scikit-fem: T. Gustafsson, G. D. McBain, Journal of Open Source
Software 5 (2020) 2369.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse import linalg as spla

from ...core.blade import Blade, clamped
from ...core.effects import ALL_EFFECTS
from ...core.modes import STATIONS, Modes
from ..cache_last import cache_last
from ..matrices.quadratic import gyroscopic_modes
from ..protocol.fingerprint import Fingerprint, of_matrix, rigid_motions, tip_flexibility
from ..protocol.interface import REFERENCE_LINE, BladeAdapter, Independence, extra
from ..theories.reference_line import element_ends, line, moments, steps
from . import reissner_forms as forms
from .assembly import bilinear, skfem
from .reissner_beam import Beam, State, at_rest, beam_of, spatial, stiffening, strain, strain_rate
from .reissner_steady import steady_state

Array = NDArray[np.float64]

COARSEST = 8
"""Elements of the coarsest level, and the largest number of intervals between stations that needs no more."""

FORMED = 600
"""Largest number of coordinates for which forming M and C is faster than applying their factors in each iteration."""

RIGID_BODY = 1e-6
"""Departure from a rigid body's mass matrix attributed to rounding, relative to its masses and moments of inertia."""


class ScikitFemReissner(BladeAdapter):
    """See the module; all blades except those whose mass matrix is not that of a rigid body."""

    name = "scikit-fem-reissner"
    title = "scikit-fem, geometrically exact beam"
    independence = Independence(
        "scikit-fem",
        "mixed geometrically exact beam, weak forms made by the adapter",
        "scikit-fem-reissner's adapter",
        sections=REFERENCE_LINE,
    )
    effects = ALL_EFFECTS
    levels = (COARSEST, 2 * COARSEST, 3 * COARSEST)
    order = 4
    finest = 96
    max_elements = 300  # the matrices are dense, with up to 12 rows per element
    hint = extra("codes")
    distribution = "scikit-fem"

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if a mass matrix is not that of a rigid body, or all strains are rigid."""
        for name, mass in (("mass", blade.mass), ("tip_mass", blade.tip_mass)):
            body = moments(mass)
            of_particles = np.einsum("ail,bij,...jl->...ab", forms.MOVE, forms.MOVE, body)
            scale = np.sqrt(np.abs(np.diagonal(mass, axis1=-2, axis2=-1)))
            if (np.abs(of_particles - mass) > RIGID_BODY * scale[..., None] * scale[..., None, :]).any():
                return (
                    f"{name}: not the matrix of a rigid body to {RIGID_BODY:g}: the weak form integrates over particles"
                )
        if np.isinf(blade.stiffness).any(axis=(0, 2)).all():
            return "stiffness: all strains are rigid: this code uses the strains as coordinates"
        return None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.BladeAdapter``.

        Every interval between stations where a property or the line has a kink is divided into the same number of
        elements, at least ``elements`` in total; ``Modes.elements`` gives the number, without those at steps.

        Raises:
            CodeError: too many elements, or no stable steady state at this speed.
        """
        self.limit(len(element_ends(blade, elements, COARSEST)) - 1)
        beam = _beam(blade, elements)
        state = steady_state(beam, omega)
        motions = _motions(beam, state)
        M, C, K = _matrices(beam, state, omega, motions)
        frequencies, vectors = gyroscopic_modes(M, C, K, count)
        shapes = _shapes(beam, motions @ vectors.real + 1j * (motions @ vectors.imag))
        largest = float(np.linalg.norm(strain(beam, state)[..., :3], axis=-1).max())
        refinement = beam.elements - steps(blade)
        return Modes(omega, frequencies, shapes, refinement, strain=largest)

    def fingerprint(self, blade: Blade, elements: int) -> Fingerprint:
        """From the mass matrix of all coordinates at rest; see ``interface.BladeAdapter``."""
        self.limit(len(element_ends(blade, elements, COARSEST)) - 1)
        beam = _beam(blade, elements)
        M = _mass(beam, at_rest(beam))
        s = beam.basis.doflocs[0]
        own = np.zeros(beam.basis.N, dtype=np.intp)
        for dofs in (beam.basis.nodal_dofs, beam.basis.interior_dofs):
            own[dofs] = np.arange(6)[:, None]
        position = line(blade, s[:, None]).position[:, 0]
        motions = np.concatenate([rigid_motions(position), np.broadcast_to(np.eye(6)[3:], (len(s), 3, 6))], axis=1)
        q = motions[np.arange(len(s)), own]
        weighed = of_matrix(q.T @ (M @ q), beam.elements)
        if not clamped(blade):
            return weighed
        Z = _motions(beam, at_rest(beam))
        full = np.asarray(Z.matmat(np.eye(Z.shape[1])))
        tip = full[np.array(beam.basis.get_dofs("tip").flatten())]
        K = _elastic(beam, _soft(beam)) + full.T @ (stiffening(beam, at_rest(beam), 0.0) @ full)
        return replace(weighed, flexibility=tip_flexibility(tip @ np.linalg.solve(K, tip.T)))


@cache_last
def _beam(blade: Blade, elements: int) -> Beam:
    return beam_of(blade, element_ends(blade, elements, COARSEST))


def _motions(beam: Beam, state: State) -> spla.LinearOperator:
    """(all, n) motion of each coordinate: the root's free motions without strain, then each strain that is not rigid.

    Given the motion of the root, the strains at the Gauss points determine the motion: B is square.
    """
    B = (strain_rate(beam, state) @ beam.to_free).tocsc()
    roots, soft = B.shape[1] - B.shape[0], _soft(beam)
    strain_factor = spla.splu(B[:, roots:])
    strained = sp.csc_array(sp.hstack([-B[:, :roots], beam.gram.tocsc()[:, soft]]))

    def motion(q: Array) -> Array:
        return beam.to_free @ np.concatenate([q[:roots], strain_factor.solve(strained @ q)])

    def work(force: Array) -> Array:
        free = beam.to_free.T @ force
        out = strained.T @ strain_factor.solve(free[roots:], "T")
        out[:roots] += free[:roots]
        return out

    shape = (beam.basis.N, roots + len(soft))
    return spla.LinearOperator(shape, matvec=motion, rmatvec=work, matmat=motion, rmatmat=work, dtype=float)  # pyright: ignore[reportCallIssue]


def _soft(beam: Beam) -> NDArray[np.intp]:
    """Indices of the section forces whose strain is not rigid."""
    return np.flatnonzero(~beam.rigid[np.arange(beam.forces.N) % 6])


def _matrices(beam: Beam, state: State, omega: float, Z: spla.LinearOperator) -> tuple[Any, Any, Array]:
    """M, C, K of the coordinates, whose motions are the columns of ``Z``. All are full; large M and C are operators."""
    M, C = _mass(beam, state), sp.csr_array((beam.basis.N, beam.basis.N))
    for part, axes in zip(beam.parts, state.part_axes, strict=True):
        about = spatial(part, axes)
        C = C + omega * bilinear(forms.quadratic, part.basis, on=forms.for_fem(forms.gyroscopic(about), 2))
    soft = _soft(beam)
    roots = Z.shape[1] - len(soft)
    full = Z @ np.eye(Z.shape[1])
    K = full.T @ (stiffening(beam, state, omega) @ full)
    K[roots:, roots:] += _elastic(beam, soft)
    K[range(roots), range(roots)] += beam.springs[:roots]
    if len(K) <= FORMED:
        return full.T @ (M @ full), full.T @ (C @ full), K
    return Z.T @ spla.aslinearoperator(M) @ Z, Z.T @ spla.aslinearoperator(C) @ Z, K


def _mass(beam: Beam, state: State) -> Any:
    """Mass matrix of all coordinates."""
    M = sp.csr_array((beam.basis.N, beam.basis.N))
    for part, axes in zip(beam.parts, state.part_axes, strict=True):
        M = M + bilinear(forms.quadratic, part.basis, on=forms.for_fem(forms.inertia(spatial(part, axes)), 2))
    return M


def _elastic(beam: Beam, soft: NDArray[np.intp]) -> Array:
    """Stiffness of the strains ``soft``, ``G C⁻¹ G`` with the Gram matrix G of the section forces; each element has its own."""
    size = len(soft) // beam.elements
    G, C = (
        sp.bsr_array(matrix.tocsr()[soft][:, soft], blocksize=(size, size)) for matrix in (beam.gram, beam.compliance)
    )
    return sp.bsr_array((G.data @ np.linalg.solve(C.data, G.data), G.indices, G.indptr)).toarray()


def _shapes(beam: Beam, q: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """(m, 21, 4) from all coordinates (N, m)."""
    scalar = beam.basis.with_element(skfem().ElementLineP2())
    sampling = scalar.probes(STATIONS[None] * beam.blade.length)
    out = np.empty((q.shape[1], len(STATIONS), 4), complex)
    for k in range(4):
        dofs = np.empty(scalar.N, dtype=np.intp)
        dofs[scalar.nodal_dofs[0]], dofs[scalar.interior_dofs[0]] = (
            beam.basis.nodal_dofs[k],
            beam.basis.interior_dofs[k],
        )
        out[:, :, k] = (sampling @ q[dofs]).T
    return out


CODE = ScikitFemReissner()
