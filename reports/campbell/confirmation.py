"""The table of independent confirmations of a Campbell diagram's lines."""

from collections.abc import Sequence
from math import isfinite

from ...cases.campbell.confirmation import Confirmed
from ...cases.campbell.diagram import Campbell
from ..shared.sheets import TOO_NEAR, Sheet
from ..shared.units import Units

TITLE = "Independent confirmation"


def sheet(diagram: Campbell, confirmed: Sequence[Confirmed], units: Units) -> Sheet:
    """The table: one row per mode and speed with the frequency ± u and the codes that confirm it."""
    rows = tuple(
        (
            diagram.labels.at(row.track, row.omega),
            f"{row.omega * units.speeds:.6g}",
            _with_uncertainty(row, units),
            ", ".join(row.codes) or f"{TOO_NEAR} none",
            f"{100 * row.difference:.2g} %" if row.codes else "–",
        )
        for row in confirmed
    )
    disagreements = dict.fromkeys(
        f"{diagram.labels.at(r.track, r.omega)}, {units.at(r.omega)}: {', '.join(r.dissenting)}"
        for r in confirmed
        if r.dissenting
    )
    without = f" Without agreement: {'; '.join(disagreements)}." if disagreements else ""
    note = (
        "± is the numerical uncertainty of Southwell's own solver; codes are those that share nothing with it and agree within "
        f"0.1 %; the last column has their largest difference.{without}"
    )
    head = ("mode", units.speed, f"{units.frequency} ± u", "confirmed by", "difference")
    return Sheet(TITLE, head, rows, note)


def _with_uncertainty(row: Confirmed, units: Units) -> str:
    value = f"{row.frequency * units.frequencies:.5g}"
    if not isfinite(row.uncertainty):
        return f"{value} ± unknown"
    return f"{value} ± {row.uncertainty * row.frequency * units.frequencies:.1g}"
