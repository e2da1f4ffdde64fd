"""Multi-blade coordinates: the motions of N equal blades as collective, cosine, sine and differential ones.

Blade k = 0 … N − 1 is at the azimuth ψ_k = ψ + 2πk/N, positive about the rotor's axis. Its coordinate is

    q_k = z_0 + Σ_m (z_mc cos mψ_k + z_ms sin mψ_k) + z_d (−1)^k,    m = 1 … (N − 1)/2 rounded down,

with the last term if N is even. In z, a rotor is seen from its support. (Coleman and Feingold 1958; Johnson, *Helicopter
Theory*, 1980, sec. 8-3; Bir, NREL/CP-500-42553, 2008.) With q = T z, dT/dψ = T R and R constant:

    q̇ = T (ż + Ω R z),    q̈ = T (z̈ + 2 Ω R ż + Ω² R² z).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]

MIN_BLADES = 3
"""Fewer blades have no multi-blade coordinates in which a rotor on an elastic support has constant equations: those of two
blades are collective and differential, and turn with the rotor."""


def names(blades: int) -> tuple[str, ...]:
    """Names of the N multi-blade coordinates: ``collective``, ``cosine``, ``sine`` …, ``differential``."""
    harmonics = _harmonics(blades)
    numbers = ["" if m == 1 else f" {m}" for m in range(1, harmonics + 1)]
    pairs = [f"{name}{number}" for number in numbers for name in ("cosine", "sine")]
    return ("collective", *pairs, *(("differential",) if blades % 2 == 0 else ()))


def transformation(psi: ArrayLike, blades: int) -> Array:
    """T (…, N, N) at azimuths ψ (…), rad: coordinates of the blades from multi-blade ones."""
    harmonics = _harmonics(blades)
    azimuth = np.asarray(psi, float)[..., None] + 2.0 * np.pi * np.arange(blades) / blades
    columns: list[Array] = [np.ones_like(azimuth)]
    for m in range(1, harmonics + 1):
        columns += [np.cos(m * azimuth), np.sin(m * azimuth)]
    if blades % 2 == 0:
        columns.append(np.zeros_like(azimuth) + (-1.0) ** np.arange(blades))
    return np.stack(columns, axis=-1)


def inverse(psi: ArrayLike, blades: int) -> Array:
    """T⁻¹ (…, N, N): its rows are means over the blades, weighted by 1, 2 cos mψ_k, 2 sin mψ_k and (−1)^k."""
    T = transformation(psi, blades)
    return np.swapaxes(T, -1, -2) / (T**2).sum(-2)[..., None]


def rate(blades: int) -> Array:
    """R (N, N) with dT/dψ = T R, the same at every azimuth."""
    R = np.zeros((blades, blades))
    for m in range(1, _harmonics(blades) + 1):
        c, s = 2 * m - 1, 2 * m
        R[c, s], R[s, c] = m, -m  # (cos mψ)′ = −m sin mψ, (sin mψ)′ = m cos mψ
    return R


@dataclass(frozen=True)
class Blades:
    """Which of n coordinates belong to the blades of a rotor.

    Attributes:
        size: n.
        groups: (g, N) indices of the coordinates of equal name on blades 0 … N − 1, in the order of their azimuths.
    """

    size: int
    groups: Index

    @property
    def number(self) -> int:
        """N, the number of blades."""
        return self.groups.shape[1]

    def transformation(self, psi: ArrayLike) -> Array:
        """T (…, n, n) of all coordinates: the unit matrix for those of no blade."""
        return self._spread(transformation(psi, self.number), 1.0)

    def inverse(self, psi: ArrayLike) -> Array:
        """T⁻¹ (…, n, n) of all coordinates."""
        return self._spread(inverse(psi, self.number), 1.0)

    def rate(self) -> Array:
        """R (n, n) of all coordinates: zero for those of no blade."""
        return self._spread(rate(self.number), 0.0)

    def _spread(self, small: Array, otherwise: float) -> Array:
        out = np.zeros((*small.shape[:-2], self.size, self.size))
        ungrouped = np.setdiff1d(np.arange(self.size), self.groups)
        out[..., ungrouped, ungrouped] = otherwise
        for group in self.groups:
            out[..., group[:, None], group] = small
        return out


def blades_of(size: int, groups: Sequence[Sequence[int]]) -> Blades:
    """``Blades`` of n = ``size`` coordinates, checked.

    Raises:
        ValueError: groups of different lengths, fewer than three blades, or a coordinate in two groups.
    """
    lengths = {len(group) for group in groups}
    if len(lengths) != 1 or min(lengths) < MIN_BLADES:
        raise ValueError(
            f"groups: of {sorted(lengths)} blades: each needs one coordinate of every blade, of at least 3"
        )
    index = np.array(groups, dtype=np.intp)
    if len(np.unique(index)) < index.size or index.min() < 0 or index.max() >= size:
        raise ValueError("groups: a coordinate is in two groups, or does not exist")
    return Blades(size, index)


def second_order(
    M: Array, C: Array, K: Array, psi: ArrayLike, omega: float, blades: Blades
) -> tuple[Array, Array, Array]:
    """M, C, K (…, n, n) at azimuths ψ (…), rad, in multi-blade coordinates at the speed Ω = ``omega`` (rad/s).

    Equations are transformed by Tᵀ, so that symmetric matrices remain symmetric.
    """
    T, R = blades.transformation(psi), omega * blades.rate()
    transposed = np.swapaxes(T, -1, -2)
    mass, damping = transposed @ M @ T, transposed @ C @ T
    return mass, damping + 2.0 * mass @ R, transposed @ K @ T + damping @ R + mass @ R @ R


def first_order(A: Array, psi: ArrayLike, omega: float, positions: Blades, rates: Index) -> Array:
    """State matrix A (…, s, s) of ẋ = A x at azimuths ψ (…), in multi-blade coordinates.

    Args:
        A: the state matrix; its states are positions, their rates and first-order states, in any order.
        psi: azimuths of blade 0, rad.
        omega: rotor speed, rad/s.
        positions: groups of the blades' positions and first-order states.
        rates: (r, 2) index of a position and of its rate; the blades' first-order states are in no row.
    """
    rate_of: dict[int, int] = {int(p): int(v) for p, v in np.asarray(rates, dtype=np.intp).reshape(-1, 2)}
    velocities = [[rate_of[int(k)] for k in group] for group in positions.groups if int(group[0]) in rate_of]
    T, inv, R = positions.transformation(psi), positions.inverse(psi), positions.rate()
    for group in velocities:
        index = np.array(group, dtype=np.intp)
        T[..., index[:, None], index] = transformation(psi, positions.number)
        inv[..., index[:, None], index] = inverse(psi, positions.number)
        R[np.ix_(index, index)] = rate(positions.number)
    # x = T (z + Ω S z) with S from positions to their rates; see q̇ above
    S = np.zeros_like(R)
    for group in positions.groups:
        if int(group[0]) in rate_of:
            index = np.array([rate_of[int(k)] for k in group], dtype=np.intp)
            S[np.ix_(index, group)] = rate(positions.number)
    unit = np.eye(len(R))
    to_z, of_z = unit - omega * S, unit + omega * S  # S² = 0
    return to_z @ (inv @ A @ T - omega * R) @ of_z


def _harmonics(blades: int) -> int:
    """Number of pairs of cosine and sine coordinates."""
    return (blades - 1) // 2
