"""Modes of linearisations as cells of the matrix, beside those of other codes: paired with core's turbine by shape.

A difference that consists of the deck's shapes and nodes, gravity and deflection, and leaves no more than the target, is known.
Nothing agrees if the files have a defect.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ....core.turbine.stations import COLUMNS, weights
from ...input.errors import CaseError
from ...judge.cells import Head, Rows, empty, mode_fields
from ...judge.pairing import pair
from ...judge.printed import printed
from ...judge.reference import Reference
from ...judge.results import Cell
from ...judge.spectrum import Spectrum
from ...judge.uncertainty import Estimate
from ...judge.verdict import AGREES
from ..findings import DEFECT
from ..judged import JudgedSet
from ..modes import Mode
from . import deck as decks
from .deck import Deck
from .split import DEFLECTION, GRAVITY, NODES, SHAPES, ModeComparison, compare
from .stations import motions

SAME_PITCH = 1e-6
"""Largest difference of two pitch angles that are the same, rad."""

KNOWN = (SHAPES, NODES, GRAVITY, DEFLECTION)
"""Parts of a difference whose cause is the deck's discretisation or operating point, computed by core."""


def rows(
    head: Head, fst: str, pitch: float, sets: Sequence[JudgedSet], core: Sequence[tuple[float, Reference]]
) -> Rows:
    """The cells of linearisations at core's speeds; at a speed that no set has, there are none.

    Args:
        head: of the cells.
        fst: path of the turbine's primary file.
        pitch: of the blades that core solves, rad.
        sets: the operating points, judged.
        core: the references at all speeds, rad/s.
    """
    try:
        deck = decks.read(Path(fst))
    except CaseError as error:
        return [empty(head, omega, "not applicable", str(error)) for omega, _ in core], []
    out: list[Cell] = []
    if abs(deck.pitch - pitch) > SAME_PITCH:
        pitches = f"{np.degrees(deck.pitch):.4g}° in the deck (BlPitch), {np.degrees(pitch):.4g}° here"
        reason = f"the blades are pitched by {pitches}: give --pitch={np.degrees(deck.pitch):.4g}"
        return [empty(head, omega, "not applicable", reason) for omega, _ in core], []
    for omega, reference in core:
        at_speed = [judged_set for judged_set in sets if at(judged_set, omega)]
        for judged_set in at_speed:
            try:
                out += _cells(head, omega, deck, judged_set, reference)
            except CaseError as error:
                out.append(empty(head, omega, "not applicable", str(error)))
    return out, []


def at(judged_set: JudgedSet, omega: float) -> bool:
    """Whether a set has this rotor speed, rad/s, within the digits of its files."""
    slack = max(file.unit for file in judged_set.azimuth_set.files) + 1e-9 * abs(omega)
    return abs(judged_set.azimuth_set.omega - omega) <= slack


def _cells(head: Head, omega: float, deck: Deck, judged_set: JudgedSet, reference: Reference) -> list[Cell]:
    azimuth_set = judged_set.azimuth_set
    absent_families = {"tower fore-aft 1", "tower side-side 1"} - {state.family for state in azimuth_set.states}
    if absent_families:
        reason = f"{azimuth_set.name} has no states of {', '.join(sorted(absent_families))}: judge it alone, with --fst"
        return [empty(head, omega, "not applicable", reason)]
    by_mode = {id(comparison.mode): comparison for comparison in compare(judged_set, deck, causes=False).modes}
    modes = tuple(mode for mode in judged_set.modes if id(mode) in by_mode)
    spectrum = Spectrum(
        np.array([mode.eigenvalue for mode in modes]), motions(deck, azimuth_set, modes), COLUMNS, weights(deck.turbine)
    )
    defects = [finding.name for finding in judged_set.findings if finding.level == DEFECT]
    out = []
    for i, partner in enumerate(pair(reference.core.spectrum, spectrum, reference.core.indices)):
        if partner.mode is None:
            cell = replace(empty(head, omega, "not applicable", ""), **mode_fields(reference, i))
            out.append(replace(cell, reason=f"{azimuth_set.name} has no mode of this shape"))
            continue
        mode = modes[partner.mode]
        cell = printed(head, omega, i, reference, _estimate(mode), "")
        cell = replace(cell, mac=partner.mac)
        out.append(_unless_defective(_known(cell, by_mode[id(mode)]), defects))
    return out


def _estimate(mode: Mode) -> Estimate:
    digits = mode.relative_uncertainty
    return Estimate(abs(mode.eigenvalue), float(digits) if np.isfinite(digits) and digits < 1.0 else None)


def _known(cell: Cell, pair: ModeComparison) -> Cell:
    """The cell, with the parts of its difference; known if what is left of it is within the target."""
    if cell.verdict in AGREES or cell.difference is None:
        return cell
    parts = {name: value for name, value in pair.parts.items() if name in KNOWN and abs(value) > 1e-5}
    remainder = cell.difference - sum(parts.values())
    listed = ", ".join(f"{name} {100 * value:+.3g} %" for name, value in parts.items())
    reason = f"{listed}; {100 * remainder:+.3g} % {'left' if parts else 'without them'}".replace("-", "−")
    if not parts:
        return cell
    if cell.verdict == "fail" and abs(remainder) + (cell.uncertainty or 0.0) <= cell.target:
        return replace(cell, verdict="known difference", reason=reason)
    return replace(cell, reason="; ".join(filter(None, (cell.reason, reason))))


def _unless_defective(cell: Cell, defects: Sequence[str]) -> Cell:
    if not defects or cell.verdict not in (*AGREES, "known difference"):
        return cell
    reason = f"the linearisation has a defect ({', '.join(defects)}): see southwell judge"
    return replace(cell, verdict="inconclusive", reason="; ".join(filter(None, (reason, cell.reason))))
