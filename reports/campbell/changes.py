"""The table of changes between two blades, for the console and for Markdown."""

from collections.abc import Sequence
from math import isnan

from ...cases.campbell.changes import Changed
from ..shared.units import Units
from .tables import Sheet


def sheet(found: Sequence[Changed], against: str, units: Units) -> Sheet:
    """The table: one row per mode and speed with both frequencies and the relative change.

    Args:
        found: the changes.
        against: name of the other blade.
        units: units of the table.
    """
    rows = tuple(
        (
            row.name,
            f"{row.omega * units.speeds:.6g}",
            f"{row.other * units.frequencies:.5g}" if not isnan(row.other) else "–",
            f"{row.frequency * units.frequencies:.5g}",
            f"{100 * row.relative:+.2f} %".replace("-", "−") if not isnan(row.other) else "no partner",
        )
        for row in found
    )
    notes = dict.fromkeys(f"{row.name}, {units.at(row.omega)}: {row.note}" for row in found if row.note)
    head = ("mode", units.speed, f"other, {units.frequency}", f"this, {units.frequency}", "change")
    text = "Modes are paired by their shapes (MAC), not by their numbers."
    return Sheet(f"Changes against {against}", head, rows, ". ".join([text.rstrip("."), *notes]) + ".")
