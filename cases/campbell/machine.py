"""The Campbell diagram of a whole turbine: named modes in the ground's frame over rotor speed, and where they meet nP."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.rotor.periodic import PeriodicError
from ...core.turbine.machine import FINER, Resolution, machine
from ...core.turbine.tracking import tracked
from ...core.turbine.turbine import Turbine
from ...core.turbine.turbine_modes import TurbineModes, turbine_modes
from ..input.errors import NO_STATE, CaseError, rad_s, unsteady
from .required import TEN_PERCENT, RequiredMargin
from .resonances import Range

Array = NDArray[np.float64]

SPARE = 4
"""Modes solved above those requested, so that each finds its successor."""

SAFETY = 3.0
"""Factor from a change under refinement to the uncertainty of a frequency."""

HARMONICS = 3
"""Largest |h| of the frequencies ω + hΩ by which a line continues."""

_POINTS = 2001  # speeds at which lines between solved speeds are compared with nP


@dataclass(frozen=True)
class MachineRequest:
    """Settings of a turbine's diagram; ``speeds`` in rad/s, ascending; otherwise as ``CampbellRequest``."""

    speeds: Sequence[float]
    modes: int = 12
    per_rev: tuple[int, ...] = (1, 2, 3, 4, 5, 6)
    operating: Range | None = None
    margin: RequiredMargin = TEN_PERCENT


@dataclass(frozen=True)
class ModeLine:
    """One mode over speed.

    Attributes:
        name: its most frequent name, numbered where two lines share one.
        frequencies: (k,) rad/s, in the ground's frame; of two blades, at speeds where its name is another, that of the mode's
            frequencies ω + hΩ which continues the line.
        names: (k,) its name at each speed.
        confidence: (k,) part of the elastic energy in the motion that names it.
        uncertainty: relative numerical uncertainty.
        places: (k,) index of the mode among those solved at each speed.
    """

    name: str
    frequencies: Array
    names: tuple[str, ...]
    confidence: Array
    uncertainty: float
    places: tuple[int, ...]


@dataclass(frozen=True)
class Crossing:
    """A speed, rad/s, at which a line meets n per revolution, interpolated between solved speeds."""

    line: int
    per_rev: int
    omega: float


@dataclass(frozen=True)
class Nearest:
    """The smallest distance of a line from n per revolution over the operating range.

    Attributes:
        line: index of the line.
        per_rev: n.
        omega: speed of the smallest distance, rad/s.
        distance: relative to nP; 0 where they meet.
        kept: whether the required margin is kept.
    """

    line: int
    per_rev: int
    omega: float
    distance: float
    kept: bool


@dataclass(frozen=True)
class MachineDiagram:
    """A turbine's diagram; ``solved`` are the modes at each speed."""

    turbine: Turbine
    request: MachineRequest
    omega: Array
    lines: tuple[ModeLine, ...]
    crossings: tuple[Crossing, ...]
    nearest: tuple[Nearest, ...]
    solved: tuple[TurbineModes, ...]

    @property
    def kept(self) -> bool:
        """Whether all required margins are kept."""
        return all(n.kept for n in self.nearest)


def machine_diagram(
    turbine: Turbine,
    request: MachineRequest,
    at: Callable[[float], str] = rad_s,
) -> MachineDiagram:
    """Compute a turbine's diagram.

    Raises:
        CaseError: fewer than two speeds, or no stable steady state at one.
    """
    omega = np.array(request.speeds)
    if len(omega) < 2:
        raise CaseError(f"speeds: {len(omega)} given: a diagram needs at least two; give a range first:last:step")
    if turbine.blades == 2 and not omega.all():
        raise CaseError(
            f"speeds: 0: the modes of two blades at rest depend on the azimuth; give speeds above 0, as in "
            f"{at(0.25 * omega[-1])} to {at(float(omega[-1]))}"
        )

    def solve(resolution: Resolution | None, speeds: Sequence[float]) -> list[TurbineModes]:
        out: list[TurbineModes] = []
        try:
            full_machine = machine(turbine, resolution)
            for speed in speeds:
                out.append(turbine_modes(full_machine, float(speed), request.modes + SPARE))
        except PeriodicError as error:
            raise CaseError(f"{turbine.name}: {error}") from error
        except NO_STATE as error:
            raise unsteady(turbine.name, float(speeds[len(out)]), error, at) from error
        return out

    solved = solve(None, request.speeds)
    doubt = _doubt((solved[0], solved[-1]), solve(FINER, (omega[0], omega[-1])))
    # from the highest speed downwards: at rest, whirls of a symmetric rotor have no definite shape
    order = tracked(solved[::-1])[::-1]
    selection = np.argsort(solved[0].frequencies[order[0]], kind="stable")[: request.modes]
    mode_lines = [_line(solved, [int(places[t]) for places in order], doubt) for t in selection]
    if turbine.blades == 2:
        mode_lines = [replace(line, frequencies=continued(line, omega)) for line in mode_lines]
    lines = _numbered(mode_lines)
    return MachineDiagram(
        turbine=turbine,
        request=request,
        omega=omega,
        lines=lines,
        crossings=tuple(c for n, line in enumerate(lines) for c in _crossings(n, line, omega, request.per_rev)),
        nearest=_margins(lines, omega, request),
        solved=tuple(solved),
    )


