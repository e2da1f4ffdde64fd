"""Run time of core and of other codes on one blade, and of core with more elements: ``make bench`` writes docs/run-time.md.

Every code runs in a process of its own with one thread of linear algebra. In each round the processes run one after another, so
that other load on the machine affects all of them equally. Times are medians over the rounds. Quote ratios of one run: times
depend on the machine.
"""

import resource
import statistics
import sys
import time
from collections.abc import Iterable, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
from dataclasses import dataclass
from itertools import pairwise
from math import log
from multiprocessing import get_context
from pathlib import Path
from platform import machine, python_version, system

import numpy as np
from tabulate import tabulate

from southwell.cases.input import library
from southwell.core.solve import mesh_modes, mesh_sweep
from southwell.references.protocol import registry
from southwell.references.protocol.interface import CodeError

PAGE = Path(__file__).parents[1] / "docs" / "run-time.md"
CASE, OMEGA, SWEEP = "park-cantilever", 10.0, tuple(np.linspace(0.0, 30.0, 31).tolist())
ELEMENTS, COUNT, COMPARED = 50, 10, 6
CODES = ("pinocchio", "exudyn-ancf", "exudyn-tree", "scikit-fem", "pybmodes")
CORE, EXACT = "Southwell", "exact-beam"
SIZES = (50, 500, 5000, 100_000)
ROUNDS, SWEEPS = 7, 3
MIN_PEAK = 2**20
"""Smallest growth of a process's peak memory that is significant, bytes."""


@dataclass(frozen=True)
class Cost:
    """Seconds of one code with some number of elements, medians over the rounds.

    Attributes:
        code: name and version.
        elements: number of elements.
        single: one speed, from the blade to the modes.
        sweep: one of the speeds of a sweep.
        error: largest relative error of the six lowest frequencies at one speed, from the exact beam's.
    """

    code: str
    elements: int
    single: float
    sweep: float
    error: float


@dataclass(frozen=True)
class Growth:
    """Core's time at one speed (median, s), and the growth of its process's peak memory (bytes)."""

    elements: int
    seconds: float
    memory: int


def main() -> None:
    """Measure, and write the page."""
    names = [CORE, *(name for name in CODES if name in registry.names() and registry.code(name).version())]
    exact = _answer(EXACT, registry.code(EXACT).levels[-1])[1]
    with ExitStack() as stack:
        pools: dict[str, Executor] = {name: stack.enter_context(_process()) for name in names}
        costs, as_accurate = measure(pools, exact)
    text = page(costs, as_accurate, [_grown_alone(n) for n in SIZES], sorted({*CODES} - {*pools, CORE}))
    PAGE.write_text(text, encoding="utf-8")
    print(text)


def measure(pools: dict[str, Executor], exact: Sequence[float]) -> tuple[list[Cost], dict[str, Cost | None]]:
    """Time every code with ``ELEMENTS`` elements, and core with the fewest elements that are as accurate as each.

    A code that fails is reported on standard error and removed from ``pools``.

    Args:
        pools: a process for each code, by name; with ``CORE``.
        exact: (COMPARED,) frequencies of the exact beam, rad/s.

    Returns:
        The costs in the order of ``pools``; for each other code core's cost, None if ``ELEMENTS`` elements are too few.
    """
    errors: dict[str, float] = {}
    for name in list(pools):  # the first answer also imports and compiles
        try:
            errors[name] = _error(pools[name].submit(_answer, name, ELEMENTS).result()[1], exact)
        except (BrokenProcessPool, CodeError) as error:
            print(f"{name}: not compared: {type(error).__name__}: {error}", file=sys.stderr)
            del pools[name]
    fewest = {name: _fewest(pools[CORE], errors[name], exact) for name in pools if name != CORE}
    runs = [(name, ELEMENTS) for name in pools]
    runs += [(CORE, n) for n in sorted({n for n in fewest.values() if n} - {ELEMENTS})]
    singles: dict[tuple[str, int], list[float]] = {run: [] for run in runs}
    sweeps: dict[tuple[str, int], list[float]] = {run: [] for run in runs}
    for _ in range(ROUNDS):
        for name, elements in runs:
            singles[name, elements].append(pools[name].submit(_answer, name, elements).result()[0])
    for _ in range(SWEEPS):
        for name, elements in runs:
            sweeps[name, elements].append(pools[name].submit(_sweep, name, elements).result() / len(SWEEP))

    def cost(name: str, elements: int) -> Cost:
        version = "" if name == CORE else f" {registry.code(name).version()}"
        single, sweep = (statistics.median(times[name, elements]) for times in (singles, sweeps))
        return Cost(f"{name}{version}", elements, single, sweep, errors[name])

    costs = [cost(name, ELEMENTS) for name in pools]
    return costs, {cost(name, ELEMENTS).code: cost(CORE, n) if n else None for name, n in fewest.items()}


def _process() -> ProcessPoolExecutor:
    return ProcessPoolExecutor(1, get_context("spawn"))


def _fewest(pool: Executor, error: float, exact: Sequence[float]) -> int | None:
    """The fewest elements, up to ``ELEMENTS``, with which core's error is no larger."""
    for n in range(2, ELEMENTS + 1):
        if _error(pool.submit(_answer, CORE, n).result()[1], exact) <= error:
            return n
    return None


def _error(frequencies: Sequence[float], exact: Sequence[float]) -> float:
    return max(abs(a / b - 1.0) for a, b in zip(frequencies, exact, strict=True))


