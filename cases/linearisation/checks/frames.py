"""The frame of BeamDyn's states, checked by the Coriolis terms and not by the flag."""

import numpy as np
from numpy.typing import NDArray

from ..findings import DEFECT, Finding
from ..modes import Mode, Spectrum, spectrum
from ..rotating_nodes import coriolis_content, rotated
from ..sets import AzimuthSet

Array = NDArray[np.float64]

ROTATING = 0.5
"""Coriolis terms relative to those of a rotating frame above which the frame rotates."""


def in_rotating_frame(azimuth_set: AzimuthSet) -> tuple[Array, tuple[Finding, ...]]:
    """State matrices with all blade states in the rotating frame, and the finding if the files' are not, though flagged."""
    content = coriolis_content(azimuth_set)
    if content is None or content > ROTATING:
        return azimuth_set.A, ()
    A = rotated(azimuth_set, azimuth_set.A)
    flagged = [s for s in azimuth_set.states if s.module == "BD" and s.rotating]
    if not flagged:
        return A, ()
    effect = _effect(spectrum(azimuth_set, azimuth_set.A), spectrum(azimuth_set, A))
    return A, (
        Finding(
            "frame flag",
            DEFECT,
            f"{len(flagged)} states of BeamDyn are flagged as rotating, but their equations have {100 * abs(content):.1f} % of "
            f"the Coriolis terms of a rotating frame{effect}",
            "their frame is frozen at this instant (OpenFAST issue 3394); the modes listed are those after transformation to "
            "the rotating frame",
            content,
        ),
    )


def _effect(before: Spectrum, after: Spectrum) -> str:
    """Change of the tower's modes, or of the lowest, by the correction."""
    pairs = [
        (mode, as_flagged)
        for mode in after.modes
        if mode.structural > 0.5 and (as_flagged := _same(before.modes, mode)) is not None
    ]
    tower = [pair for pair in pairs if pair[0].name.startswith("tower side-side")] or pairs
    if not tower:
        return ""
    mode, as_flagged = tower[0]
    return f" ({mode.name}: {as_flagged.frequency:.4f} Hz as flagged, {mode.frequency:.4f} Hz corrected)"


def _same(modes: tuple[Mode, ...], mode: Mode) -> Mode | None:
    candidates = [candidate for candidate in modes if candidate.name == mode.name]
    return min(candidates, key=lambda candidate: abs(candidate.frequency - mode.frequency), default=None)
