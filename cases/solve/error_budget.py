"""Error budget: effect of discretisation, model form and rounding on frequencies, each switched on in core alone.

A difference between two answers has four sources: discretisation, the digits that a table prints, effects missing from
a model, and faults. The first three are reported for each mode; the remainder is due to faults. Each entry is the
relative change of one of core's frequencies when one thing is altered, against core with all effects and its own fine
discretisation:

* discretisation, at the source's number of elements or ``ELEMENTS``: mass lumped at the nodes, stiffness linear in one end's
  frame, both, neither; and the largest uncertainty of the codes after refinement;
* model form: the steady stretch not followed, no Coriolis force, no rotary inertia, no stretch at all, and shear, switched
  on where a blade has none and off where it has;
* rounding: half a unit of the last digit of a printed number.

Only one thing is altered at a time: effects this small add up, except for their products.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.blade import AXIAL, SHEAR_Y, SHEAR_Z, Blade
from ...core.effects import ALL_EFFECTS, Effects
from ...core.element.discretize import Mass
from ...core.element.measures import Measure
from ...core.modes import Modes
from ...core.participation import families, numbered, participation
from ..input.schema import Case, Compare, Variant
from ..judge.pairing import aligned, pair, weights
from ..judge.results import BudgetEntry, Cell
from ..judge.spectrum import of_blade
from .core_solver import answers, qualifying
from .published_tables import about

ELEMENTS = 50
"""Number of elements of the compared discretisations if the source gives none: the paper's."""

FINE = 100
"""Number of elements of the answer they are compared with; its error is below 1e-6 for the modes compared."""

SHEAR = 5 / 6 / (2 * (1 + 0.3))
"""GA/EA of a solid rectangular isotropic section: shear factor 5/6 (Reissner 1945), Poisson's ratio 0.3."""

WAYS: dict[str, tuple[Mass, Measure]] = {
    "lumped mass": ("half_end", "corotational"),
    "parent's frame": ("consistent", "body_fixed"),
    "both": ("half_end", "body_fixed"),
    "neither": ("consistent", "corotational"),
}
"""Discretisations."""

EFFECTS = {
    "no prestretch": Effects(prestretch=False),
    "no Coriolis": Effects(coriolis=False),
    "no rotary inertia": Effects(rotary_inertia=False),
}
"""Omitted effects, one at a time."""

Altered = tuple[str, str, Modes | None]
"""Cause, part, and core's modes with that part altered."""


def solve(case: Case, variant: Variant) -> list[BudgetEntry]:
    """Error budget of one blade's compared modes, at the highest speed with printed numbers, or the highest of all."""
    blade, compare, source = variant.blade, case.text.compare, case.text.discretisation
    printed_speeds = [d.speed * table.speed for table in about(blade, compare.tables) for d in table.series.data]
    printed_at = [omega for omega in variant.speeds.tolist() if np.isclose(omega, printed_speeds, rtol=1e-9).any()]
    omega, count = max(printed_at or variant.speeds.tolist()), 2 * compare.modes + 2
    correct = solved(blade, omega, FINE, count)
    if correct is None:
        return []
    rows = []
    for cause, part, altered in _altered(blade, omega, source.elements if source else ELEMENTS, count):
        if altered is not None:
            changes = changed(correct, altered, blade, compare)
            rows += [BudgetEntry(variant.name, omega, mode.name, cause, part, mode.change) for mode in changes]
    return rows


def _altered(blade: Blade, omega: float, elements: int, count: int) -> Iterator[Altered]:
    for part, (mass, stiffness) in WAYS.items():
        coarse = solved(blade, omega, elements, count, mass=mass, stiffness=stiffness)
        yield "discretisation", f"{part}, {elements} elements", coarse
    for part, effects in EFFECTS.items():
        yield "model form", part, solved(blade, omega, FINE, count, effects)
    for part, altered_blade in _with_other_strains(blade):
        yield "model form", part, solved(altered_blade, omega, FINE, count)


def solved(
    blade: Blade,
    omega: float,
    elements: int,
    count: int,
    effects: Effects = ALL_EFFECTS,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
) -> Modes | None:
    """Core's modes on one mesh; None without an answer, as of an altered blade that nothing holds."""
    try:
        with np.errstate(invalid="ignore"):
            (answer,) = answers(blade, [(omega, elements, count)], mass, stiffness, effects)
    except (ArithmeticError, ValueError):
        return None
    return answer if isinstance(answer, Modes) else None


def _with_other_strains(blade: Blade) -> Iterator[tuple[str, Blade]]:
    """The blade without stretch, and with its shear switched between rigid and flexible."""
    shear = [SHEAR_Y, SHEAR_Z]
    rigid = np.isinf(blade.stiffness[:, shear, shear])
    axial = blade.stiffness[:, AXIAL, AXIAL]
    if np.isfinite(axial).all():
        yield "no stretch", _rigid(blade, [AXIAL])
        if rigid.all():
            stiffness = blade.stiffness.copy()
            stiffness[:, shear, shear] = SHEAR * axial[:, None]
            yield "with shear (κ = 5/6, ν = 0.3)", replace(blade, stiffness=stiffness)
    if not rigid.any():
        yield "no shear", _rigid(blade, shear)


def _rigid(blade: Blade, strains: Sequence[int]) -> Blade:
    stiffness = blade.stiffness.copy()
    for k in strains:
        stiffness[:, k, :] = stiffness[:, :, k] = 0.0
        stiffness[:, k, k] = np.inf
    return replace(blade, stiffness=stiffness)


def uncertain(case: str, rows: Sequence[BudgetEntry], cells: Sequence[Cell]) -> list[BudgetEntry]:
    """Largest numerical uncertainty of the codes and rounding of printed numbers, for the modes and speed of ``rows``."""
    out = []
    for omega, name in dict.fromkeys((r.omega, r.mode) for r in rows):
        of_mode = [c for c in cells if c.omega == omega and c.uncertainty is not None and c.name == name]
        comparable = [c for c in of_mode if c.verdict in ("pass", "known difference")]
        for cause, part, role in (
            ("discretisation", "codes, refined", "code"),
            ("rounding", "printed digits", "table"),
        ):
            of_role = [c for c in comparable if c.role == role]
            # an error bound given by a code is not a discretisation error
            sizes = [c.uncertainty or 0.0 for c in of_role if role != "code" or c.order is not None]
            if sizes:
                out.append(BudgetEntry(case, omega, name, cause, part, max(sizes), bound=True))
    return out


@dataclass(frozen=True)
class ModeChange:
    """Name and frequencies (rad/s) of one mode with and without the alteration; ``altered`` is None if no mode corresponds."""

    name: str
    correct: float
    altered: float | None

    @property
    def change(self) -> float | None:
        """Relative difference of ``altered`` from ``correct``."""
        return None if self.altered is None else self.altered / self.correct - 1.0


def changed(correct: Modes, altered: Modes, blade: Blade, compare: Compare) -> tuple[ModeChange, ...]:
    """The modes of ``correct`` that a case compares, with names, and the most similar modes of ``altered``."""
    weight = weights(blade)
    correct, altered = aligned(correct, weight), aligned(altered, weight)
    energies = participation(correct, blade)
    indices, names = qualifying(energies, compare), numbered(families(energies))
    partners = [p.mode for p in pair(of_blade(correct, weight), of_blade(altered), indices)]
    return tuple(
        ModeChange(names[k], float(correct.frequencies[k]), None if p is None else float(altered.frequencies[p]))
        for k, p in zip(indices, partners, strict=True)
    )
