"""The lowest modes of a blade at several rotor speeds, each tracked from speed to speed by its shape.

A mode may change its dominant motion, and with it its name, between two speeds: frequencies of the same name are then not
those of the same mode.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from ...core.blade import Blade
from ...core.participation import families, numbered, participation
from ..input.errors import CaseError, rad_s
from ..judge.pairing import weights
from .diagram import CampbellRequest, solver
from .labels import labels
from .sweep import NamedMode
from .tracking import Doubt, Solver, Tracks, track


@dataclass(frozen=True)
class TrackedMode:
    """One mode at the requested speeds.

    Attributes:
        label: name at its first speed, and the family at its last if it differs: ``flapwise 2 → edgewise``.
        at: the mode at each speed, ascending, as far as it was solved.
        doubts: steps of speed over which its continuation is ambiguous.
    """

    label: str
    at: tuple[NamedMode, ...]
    doubts: tuple[Doubt, ...] = ()


def tracked(
    blade: Blade, request: CampbellRequest, at: Callable[[float], str] = rad_s, solve: Solver | None = None
) -> tuple[TrackedMode, ...]:
    """The modes that are among the ``request.modes`` lowest at any of ``request.speeds``, in order of first occurrence.

    Speeds between those requested are solved only where the shapes at neighbouring speeds do not identify the modes.
    ``solve`` replaces core; ``at`` formats a speed in an error.

    Raises:
        CaseError: if a requested speed has no stable steady state, or one of large strain.
    """
    tracks = _tracks(blade, request, at, solve)
    mode_labels, _ = labels(tracks, blade)
    names = [numbered(families(participation(modes, blade))) for modes in tracks.solved]
    return tuple(
        TrackedMode(
            mode_labels[t],
            tuple(
                NamedMode(
                    float(tracks.omega[k]),
                    int(tracks.mode_index[k, t]) + 1,
                    names[k][tracks.mode_index[k, t]],
                    float(tracks.frequencies[k, t]),
                    float(tracks.uncertainty[k, t]),
                    tracks.solved[k].strain,
                )
                for k in np.flatnonzero(tracks.requested & (tracks.mode_index[:, t] >= 0))
            ),
            tuple(d for d in tracks.doubts if d.track == t),
        )
        for t in range(tracks.count)
        if (tracks.mode_index[tracks.requested, t] >= 0).any()
    )


def _tracks(blade: Blade, request: CampbellRequest, at: Callable[[float], str], solve: Solver | None) -> Tracks:
    weight, speeds, count = weights(blade), request.speeds, request.modes
    tracks = track(solve or solver(blade, request, at=at, spare=0), speeds, weight, count, smallest_step=1.0)
    if tracks.certain:
        return tracks
    try:
        return track(cache(solve or solver(blade, request, at=at)), speeds, weight, count)
    except CaseError:  # a speed between those requested has no steady state
        return track(solve or solver(blade, request, at=at), speeds, weight, count, smallest_step=1.0)
