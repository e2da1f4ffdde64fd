"""What the conformance checks share: their errors, comparisons within a tolerance, and the questions put to a code."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade
from ...core.effects import Effects
from ...core.modes import Modes
from ...references.protocol.interface import Adapter, BladeAdapter, Independence

Array = NDArray[np.float64]

TOLERANCE = 1e-3
"""Required relative agreement after extrapolation from the two coarsest levels, or the code's error bound if wider."""

ROUNDING = 1e-6
"""Largest relative difference between two answers of one code to the same numbers."""


class BrokenError(AssertionError):
    """A code that fails a check; one line describes its behaviour."""


class NotForItError(Exception):
    """A check that the code declines or that does not apply to it, with the reason."""


def require(true: Any, message: str) -> None:
    """Fail the check with a message unless something holds."""
    if not bool(true):
        raise BrokenError(message)


def require_close(values: Any, exact: Any, label: str, within: float, first: int = 1) -> None:
    """Compare the frequencies (rad/s) of the modes ``first``, … with the expected ones, within a relative tolerance.

    ``label`` names the blade with its parameter and speed; the message adds the mode that differs most.
    """
    values, exact = np.atleast_1d(values), np.atleast_1d(exact)
    require(len(values) >= len(exact), f"{label}: {len(values)} modes, {len(exact)} expected")
    values = values[: len(exact)]
    deviation = np.abs(values / exact - 1.0)
    k = int(deviation.argmax())
    message = f"{label}, mode {first + k}: {values[k]:.9g} rad/s, expected {exact[k]:.9g}"
    require(deviation[k] <= within, f"{message}: {deviation[k]:.1e} apart, at most {within:.0e}")


def named(code: Adapter) -> None:
    """Check the declarations that codes for blades and for mechanisms have in common."""
    require(
        code.name and not set(code.name) & set(" ,:/\n"),
        f"name: {code.name!r}: it is typed on a command line: no spaces, commas, colons or slashes",
    )
    require(code.title.strip(), "title: empty")
    require(
        code.independence is None or isinstance(code.independence, Independence),
        f"independence: {code.independence!r}: not a references.protocol.interface.Independence",
    )
    require(isinstance(code.effects, Effects), f"effects: {code.effects!r}: not a core.effects.Effects")
    version = code.version()
    require(version is None or version.strip(), "version: empty: return None if the code is not installed")
    require(version is not None or code.hint.strip(), "hint: empty: say how to install the code")


def rounding(code: BladeAdapter) -> float:
    """Relative rounding of two answers: half a unit of the last digit each, for a first digit of 1."""
    return 10.0 ** (1 - code.digits)


def same(code: BladeAdapter) -> float:
    """The same for answers to the same numbers, which conditioning does not affect."""
    return min(rounding(code), ROUNDING)


def ask(code: BladeAdapter, blade: Blade, omega: float, level: int, count: int = 4) -> Modes:
    """The modes at one level of refinement, or the reason why the code declines the blade."""
    if reason := code.unsupported(blade):
        raise NotForItError(reason)
    return code.solve(blade, omega, code.levels[level], count)


def limit_of(
    code: BladeAdapter, blade: Blade, omega: float, levels: tuple[int, int] = (0, 1)
) -> tuple[Array, Modes, float]:
    """Frequencies (m,) extrapolated by the declared order from two levels, the finer modes, and their error bound."""
    coarse, fine = (ask(code, blade, omega, level) for level in levels)
    m = min(len(coarse.frequencies), len(fine.frequencies))
    limit = fine.frequencies[:m]
    if code.order:
        gain = (fine.elements / coarse.elements) ** code.order - 1.0
        limit = limit + (limit - coarse.frequencies[:m]) / gain
    return limit, fine, float(max(fine.uncertainty[:m], default=0.0))


def along(modes: Modes, axis: int) -> int:
    """The lowest mode whose tip moves most along ``axis`` of y, z."""
    tips = np.abs(modes.shapes[:, -1, 1:3])
    modes_along = np.flatnonzero(tips[:, axis - 1] > tips[:, 2 - axis])
    require(
        modes_along.size,
        f"no mode of {len(tips)} moves mostly along {'xyz'[axis]} at the tip: check the conversion of axes",
    )
    return int(modes_along[0])


def agrees(code: BladeAdapter, blade: Blade, omega: float, exact: float, axis: int | None = None) -> None:
    """Compare the lowest frequency, or the lowest one along ``axis`` of y, z, with the exact one (rad/s)."""
    limit, fine, bracket = limit_of(code, blade, omega)
    k = 0 if axis is None else along(fine, axis)
    where = "" if axis is None else f" along {'xyz'[axis]}"
    require_close(limit[k], exact, f"{blade.name} at {omega:g} rad/s, lowest{where}", max(bracket, TOLERANCE), k + 1)
