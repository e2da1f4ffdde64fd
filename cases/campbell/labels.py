"""Labels of tracked modes: one per track, with the family at a speed where the dominant motion has changed."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from ...core.blade import Blade
from ...core.participation import families, numbered, participation
from ..judge.pairing import Array
from .tracking import Tracks


@dataclass(frozen=True)
class Labels:
    """Labels of tracks.

    Attributes:
        names: (t,) name of each track: family and number within it at the first speed of the track, ``flapwise 2``.
        families: (n, t) family at each speed; empty where the track has no mode.
        omega: (n,) rotor speeds, rad/s.
    """

    names: tuple[str, ...]
    families: tuple[tuple[str, ...], ...]
    omega: Array

    def __getitem__(self, t: int) -> str:
        """The name of track ``t``, and the family at the last speed if it differs: ``flapwise 2 → edgewise``."""
        return self.over(t, -np.inf, np.inf)

    def at(self, t: int, omega: float) -> str:
        """The name, and the family at the solved speed nearest ``omega`` (rad/s) if it differs: ``mixed 1 (axial)``."""
        return self.over(t, omega, omega)

    def over(self, t: int, low: float, high: float) -> str:
        """The name, and the families at ``low`` and ``high`` (rad/s) if they differ from it."""
        present = np.array([k for k, row in enumerate(self.families) if row[t]])
        limits = np.clip([low, high], self.omega[present[0]], self.omega[present[-1]])
        ends = [present[np.abs(self.omega[present] - limit).argmin()] for limit in limits]
        name = self.names[t]
        first, *later_names = [family for family, _ in groupby(self.families[k][t] for k in ends)]
        start = name if name.split()[0] == first else f"{name} ({first})"
        return " → ".join((start, *later_names))


def labels(tracks: Tracks, blade: Blade) -> tuple[Labels, Array]:
    """The labels, and the energy fractions (n, t, 4) in the order of ``FAMILIES``; NaN where a track has no mode."""
    fractions = np.full((*tracks.mode_index.shape, 4), np.nan)
    names: dict[int, str] = {}
    kinds: list[tuple[str, ...]] = []
    for k, solved in enumerate(tracks.solved):
        present = np.flatnonzero(tracks.mode_index[k] >= 0)
        energies = participation(solved, blade)
        fractions[k, present] = energies[tracks.mode_index[k, present]]
        kind, name = families(energies), numbered(families(energies))
        kinds.append(tuple(kind[p] if p >= 0 else "" for p in tracks.mode_index[k]))
        names = {int(t): name[tracks.mode_index[k, t]] for t in present} | names
    return Labels(_distinct([names[t] for t in range(tracks.count)]), tuple(kinds), tracks.omega), fractions


def _distinct(names: Sequence[str]) -> tuple[str, ...]:
    """Make names unique: tracks that begin at different speeds can have the same name; later ones get a prime."""
    out: list[str] = []
    for name in names:
        while name in out:
            name += "′"
        out.append(name)
    return tuple(out)
