"""The Sandia rotor's frequencies, simulated over the speeds and compared with the measured ones point by point.

Modes are named by symmetry and direction. Under half a turn about the rotor's axis a mode is unchanged (symmetric, S) or
changes its sign (antisymmetric, A). The blades move in their own plane (flatwise, F) or normal to it (edgewise, E). ``FA 2``
is the second flatwise antisymmetric mode.
"""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from ...core import multibody as mb
from ...core.participation import numbered
from ..judge.measured import Validation
from . import sandia34
from .points import RPM, Point
from .sandia34 import Variation

Array = NDArray[np.float64]

SPEEDS = (0.0, 10.0, 20.0, 30.0, 40.0)
"""Rotor speeds in rpm at which the model is solved; ``at_speed`` interpolates between them."""

VARIED_AT = (0.0, 20.0, 40.0)
"""Rotor speeds in rpm at which the inputs are varied; u_input is interpolated linearly."""

COUNT = 12
"""Number of modes computed; all measured modes are among them."""

ORDER = 2
"""Order of convergence as elements are halved: curved members consist of straight elements. The order observed at rest, with
every element divided into four, is 1.85 to 2.21 for all measured modes."""


@cache
def data() -> dict[str, Any]:
    """The data in ``sandia34_measured.toml``."""
    return tomllib.loads((files(str(__package__)) / "sandia34_measured.toml").read_text(encoding="utf-8"))


def named(solution: mb.Solution) -> dict[str, float]:
    """Frequencies (Hz) of a solution by mode name."""
    state = solution.linear.state.kinematics
    bodies = [b.name for b in solution.linear.tree.mechanism.bodies]
    number = sum(name.startswith("right ") for name in bodies)
    sides = [np.array([bodies.index(f"{side} {k}") for k in range(1, number + 1)]) for side in ("right", "left")]
    kinds = []
    for shape in solution.shapes:
        twist = state.B @ shape  # of every body, taken at the ground's origin
        right, left = (twist[s, :3] + np.cross(twist[s, 3:], state.poses[s, :3, 3]) for s in sides)
        half_turn = left * [-1.0, -1.0, 1.0]
        symmetric = np.linalg.norm(right + half_turn) > np.linalg.norm(right - half_turn)
        across = np.linalg.norm(right[:, 1])
        kinds.append(("E" if across > np.linalg.norm(right[:, [0, 2]]) else "F") + ("S" if symmetric else "A"))
    return dict(zip(numbered(kinds), (solution.frequencies / (2.0 * np.pi)).tolist(), strict=True))


def solved(rpm: float, how: Variation) -> dict[str, float]:
    """The model's frequencies (Hz) by name at one speed."""
    return named(mb.solve(sandia34.mechanism(rpm * RPM, how), count=COUNT))


@dataclass(frozen=True)
class Simulated:
    """Frequencies of the model over the rotor speeds.

    Attributes:
        base: frequencies (Hz) by mode name at each of ``SPEEDS``.
        inputs: u_input (Hz) of each mode at each of ``VARIED_AT``.
        numerical: relative discretisation error of each mode at rest, from the change when every element is halved.
    """

    base: tuple[dict[str, float], ...]
    inputs: tuple[dict[str, float], ...]
    numerical: dict[str, float]


def changes(base: dict[str, float], varied: dict[str, float]) -> dict[str, float]:
    """Absolute change (Hz) of each mode of ``base`` in a slightly different model; ∞ if that model has too few modes.

    Modes of equal symmetry veer instead of crossing as the model changes, and may exchange their dominant motion. The k-th
    symmetric mode of one model therefore corresponds to the k-th symmetric mode of the other, likewise the antisymmetric.
    """
    out = {}
    for symmetry in "SA":
        base_modes, varied_modes = (
            [(n, f) for n, f in at.items() if n.split()[0].endswith(symmetry)] for at in (base, varied)
        )
        other_frequencies = sorted(f for _, f in varied_modes)
        for k, (name, f) in enumerate(sorted(base_modes, key=lambda mode: mode[1])):
            out[name] = abs(other_frequencies[k] - f) if k < len(other_frequencies) else np.inf
    return out


def inputs(at: Sequence[dict[str, float]]) -> dict[str, float]:
    """u_input from the frequencies of all ``variations`` at one speed: root of the sum of squared changes."""
    plain, *variations = at
    shifts = [changes(plain, variation) for variation in variations]
    return {name: float(np.sqrt(sum(m[name] ** 2 for m in shifts))) for name in plain}


def variations() -> tuple[Variation, ...]:
    """The model, followed by one variation of each uncertain input: by its standard uncertainty, or to the alternative."""
    u = sandia34.data()["uncertainty"]
    return (
        Variation(),
        Variation(stiffness=1.0 + u["stiffness"]),
        Variation(mass=1.0 + u["mass"]),
        Variation(centre="across the chord"),
        Variation(centre="along the chord"),
        Variation(mirrored=True),
    )


def simulated() -> Simulated:
    """Solve the model at all speeds, with varied inputs and with a refined mesh: 21 solutions, a few minutes."""
    base = tuple(solved(rpm, Variation()) for rpm in SPEEDS)
    varied = tuple(
        inputs([base[SPEEDS.index(rpm)], *(solved(rpm, how) for how in variations()[1:])]) for rpm in VARIED_AT
    )
    fine = solved(0.0, Variation(refine=2))
    richardson = 2.0**ORDER / (2.0**ORDER - 1.0)
    return Simulated(base, varied, {name: richardson * d / base[0][name] for name, d in changes(base[0], fine).items()})


def at_speed(values: Sequence[float], rpm: float) -> tuple[float, float]:
    """A frequency interpolated between ``SPEEDS``, and the error of the interpolation; both in Hz.

    By Southwell's law f² is nearly linear in Ω², less so where modes veer. It is interpolated by a monotone cubic (PCHIP);
    the difference from linear interpolation bounds the error.
    """
    x, y = np.square(SPEEDS), np.square(values)
    smooth = float(PchipInterpolator(x, y)(rpm**2))
    straight = float(np.interp(rpm**2, x, y))
    return smooth**0.5, abs(smooth**0.5 - straight**0.5)


def points(model: Simulated) -> tuple[Point, ...]:
    """Every measured point of a mode that the model has, with the simulated frequency at its speed."""
    out = []
    for line in data()["lines"]:
        for rpm, measured in line["points"]:
            at_modes = [at_speed([at[name] for at in model.base], rpm) for name in line["of"]]
            all_, between = [f for f, _ in at_modes], max(u for _, u in at_modes)
            S = float(np.mean(all_))
            half_spread = 0.5 * (max(all_) - min(all_))  # which of a pair was measured is not known
            discretised = max(model.numerical[name] for name in line["of"]) * S
            numerical = np.sqrt(discretised**2 + half_spread**2 + between**2)
            u = max(np.interp(rpm, VARIED_AT, [at[name] for at in model.inputs]) for name in line["of"])
            out.append(
                Point(line["name"], rpm, Validation(S, measured, float(numerical), float(u), data()["uncertainty"]))
            )
    return tuple(out)
