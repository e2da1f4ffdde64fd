"""The tables of a Campbell diagram, for the terminal and for Markdown."""

import numpy as np

from ...cases.campbell.diagram import Campbell, Margin
from ...cases.campbell.encounters import Encounter
from ...cases.campbell.margins import Southwell
from ...cases.campbell.required import UNITS, RequiredMargin
from ...cases.campbell.sweep import NamedMode
from ...core.participation import describe_fractions
from ..shared.certain import certain, relative, remarks
from ..shared.sheets import TOO_NEAR, Sheet
from ..shared.units import Units


def sheets(diagram: Campbell, units: Units) -> tuple[Sheet, ...]:
    """All tables that have rows."""
    makers = (_modes, _margins, _resonances, _encounters, _doubts)
    return tuple(s for s in (make(diagram, units) for make in makers) if s.rows)


def _modes(diagram: Campbell, units: Units) -> Sheet:
    tracks, request = diagram.tracks, diagram.request
    first, last = request.speeds[0], request.speeds[-1]
    rows = []
    for t in range(tracks.count):
        k = np.flatnonzero(tracks.mode_index[:, t] >= 0)
        fit = diagram.southwell[t]
        row = [diagram.labels[t], describe_fractions(diagram.energy_fractions[k[0], t])]
        for end in (0, -1):
            f, uncertainty = tracks.frequencies[end, t] * units.frequencies, tracks.uncertainty[end, t]
            row.append(certain(float(f), float(uncertainty)) if np.isfinite(f) else "–")
        row.append(relative(float(np.nanmax(tracks.uncertainty[:, t]))))
        rise = tracks.frequencies[-1, t] / tracks.frequencies[0, t] - 1.0
        row.append(_rise(float(rise), float(tracks.uncertainty[0, t] + tracks.uncertainty[-1, t])))
        row += [*_southwell(fit, float(np.nanmax(tracks.uncertainty[:, t])))] if fit else ["–", "–"]
        rows.append(tuple(row))
    frequency = units.frequency
    at = _at(units, first)
    head = ("mode", "kinetic energy", f"{frequency} {at}", f"{frequency} {_at(units, last)}", "± relative", "change")
    note = (
        f"Kinetic energy {at}: flapwise, edgewise and axial motion of the mass centres, torsion about them; blade axes. "
        "± relative: numerical uncertainty, the largest at any speed; the interpretation of a blade file is not included. "
        "φ, residual: ω² = ω₀² + φ Ω², and the fit's largest deviation."
    )
    return Sheet("Modes", (*head, "φ", "residual"), tuple(rows), note)


def _at(units: Units, omega: float) -> str:
    return f"at {units.at(omega)}" if omega else units.at(omega)


def _rise(rise: float, doubt: float) -> str:
    """A change in percent with at most two decimals; ``doubt`` is the relative uncertainty of the ratio."""
    if not np.isfinite(rise):
        return "–"
    uncertainty = 100 * (1.0 + rise) * doubt
    if not uncertainty < 50:
        return "?"
    places = 2 if uncertainty <= 0.01 else max(int(-np.ceil(np.log10(uncertainty))), 0)
    return f"{100 * rise:+.{places}f} %"


def _southwell(fit: Southwell, uncertainty: float) -> tuple[str, str]:
    """Φ with at most four of the digits that are certain, and the residual if it exceeds the uncertainty."""
    size = abs(fit.coefficient)
    text = certain(fit.coefficient, fit.uncertainty / size if size else np.inf, 4)
    floor = max(uncertainty, 1e-6)
    return text, f"{100 * fit.residual:.2g} %" if fit.residual >= floor else f"< {100 * floor:.1g} %"


