"""Pairing of the modes of two codes by mass-weighted shape, never by number.

The modal assurance criterion (Allemang and Brown, 1982) uses the mass as the metric, so that displacements and rotations can
be added: ``MAC = |aᴴWb|² / (aᴴWa · bᴴWb)``. For a blade, ``W`` holds, at each common station, the 4×4 mass of the blade near
it, for the three displacements and the rotation about x; for a mechanism, the mass matrix over its coordinates. Shapes are
complex: gyroscopic phase differences affect the MAC.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.optimize import linear_sum_assignment

from ...core.blade import Blade
from ...core.modes import STATIONS, Modes
from ...core.sampling import mass_at, twist_at
from ...core.space import gauss
from .spectrum import Spectrum, on_common

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

LEAST_MAC = 0.8
"""Below this MAC two shapes are not the same mode (customary value; at 0.8 the angle between them is 27°)."""

RIVAL_MAC = 0.5
"""A second candidate with at least this MAC makes a pairing ambiguous and is noted."""

ALIKE = 0.05
"""A candidate is no rival if its MAC exceeds that of its own partner, another mode of the reference, by less than this."""

DEGENERATE = 2e-3
"""Relative frequency gap below which codes may return different linear combinations of two shapes."""

DOUBLE = 1e-7
"""Relative frequency gap below which any combination of two shapes is as good as another."""

DEPENDENT = 1e12
"""Condition number of shapes' products above which they are linearly dependent."""


@dataclass(frozen=True)
class Pair:
    """The partner of one mode.

    Attributes:
        mode: index among the other code's modes; None if there is no partner.
        mac: of the two shapes, or of the two subspaces (cos² of the largest principal angle).
        note: remarks: compared as a subspace, ambiguous, or why there is no partner.
        ambiguous: whether the other code has a mode of nearly the same shape at another frequency.
    """

    mode: int | None
    mac: float
    note: str = ""
    ambiguous: bool = False


def weights(blade: Blade) -> Array:
    """Metric ``W`` (21, 4, 4): mass at the common stations, kg, kg m and kg m², in blade axes, with the tip mass.

    A slice of the blade is divided between the two nearest common stations by the lever rule.
    """
    between, weight = gauss.between(np.union1d(blade.stations, STATIONS * blade.length), 3)
    s = np.append(between, blade.length)
    mass = np.concatenate([weight.reshape(-1, 1, 1) * mass_at(blade, s[:-1]), blade.tip_mass[None]])[:, :4, :4]
    angle = twist_at(blade, s) + blade.pitch
    cos, sin = np.cos(angle), np.sin(angle)
    rotation = np.zeros((len(s), 4, 4))  # section axes → blade axes, for (x, y, z, rotation about x)
    rotation[:, 0, 0] = rotation[:, 3, 3] = 1.0
    rotation[:, 1, 1] = rotation[:, 2, 2] = cos
    rotation[:, 1, 2], rotation[:, 2, 1] = -sin, sin
    shares = np.maximum(0.0, 1.0 - np.abs(s / blade.length - STATIONS[:, None]) / STATIONS[1])
    return np.einsum("ns,sij->nij", shares, rotation @ mass @ rotation.swapaxes(1, 2))


def mac(a: Complex, b: Complex, weight: Array) -> Array:
    """MAC (m, k) of shapes ``a`` (m, s, n) with ``b`` (k, s, n); 0 where a shape has no modal mass."""
    momenta = [_momenta(shapes, weight) for shapes in (a, b)]
    norms = np.outer(*(_norm(shapes, momentum) for shapes, momentum in zip((a, b), momenta, strict=True)))
    cross = _products(a, momenta[1])
    return np.divide(np.abs(cross) ** 2, norms, out=np.zeros_like(norms), where=norms > 0)


def _momenta(shapes: Complex, weight: Array) -> Complex:
    return (weight @ shapes[..., None])[..., 0]


def _products(shapes: Complex, momenta: Complex) -> Complex:
    """(m, k) of shapes (m, s, n) with momenta W b (k, s, n)."""
    return np.tensordot(shapes.conj(), momenta, ((1, 2), (1, 2)))


def _norm(shapes: Complex, momenta: Complex) -> Array:
    return (shapes.conj() * momenta).sum((1, 2)).real


def groups(frequencies: Array, gap: float = DEGENERATE) -> list[list[int]]:
    """Indices of ascending frequencies, grouped so that neighbours closer than ``gap`` (relative) are together."""
    out: list[list[int]] = []
    for k, f in enumerate(frequencies):
        if out and f - frequencies[k - 1] <= gap * f:
            out[-1].append(k)
        else:
            out.append([k])
    return out


