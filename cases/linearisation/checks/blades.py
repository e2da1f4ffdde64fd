"""Checks that the blades are equal: entries of A of each blade as one function of its own azimuth."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..findings import DEFECT, Finding, listed
from ..sets import AzimuthSet
from ..states import STRUCTURAL

Array = NDArray[np.float64]

MIN_DIFFERENCE = 0.01
"""Smallest difference between blades that is reported, relative to the entry."""

MIN_COUPLING = 1e-3
"""Couplings smaller than this, relative to the stiffnesses that they couple, are left out."""


@dataclass(frozen=True)
class Difference:
    """An entry of M⁻¹K that differs between blades.

    Attributes:
        row, column: families of the coupled motions.
        blade: the blade that differs from the two others.
        ratio: its entry relative to theirs.
        weight: size of the entry relative to the stiffnesses that it couples.
    """

    row: str
    column: str
    blade: int
    ratio: float
    weight: float


def differences(azimuth_set: AzimuthSet) -> tuple[Difference, ...]:
    """Entries of the blades' stiffness that are not one function of the blade's azimuth."""
    if azimuth_set.blades != 3 or len(azimuth_set.files) < 2:
        return ()
    groups = [
        g
        for g in azimuth_set.groups
        if not g.rate and g.derivative and azimuth_set.states[g.members[0]].module in STRUCTURAL
    ]
    psi = azimuth_set.blade_azimuths
    diagonal = [
        np.mean([np.abs(azimuth_set.A[:, v, q]).mean() for v, q in zip(g.derivative or (), g.members, strict=True)])
        for g in groups
    ]
    out = []
    for i, a in enumerate(groups):
        for j, b in enumerate(groups):
            rows, columns = a.derivative or (), b.members
            values = np.array([azimuth_set.A[:, v, q] for v, q in zip(rows, columns, strict=True)]).T
            half_unit = float(
                np.max([azimuth_set.half_unit[:, v, q].max() for v, q in zip(rows, columns, strict=True)])
            )
            size = float(np.sqrt(diagonal[i] * diagonal[j]))
            mean = np.abs(values).mean()
            if not size or mean < MIN_COUPLING * size:
                continue
            odd = _odd_blade(psi, values, half_unit)
            if odd:
                blade, ratio = odd
                out.append(
                    Difference(
                        _family(azimuth_set, a.members[0]),
                        _family(azimuth_set, b.members[0]),
                        blade,
                        ratio,
                        mean / size,
                    )
                )
    return tuple(out)


def _family(azimuth_set: AzimuthSet, member: int) -> str:
    state = azimuth_set.states[member]
    return state.label.partition(" of blade")[0]


def _odd_blade(psi: Array, values: Array, half_unit: float) -> tuple[int, float] | None:
    """The blade whose mean differs from the others', and its ratio to theirs; None if the blades are equal."""
    means = _means(psi, values)
    if means is None:
        return None
    own, residual = means
    odd = int(np.argmax([abs(own[k] - np.delete(own, k).mean()) for k in range(3)]))
    others = np.delete(own, odd)
    difference = abs(own[odd] - others.mean())
    noise = np.ptp(others) + residual / len(values) + 2 * half_unit
    if difference < 3 * noise or difference < MIN_DIFFERENCE * abs(others.mean()):
        return None
    return odd + 1, float(own[odd] / others.mean()) if others.mean() else float("inf")


def _means(psi: Array, values: Array) -> tuple[Array, float] | None:
    """Means of the three blades over the azimuth, and the residual, from harmonics that the blades have in common."""
    blade = np.tile(np.eye(3), (len(values), 1))
    for harmonics in (2, 1):
        h = np.arange(1, harmonics + 1)
        basis = np.column_stack([blade, np.cos(np.outer(psi, h)), np.sin(np.outer(psi, h))])
        if len(psi) > basis.shape[1] and np.linalg.cond(basis) < 30:
            coefficients = np.asarray(np.linalg.lstsq(basis, values.ravel(), rcond=None)[0], dtype=np.float64)
            residual = values.ravel() - basis @ coefficients
            return coefficients[:3], float(np.abs(residual).max())
    return None


def equality(differences: tuple[Difference, ...], azimuth_set: AzimuthSet) -> Iterator[Finding]:
    """A blade whose stiffness or coupling differs from the others'."""
    stiff = [d for d in differences if d.row == d.column]
    reversed_sign = [d for d in differences if d.row != d.column and d.ratio < -0.5]
    if reversed_sign and not any(abs(d.ratio - 1) > 0.03 for d in stiff):
        d = max(reversed_sign, key=lambda d: d.weight)
        yield Finding(
            "pitch reversed",
            DEFECT,
            f"blade {d.blade}: the coupling of {d.row} and {d.column} has the opposite sign (ratio {d.ratio:.2f}), its "
            "stiffnesses are equal",
            "its pitch or twist turns the other way: check the pitch axis and the initial pitch of the blades",
            d.ratio,
        )
    elif stiff:
        d = max(stiff, key=lambda d: abs(d.ratio - 1))
        entries = listed(sorted({f"{e.row} {100 * (e.ratio - 1):+.1f} %" for e in stiff if e.blade == d.blade}))
        yield Finding(
            "unequal blades",
            DEFECT,
            f"blade {d.blade} is stiffer than the others by {entries}"
            if d.ratio > 1
            else f"blade {d.blade} is softer than the others by {entries}",
            "check the blade files; multi-blade coordinates assume equal blades",
            d.ratio - 1,
        )
    elif differences:
        d = max(differences, key=lambda d: d.weight)
        yield Finding(
            "unequal blades",
            DEFECT,
            f"blade {d.blade}: the coupling of {d.row} and {d.column} is {d.ratio:.2f} times that of the others",
            "check the blade files; multi-blade coordinates assume equal blades",
            d.ratio,
        )
