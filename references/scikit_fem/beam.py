"""scikit-fem: a prestressed rotating beam by standard finite elements, sparse and of fourth order.

Bending fields are cubic (Hermite), stretch and torsion quadratic; ``forms`` contains the weak forms and their
derivation. The steady stretch and twist are computed first, then the matrices about them. Nothing is shared with core.
scikit-fem: T. Gustafsson, G. D. McBain, Journal of Open Source Software 5 (2020) 2369.
"""

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, dia_array
from scipy.sparse.linalg import splu

from ...core.blade import BEND_Y, BEND_Z, Blade, clamped, coupled, straight
from ...core.effects import ALL_EFFECTS
from ...core.modes import STATIONS, Modes
from ..cache_last import cache_last
from ..matrices.quadratic import gyroscopic_modes
from ..protocol.fingerprint import Fingerprint, of_matrix, tip_flexibility
from ..protocol.interface import BladeAdapter, CodeError, Independence, extra
from ..sampling import SampledSections, sample
from ..theories.grading import element_ends
from . import forms as forms
from .assembly import bilinear, skfem

Array = NDArray[np.float64]

COARSEST = 20
"""Elements of the coarsest level, and the largest number of intervals between stations that needs no more."""

QUADRATURE = 9
"""Degree integrated exactly: products of cubics with linear properties, and two more for twist and stretch."""


NEWTON = 30
"""Largest number of Newton steps for the steady twist."""


