"""``southwell modes`` and ``southwell mechanism``: natural frequencies by the in-house solver."""

from collections.abc import Sequence

import msgspec
import numpy as np
from rich.console import Console

from ...cases.campbell.sweep import ELEMENTS, Method, Named, sweep
from ...cases.input import library
from ...cases.input.schema import speed_range
from ...core.velocity_transformation import MAX_ELEMENTS
from ..shared import not_used
from ..shared.console import output
from ..shared.units import RAD_S, RPM, Units
from ..verification import terminal
from . import mechanism_text as answer
from . import subjects
from .arguments import PASSED, Accuracy, Elements, Flag, UsageError, Whole
from .mounting import Mounting


def modes(
    case: str,
    /,
    *,
    omega: str | None = None,
    rpm: str | None = None,
    elements: Elements | None = None,
    accuracy: Accuracy = 1e-6,
    modes: Whole = 10,
    method: Method = "chain",
    allow_large_strain: Flag = False,
    json: Flag = False,
    mounting: Mounting | None = None,
) -> int:
    """Natural frequencies by the in-house solver, with their families.

    Parameters
    ----------
    case
        A case by name (`southwell cases`), one of its blades as `case/blade`, or its TOML file; or a blade's file: ElastoDyn,
        BeamDyn, BModes, HAWC2, windIO, or Southwell's own TOML and CSV.
    omega
        Rotor speed in rad/s, a list `0,5,10`, or a range `first:last:step` with both ends; by default the case's own speeds,
        or the one that a BModes file states.
    rpm
        The same in revolutions per minute.
    elements
        Beam elements of equal length along the blade; by default, as many as --accuracy takes.
    accuracy
        Largest relative uncertainty of a frequency, without --elements.
    modes
        How many, from the lowest.
    method
        `chain`: block-tridiagonal matrices, no velocity transformation. `velocity-transformation`: the method of Park et al.
        (2010), with dense matrices: 50 elements by default, at most 200.
    allow_large_strain
        Accept steady strains above 20 %.
    json
        Print rows as JSON: case, omega_rad_s, mode, name, frequency_rad_s, frequency_hz, relative_uncertainty (null: unknown),
        steady_strain.
    """
    if method != "chain" and (elements or 0) > MAX_ELEMENTS:
        raise UsageError(
            f"--elements {elements}: --method {method} has dense matrices: at most {MAX_ELEMENTS}; or use --method chain"
        )
    speeds, units = _speeds(omega, rpm)
    rows: list[dict[str, object]] = []
    for subject in subjects.subjects(case, (mounting or Mounting()).mount()):
        if speeds is None and not subject.speeds:
            raise UsageError(f"--rpm: missing: {case} says no speeds: give them, as in 0:15:5")
        blade = subject.blade
        at = subject.speeds if speeds is None else speeds
        found = sweep(blade, at, elements, modes, accuracy, allow_large_strain, method, (units or subject.units).at)
        rows += [_tidy(blade.name, row) for row in found]
        console = Console(stderr=True, highlight=False) if json else output()
        for note in subject.notes:
            console.print(note, style="dim", markup=False, soft_wrap=True)
        not_used.show(subject.unused, console)
        if not json:
            if elements is None and method != "chain":
                elements = ELEMENTS
            mesh = f"accuracy {accuracy:g}" if elements is None else f"{elements} elements"
            title, shown = (
                f"{blade.name}: {len(blade.stations)} stations, {mesh}, method: {method}",
                units or subject.units,
            )
            console.print(terminal.frequencies(found, title, shown))
            for line in terminal.remarks(found, accuracy if elements is None else None, shown):
                console.print(line, markup=False, soft_wrap=True)
    if json:
        print(msgspec.json.format(msgspec.json.encode(rows)).decode())
    return PASSED


def mechanism(
    name: str,
    /,
    *,
    modes: Whole = 10,
    time: float = 0.0,
    json: Flag = False,
) -> int:
    """Steady state and modes of any mechanism: frequencies, damping ratios, what was chosen, what was redundant.

    Parameters
    ----------
    name
        A mechanism by name (`southwell cases`), or a TOML file of bodies and joints.
    modes
        How many, from the lowest.
    time
        The instant looked at, in seconds, where motions are functions of time.
    json
        Print everything as JSON.
    """
    described = library.mechanism(name)
    found = described.solve(modes, time)
    if json:
        plain = msgspec.json.encode(answer.plain(described.text.name, found))
        print(msgspec.json.format(plain).decode())
        return PASSED
    console = output()
    console.print(answer.modes(found, described.text.title or described.text.name))
    console.print(answer.state(found))
    console.print(answer.redundant(found), markup=False, soft_wrap=True)
    return PASSED


def _tidy(case: str, row: Named) -> dict[str, object]:
    return {
        "case": case,
        "omega_rad_s": row.omega,
        "mode": row.mode,
        "name": row.name,
        "frequency_rad_s": row.frequency,
        "frequency_hz": row.frequency / (2 * np.pi),
        "relative_uncertainty": row.uncertainty if np.isfinite(row.uncertainty) else None,
        "steady_strain": row.strain,
    }


def _speeds(omega: str | None, rpm: str | None) -> tuple[Sequence[float] | None, Units | None]:
    if omega is not None and rpm is not None:
        raise UsageError(f"--omega {omega} and --rpm {rpm}: the speed is given twice: give one of them")
    if omega is None and rpm is None:
        return None, None
    option, text, units = ("--omega", omega, RAD_S) if omega is not None else ("--rpm", rpm, RPM)
    try:
        return (speed_range(text or "") / units.speeds).tolist(), units
    except ValueError as error:
        raise UsageError(f"{option}: {error}") from error