def _margins(diagram: Campbell, units: Units) -> Sheet:
    request = diagram.request
    if request.operating is None:
        return Sheet("Margins", (), ())
    low, high = request.operating
    rows = []
    for t in range(diagram.tracks.count):
        margins = {m.per_rev: m for m in diagram.margins if m.track == t}
        fields = [_margin(margins[n], request.margin) if margins else "not tracked to here" for n in request.per_rev]
        rows.append((diagram.labels.over(t, low, high), *fields))
    unit = request.margin.unit
    measure = f"in {unit}" if unit else "in % of n per revolution (far: 1000 % or more)"
    note = (
        f"Distance of each mode above n per revolution {_at(units, low)} … {units.at(high)}, {measure}. "
        f"{TOO_NEAR}: below {request.margin} at some speed; a change of sign: a crossing."
    )
    return Sheet("Margins in the operating range", ("mode", *[f"{n}P" for n in request.per_rev]), tuple(rows), note)


def _margin(m: Margin, required: RequiredMargin) -> str:
    text_of = _percent if not required.unit else lambda value: f"{value / UNITS[required.unit]:+.3g}".replace("-", "−")
    ends = "…".join(dict.fromkeys((text_of(m.low), text_of(m.high))))
    return ends if m.kept else f"{TOO_NEAR} {ends}"


def _percent(value: float) -> str:
    return "far" if value >= 10 else f"{100 * value:+.{0 if abs(value) >= 0.1 else 1}f}".replace("-", "−")


def _resonances(diagram: Campbell, units: Units) -> Sheet:
    rows = []
    for r in diagram.resonances:
        row = [
            diagram.labels.at(r.track, r.omega),
            f"{r.per_rev}P{' (may only touch it)' if r.touches else ''}",
            certain(r.omega * units.speeds, r.uncertainty),
            certain(r.frequency * units.frequencies, r.uncertainty),
            relative(r.uncertainty),
        ]
        if r.distance is not None:
            row.append(f"{TOO_NEAR} inside" if r.distance == 0 else f"{100 * r.distance:+.1f} %")
        rows.append(tuple(row))
    head = ["mode", "crosses", units.speed_label, units.frequency_label, "± relative"]
    note = "± relative: uncertainty of the speed and of the frequency; modes are solved at each crossing."
    if diagram.request.operating:
        head.append("from the operating range")
        note += " Last column: distance of the speed from the nearer end of the operating range, relative to that end."
    return Sheet("Crossings of n per revolution", tuple(head), tuple(rows), note)


def _encounters(diagram: Campbell, units: Units) -> Sheet:
    rows = []
    for e in diagram.encounters:
        lower, upper = (diagram.labels.at(t, e.window[0]) for t in e.tracks)
        rows.append(
            (
                e.kind,
                f"{e.omega * units.speeds:.3f}",
                certain(e.frequency * units.frequencies, e.uncertainty, 5),
                gap(e, units) if e.kind == "veering" else _narrower(e, units),
                f"{lower} × {upper}",
                f"{100 * e.exchanged:.0f} %"
                + ("" if e.complete else " (incomplete: ends at the range of speeds or at another encounter)"),
                f"{describe_fractions(e.before[0])} → {describe_fractions(e.after[0])}",
            )
        )
    head = (
        "kind",
        units.speed_label,
        units.frequency_label,
        f"gap, {units.frequency}",
        "modes",
        "exchanged",
        "lower mode",
    )
    note = (
        "Veering: two modes approach, exchange their shapes and separate. The gap of a crossing is an upper bound. "
        "Exchanged: the part of the shapes that is exchanged. Lower mode: its kinetic energy, before → after."
    )
    return Sheet("Modes that come close", head, tuple(rows), note)


def gap(e: Encounter, units: Units, digits: int = 3) -> str:
    """The gap of two modes that meet; if it is below their uncertainty, an upper bound."""
    if not e.gap_uncertainty < 0.5 * e.gap:
        return f"< {(e.gap + e.gap_uncertainty) * units.frequencies:.{digits}g}"
    return certain(e.gap * units.frequencies, e.gap_uncertainty / e.gap, digits)