def aligned(modes: Modes, weight: Array) -> Modes:
    """The same modes, with shapes of equal frequency combined so that each moves along one axis where possible.

    The basis of a degenerate eigenspace is arbitrary; the modes that diagonalise the flapwise mass can be named.
    """
    shapes = modes.shapes.copy()
    for group in groups(modes.frequencies, DOUBLE):
        if len(group) > 1:
            flap = np.einsum("ms,s,ks->mk", shapes[group, :, 2].conj(), weight[:, 2, 2], shapes[group, :, 2])
            mass = _products(shapes[group], _momenta(shapes[group], weight))
            if np.linalg.cond(mass) < DEPENDENT:
                shapes[group] = np.einsum("mk,msi->ksi", eigh(flap, mass)[1], shapes[group])
    return replace(modes, shapes=shapes)


def pair(reference: Spectrum, answer: Spectrum, indices: Sequence[int], min_mac: float = LEAST_MAC) -> list[Pair]:
    """Partners in ``answer`` of the reference's modes ``indices``, by the shapes over their common degrees of freedom.

    One assignment over all modes of both maximises the sum of MACs. Modes of the same eigenvalue are compared as a subspace and
    matched in order of frequency; so are modes of nearly the same frequency if the MAC of one of them is below ``min_mac``, the
    MAC below which two shapes are not partners.
    """
    reference_shapes, answer_shapes, weight = on_common(reference, answer)
    table = mac(reference_shapes, answer_shapes, weight)
    rows, columns = linear_sum_assignment(-table)
    partner = dict(zip(rows.tolist(), columns.tolist(), strict=True))
    own = mac(reference_shapes, reference_shapes, weight)
    similarity = np.zeros_like(table)  # MAC of each mode with the reference's mode whose partner a column is
    similarity[:, columns] = own[:, rows]
    frequencies, pairs = reference.frequencies, dict[int, Pair]()
    for group in groups(frequencies):
        values = reference.values[group]
        is_multiple = float(np.abs(values - values[0]).max()) <= DOUBLE * frequencies[group[-1]]
        if is_multiple or any(table[k, partner[k]] < min_mac for k in group if k in partner):
            pairs.update(_as_subspace(group, partner, reference_shapes, answer_shapes, weight, min_mac))
    return [
        pairs.get(k) or _alone(table[k], similarity[k], partner.get(k), answer.frequencies, min_mac) for k in indices
    ]


def _as_subspace(
    group: list[int],
    partner: dict[int, int],
    reference_shapes: Complex,
    answer_shapes: Complex,
    weight: Array,
    min_mac: float,
) -> dict[int, Pair]:
    if len(group) == 1 or not all(k in partner for k in group):
        return {}
    modes = sorted(partner[k] for k in group)
    likeness = _subspace(reference_shapes[group], answer_shapes[modes], weight)
    if likeness < min_mac:
        return {}
    note = f"compared as a subspace of {len(group)} close modes"
    return {k: Pair(mode, likeness, note) for k, mode in zip(group, modes, strict=True)}


def _alone(row: Array, similarity: Array, mode: int | None, frequencies: Array, min_mac: float) -> Pair:
    if not len(row):
        return Pair(None, 0.0, "no partner: the code returned no modes")
    if mode is None or row[mode] < min_mac:
        best = int(row.argmax())
        nearest = f"its most similar mode, at {frequencies[best]:.6g} rad/s, has MAC {row[best]:.2f}"
        return Pair(None, float(row[best]), f"no partner: {nearest}")
    rivals = np.delete(np.where(row <= similarity + ALIKE, 0.0, row), mode)
    if rivals.max(initial=0.0) < RIVAL_MAC:
        return Pair(mode, float(row[mode]))
    second = float(np.delete(frequencies, mode)[rivals.argmax()])
    is_distinct = abs(second - frequencies[mode]) > DEGENERATE * second
    return Pair(
        mode, float(row[mode]), f"ambiguous: MAC {rivals.max():.2f} with {second:.6g} rad/s too", bool(is_distinct)
    )


def _subspace(a: Complex, b: Complex, weight: Array) -> float:
    """cos² of the largest principal angle between two subspaces of equal dimension; 0 if shapes are linearly dependent.

    The eigenvalues of ``(aᴴWa)⁻¹ aᴴWb (bᴴWb)⁻¹ bᴴWa`` are the cos² of all angles (Hotelling, 1936: canonical correlations).
    """
    own_a, own_b, cross = (_products(x, _momenta(y, weight)) for x, y in ((a, a), (b, b), (a, b)))
    if max(np.linalg.cond(own) for own in (own_a, own_b)) > DEPENDENT:
        return 0.0
    squares = np.linalg.eigvals(np.linalg.solve(own_a, cross) @ np.linalg.solve(own_b, cross.conj().T)).real
    return float(squares.min().clip(0.0, 1.0))
