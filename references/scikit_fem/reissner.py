"""scikit-fem: a geometrically exact beam that supports every property of a section, a root and a tip.

Displacement and rotation are quadratic in each element, the strains are taken at its two Gauss points (reduced
integration), and section forces are separate fields, linear and discontinuous (E. Hellinger 1914, E. Reissner 1950):
there is no locking, and a rigid strain is an exact constraint, without a penalty. The weak forms are in
``reissner_forms``, their derivation in docs/geometrically-exact-beam.md. The steady state is computed first, by
Newton's method to rounding, then the matrices about it, with the strains that are not rigid as coordinates. Frequencies
converge with the fourth power of the element size. scikit-fem: T. Gustafsson, G. D. McBain, Journal of Open Source
Software 5 (2020) 2369.
"""

import time
from importlib import metadata

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse import linalg as spla

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS
from ...core.modes import STATIONS, Modes
from ..protocol import install
from ..protocol.interface import CodeError, Independence, Shares
from ..protocol.latest import latest
from ..protocol.quadratic import gyroscopic_modes
from ..theories.reference_line import element_ends, moments, steps
from . import reissner_forms as forms
from .assembly import bilinear
from .reissner_beam import Beam, State, beam_of, skfem, spatial, stiffening, strain, strain_rate
from .reissner_steady import steady

Array = NDArray[np.float64]

COARSEST = 8
"""Elements of the coarsest level, and the largest number of intervals between stations that needs no more."""

MAX_ELEMENTS = 300
"""Largest number of elements: the matrices are dense, with up to 12 rows per element."""

RIGID_BODY = 1e-6
"""Departure from a rigid body's mass matrix attributed to rounding, relative to its masses and moments of inertia."""


class ScikitFemReissner:
    """See the module; all blades except those whose mass matrix is not that of a rigid body."""

    name = "scikit-fem-reissner"
    title = "scikit-fem, geometrically exact beam"
    shares: Shares = "nothing"
    independence = Independence("scikit-fem", "geometrically exact beam", "scikit-fem-reissner's adapter")
    effects = ALL_EFFECTS
    levels = (COARSEST, 2 * COARSEST, 3 * COARSEST)
    order = 4
    hint = install.extra("codes")
    distribution = "scikit-fem"

    def version(self) -> str | None:
        """Version of scikit-fem, without importing it."""
        try:
            return metadata.version(self.distribution)
        except metadata.PackageNotFoundError:
            return None

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if a mass matrix is not that of a rigid body, or all strains are rigid."""
        for name, mass in (("mass", blade.mass), ("tip_mass", blade.tip_mass)):
            body = moments(mass)
            again = np.einsum("ail,bij,...jl->...ab", forms.MOVE, forms.MOVE, body)
            scale = np.sqrt(np.abs(np.diagonal(mass, axis1=-2, axis2=-1)))
            if (np.abs(again - mass) > RIGID_BODY * scale[..., None] * scale[..., None, :]).any():
                return (
                    f"{name}: not the matrix of a rigid body to {RIGID_BODY:g}: the weak form integrates over particles"
                )
        if np.isinf(blade.stiffness).any(axis=(0, 2)).all():
            return "stiffness: all strains are rigid: this code uses the strains as coordinates"
        return None

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.Code``.

        Every interval between stations where a property or the line has a kink is divided into the same number of
        elements, at least ``elements`` in total; ``Modes.elements`` gives the number, without those at steps.

        Raises:
            CodeError: an unsupported blade, too many elements, or no stable steady state at this speed.
        """
        if reason := self.unsupported(blade):
            raise CodeError(f"{blade.name}: {reason}")
        begun = time.perf_counter()
        beam = _beam(blade, elements)
        state = steady(beam, omega)
        coordinates = _coordinates(beam, state)
        M, C, K = _matrices(beam, state, omega, coordinates)
        frequencies, vectors = gyroscopic_modes(M, C, K, count)
        shapes = _shapes(beam, coordinates @ vectors)
        largest = float(np.linalg.norm(strain(beam, state)[..., :3], axis=-1).max())
        refinement = beam.elements - steps(blade)
        return Modes(omega, frequencies, shapes, refinement, strain=largest, seconds=time.perf_counter() - begun)


@latest
def _beam(blade: Blade, elements: int) -> Beam:
    ends = element_ends(blade, elements, COARSEST)
    if len(ends) - 1 > MAX_ELEMENTS:
        raise CodeError(f"elements: {len(ends) - 1}: the matrices are dense; at most {MAX_ELEMENTS}")
    return beam_of(blade, ends)


def _coordinates(beam: Beam, state: State) -> Array:
    """(all, n) motion of each coordinate: the root's free motions without strain, then each strain that is not rigid.

    Given the motion of the root, the strains at the Gauss points determine the motion: B is square.
    """
    B = (strain_rate(beam, state) @ beam.to_free).tocsc()
    roots = len(beam.springs) - B.shape[0]
    soft = np.flatnonzero(~beam.rigid[np.arange(beam.forces.N) % 6])
    wanted = np.hstack([-B[:, :roots].toarray(), beam.gram.tocsc()[:, soft].toarray()])
    inner = spla.splu(B[:, roots:].tocsc()).solve(wanted)
    first = np.hstack([np.eye(roots), np.zeros((roots, len(soft)))])
    return beam.to_free @ np.vstack([first, inner])


def _matrices(beam: Beam, state: State, omega: float, Z: Array) -> tuple[Array, Array, Array]:
    """M, C, K of the coordinates, whose motions are the columns of ``Z``."""
    M = C = sp.csr_array((beam.basis.N, beam.basis.N))
    for part, axes in zip(beam.parts, state.part_axes, strict=True):
        about = spatial(part, axes)
        M = M + bilinear(forms.quadratic, part.basis, on=forms.for_fem(forms.inertia(about), 2))
        C = C + omega * bilinear(forms.quadratic, part.basis, on=forms.for_fem(forms.gyroscopic(about), 2))
    soft = np.flatnonzero(~beam.rigid[np.arange(beam.forces.N) % 6])
    roots = Z.shape[1] - len(soft)
    K = Z.T @ (stiffening(beam, state, omega) @ Z)
    gram, compliance = (matrix.tocsc()[soft][:, soft] for matrix in (beam.gram, beam.compliance))
    K[roots:, roots:] += gram @ spla.splu(compliance).solve(gram.toarray())
    K[range(roots), range(roots)] += beam.springs[:roots]
    return Z.T @ (M @ Z), Z.T @ (C @ Z), K


def _shapes(beam: Beam, q: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """(m, 21, 4) from all coordinates (N, m)."""
    one = beam.basis.with_element(skfem().ElementLineP2())
    read = one.probes(STATIONS[None] * beam.blade.length)
    out = np.empty((q.shape[1], len(STATIONS), 4), complex)
    for k in range(4):
        of = np.empty(one.N, dtype=np.intp)
        of[one.nodal_dofs[0]], of[one.interior_dofs[0]] = beam.basis.nodal_dofs[k], beam.basis.interior_dofs[k]
        out[:, :, k] = (read @ q[of]).T
    return out


CODE = ScikitFemReissner()
