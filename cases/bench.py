"""What a frequency costs: core and the other codes on one cantilever, side by side, and core as the elements multiply.

Every code has a process of its own with one thread of linear algebra; in each round the processes work one after another, so
that whatever else the machine does falls on all of them alike. Figures are medians over the rounds, and what is compared are
their ratios.
"""

import resource
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np

from ..core.solve import modes, sweep
from ..references import codes as registry
from ..references.interface import CodeError
from . import library
from .pool import Pool

CASE = "park-cantilever"
OMEGA = 10.0
SWEEP = tuple(float(v) for v in np.linspace(0.0, 30.0, 31))
ELEMENTS, COUNT = 50, 10
CODES = ("pinocchio", "exudyn-ancf", "exudyn-tree", "scikit-fem", "pybmodes")
SIZES = (50, 500, 5000)
ROUNDS, SWEEPS = 7, 3
EXACT = "exact-beam"


@dataclass(frozen=True)
class Timing:
    """One code's cost at ``ELEMENTS`` elements; seconds, medians over the rounds.

    Attributes:
        code: its name; ``core`` is the in-house solver.
        version: empty for one that was not run.
        single: one speed, from the blade to the modes.
        sweep: all of ``SWEEP``, likewise.
        spread: largest over smallest of the single speeds' times.
        error: largest relative difference of the six lowest frequencies from the exact beam's, at one speed.
        note: why it was not run.
    """

    code: str
    version: str
    single: float | None = None
    sweep: float | None = None
    spread: float | None = None
    error: float | None = None
    note: str = ""


@dataclass(frozen=True)
class Growth:
    """Core's cost at one speed: seconds (median), and the memory its process came to beyond that of one element, bytes."""

    elements: int
    seconds: float
    memory: int


@dataclass(frozen=True)
class Bench:
    """Everything measured in one run; the settings are this module's constants."""

    timings: tuple[Timing, ...]
    growth: tuple[Growth, ...]
    versions: dict[str, str]


def bench(say: Callable[[str], None], names: Sequence[str] = CODES) -> Bench:
    """Measure; ``say`` is told what is being done.

    Raises:
        UnknownCodeError: a name that no code has.
    """
    exact = _answer(EXACT, OMEGA)[1]
    return Bench(
        _side_by_side(say, names, exact), _growth(say), {"python": sys.version.split()[0], "numpy": np.__version__}
    )


def write(path: Path, found: Bench) -> None:
    """Keep what was measured, as JSON."""
    path.write_bytes(msgspec.json.format(msgspec.json.encode(found)) + b"\n")


def read(path: Path) -> Bench:
    """What ``write`` kept.

    Raises:
        msgspec.DecodeError: if the file is not such a one.
    """
    return msgspec.json.decode(path.read_bytes(), type=Bench)


def _side_by_side(say: Callable[[str], None], names: Sequence[str], exact: tuple[float, ...]) -> tuple[Timing, ...]:
    versions = {name: _version(name) for name in names if name in registry.names()}
    found = ["core", *(name for name, version in versions.items() if version)]
    pools = {name: Pool(1) for name in found}
    single: dict[str, list[float]] = {name: [] for name in found}
    swept: dict[str, list[float]] = {name: [] for name in found}
    error: dict[str, float] = {}
    try:
        for turn in range(ROUNDS + 1):  # the first only loads libraries
            for name, pool in pools.items():
                say(f"one speed, round {turn} of {ROUNDS}: {name}")
                seconds, frequencies = pool.submit(_answer, name, OMEGA).result()
                error[name] = max(abs(a / b - 1.0) for a, b in zip(frequencies[: len(exact)], exact, strict=True))
                if turn:
                    single[name].append(seconds)
        for turn in range(SWEEPS):
            for name, pool in pools.items():
                say(f"{len(SWEEP)} speeds, round {turn + 1} of {SWEEPS}: {name}")
                swept[name].append(pool.submit(_swept, name).result())
    finally:
        for pool in pools.values():
            pool.stop()
    measured = {
        name: Timing(
            name,
            versions.get(name) or "",
            statistics.median(single[name]),
            statistics.median(swept[name]),
            max(single[name]) / min(single[name]),
            error[name],
        )
        for name in found
    }
    return tuple(measured.get(name) or Timing(name, "", note=_hint(name)) for name in ("core", *names))


def _version(name: str) -> str | None:
    return registry.code(name).version()


def _hint(name: str) -> str:
    return registry.code(name).hint if name in registry.names() else "not among the codes known here"


def _answer(name: str, omega: float) -> tuple[float, tuple[float, ...]]:
    """Seconds, and the six lowest frequencies (rad/s)."""
    blade = library.load(CASE).variants[0].blade
    code = None if name == "core" else registry.code(name)
    elements = ELEMENTS if name != EXACT else registry.code(EXACT).levels[-1]
    begun = time.perf_counter()
    found = code.solve(blade, omega, elements, COUNT) if code else modes(blade, omega, elements, COUNT)
    seconds = time.perf_counter() - begun
    if len(found.frequencies) < 6:
        raise CodeError(f"{name}: {len(found.frequencies)} modes found of {COUNT} asked for")
    return seconds, tuple(found.frequencies[:6].tolist())


def _swept(name: str) -> float:
    """Seconds for all speeds of the sweep, the blade new."""
    blade = library.load(CASE).variants[0].blade
    code = None if name == "core" else registry.code(name)
    begun = time.perf_counter()
    if code is None:
        for _ in sweep(blade, SWEEP, ELEMENTS, COUNT):
            pass
    else:
        for omega in SWEEP:
            code.solve(blade, omega, ELEMENTS, COUNT)
    return time.perf_counter() - begun


def _growth(say: Callable[[str], None]) -> tuple[Growth, ...]:
    out = []
    for elements in SIZES:
        say(f"core, {elements} elements")
        pool = Pool(1)  # a new process: its peak of memory is this size's
        try:
            out.append(pool.submit(_grown, elements).result())
        finally:
            pool.stop()
    return tuple(out)


def _grown(elements: int) -> Growth:
    blade = library.load(CASE).variants[0].blade
    modes(blade, OMEGA, 1, COUNT)
    before = _peak()
    seconds = []
    for _ in range(3):
        begun = time.perf_counter()
        modes(blade, OMEGA, elements, COUNT)
        seconds.append(time.perf_counter() - begun)
    return Growth(elements, statistics.median(seconds), _peak() - before)


def _peak() -> int:
    """The most memory this process has had, bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