def _answer(name: str, elements: int) -> tuple[float, tuple[float, ...]]:
    """Seconds for one speed, and the six lowest frequencies (rad/s)."""
    blade = library.load(CASE).variants[0].blade
    code = None if name == CORE else registry.code(name)
    begun = time.perf_counter()
    modes = code.solve(blade, OMEGA, elements, COUNT) if code else mesh_modes(blade, OMEGA, elements, COUNT)
    seconds = time.perf_counter() - begun
    if len(modes.frequencies) < COMPARED:
        raise CodeError(f"{name}: {len(modes.frequencies)} modes found of {COUNT} requested")
    return seconds, tuple(modes.frequencies[:COMPARED].tolist())


def _sweep(name: str, elements: int) -> float:
    """Seconds for all speeds of the sweep, starting from a new blade."""
    blade = library.load(CASE).variants[0].blade
    code = None if name == CORE else registry.code(name)
    begun = time.perf_counter()
    solved: Iterable[object] = (
        (code.solve(blade, omega, elements, COUNT) for omega in SWEEP)
        if code
        else mesh_sweep(blade, SWEEP, elements, COUNT)
    )
    for _ in solved:
        pass
    return time.perf_counter() - begun


def _grown_alone(elements: int) -> Growth:
    with _process() as pool:  # a new process: its peak memory is that of this size
        return pool.submit(_grown, elements).result()


def _grown(elements: int) -> Growth:
    blade = library.load(CASE).variants[0].blade
    mesh_modes(blade, OMEGA, 1, COUNT)
    before, seconds = _peak_memory(), []
    for _ in range(3):
        begun = time.perf_counter()
        mesh_modes(blade, OMEGA, elements, COUNT)
        seconds.append(time.perf_counter() - begun)
    return Growth(elements, statistics.median(seconds), _peak_memory() - before)


def _peak_memory() -> int:
    """Peak memory of this process, bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


# ------------------------------------------------------------------------------------------------------------ the page


def page(
    costs: Sequence[Cost], as_accurate: dict[str, Cost | None], growth: Sequence[Growth], absent: Sequence[str]
) -> str:
    """The page in Markdown."""
    core = next(c for c in costs if c.code == CORE)
    missing = f"Not compared, because it is not installed or failed: {', '.join(absent)}.\n\n" if absent else ""
    return f"""# Run time

Written by `make bench` with Python {python_version()} and NumPy {np.__version__} on {system()} {machine()}.

The blade is the uniform cantilever of Park et al. (2010) with {ELEMENTS} elements and the {COUNT} lowest modes. It is timed
from the blade to the modes at one speed ({OMEGA:g} rad/s) and in a sweep of {len(SWEEP)} speeds. Each process has one thread;
times are medians over rounds in which the codes take turns. *× Southwell* is the time relative to Southwell's own solver with
as many elements. The error is the largest error of the {COMPARED} lowest frequencies relative to the exact beam, at one speed.

{_table([_cost(c, core) for c in costs])}

{missing}## At equal accuracy

Each code with {ELEMENTS} elements, and Southwell with the fewest elements whose error is no larger, at most {ELEMENTS}.

{_table([_pair(c, as_accurate[c.code]) for c in costs if c is not core])}

## What is timed

Included: building each code's model, its steady state and its eigenproblem. In a sweep Southwell and scikit-fem build their
model once, and Southwell starts each speed from the previous ones; the other codes start anew. Excluded: starting the process,
importing libraries, compilation, reading the blade's file, and estimating the uncertainty. Southwell is timed on one mesh, as
the other codes are; `southwell modes` refines the mesh and takes longer.

## Southwell with more elements

{_table([_growth(g) for g in growth])}

{exponents(growth)}
"""


def exponents(growth: Sequence[Growth]) -> str:
    """How time and memory grow, as powers of the number of elements."""
    steps = ", ".join(f"N^{_power(a, b, 'seconds'):.2f} from {a.elements} to {b.elements}" for a, b in pairwise(growth))
    significant = [g for g in growth if g.memory > MIN_PEAK]
    if len(significant) < 2:
        return f"Time grows as {steps}."
    power = _power(significant[0], significant[-1], "memory")
    return f"Time grows as {steps}; memory as N^{power:.2f} from {significant[0].elements} on."


def _power(a: Growth, b: Growth, quantity: str) -> float:
    return log(getattr(b, quantity) / getattr(a, quantity)) / log(b.elements / a.elements)


def _table(rows: list[dict[str, str]]) -> str:
    return tabulate(rows, headers="keys", tablefmt="pipe", disable_numparse=True)


def _cost(cost: Cost, core: Cost) -> dict[str, str]:
    return {
        "code": cost.code,
        "one speed": _ms(cost.single),
        "× Southwell": f"{cost.single / core.single:.1f}",
        "sweep, per speed": _ms(cost.sweep),
        "× Southwell in the sweep": f"{cost.sweep / core.sweep:.1f}",
        "error": f"{100 * cost.error:.1g} %",
    }


def _pair(cost: Cost, core: Cost | None) -> dict[str, str]:
    row = {"code": cost.code, "error": f"{100 * cost.error:.1g} %"}
    if core is None:
        return row | {"Southwell": f"more than {ELEMENTS} elements"}
    return row | {
        "Southwell": f"{core.elements} elements",
        "Southwell, one speed": _ms(core.single),
        "× Southwell": f"{cost.single / core.single:.1f}",
        "Southwell, sweep": _ms(core.sweep),
        "× Southwell in the sweep": f"{cost.sweep / core.sweep:.1f}",
    }


def _growth(growth: Growth) -> dict[str, str]:
    return {
        "elements": f"{growth.elements}",
        "time": f"{1e3 * growth.seconds:.0f} ms",
        "memory": f"{growth.memory / 2**20:.0f} MiB",
    }


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.1f} ms"


if __name__ == "__main__":
    main()
