"""The table of changes between two blades, for the console and for Markdown."""

from collections.abc import Sequence
from math import isnan

from ...cases.campbell.changes import ModeDifference
from ..shared.certain import certain
from ..shared.sheets import Sheet
from ..shared.units import Units


def sheet(differences: Sequence[ModeDifference], against: str, units: Units) -> Sheet:
    """The table: one row per mode and speed with both frequencies and the relative change.

    Args:
        differences: the changes.
        against: name of the other blade.
        units: units of the table.
    """
    rows = tuple(
        (
            row.name,
            f"{row.omega * units.speeds:.6g}",
            certain(row.partner * units.frequencies, row.uncertainty) if not isnan(row.partner) else "–",
            certain(row.frequency * units.frequencies, 0.0 if isnan(row.partner) else row.uncertainty),
            percent(row.relative) if not isnan(row.partner) else "no partner",
            f"{100 * row.uncertainty:.0e} %" if not isnan(row.partner) else "–",
        )
        for row in differences
    )
    notes = dict.fromkeys(f"{row.name}, {units.at(row.omega)}: {row.note}" for row in differences if row.note)
    head = ("mode", units.speed, f"other, {units.frequency}", f"this, {units.frequency}", "change", "±")
    text = "Modes are paired by shape (MAC); ± is the numerical uncertainty of the change"
    return Sheet(f"Changes against {against}", head, rows, ". ".join([text, *notes]) + ".")


def percent(change: float) -> str:
    """A relative change in percent with three significant digits, such as ``+0.0123 %`` or ``−1.5e-07 %``."""
    text = f"{100 * change:+#.3g}".rstrip(".") if change else "0"
    return f"{text.replace('-', '−', 1) if change < 0 else text} %"
