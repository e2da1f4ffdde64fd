"""Turbines of two blades against Exudyn, which linearises the whole machine at several azimuths.

Of core nothing is used but the description of the turbine: Hill's equations are assembled here from the Fourier coefficients of
Exudyn's matrices, and solved directly. A frequency of theirs is that of core plus a multiple of Ω.
"""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse import linalg as spla

from southwell import multibody as mb
from southwell.core.turbine.machine import FINER, machine
from southwell.core.turbine.turbine import Drivetrain, Teeter, Turbine
from southwell.core.turbine.turbine_modes import turbine_modes
from southwell.references.exudyn import tower_weight, turbine
from southwell.references.exudyn.hinged_segments import hinge_segments
from southwell.references.exudyn.tree import linearize
from southwell.references.theories import turbine_motion
from southwell.references.theories.turbine_tree import NOTHING, TurbineTree
from southwell.tests.support.turbines import small

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

pytest.importorskip("exudyn")

OMEGA = 4.0

AZIMUTHS, HARMONICS, MOTIONS = 6, 8, 24
"""Azimuths of a revolution at which Exudyn linearises, harmonics of a mode on both sides, and motions of each sign."""

ELEMENTS = (14, 21)

RATIO = ELEMENTS[1] / ELEMENTS[0]

FLAT = mb.inertia(200.0, (5.0, 50.0, 45.0))
"""A hub that is not symmetric about the shaft."""


def teetering(tree: TurbineTree, teeter: Teeter) -> TurbineTree:
    """The tree with a joint about y between the shaft and the hub, whose centre is upwind of the joint."""
    new, to_hinge = tree.hub + 1, np.array([0.0, 0.0, teeter.undersling])
    first = tree.blades[:, 0]
    offset = tree.offset.copy()
    offset[first] -= to_hinge
    parent = np.where(tree.parent >= new, tree.parent + 1, tree.parent)
    parent[first] = new
    bodies = [*tree.bodies]
    bodies[tree.hub], hub = NOTHING, bodies[tree.hub].moved(-to_hinge, np.eye(3))
    stiffness = np.insert(np.insert(tree.stiffness, new, 0.0, 0), new, 0.0, 1)
    stiffness[new, new] = teeter.stiffness
    return replace(
        tree,
        strain=np.insert(tree.strain, new, 4),
        parent=np.insert(parent, new, tree.hub),
        offset=np.insert(offset, new, to_hinge, 0),
        axes=np.insert(tree.axes, new, np.eye(3), 0),
        bodies=(*bodies[:new], hub, *bodies[new:]),
        stiffness=stiffness,
        blades=tree.blades + 1,
    )


def fourier(machine: Turbine, elements: int) -> tuple[Complex, Array]:
    """(h, 3, n, n) coefficients of M, C, K over the azimuth, and the sign (n,) of each coordinate half a revolution later.

    The coordinates of the blades are their sums and differences.
    """
    segments = hinge_segments(machine.blade, elements, OMEGA, equal=True)
    tree = turbine._tree(machine, segments, elements)
    hinge = [tree.hub + 1] if machine.teeter else []
    if machine.teeter:
        tree = teetering(tree, machine.teeter)
    q = np.zeros(len(tree.strain))
    q[tree.tower], weight = tower_weight.standing(tree)
    q[tree.blades] = linearize(segments, OMEGA)[3]
    parts = []
    for psi in 2.0 * np.pi * np.arange(AZIMUTHS) / AZIMUTHS:
        M, C, K = turbine._linearized(tree, q, OMEGA, psi)
        K[np.ix_(tree.tower, tree.tower)] += weight
        parts.append(turbine_motion.with_generator(tree, q, M, C, K))
    blades = tree.blades - 1  # the azimuth has no row
    T, signs = np.eye(len(parts[0][0])), np.ones(len(parts[0][0]))
    for one, other in blades.T:
        T[np.ix_([one, other], [one, other])] = np.array([[1.0, 1.0], [1.0, -1.0]]) / np.sqrt(2.0)
    signs[[*blades[1], *(k - 1 for k in hinge)]] = -1.0
    return np.fft.fft(T.T @ np.array(parts) @ T, axis=0) / AZIMUTHS, signs


