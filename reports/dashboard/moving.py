"""Core's mode shapes for the animation; a run does not store them, so they are solved when the site is written."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...cases.input import library
from ...cases.input.errors import CaseError
from ...cases.judge.pairing import aligned, weights
from ...cases.judge.results import Cell
from ...core.blade import Blade
from ...core.element import sections
from ...core.modes import STATIONS, Modes
from ...core.participation import families, participation
from ...core.solve import modes
from ...core.spectrum.eigen import UnstableError
from ...core.steady.blade_state import SteadyStateError
from ..shared.units import Units

ELEMENTS, COUNT = 40, 6

FARTHEST, STEEPEST = 0.12, 0.5
"""Limits to which a shape is scaled: displacement relative to the rotor's radius, and rotation in rad."""

HALF_CHORD = 0.035
"""Half chord of the blade's ribbon, relative to the rotor's radius; the rows have no chord."""

MAX_CHANGE = 0.01
"""Largest relative difference of a frequency between this blade and the blade of the run."""


def moving(case: str, cells: Sequence[Cell], u: Units) -> dict[str, Any] | None:
    """Modes at the lowest and highest speed; lengths are relative to the rotor's radius, in the hub's axes.

    ``rest`` and ``across`` (21, 3) are positions and the half chord. ``re`` and ``im`` (21, 4) of a mode are
    displacement and rotation about the blade. Returns None if the case is not a blade of the package, its files are
    missing, or the run was of another blade with the same name.
    """
    blade = _blade(case)
    if blade is None:
        return None
    radius, weight = blade.length + blade.hub_radius, weights(blade)
    solved = []
    for omega in sorted({min(c.omega for c in cells), max(c.omega for c in cells)}):
        try:
            at_speed = modes(blade, omega, ELEMENTS, COUNT)
        except (SteadyStateError, UnstableError):
            continue
        if not _same(at_speed, cells):
            return None
        at_speed = aligned(at_speed, weight)
        solved.append(_at(at_speed, families(participation(at_speed, blade)), radius, u))
    frames = sections.frames(blade, STATIONS * blade.length)
    return {
        "elements": ELEMENTS,
        "rest": (frames[:, :3, 3] / radius).round(5).tolist(),
        "across": (HALF_CHORD * frames[:, :3, 1]).round(5).tolist(),
        "speeds": solved,
    }


def _at(solved: Modes, names: Sequence[str], radius: float, u: Units) -> dict[str, Any]:
    out = []
    for k, (name, shape) in enumerate(zip(names, solved.shapes, strict=True)):
        deflection, slope = np.abs(shape[:, :3]).max() / radius / FARTHEST, np.abs(shape[:, 3]).max() / STEEPEST
        scaled = shape / [radius, radius, radius, 1.0] / max(deflection, slope)
        label = f"{name} {1 + list(names[:k]).count(name)}"
        f = float(solved.frequencies[k]) * u.frequencies
        out.append({"name": label, "f": f, "re": scaled.real.round(5).tolist(), "im": scaled.imag.round(5).tolist()})
    return {"speed": solved.omega * u.speeds, "modes": out}


def _same(solved: Modes, cells: Sequence[Cell]) -> bool:
    """Whether the run's lowest frequency at this speed is among the computed ones."""
    references = [c.full for c in cells if c.omega == solved.omega and c.full is not None]
    return not references or bool(np.abs(solved.frequencies / min(references) - 1.0).min() < MAX_CHANGE)


def _blade(case: str) -> Blade | None:
    stem = case.partition("/")[0]
    if stem not in library.names():
        return None
    try:
        return next((v.blade for v in library.load(stem).variants if v.name == case), None)
    except CaseError:
        return None
