"""Results with a short text, a table in a notebook, a pandas table and a figure."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from ...cases.campbell.diagram import Campbell
from ...cases.campbell.required import UNITS
from ...cases.judge.pairing import aligned, weights
from ...cases.judge.results import Run
from ...core.blade import Blade
from ...core.modes import STATIONS, Modes
from ...core.participation import families, numbered, participation
from ...references.protocol.interface import MOTIONS
from ..campbell import interactive as plotly
from ..campbell import page, tables
from ..campbell.figure import lines
from ..shared import summary
from ..shared.units import RAD_S, Units

SIGNIFICANT = 6
"""Digits of a frequency in a notebook's table; ``to_frame`` has full precision."""


def _html(title: str, frame: pd.DataFrame) -> str:
    return f"<p>{title}</p>{frame.to_html(index=False, border=0, float_format=f'%.{SIGNIFICANT}g')}"


def _axes(width: float, height: float) -> Axes:
    """Axes of a new figure of the given size, inches."""
    import matplotlib.pyplot as plt  # imported here because it selects a backend

    return plt.subplots(figsize=(width, height), layout="constrained")[1]


@dataclass(frozen=True, repr=False)
class ModesResult(Modes):
    """Modes of a blade at one rotor speed.

    Attributes:
        blade: the blade; the other attributes are those of ``Modes``.
        units: in which the speed was given.
    """

    blade: Blade = field(kw_only=True)
    units: Units = field(kw_only=True, default=RAD_S)

    def to_frame(self) -> pd.DataFrame:
        """One row per mode: ``mode``, ``name``, ``frequency_hz``, ``frequency_rad_s``, ``uncertainty`` (relative),
        ``damping_ratio``."""
        uncertainty = self.uncertainty if len(self.uncertainty) else np.full(len(self.frequencies), np.nan)
        return pd.DataFrame(
            {
                "mode": np.arange(1, len(self.frequencies) + 1),
                "name": self.names,
                "frequency_hz": self.frequencies / (2 * np.pi),
                "frequency_rad_s": self.frequencies,
                "uncertainty": uncertainty,
                "damping_ratio": self.damping,
            }
        )

    @property
    def names(self) -> list[str]:
        """Name of each mode, its family and ordinal in the family, such as ``flapwise 2``."""
        weight = weights(self.blade)
        return list(numbered(families(participation(aligned(self, weight), self.blade))))

    def plot(self, modes: int = 4, axes: Axes | None = None) -> Axes:
        """Draw the dominant motion of the lowest ``modes`` shapes along the span, scaled to 1; return the axes."""
        axes = axes or _axes(6.4, 4.8)
        for k, name in enumerate(self.names[:modes]):
            shape = self.shapes[k] * (1, 1, 1, self.blade.length / 10)  # a rotation by its displacement at a tenth of L
            part = int(np.abs(shape).max(axis=0).argmax())
            tip = shape[np.abs(shape[:, part]).argmax(), part]
            label = name if name.startswith(MOTIONS[part]) else f"{name} ({MOTIONS[part]})"
            axes.plot(STATIONS * self.blade.length, (shape[:, part] / tip).real, label=label)
        axes.set_xlabel("distance from the root, m")
        axes.set_ylabel("mode shape, scaled")
        axes.legend()
        return axes

    def __repr__(self) -> str:
        hertz = ", ".join(f"{f:.4g}" for f in self.frequencies[:4] / (2 * np.pi))
        more = ", …" if len(self.frequencies) > 4 else ""
        return f"<{len(self.frequencies)} modes of {self.blade.name} at {self.units.at(self.omega)}: {hertz}{more} Hz>"

    def _repr_html_(self) -> str:
        return _html(f"{self.blade.name} at {self.units.at(self.omega)}", self.to_frame())