def restricted(coefficients: Complex, signs: Array) -> tuple[Complex, Array]:
    """The coefficients and signs for the lowest motions of the mean machine."""
    M, _, K = coefficients[0].real
    X = np.zeros((len(signs), 2 * MOTIONS))
    for k, sign in enumerate((1.0, -1.0)):
        own = np.flatnonzero(signs == sign)
        # the inverse problem: links without inertia have infinite frequencies, a rotor that turns freely has none
        mass, stiffness = M[np.ix_(own, own)], (K + OMEGA**2 * M)[np.ix_(own, own)]
        top = [len(own) - MOTIONS, len(own) - 1]
        X[own, k * MOTIONS : (k + 1) * MOTIONS] = scipy.linalg.eigh(mass, stiffness, subset_by_index=top)[1]
    return X.T @ coefficients @ X, np.repeat([1.0, -1.0], MOTIONS)


def hill(coefficients: Complex, signs: Array, parity: float) -> tuple[Complex, Complex, Complex]:
    """The matrices of ``λ² A₂ + λ A₁ + A₀`` for the harmonics of one parity."""
    orders, size = np.arange(-HARMONICS, HARMONICS + 1), len(signs)
    A = np.zeros((3, len(orders), size, len(orders), size), np.complex128)
    for j, row in enumerate(orders):
        for k, column in enumerate(orders):
            if abs(row - column) < AZIMUTHS / 2:
                rate = 1j * column * OMEGA
                m, c, s = coefficients[row - column]
                A[0, j, :, k], A[1, j, :, k], A[2, j, :, k] = s + rate * c + rate**2 * m, c + 2.0 * rate * m, m
    kept = np.flatnonzero((-1.0) ** orders[:, None] * signs == parity)
    A0, A1, A2 = A.reshape(3, len(orders) * size, -1)[:, kept[:, None], kept]
    return A0, A1, A2


def nearest(coefficients: Complex, signs: Array, frequencies: Array) -> Complex:
    """(m,) solutions of Hill's equations that are nearest to the frequencies (m,)."""
    out = np.full((2, len(frequencies)), np.inf + 0j)
    reduced = restricted(coefficients, signs)
    for row, parity in zip(out, (1.0, -1.0), strict=True):
        A0, A1, A2 = hill(*reduced, parity)
        unit, start = sp.eye_array(len(A0)), np.random.default_rng(0).standard_normal(2 * len(A0)) + 0j
        pencil = sp.block_array([[None, unit], [-A0, -A1]], format="csc"), sp.block_diag([unit, A2], format="csc")
        for k, shift in enumerate(1j * frequencies):
            row[k] = spla.eigs(pencil[0], 1, pencil[1], shift, v0=start, return_eigenvectors=False)[0]
    return out[np.abs(out - 1j * frequencies).argmin(0), np.arange(len(frequencies))]


@pytest.mark.slow
@pytest.mark.parametrize(
    "machine_of_two",
    [
        replace(small(4e6, Drivetrain(2e6, 0.3, 20.0, True), blades=2), hub=FLAT),
        replace(small(4e6, Drivetrain(2e6), blades=2), teeter=Teeter(0.3, 1e4), hub=FLAT),
    ],
    ids=["fixed hub", "underslung teeter"],
)
def test_two_blades_are_those_of_exudyn(machine_of_two: Turbine) -> None:
    modes = turbine_modes(machine(machine_of_two, FINER), OMEGA, 6)
    fine = nearest(*fourier(machine_of_two, ELEMENTS[1]), modes.frequencies)
    expected = modes.frequencies + RATIO**2 * (fine.imag - modes.frequencies)  # of second order
    coarse = nearest(*fourier(machine_of_two, ELEMENTS[0]), expected)
    assert np.abs([coarse.real, fine.real]).max() < 1e-6 * OMEGA
    converged = fine.imag + (fine - coarse).imag / (RATIO**2 - 1.0)
    np.testing.assert_allclose(converged, modes.frequencies, rtol=3e-5)