def _narrower(e: Encounter, units: Units) -> str:
    """An upper bound of the gap of a crossing, or ``none``."""
    upper_bound = (e.gap + e.gap_uncertainty) * units.frequencies
    return "?" if not np.isfinite(upper_bound) else f"< {upper_bound:.3g}" if upper_bound >= 1e-9 else "none"


def _doubts(diagram: Campbell, units: Units) -> Sheet:
    rows = tuple(
        (
            diagram.labels[d.track],
            f"{d.omega[0] * units.speeds:.4f} – {d.omega[1] * units.speeds:.4f}",
            f"{d.frequency * units.frequencies:.4g}",
            f"{d.mac:.2f}" if d.mac else "none",
            f"{d.rival:.2f}",
        )
        for d in diagram.tracks.doubts
    )
    step = f"{diagram.tracks.smallest * units.speeds:.3g} {units.speed}"
    head = ("mode", units.speed_label, units.frequency_label, "MAC of the mode chosen", "of another")
    note = (
        f"The continuation of these modes is ambiguous even at the smallest step, {step}: the mode chosen may be wrong."
    )
    return Sheet("Ambiguous tracking", head, rows, note)


def notes(diagram: Campbell, units: Units) -> list[str]:
    """Remarks on large steady strains, an accuracy that was not reached, and crossings that may be missing."""
    tracks, request = diagram.tracks, diagram.request
    rows = [
        NamedMode(
            omega,
            int(tracks.mode_index[k, t]) + 1,
            diagram.labels.at(t, omega),
            float(tracks.frequencies[k, t]),
            float(tracks.uncertainty[k, t]),
            tracks.solved[k].strain,
        )
        for k, omega in enumerate(tracks.omega.tolist())
        for t in range(tracks.count)
        if tracks.mode_index[k, t] >= 0
    ]
    missing = [
        f"{u.per_rev}P: from {units.at(u.omega[0])} to {units.at(u.omega[1])} the number of modes below it changes by "
        f"{u.number:+d} more than by the crossings listed: a crossing may be missing; give closer speeds or more modes"
        for u in diagram.unlisted
    ]
    return [*remarks(rows, request.accuracy if request.elements is None else None, units), *missing]


def margins_kept(diagram: Campbell) -> bool:
    """Whether every mode could be judged over the operating range and keeps its margins."""
    judged_tracks = {m.track for m in diagram.margins}
    return len(judged_tracks) == diagram.tracks.count and all(m.kept for m in diagram.margins)


def verdict(diagram: Campbell, units: Units) -> str:
    """The verdict on the margins in one line."""
    request = diagram.request
    if request.operating is None:
        return f"{len(diagram.resonances)} resonances in the speeds shown; no operating range given, so no margin is judged."
    low, high = request.operating
    speed_range = f"{low * units.speeds:.4g} to {high * units.speeds:.4g} {units.speed}"
    broken = [m for m in diagram.margins if not m.kept]
    judged_tracks = {m.track for m in diagram.margins}
    unjudged = [diagram.labels.over(t, low, high) for t in range(diagram.tracks.count) if t not in judged_tracks]
    but = f" Not judged, because not tracked over the whole range: {', '.join(unjudged)}." if unjudged else ""
    if not broken:
        subject = "Every other mode" if unjudged else "Every mode"
        return f"{subject} stays at least {request.margin} away from every n per revolution at {speed_range}.{but}"
    sentences = []
    for t in dict.fromkeys(m.track for m in broken):
        margins = [m for m in broken if m.track == t]
        crossed = ", ".join(f"{m.per_rev}P" for m in margins if m.smallest == 0.0)
        near_by = ", ".join(f"{m.per_rev}P" for m in margins if m.smallest != 0.0)
        words = [
            f"crosses {crossed}" if crossed else "",
            f"comes within {request.margin} of {near_by}" if near_by else "",
        ]
        sentences.append(f"{diagram.labels.over(t, low, high)} {' and '.join(w for w in words if w)}")
    return f"{TOO_NEAR} At {speed_range}, {'; '.join(sentences)}.{but}"
