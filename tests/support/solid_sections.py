"""Sections of solids: their weights, the mass of the parts between them, and a clamp that lets them contract."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from southwell.references.solid import calculix, hexahedra, materials, mesh
from southwell.references.solid.mesh import Bricks

Array = NDArray[np.float64]


def section_weights(bricks: Bricks, layer: int) -> Array:
    """(k, k) ∫NᵀN over a layer of faces, with the shape functions N of 8-node faces; nodes as in ``numbered``.

    Args:
        bricks: the block.
        layer: index of the layer of corners along the span, 0 at the root.
    """
    places = calculix.numbered(bricks)[0]
    here = places[2 * layer]
    k = np.unique(here)[1:]
    index = np.searchsorted(k, here)
    t, w = np.polynomial.legendre.leggauss(3)
    xi, eta = (v.ravel() for v in np.meshgrid(t, t, indexing="ij"))
    at = calculix.FACE - 1
    corner = (1 + at[:, :1] * xi) * (1 + at[:, 1:] * eta) * (at[:, :1] * xi + at[:, 1:] * eta - 1) / 4
    edge = np.where(at[:, :1] == 0, (1 - xi**2) * (1 + at[:, 1:] * eta), (1 + at[:, :1] * xi) * (1 - eta**2)) / 2
    N = np.where((at != 0).all(axis=1)[:, None], corner, edge)
    out = np.zeros((len(k), len(k)))
    for y, z in np.ndindex(*bricks.counts[1:]):
        a, b, c, d = (bricks.corners[layer, y + i, z + j, 1:] for i, j in calculix.FACE[:4] // 2)
        along_xi, along_eta = (
            (np.outer(1 - q, first) + np.outer(1 + q, second)) / 4
            for q, first, second in ((eta, b - a, c - d), (xi, d - a, c - b))
        )
        area = np.outer(w, w).ravel() * np.abs(along_xi[:, 0] * along_eta[:, 1] - along_xi[:, 1] * along_eta[:, 0])
        own = index[tuple((np.array([2 * y, 2 * z]) + calculix.FACE).T)]
        out[np.ix_(own, own)] += (N * area) @ N.T
    return out


def lumped(solid: hexahedra.Solid) -> Array:
    """Lumped mass (3n,), kg: row sums, which for 27 nodes is Simpson's rule."""
    return np.tile(hexahedra.mass(solid).sum(axis=1), 3)


def lumped_by_part(bricks: Bricks, material: materials.Material, cuts: NDArray[np.intp]) -> Array:
    """(m, 3n) lumped mass of each part of a block, cut at layers of corners ``cuts`` (m+1,) along the span."""
    shape = bricks.lattice().shape[:3]
    out = np.zeros((len(cuts) - 1, 3, *shape))
    for k, (a, b) in enumerate(pairwise(cuts)):
        part = bricks.part(a, b)
        out[k, :, 2 * a : 2 * b + 1] = lumped(hexahedra.solid(part, material)).reshape(3, *part.lattice().shape[:3])
    return out.reshape(len(cuts) - 1, -1)


def clamped_free_to_contract(at: float) -> mesh.Clamp:
    """Clamp the section at ``x = at`` (m) without restraining its width: fixed along x; y and z fixed on the centre lines.

    A full clamp restrains the Poisson contraction due to bending, which a beam's clamp does not.
    """

    def fixed(nodes: Array) -> NDArray[np.bool_]:
        near = np.abs(nodes - [at, 0.0, 0.0]) < 1e-9 * np.abs(nodes).max()
        return near & near[:, :1]

    return fixed
