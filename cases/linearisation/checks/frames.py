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


def in_rotating_frame(each: AzimuthSet) -> tuple[Array, tuple[Finding, ...]]:
    """State matrices with all blade states in the rotating frame, and the finding if the files' are not, though flagged."""
    content = coriolis_content(each)
    if content is None or content > ROTATING:
        return each.A, ()
    A = rotated(each, each.A)
    flagged = [s for s in each.states if s.module == "BD" and s.rotating]
    if not flagged:
        return A, ()
    effect = _effect(spectrum(each, each.A), spectrum(each, A))
    return A, (
        Finding(
            "frame flag",
            DEFECT,
            each.name,
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
        (mode, other)
        for mode in after.modes
        if mode.structural > 0.5 and (other := _same(before.modes, mode)) is not None
    ]
    tower = [pair for pair in pairs if pair[0].name.startswith("tower side-side")] or pairs
    if not tower:
        return ""
    mode, other = tower[0]
    return f" ({mode.name}: {other.frequency:.4f} Hz as flagged, {mode.frequency:.4f} Hz corrected)"


def _same(modes: tuple[Mode, ...], mode: Mode) -> Mode | None:
    named = [other for other in modes if other.name == mode.name]
    return min(named, key=lambda other: abs(other.frequency - mode.frequency), default=None)