class ScikitFemBeam(BladeAdapter):
    """See the module; straight blades, uncoupled and shear-free, with twist, taper, pitch and a centred tip mass."""

    name = "scikit-fem"
    title = "scikit-fem, prestressed beam"
    independence = Independence(
        "scikit-fem", "prestressed beam, weak forms made by the adapter", "scikit-fem's adapter"
    )
    effects = ALL_EFFECTS
    levels = (COARSEST, 2 * COARSEST, 4 * COARSEST)
    order = 4
    hint = extra("codes")
    distribution = "scikit-fem"

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if the blade's steady state is not straight, its sections couple or shear, or a strain is rigid."""
        if coupled(blade):
            return (
                "sections couple (off-diagonal entries): the weak form needs principal axes through the reference curve"
            )
        if not straight(blade):
            return "prebend or sweep: the weak form is linearised about a straight steady state"
        if blade.precone:
            return (
                f"precone = {blade.precone:g} rad: it bends the blade, and the weak form needs a straight steady state"
            )
        if (blade.tip_mass != _rigid_body(blade.tip_mass)).any():
            return "tip_mass is not a mass with moments of inertia on the axis: off the axis, it would bend the blade"
        if np.isfinite(blade.root[:4]).any():
            return "the root can slide or twist: the weak form clamps displacements and torsion at the root"
        if not clamped(blade) and blade.pitch:
            return f"pitch = {blade.pitch:g} rad with a joint at the root: the joint's axes are not those of the fields"
        section = sample(blade, blade.stations)
        if np.ptp(np.diagonal(blade.mass, axis1=1, axis2=2)[:, :3], axis=1).any():
            return "mass differs with direction: the weak form has one mass per length"
        if np.isfinite([section.GA_y, section.GA_z]).any():
            return "finite shear stiffness: the weak form is shear-free (Euler–Bernoulli)"
        for name in ("EA", "GJ", "EI_y", "EI_z"):
            if np.isinf(getattr(section, name)).any():
                return f"{name} is infinite: the weak form needs it finite"
        return None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.BladeAdapter``.

        Every interval between the blade's kinks is divided into the same number of elements, so that properties are
        smooth within each and the order of convergence is preserved. There are at least ``elements``;
        ``Modes.elements`` gives the number. A blade with more than ``COARSEST`` intervals has proportionally more, so
        that refinements stay distinct.

        Raises:
            CodeError: no stable steady state at this speed.
        """
        basis, parts, readings = _mesh(blade, elements)
        matrices = _matrices(blade, omega, parts)
        clamp = basis.get_dofs("root").flatten()
        free = basis.complement_dofs(np.setdiff1d(clamp, list(_hinges(blade, basis))))
        M, C, K = (matrix[free][:, free] for matrix in matrices)
        frequencies, vectors = gyroscopic_modes(M, C, K, count)
        q = np.zeros((basis.N, len(frequencies)), complex)
        q[free] = vectors
        shapes = np.stack([sampling @ q[dofs] for dofs, sampling in readings], axis=-1).transpose(1, 0, 2)
        return Modes(omega, frequencies, shapes, basis.mesh.nelements)

    def fingerprint(self, blade: Blade, elements: int) -> Fingerprint:
        """From the matrices of all coordinates at rest; see ``interface.BladeAdapter``."""
        basis, parts, _ = _mesh(blade, elements)
        M, _, K = _matrices(blade, 0.0, parts)
        q = np.zeros((basis.N, 6))
        bases = basis.split_bases()
        for k, (dofs, field) in enumerate(zip(basis.split_indices(), bases, strict=True)):
            q[dofs, k] = field.project(lambda x: np.ones_like(x[0]))
            if k in (1, 2):  # rotations about z and y move v and w
                q[dofs, 5 if k == 1 else 4] = (1 if k == 1 else -1) * field.project(lambda x: blade.hub_radius + x[0])
        weighed = of_matrix(q.T @ (M @ q), basis.mesh.nelements)
        if not clamped(blade):
            return weighed
        tip = basis.get_dofs("tip").nodal
        names = (("u^1", 1.0), ("u^2", 1.0), ("u^3", 1.0), ("u^4", 1.0), ("u_x^3", -1.0), ("u_x^2", 1.0))
        loads = np.zeros((basis.N, 6))
        for k, (name, sign) in enumerate(names):
            loads[int(tip[name][0]), k] = sign
        free = basis.complement_dofs(basis.get_dofs("root").flatten())
        displacement = splu(csc_array(K[free][:, free])).solve(loads[free])
        return replace(weighed, flexibility=tip_flexibility(loads[free].T @ displacement))


def _hinges(blade: Blade, basis: Any) -> dict[int, float]:
    """Indices of the slopes at the root that its joint leaves free → stiffness of their springs, N m."""
    slopes = basis.get_dofs("root").nodal
    about = {int(slopes["u_x^3"][0]): BEND_Y, int(slopes["u_x^2"][0]): BEND_Z}
    return {slope: blade.root[axis] for slope, axis in about.items() if np.isfinite(blade.root[axis])}


def _rigid_body(inertia: Array) -> Array:
    """The mass and the three moments of inertia of a 6×6 inertia, as a 6×6 diagonal matrix."""
    return np.diag([inertia[0, 0]] * 3 + list(np.diag(inertia)[3:]))


def _basis(nodes: Array) -> Any:
    """Fields u, v, w, φ: quadratic, cubic (Hermite), cubic, quadratic.

    New elements are made each time, because Hermite elements keep the mesh they are first used on.
    """
    fem = skfem()
    ends = {"root": lambda x: x[0] == nodes[0], "tip": lambda x: x[0] == nodes[-1]}
    mesh = fem.MeshLine(nodes).with_boundaries(ends)
    along, across = fem.ElementLineP2, fem.ElementLineHermite
    return fem.Basis(mesh, fem.ElementComposite(along(), across(), across(), along()), intorder=QUADRATURE)


@dataclass(frozen=True)
class Part:
    """A part with inertia: the line, with properties per length, or the tip, with lumped properties.

    Attributes:
        basis: of the fields u, v, w, φ.
        steady_basis: of the steady stretch and twist; cubic, because their derivatives are needed.
        x: (elements, points) arc length, m.
        mass, I_x, I_y, I_z: (elements, points) in section axes.
        angle: (elements, points) from the axes y, z to those of the undeformed sections, rad.
    """

    basis: Any
    steady_basis: Any
    x: Array
    mass: Array
    I_x: Array
    I_y: Array
    I_z: Array
    angle: Array


@cache_last
def _mesh(blade: Blade, elements: int) -> tuple[Any, list[Part], list[tuple[Any, Any]]]:
    """The mesh, which does not depend on the speed.

    Returns:
        The basis; the parts; for each field, its coordinates, and the matrix that gives the field at the common stations.
    """
    basis = _basis(element_ends(blade, elements, COARSEST))
    at = STATIONS[None] * blade.length
    readings = [(dofs, part.probes(at)) for dofs, part in zip(basis.split_indices(), basis.split_bases(), strict=True)]
    return basis, _parts(blade, basis), readings


def _parts(blade: Blade, basis: Any) -> list[Part]:
    """The line, and the tip if it has mass."""
    fem = skfem()
    steady_basis = basis.with_element(fem.ElementLineHermite())
    x, at = _sections(blade, basis)
    parts = [Part(basis, steady_basis, x, at.mass, at.I_x, at.I_y, at.I_z, at.twist + blade.pitch)]
    if blade.tip_mass.any():
        tip = basis.boundary("tip")
        x, at = _sections(blade, tip)
        mass, _, _, I_x, I_y, I_z = np.diag(blade.tip_mass)[:, None, None]
        parts.append(Part(tip, steady_basis.boundary("tip"), x, mass, I_x, I_y, I_z, at.twist + blade.pitch))
    return parts


def _sections(blade: Blade, basis: Any) -> tuple[Array, SampledSections]:
    """The quadrature points and the properties there (elements, points)."""
    x = np.array(basis.global_coordinates())[0]
    at = sample(blade, x.ravel())
    return x, SampledSections(**{f.name: getattr(at, f.name).reshape(x.shape) for f in fields(at)})


def _stretch(blade: Blade, parts: list[Part], at: SampledSections, omega: float) -> Array:
    """Steady displacement along x: ``(EA U')' + μ Ω² (R + x + U) = 0``, which is linear for any amplitude."""
    fem = skfem()
    load = fem.LinearForm(forms.load)
    steady_basis = parts[0].steady_basis
    K, f = bilinear(forms.spring, steady_basis, k=at.EA), steady_basis.zeros()
    for p in parts:
        K = K - omega**2 * bilinear(forms.bedding, p.steady_basis, k=p.mass)
        f = f + omega**2 * load.assemble(p.steady_basis, k=p.mass * (blade.hub_radius + p.x))
    return fem.solve(*fem.condense(K, f, D=steady_basis.get_dofs("root").all("u")))


def _untwist(parts: list[Part], at: SampledSections, omega: float) -> Array:
    """Steady rotation of the sections about x by the propeller moment: ``(GJ Φ')' + Ω² J_yz(Φ) = 0``, by Newton's method."""
    fem = skfem()
    load = fem.LinearForm(forms.load)
    steady_basis = parts[0].steady_basis
    torsion, torsion_angle = bilinear(forms.spring, steady_basis, k=at.GJ), steady_basis.zeros()
    for _ in range(NEWTON):
        K, f = torsion, -torsion @ torsion_angle
        for p in parts:
            J_yy, J_zz, J_yz = forms.rotated(p.I_y, p.I_z, p.angle + p.steady_basis.interpolate(torsion_angle))
            K = K - omega**2 * bilinear(forms.bedding, p.steady_basis, k=J_yy - J_zz)
            f = f + omega**2 * load.assemble(p.steady_basis, k=J_yz)
        step = fem.solve(*fem.condense(K, f, D=steady_basis.get_dofs("root").all("u")))
        torsion_angle = torsion_angle + step
        if np.abs(step).max() < 1e-8:  # the error of the next is its square
            return torsion_angle
    raise CodeError(f"omega: {omega:g} rad/s: no steady twist of the sections in {NEWTON} steps; lower the speed")


def _matrices(blade: Blade, omega: float, parts: list[Part]) -> tuple[Any, Any, Any]:
    """M, C, K of all coordinates about the steady state, in axes that rotate with the hub."""
    basis = parts[0].basis
    at = _sections(blade, basis)[1]
    stretch, torsion_angle = _stretch(blade, parts, at, omega), _untwist(parts, at, omega)
    U, rotation = (parts[0].steady_basis.interpolate(field) for field in (stretch, torsion_angle))
    if not (U.grad[0] > -1).all():
        raise CodeError(
            f"omega: {omega:g} rad/s: no steady stretch: centrifugal force exceeds axial stiffness; lower the speed"
        )
    EI_yy, EI_zz, EI_yz = forms.rotated(at.EI_y, at.EI_z, parts[0].angle + rotation)
    stiffness = {"EA": at.EA, "GJ": at.GJ, "EI_yy": EI_yy, "EI_zz": EI_zz, "EI_yz": EI_yz}
    prestress = {
        "g": 1 + U.grad[0],
        "g_s": U.hess[0, 0],
        "tension": at.EA * U.grad[0],
        "torque": at.GJ * rotation.grad[0],
    }
    K = bilinear(forms.elastic, basis, **stiffness, **prestress)
    M = C = 0 * K
    for p in parts:
        J_yy, J_zz, J_yz = forms.rotated(p.I_y, p.I_z, p.angle + p.steady_basis.interpolate(torsion_angle))
        inertia = {"mass": p.mass, "J_xx": p.I_x, "J_yy": J_yy, "J_zz": J_zz, "J_yz": J_yz}
        inertia["g"] = 1 + p.steady_basis.interpolate(stretch).grad[0]
        M = M + bilinear(forms.inertia, p.basis, **inertia)
        C = C + omega * bilinear(forms.gyroscopic, p.basis, **inertia)
        K = K - omega**2 * bilinear(forms.centrifugal, p.basis, **inertia)
    springs = np.zeros(basis.N)
    root = 1 + stretch[parts[0].steady_basis.get_dofs("root").nodal["u_x"][0]]
    for slope, spring in _hinges(blade, basis).items():
        springs[slope] = spring / root**2  # the section rotates by the slope over the stretch
    return M, C, K + dia_array((springs[None], [0]), shape=K.shape)


CODE = ScikitFemBeam()
