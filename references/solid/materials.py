"""Elastic materials of solids: isotropic, and orthotropic with axes that follow the blade's sections."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]

PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
"""Components of strain in the order of an orthotropic material's constants: 11, 22, 33, 12, 13, 23."""


@dataclass(frozen=True)
class Material:
    """Isotropic: Young's modulus Pa, Poisson's ratio, density kg/m³."""

    young: float
    poisson: float
    density: float

    @property
    def lame(self) -> tuple[float, float]:
        """λ and μ, Pa."""
        mu = self.young / (2.0 * (1.0 + self.poisson))
        return 2.0 * mu * self.poisson / (1.0 - 2.0 * self.poisson), mu

    @property
    def moduli(self) -> Array:
        """C (3, 3, 3, 3), Pa: S_ij = C_ijkl E_kl."""
        lam, mu = self.lame
        delta = np.eye(3)
        return (
            lam * np.einsum("ij,kl->ijkl", delta, delta)
            + mu * np.einsum("ik,jl->ijkl", delta, delta)
            + mu * np.einsum("il,jk->ijkl", delta, delta)
        )


@dataclass(frozen=True)
class Orthotropic:
    """Three planes of symmetry; axis 1 lies in the section's x–y plane, rotated from x towards y, axis 3 along z.

    Attributes:
        young: Pa, along 1, 2 and 3.
        poisson: ν12, ν13, ν23.
        shear: Pa, of the planes 12, 13 and 23.
        density: kg/m³.
        angle: from the section's x axis to axis 1, about z, rad.
    """

    young: tuple[float, float, float]
    poisson: tuple[float, float, float]
    shear: tuple[float, float, float]
    density: float
    angle: float = 0.0

    @property
    def axes(self) -> Array:
        """(3, 3) the material's axes in those of the section, in columns."""
        return Rotation.from_rotvec([0.0, 0.0, self.angle]).as_matrix()

    @property
    def moduli(self) -> Array:
        """C (3, 3, 3, 3), Pa, in the section's axes: S_ij = C_ijkl E_kl."""
        compliance = np.diag([*np.reciprocal(self.young), *np.reciprocal(self.shear)])
        for (i, j), ratio in zip(PAIRS[3:], self.poisson, strict=True):
            compliance[i, j] = compliance[j, i] = -ratio / self.young[i]
        stiffness = np.linalg.inv(compliance)
        own = np.zeros((3, 3, 3, 3))
        for a, (i, j) in enumerate(PAIRS):
            for b, (k, m) in enumerate(PAIRS):
                own[i, j, k, m] = own[j, i, k, m] = own[i, j, m, k] = own[j, i, m, k] = stiffness[a, b]
        return rotated(own, self.axes)


def rotated(moduli: Array, axes: Array) -> Array:
    """C (…, 3, 3, 3, 3) in other axes, from C in axes whose columns there are ``axes`` (…, 3, 3)."""
    return np.einsum("...ia,...jb,...kc,...ld,abcd->...ijkl", axes, axes, axes, axes, moduli, optimize=True)
