"""Writes a Campbell diagram as CSV, in SI units."""

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from ...cases.campbell.diagram import Campbell
from ...cases.input import atomic
from ...core.participation import FAMILIES


def write(diagram: Campbell, folder: Path) -> tuple[Path, ...]:
    """Write ``campbell.csv`` (one row per mode and speed), ``resonances.csv``, ``margins.csv`` and ``encounters.csv``.

    All numbers are in SI units. Returns the paths.

    Raises:
        OSError: if a file cannot be written.
    """
    tracks = diagram.tracks
    lines = [
        (
            k + 1,
            repr(float(tracks.omega[k])),
            f"{tracks.omega[k] * 30 / np.pi:.9g}",
            int(tracks.requested[k]),
            t + 1,
            diagram.labels[t],
            int(tracks.mode_index[k, t]) + 1,
            repr(float(tracks.frequencies[k, t])),
            f"{tracks.frequencies[k, t] / (2 * np.pi):.9g}",
            f"{tracks.uncertainty[k, t]:.6g}",
            f"{tracks.solved[k].strain:.6g}",
            *[f"{share:.6f}" for share in diagram.energy_fractions[k, t]],
            f"{tracks.mac[k, t]:.6f}" if np.isfinite(tracks.mac[k, t]) else "",
        )
        for k in range(len(tracks.omega))
        for t in range(tracks.count)
        if tracks.mode_index[k, t] >= 0
    ]
    speed = ("speed_number", "omega_rad_s", "rotor_speed_rpm", "asked_for")
    columns = [*speed, "track", "name", "mode", "frequency_rad_s", "frequency_hz"]
    columns += ["relative_uncertainty", "steady_strain", *FAMILIES, "mac_with_speed_before"]
    resonances = [
        (
            diagram.labels.at(r.track, r.omega),
            r.per_rev,
            r.omega,
            r.frequency,
            f"{r.uncertainty:.6g}",
            "" if r.distance is None else r.distance,
            int(r.touches),
        )
        for r in diagram.resonances
    ]
    margins = [
        (
            *(diagram.labels[m.track], m.per_rev, m.low, m.high, m.smallest, m.omega),
            *(f"{m.uncertainty:.6g}", "rad/s" if diagram.request.margin.unit else "relative", int(m.kept)),
        )
        for m in diagram.margins
    ]
    resonance_rows = [
        (
            e.kind,
            e.omega,
            e.frequency,
            e.gap,
            f"{e.uncertainty:.6g}",
            f"{e.gap_uncertainty:.6g}",
            *[diagram.labels[t] for t in e.tracks],
            e.exchanged,
            *e.window,
            int(e.complete),
        )
        for e in diagram.encounters
    ]
    where, distance_columns, window = (
        ("kind", "omega_rad_s", "frequency_rad_s", "gap_rad_s"),
        "relative_uncertainty",
        ("from_rad_s", "to_rad_s"),
    )
    files: dict[str, tuple[Sequence[str], Iterable[Sequence[object]]]] = {
        "campbell.csv": (columns, lines),
        "resonances.csv": (
            ("name", "per_rev", "omega_rad_s", "frequency_rad_s", distance_columns, "from_operating_range", "touches"),
            resonances,
        ),
        "margins.csv": (
            ("name", "per_rev", "at_low", "at_high", "least", "omega_least_rad_s", "uncertainty", "measure", "kept"),
            margins,
        ),
        "encounters.csv": (
            (*where, distance_columns, "gap_uncertainty_rad_s", "lower", "upper", "exchanged", *window, "whole"),
            resonance_rows,
        ),
    }
    for name, (heads, rows) in files.items():
        atomic.write_csv(folder / name, heads, rows)
    return tuple(folder / name for name in files)
