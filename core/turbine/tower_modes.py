"""The modes of a tower on its foundation, named by their motion or, if the base moves most, by that of the platform."""

from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import participation
from ..modes import Modes
from ..spectrum.lanczos import lanczos
from ..steady.blade_state import Steady
from ..threads import one_thread
from ..tree.links import twists
from ..tree.mode_shapes import mode_shapes
from ..tree.pencil import on_nodes
from .tower import Support, Tower, standing, tower_mesh

Array = NDArray[np.float64]

ELEMENTS = 48
"""Elements of a tower; half of them, too, for the uncertainty."""

SAFETY = 3.0
"""Factor from a change under refinement to the uncertainty of a frequency."""

PLATFORM = ("heave", "sway", "surge", "yaw", "pitch", "roll")
"""Names of the base's motions along and about x (up), y and z (downwind)."""

NAMES = ("fore-aft", "side-side", "torsion", "axial")
"""Names of a tower's motions in the order of ``participation.FAMILIES``."""


@dataclass(frozen=True)
class TowerModes:
    """The lowest modes of a tower.

    Attributes:
        frequencies: (m,) rad/s, ascending.
        names: (m,) as ``1st fore-aft``; ``platform surge`` if more than half of the elastic energy is that of the base.
        confidence: (m,) part of the kinetic energy in the motion that names each mode, or of the elastic energy in the base.
        uncertainty: (m,) relative numerical uncertainty.
    """

    frequencies: Array
    names: tuple[str, ...]
    confidence: Array
    uncertainty: Array


def tower_modes(tower: Tower, count: int = 6) -> TowerModes:
    """The ``count`` lowest modes.

    Raises:
        ValueError: a stiffness is not symmetric or not positive, or a spring is not on the tower.
        SteadyStateError, UnstableError: the tower does not carry the weight.
    """
    with one_thread():
        coarse, _ = _solved(tower, ELEMENTS // 2, count)
        fine, base = _solved(tower, ELEMENTS, count)
    fractions = participation.participation(fine, tower.beam)
    confidence, names = fractions.max(1), []
    occurrences: Counter[str] = Counter()
    for k, family in enumerate(fractions.argmax(1).tolist()):
        if base[:, k].sum() > 0.5:
            confidence[k] = base[:, k].sum()
            names.append(f"platform {PLATFORM[int(base[:, k].argmax())]}")
            continue
        occurrences[NAMES[family]] += 1
        names.append(f"{ordinal(occurrences[NAMES[family]])} {NAMES[family]}")
    change = SAFETY * np.abs(coarse.frequencies / fine.frequencies - 1.0)
    return TowerModes(fine.frequencies, tuple(names), confidence, change)


def _solved(tower: Tower, elements: int, count: int) -> tuple[Modes, Array]:
    """The modes, and the part (6, m) of their elastic energy in each direction of the base's stiffness."""
    mesh = tower_mesh(tower.beam, tower.support, elements)
    state = standing(mesh, tower, elements)
    lowest = lanczos(state.pencil, count)
    shapes = mode_shapes(mesh, state.shape, on_nodes(state.pencil, lowest.vectors))
    motions = lowest.vectors.T
    phase = motions[np.arange(len(motions)), np.abs(motions).argmax(1)]
    real = np.real(motions * (np.abs(phase) / phase)[:, None])  # of unit elastic energy
    base = base_energy(tower.support, state, real, np.eye(len(real), dtype=complex))
    return Modes(0.0, lowest.frequencies, shapes, mesh.elements), base


def base_energy(support: Support, state: Steady, vectors: Array, motions: NDArray[np.complex128]) -> Array:
    """(6, m) twice the energy of the base's stiffness in sums (r, m) of vectors (r, dn), by direction; 0 if it is clamped."""
    foot = len(support.free)
    if not foot:
        return np.zeros((6, motions.shape[1]))
    axes = state.shape.nodes[foot, :3, :3]
    own = twists(state.pencil.links, vectors)[:, foot - 1, :6].reshape(-1, 2, 3)
    base_motions = (own @ axes.T).reshape(-1, 6).T @ motions
    K = support.finite
    total = np.einsum("im,ij,jm->m", base_motions.conj(), K, base_motions).real
    parts = np.diagonal(K)[:, None] * np.abs(base_motions) ** 2
    return parts * (total / np.maximum(parts.sum(0), np.finfo(float).tiny))


def ordinal(number: int) -> str:
    """``1st``, ``2nd``, ``3rd``, ``4th`` …"""
    suffix = "th" if 10 <= number % 100 <= 20 else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{suffix}"