@dataclass(frozen=True, repr=False)
class CampbellResult:
    """A Campbell diagram.

    Attributes:
        diagram: tracks, crossings, resonances and margins, in rad/s.
        units: units of the tables and figures, which are those of the given speeds.
    """

    diagram: Campbell
    units: Units

    def to_frame(self) -> pd.DataFrame:
        """Frequencies (k, t): one row per rotor speed, one column per mode, NaN where a mode was not found; the index and
        ``attrs["frequency"]`` name the units."""
        tracks = self.diagram.tracks
        frame = pd.DataFrame(
            tracks.frequencies * self.units.frequencies,
            index=pd.Index(tracks.omega * self.units.speeds, name=self.units.speed_label),
            columns=[self.diagram.labels[t] for t in range(tracks.count)],
        )
        frame.attrs["frequency"] = self.units.frequency
        return pd.DataFrame(frame.loc[tracks.requested])

    def margins(self) -> pd.DataFrame:
        """One row per mode and order n: ``mode``, ``per_rev``, ``low``, ``high`` (margins at both ends of the operating range),
        ``kept``; relative to n per revolution, or in the unit of the required margin. Empty without an operating range."""
        unit = UNITS.get(self.diagram.request.margin.unit, 1.0)
        rows = [
            {
                "mode": self.diagram.labels[m.track],
                "per_rev": m.per_rev,
                "low": m.low / unit,
                "high": m.high / unit,
                "kept": m.kept,
            }
            for m in self.diagram.margins
        ]
        return pd.DataFrame(rows, columns=["mode", "per_rev", "low", "high", "kept"])

    @property
    def verdict(self) -> str:
        """The verdict on the margins in one line."""
        return tables.verdict(self.diagram, self.units)

    def plot(self, axes: Axes | None = None, interactive: bool | None = None) -> Any:
        """Draw frequencies over rotor speed, the lines of n per revolution and the operating range.

        Returns a Plotly figure if ``interactive``, else Matplotlib's axes; by default interactive without ``axes`` where Plotly
        (the extra ``interactive``) is installed.
        """
        if interactive is None:
            interactive = axes is None and plotly.installed()
        if interactive:
            return plotly.lines(self.diagram, self.units)
        axes = axes or _axes(7.0, 4.5)
        return lines(axes, self.diagram, self.units)

    def write(self, folder: str | Path) -> tuple[Path, ...]:
        """Write campbell.md, figures (SVG, PNG) and CSV tables, as ``southwell campbell`` does; return the paths."""
        return page.write(self.diagram, Path(folder), self.units, "from Python")

    def __repr__(self) -> str:
        speeds = np.array(self.diagram.request.speeds) * self.units.speeds
        over = f"{len(speeds)} speeds from {speeds[0]:g} to {speeds[-1]:g} {self.units.speed}"
        return f"<Campbell diagram of {self.diagram.blade.name}: {self.diagram.tracks.count} modes, {over}>"

    def _repr_html_(self) -> str:
        return _html(f"{self!r}".strip("<>") + f", in {self.units.frequency}", self.to_frame().reset_index())


@dataclass(frozen=True, repr=False)
class VerifyResult:
    """The results of other codes, compared with Southwell's own solver.

    Attributes:
        run: all cells, refinements and origins; see ``cases.judge.results``.
    """

    run: Run

    def to_frame(self) -> pd.DataFrame:
        """One row per code, speed, mode and quantity.

        The columns are ``case``, ``omega_rad_s``, ``mode``, ``quantity``, ``code``, ``value`` and ``reference`` (frequencies in
        rad/s), ``difference``, ``uncertainty``, ``target`` (relative), ``verdict``, ``shares`` (what the code has in common
        with Southwell's own solver) and ``reason``.
        """
        rows = [
            {
                "case": c.case,
                "omega_rad_s": c.omega,
                "mode": c.name,
                "quantity": c.quantity,
                "code": summary.column(c),
                "value": c.value,
                "reference": c.reference,
                "difference": c.difference,
                "uncertainty": c.uncertainty,
                "target": c.target,
                "verdict": c.verdict,
                "shares": c.shares,
                "reason": c.reason,
            }
            for c in self.run.cells
        ]
        return pd.DataFrame(rows)

    def evidence(self) -> pd.DataFrame:
        """One row per code that answered: ``code``, ``shares`` (with Southwell's own solver), ``verdict`` (the worst),
        ``difference`` (the largest, relative), ``modes`` (compared)."""
        frame = self.to_frame()
        rows = []
        for code, cells in pd.DataFrame(frame[frame["value"].notna()]).groupby("code", sort=False):
            verdicts = set(cells["verdict"])
            rows.append(
                {
                    "code": code,
                    "shares": cells["shares"].iloc[0],
                    "verdict": next(v for v in summary.WORST_FIRST if v in verdicts),
                    "difference": cells["difference"].abs().max(),
                    "modes": list(cells["quantity"]).count("frequency"),
                }
            )
        return pd.DataFrame(rows, columns=["code", "shares", "verdict", "difference", "modes"])

    @property
    def passed(self) -> bool:
        """Whether nothing fails or is inconclusive and every blade has the independent confirmations it requires."""
        return summary.status(self.run) == 0

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draw |difference| + uncertainty of every cell, one row per code, with the targets as lines; return the axes."""
        axes = axes or _axes(7.0, 3.5)
        frame = self.to_frame().dropna(subset=["difference"])
        codes = list(dict.fromkeys(frame["code"]))
        size = (frame["difference"].abs() + frame["uncertainty"].fillna(0.0)).clip(lower=1e-16)
        axes.plot(size, [codes.index(code) for code in frame["code"]], "o", alpha=0.6)
        for target in sorted(set(frame["target"])):
            axes.axvline(target, color="0.5", lw=1, ls="--")
        axes.set_xscale("log")
        axes.set_yticks(range(len(codes)), codes)
        axes.invert_yaxis()
        axes.set_xlabel("|difference from Southwell's own solver| + uncertainty, relative")
        return axes

    def __repr__(self) -> str:
        counts = ", ".join(f"{n} {v}" for v, n in summary.counts(self.run.cells).items())
        return f"<verification of {', '.join(summary.cases(self.run))}: {counts}>"

    def _repr_html_(self) -> str:
        return _html(f"{self!r}".strip("<>"), self.evidence())
