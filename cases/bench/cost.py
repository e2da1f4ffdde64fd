"""Cost of a frequency: core and the other codes on one cantilever, and core with increasing numbers of elements.

Every code runs in a separate process with one thread of linear algebra. In each round the processes run one after
another, so that other load on the machine affects all of them equally. Times are medians over the rounds; their ratios
are compared.
"""

import resource
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np

from ...core.regular_files import read_bytes
from ...core.solve import mesh_modes, mesh_sweep
from ...references.protocol import registry as registry
from ...references.protocol.description import Description, describe
from ...references.protocol.interface import CodeError
from ...references.protocol.process import Limits
from ..input import atomic, library
from ..verify.pool import Pool

CASE = "park-cantilever"
OMEGA = 10.0
SWEEP = tuple(float(v) for v in np.linspace(0.0, 30.0, 31))
ELEMENTS, COUNT = 50, 10
CODES = ("pinocchio", "exudyn-ancf", "exudyn-tree", "scikit-fem", "pybmodes")
SIZES = (50, 500, 5000, 100_000)
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
        equal: core with the fewest elements that are as accurate; None for core itself, and if ``ELEMENTS`` are too few.
        note: why it was not run.
    """

    code: str
    version: str
    single: float | None = None
    sweep: float | None = None
    spread: float | None = None
    error: float | None = None
    equal: "Equal | None" = None
    note: str = ""


@dataclass(frozen=True)
class Equal:
    """Core with the fewest elements whose error is no larger than a code's; seconds as in ``Timing``."""

    elements: int
    single: float
    sweep: float


@dataclass(frozen=True)
class Growth:
    """Core's cost at one speed: time (median, s), and the peak memory of its process less that with one element, bytes."""

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
    """Run the benchmark; ``say`` is called with progress messages.

    Raises:
        UnknownCodeError: if a name is unknown.
    """
    exact = _answer(EXACT, OMEGA, registry.code(EXACT).levels[-1])[1]
    return Bench(
        _side_by_side(say, names, exact), _growth(say), {"python": sys.version.split()[0], "numpy": np.__version__}
    )


def write(path: Path, found: Bench) -> None:
    """Write the results as JSON."""
    atomic.write(path, msgspec.json.format(msgspec.json.encode(found)) + b"\n")


def read(path: Path) -> Bench:
    """Read a file written by ``write``.

    Raises:
        msgspec.DecodeError: if the format is invalid.
    """
    return msgspec.json.decode(read_bytes(path), type=Bench)


def _side_by_side(say: Callable[[str], None], names: Sequence[str], exact: tuple[float, ...]) -> tuple[Timing, ...]:
    known = {code.asked: code for code in describe([name for name in names if name in registry.names()])}
    notes = {name: _absent(known.get(name)) for name in names}
    found = ["core", *(name for name, note in notes.items() if not note)]
    pools = {name: Pool(1) for name in found}
    try:
        error: dict[str, float] = {}
        for name in list(found):  # which loads its libraries too
            say(f"accuracy: {name}")
            try:
                error[name] = _error(pools[name].submit(_answer, name, OMEGA).result(Limits.seconds)[1], exact)
            except (BrokenProcessPool, TimeoutError, CodeError) as why:
                found.remove(name)
                notes[name] = f"no answer: {type(why).__name__}: {why}"
        enough = {name: _enough(pools["core"], error[name], exact) for name in found[1:]}
        runs = [(name, ELEMENTS) for name in found]
        runs += [("core", n) for n in sorted({n for n in enough.values() if n} - {ELEMENTS})]
        single: dict[tuple[str, int], list[float]] = {run: [] for run in runs}
        swept: dict[tuple[str, int], list[float]] = {run: [] for run in runs}
        for turn in range(ROUNDS):
            for name, elements in runs:
                say(f"one speed, round {turn + 1} of {ROUNDS}: {name}")
                single[name, elements].append(pools[name].submit(_answer, name, OMEGA, elements).result()[0])
        for turn in range(SWEEPS):
            for name, elements in runs:
                say(f"{len(SWEEP)} speeds, round {turn + 1} of {SWEEPS}: {name}")
                swept[name, elements].append(pools[name].submit(_swept, name, elements, SWEEP).result())
    finally:
        for pool in pools.values():
            pool.stop()
    one, all_ = ({run: statistics.median(seconds) for run, seconds in times.items()} for times in (single, swept))
    measured = {
        name: Timing(
            name,
            (known[name].version or "") if name in known else "",
            one[name, ELEMENTS],
            all_[name, ELEMENTS],
            max(single[name, ELEMENTS]) / min(single[name, ELEMENTS]),
            error[name],
            Equal(n, one["core", n], all_["core", n]) if (n := enough.get(name)) else None,
        )
        for name in found
    }
    return tuple(measured.get(name) or Timing(name, "", note=notes[name]) for name in ("core", *names))


def _enough(pool: Pool, error: float, exact: tuple[float, ...]) -> int | None:
    """The fewest elements, up to ``ELEMENTS``, with which core's error is no larger."""
    for n in range(2, ELEMENTS + 1):
        if _error(pool.submit(_answer, "core", OMEGA, n).result()[1], exact) <= error:
            return n
    return None


def _error(frequencies: tuple[float, ...], exact: tuple[float, ...]) -> float:
    return max(abs(a / b - 1.0) for a, b in zip(frequencies[: len(exact)], exact, strict=True))


def _absent(code: Description | None) -> str:
    """Why a code is not timed; empty if it is."""
    if code is None:
        return "not a known code"
    return code.failure.reason if code.failure else "" if code.version else code.hint


def _answer(name: str, omega: float, elements: int = ELEMENTS) -> tuple[float, tuple[float, ...]]:
    """Seconds, and the six lowest frequencies (rad/s)."""
    blade = library.load(CASE).variants[0].blade
    code = None if name == "core" else registry.code(name)
    begun = time.perf_counter()
    found = code.solve(blade, omega, elements, COUNT) if code else mesh_modes(blade, omega, elements, COUNT)
    seconds = time.perf_counter() - begun
    if len(found.frequencies) < 6:
        raise CodeError(f"{name}: {len(found.frequencies)} modes found of {COUNT} requested")
    return seconds, tuple(found.frequencies[:6].tolist())


def _swept(name: str, elements: int, speeds: Sequence[float]) -> float:
    """Seconds for all speeds, starting from a new blade."""
    blade = library.load(CASE).variants[0].blade
    code = None if name == "core" else registry.code(name)
    begun = time.perf_counter()
    if code is None:
        for _ in mesh_sweep(blade, speeds, elements, COUNT):
            pass
    else:
        for omega in speeds:
            code.solve(blade, omega, elements, COUNT)
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
    mesh_modes(blade, OMEGA, 1, COUNT)
    before = _peak()
    seconds = []
    for _ in range(3):
        begun = time.perf_counter()
        mesh_modes(blade, OMEGA, elements, COUNT)
        seconds.append(time.perf_counter() - begun)
    return Growth(elements, statistics.median(seconds), _peak() - before)


def _peak() -> int:
    """Peak memory of this process, bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
