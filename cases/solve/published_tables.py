"""Printed tables as columns of the matrix: the series for a case's blade, at the common speeds."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade, uniform
from ...core.effects import Effects
from ...references.protocol.worker import Run
from ...references.published import Datum, Series, Table, label, load, names
from ...references.sampling import sample
from ..input.schema import Discretisation
from ..judge.cells import Head
from ..judge.convergence import follow
from ..judge.printed import Coarse, explained_by_discretisation, printed
from ..judge.reference import Reference
from ..judge.results import Cell, Level
from ..judge.spectrum import Answer, of_blades
from ..judge.uncertainty import from_print
from ..judge.verdict import unsigned
from .core_solver import answers, as_given
from .refinement import solve

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Printed:
    """A series of printed numbers for one blade.

    Attributes:
        name: name of the table and the series, ``park2010/present``.
        source: name of the table, ``park2010``.
        series: the numbers.
        unit: factor from the series' frequencies to rad/s.
        speed: factor from its speeds to rad/s.
    """

    name: str
    source: str
    series: Series
    unit: float
    speed: float

    def at(self, omega: float, names: Sequence[str]) -> list[Datum | None]:
        """The number for each mode, given by names such as ``flapwise 2``, at rotor speed ``omega``."""
        at_speed = {
            f"{d.family} {d.mode}": d for d in self.series.data if np.isclose(d.speed * self.speed, omega, rtol=1e-9)
        }
        return [at_speed.get(name) for name in names]


SAME_BLADE = 1e-3
"""Largest relative difference of length and mass from those of a published deck's blade."""


def about(blade: Blade, tables: Sequence[str]) -> list[Printed]:
    """The series of the ``tables`` whose beam is this blade.

    Raises:
        TableError: if a table does not exist.
    """
    return [
        _printed(blade, name, table, series)
        for name in tables
        for table in [load(name)]
        for series in table.series
        if (series.blade == blade.name if series.blade else not series.deck and _alike(blade, series))
    ]


def about_deck(blade: Blade, speeds: Array) -> list[Printed]:
    """The series of all tables that other programs computed from the deck whose blade this is, by its length and mass.

    Only those with numbers at one of the rotor ``speeds``, rad/s.
    """
    mass = float(np.trapezoid(blade.mass[:, 0, 0], blade.stations))
    candidates = [
        _printed(blade, name, table, series)
        for name in names()
        for table in [load(name)]
        for series in table.series
        if series.deck
        and np.allclose([blade.length, mass], [series.deck.length, series.deck.mass], rtol=SAME_BLADE, atol=0.0)
    ]
    return [p for p in candidates if any(np.isclose(d.speed * p.speed, speeds, rtol=1e-9).any() for d in p.series.data)]


def _printed(blade: Blade, name: str, table: Table, series: Series) -> Printed:
    scale = UNITS.get(table.unit) or 2 * (_rate(blade),)
    return Printed(f"{label(name)}/{series.name}", label(name), series, *scale)


UNITS = {"rad/s": (1.0, 1.0), "rpm, rad/s": (1.0, np.pi / 30), "rpm, Hz": (2 * np.pi, np.pi / 30)}
"""Factors from frequencies and speeds of a table to rad/s; for dimensionless ones the beam's reference frequency."""


def _rate(blade: Blade) -> float:
    section = sample(blade, 0.0)
    return float(np.sqrt(section.EI_z[0] / (section.mass[0] * blade.length**4)))


def _alike(blade: Blade, series: Series) -> bool:
    if series.tapered or not uniform(replace(blade, tip_mass=np.zeros((6, 6)))):
        return False
    section = sample(blade, 0.0)
    point = series.tip_mass_ratio * section.mass[0] * blade.length * np.diag([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    slenderness = blade.length * np.sqrt(section.EA[0] / section.EI_z[0])
    return bool(
        np.allclose(blade.tip_mass, point, rtol=1e-6, atol=1e-12)
        and np.isclose(series.hub_ratio, blade.hub_radius / blade.length, rtol=1e-6, atol=1e-9)
        and (series.slenderness is None or np.isclose(series.slenderness, slenderness, rtol=1e-6))
    )


def rows(
    head: Head, table: Printed, blade: Blade, source: Discretisation | None, core: Sequence[tuple[float, Reference]]
) -> tuple[list[Cell], list[Level]]:
    """Cells of every number in the table for core's modes; ``source`` is the discretisation of the source, if known."""
    cells = []
    series = table.series
    if series.target:
        head = replace(head, target=max(head.target, series.target))
    for omega, reference in core:
        data = table.at(omega, reference.core.names)
        if any(data):
            coarse = (
                discretised(blade, omega, table.series.effects, reference, source) if source else [None] * len(data)
            )
            for i, datum in enumerate(data):
                if datum:
                    value = from_print(datum.printed, table.unit)
                    note = f"suspect print: {datum.evidence}" if datum.suspect else ""
                    cell = printed(head, omega, i, reference, value, note)
                    if series.grounds and cell.verdict == "pass":
                        cell = replace(cell, reason=f"target {unsigned(head.target)}: {series.grounds}")
                    cells.append(explained_by_discretisation(cell, coarse[i], source.label) if source else cell)
    return cells, []


def discretised(
    blade: Blade, omega: float, effects: Effects, reference: Reference, source: Discretisation
) -> list[Coarse | None]:
    """Core's answers for the reference's modes in the source's discretisation, with limits; None without a partner."""
    n, compared = source.elements, reference.core

    def ask(runs: Sequence[Run]) -> list[Answer]:
        return of_blades(answers(blade, runs, source.mass, source.stiffness, effects))

    plan = as_given(source)
    (refinements,) = solve(ask, [omega], plan, reference.core.count, lambda *_: compared)
    fine = follow(refinements.answers, compared, plan.order)
    out: list[Coarse | None] = []
    for mode in fine:
        levels = dict(mode.history)
        is_paired = mode.estimate is not None and n in levels
        out.append(Coarse(levels[n], mode.estimate.value) if is_paired and mode.estimate else None)
    return out or [None] * len(compared.indices)