def _doubt(coarse: Sequence[TurbineModes], fine: Sequence[TurbineModes]) -> Array:
    """(m,) relative uncertainty of the modes in order of frequency: the larger change of both speeds, times ``SAFETY``."""
    changes = [np.abs(a.frequencies / b.frequencies - 1.0) for a, b in zip(coarse, fine, strict=True)]
    return SAFETY * np.maximum.accumulate(np.max(changes, axis=0))


def _line(solved: Sequence[TurbineModes], places: Sequence[int], doubt: Array) -> ModeLine:
    names = tuple(modes.names[k] for modes, k in zip(solved, places, strict=True))
    turning = [name for name, modes in zip(names, solved, strict=True) if modes.omega] or list(names)
    return ModeLine(
        name=Counter(turning).most_common(1)[0][0],
        frequencies=np.array([modes.frequencies[k] for modes, k in zip(solved, places, strict=True)]),
        names=names,
        confidence=np.array([modes.confidence[k] for modes, k in zip(solved, places, strict=True)]),
        uncertainty=float(doubt[list(places)].max()),
        places=tuple(places),
    )


def continued(line: ModeLine, omega: Array) -> Array:
    """(k,) frequencies of a line of a periodic system, continued through speeds at which its name is another.

    A mode moves at ω + hΩ. There, its largest motion is another, perhaps at another h than before: the frequency is the one
    nearest to the straight line of f² over Ω² through the speeds with the line's own name.
    """
    own = np.array([name == line.name for name in line.names])
    expected = np.sqrt(np.interp(omega**2, omega[own] ** 2, line.frequencies[own] ** 2))
    candidates = np.abs(line.frequencies + np.arange(-HARMONICS, HARMONICS + 1)[:, None] * omega)
    nearest = np.abs(candidates - expected).argmin(0)
    return np.where(own, line.frequencies, np.take_along_axis(candidates, nearest[None], 0)[0])


def _numbered(lines: Sequence[ModeLine]) -> tuple[ModeLine, ...]:
    """The lines, of which those of equal name are numbered from the second on."""
    occurrences: Counter[str] = Counter()
    out = []
    for line in lines:
        occurrences[line.name] += 1
        name = line.name if occurrences[line.name] == 1 else f"{line.name} ({occurrences[line.name]})"
        out.append(replace(line, name=name))
    return tuple(out)


def _crossings(index: int, line: ModeLine, omega: Array, per_rev: Sequence[int]) -> list[Crossing]:
    fine = np.linspace(omega[0], omega[-1], _POINTS)
    values = _between(line, omega, fine)
    out = []
    for n in per_rev:
        excess = values - n * fine
        for k in np.flatnonzero(np.signbit(excess[:-1]) != np.signbit(excess[1:])):
            part = excess[k] / (excess[k] - excess[k + 1])
            out.append(Crossing(index, n, float(fine[k] + part * (fine[k + 1] - fine[k]))))
    return out


def _margins(lines: Sequence[ModeLine], omega: Array, request: MachineRequest) -> tuple[Nearest, ...]:
    if not request.operating:
        return ()
    low, high = request.operating
    speeds = np.linspace(max(low, 1e-9 * high), high, _POINTS)
    out = []
    for index, line in enumerate(lines):
        values = _between(line, omega, speeds)
        for n in request.per_rev:
            distance = values - n * speeds
            meets = bool((np.signbit(distance[:-1]) != np.signbit(distance[1:])).any())
            relative = np.abs(distance) / (n * speeds)
            k = int(relative.argmin())
            required = np.array([request.margin.distance(n * speed) for speed in speeds.tolist()])
            is_kept = not meets and bool((np.abs(distance) * (1 - line.uncertainty) >= required).all())
            out.append(Nearest(index, n, float(speeds[k]), 0.0 if meets else float(relative[k]), is_kept))
    return tuple(out)


def _between(line: ModeLine, omega: Array, speeds: Array) -> Array:
    """Frequencies between the solved speeds, by the straight line of f² over Ω²."""
    return np.sqrt(np.interp(speeds**2, omega**2, line.frequencies**2))
