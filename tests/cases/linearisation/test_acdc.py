"""Frequencies and damping against ACDC's method, written again from its published source.

ACDC (OpenFAST/acdc, ``lin/mbc.go`` and ``lin/mat_data.go``): states in the order displacements, rates, first order; those that
are flagged as rotating form triplets if descriptions, without what is in parentheses, differ in the blade's number alone; Bir's
equation 29 at each azimuth without angular acceleration; the mean; eigenvalues with positive imaginary part.
"""

import os
import re
from pathlib import Path
from typing import cast

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import block_diag

from southwell.cases.linearisation.lin_file import read
from southwell.cases.linearisation.modes import spectrum
from southwell.cases.linearisation.sets import AzimuthSet, collect
from southwell.cases.linearisation.states import State

Array = NDArray[np.float64]

FOLDER = os.environ.get("SOUTHWELL_LINEARISED")

pytestmark = pytest.mark.skipif(not FOLDER, reason="set SOUTHWELL_LINEARISED to public linearisations")

_BLADE = re.compile(r"(blade\s+|blade root |PitchBearing|BD_|BD)(\d)", re.IGNORECASE)


def ordered(states: tuple[State, ...], indices: list[int]) -> tuple[list[int], int]:
    """States of one kind, fixed ones first, then triplets of blades; and the number of triplets."""
    plain = {re.sub(r"\s*\([^)]*\)", "", states[k].text): k for k in indices if states[k].rotating}
    fixed = [k for k in indices if not states[k].rotating]
    triplets: list[int] = []
    for text in list(plain):
        match = _BLADE.search(text)
        if text not in plain or not match:
            continue
        names = [text.replace(match[0], f"{match[1]}{blade}", 1) for blade in (1, 2, 3)]
        members = [plain.pop(name) for name in names if name in plain]
        if len(members) == 3:
            triplets += members
        else:
            fixed += members
    return fixed + triplets, len(triplets) // 3


def eigenvalues(azimuth_set: AzimuthSet) -> NDArray[np.complex128]:
    """Of the mean of the matrices in the fixed frame, by ACDC's method."""
    rates = [k for k, state in enumerate(azimuth_set.states) if state.rate]
    first = [k for k, state in enumerate(azimuth_set.states) if state.order == 1]
    q = [k for k in range(len(azimuth_set.states)) if k not in rates and k not in first]
    (x2, n2), (x2dot, _), (x1, n1) = (ordered(azimuth_set.states, kept) for kept in (q, rates, first))
    order = [*x2, *x2dot, *x1]
    f2, f1 = len(x2) - 3 * n2, len(x1) - 3 * n1
    total = np.zeros((len(order), len(order)))
    for A, psi, file in zip(azimuth_set.A, azimuth_set.azimuths, azimuth_set.files, strict=True):
        angles, omega = psi + 2 * np.pi * np.arange(3) / 3, file.rotor_speed
        c, s, ones = np.cos(angles), np.sin(angles), np.ones(3)
        t, t2, t3 = (np.stack(columns, axis=-1) for columns in ((ones, c, s), (0 * ones, -s, c), (0 * ones, -c, -s)))

        def spread(fixed: Array, small: Array, count: int) -> Array:
            return np.asarray(block_diag(fixed, *[small] * count))

        T1, T1q = spread(np.eye(f2), t, n2), spread(np.eye(f1), t, n1)
        T2, T3, T2q = (spread(np.zeros((f, f)), small, n) for f, small, n in ((f2, t2, n2), (f2, t3, n2), (f1, t2, n1)))
        L, R = (
            cast("Array", block_diag(*parts)) for parts in ((T1, T1, T1q), (omega * T2, 2 * omega * T2, omega * T2q))
        )
        n = len(x2)
        L[n : 2 * n, :n], R[n : 2 * n, :n] = omega * T2, omega**2 * T3
        inverse = np.linalg.inv(cast("Array", block_diag(T1, T1, T1q)))
        total += inverse @ (A[np.ix_(order, order)] @ L - R)
    return cast("NDArray[np.complex128]", np.linalg.eigvals((total / len(azimuth_set.A)).astype(np.complex128)))


@pytest.mark.parametrize(
    "pattern",
    [
        "nrel5mw/blade-only/*.lin",
        "nrel5mw/rotating/*.lin",
        "nrel5mw/5MW_Land_BD_Linear.1.lin",
        "iea15-semi/*.lin",
    ],
)
def test_frequencies_and_damping_are_acdcs(pattern: str) -> None:
    (azimuth_set,) = collect([read(path) for path in sorted(Path(FOLDER or "").glob(pattern))])
    values = eigenvalues(azimuth_set)
    values = values[values.imag > 1e-6 * max(1.0, np.abs(values).max())]
    own = np.array([mode.eigenvalue for mode in spectrum(azimuth_set, azimuth_set.A).modes], dtype=np.complex128)
    own = own[own.imag > 1e-6 * max(1.0, np.abs(own).max())]
    assert len(own) == len(values)
    distance = np.abs(own[:, None] - values[None, :]).min(axis=1) / np.abs(own)
    assert distance.max() < 1e-10
