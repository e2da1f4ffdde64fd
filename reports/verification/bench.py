"""``southwell bench``: measures the run time of core and the other codes, and renders it as tables."""

from itertools import pairwise
from math import log
from pathlib import Path

from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
from tabulate import tabulate

from ...cases.bench import cost as measure
from ...cases.bench.cost import COUNT, ELEMENTS, OMEGA, SWEEP, Bench, Growth, Timing
from ...cases.input import atomic
from ..shared.console import output
from ..shared.writing import writable

FILE = "bench.json"

SEEN = 2**20
"""Smallest peak memory of a process, in bytes, that is significant."""

ABOUT = f"""One thread per process; medians over rounds in which the codes take turns. The case is the uniform cantilever with
{ELEMENTS} elements and the {COUNT} lowest modes, timed from the blade to the modes at one speed ({OMEGA:g} rad/s) and in a
sweep of {len(SWEEP)} speeds (time per speed). *× core* is the time relative to core's with as many elements. The error is the
largest error of the six lowest frequencies relative to the exact beam, at one speed."""

EQUAL = f"""At equal accuracy: each code with {ELEMENTS} elements, and core with the fewest elements whose error is no
larger, at most {ELEMENTS}. *× core* is the code's time relative to core's with that number."""

EXCLUDED = """The times include building each code's model, its steady state and its eigenproblem. In a sweep core and
scikit-fem build their model once, and core starts each speed from the previous ones; the other codes start anew. Excluded:
starting the process, importing libraries, compilation (each code has answered once before), reading the blade's file, and
estimating the uncertainty: core is timed on one mesh, as the other codes are, while `southwell modes` refines the mesh and
takes longer. The accuracy is that of frequencies at one speed, not of shapes. Codes that are not installed or fail are not
compared."""


def command(*, out: Path = Path("southwell-report")) -> int:
    """Measure the run time of core and of the other codes.

    Takes minutes. Writes bench.json and bench.md, which `southwell report` includes if they are in the folder of the report.
    Quote ratios of one run: times depend on the machine.

    Parameters
    ----------
    out
        Output folder.
    """
    with writable(f"--out {out}"):
        out.mkdir(parents=True, exist_ok=True)
    console = Console(stderr=True, highlight=False)
    bar = Progress(
        SpinnerColumn(),
        TimeElapsedColumn(),
        TextColumn("{task.description}", markup=False),
        console=console,
        transient=True,
    )
    with bar:
        task = bar.add_task("starting")
        found = measure.bench(lambda text: bar.update(task, description=text))
    measure.write(out / FILE, found)
    text = render(found)
    atomic.write(out / "bench.md", text)
    output().print(text, markup=False, soft_wrap=True)
    return 0


def beside(folder: Path) -> str:
    """The tables of the measurement in a report's folder; empty if there is none."""
    path = folder / FILE
    return render(measure.read(path)) if path.exists() else ""


def render(found: Bench) -> str:
    """The tables in Markdown, what the times include, and one line on how cost and memory grow."""
    core = next(t for t in found.timings if t.code == "core")
    codes = _table([_row(t, core) for t in found.timings])
    equal = _table([_as_accurate(t) for t in found.timings if t is not core and t.error is not None])
    growth = _table([_grown(g) for g in found.growth])
    parts = [
        ABOUT,
        codes,
        *([EQUAL, equal] if equal else []),
        EXCLUDED,
        "Core at one speed with more elements:",
        growth,
    ]
    return "\n\n".join([*parts, exponents(found.growth)]) + "\n"


def exponents(growth: tuple[Growth, ...]) -> str:
    """How time and memory grow, as powers of the number of elements.

    Meshes whose peak memory is below ``SEEN`` are left out of the growth of memory.
    """
    first, last = growth[0], growth[-1]
    steps = ", ".join(f"N^{_power(a, b, 'seconds'):.2f} from {a.elements} to {b.elements}" for a, b in pairwise(growth))
    whole = f"N^{_power(first, last, 'seconds'):.2f} from {first.elements} to {last.elements} elements"
    seen = [g for g in growth if g.memory > SEEN]
    memory = (
        f"; memory as N^{_power(seen[0], seen[-1], 'memory'):.2f} from {seen[0].elements} on" if len(seen) > 1 else ""
    )
    return f"Time grows as {whole} ({steps}){memory}."


def _power(a: Growth, b: Growth, what: str) -> float:
    return log(getattr(b, what) / getattr(a, what)) / log(b.elements / a.elements)


def _table(rows: list[dict[str, str]]) -> str:
    return tabulate(rows, headers="keys", tablefmt="pipe", disable_numparse=True)


def _row(t: Timing, core: Timing) -> dict[str, str]:
    row = {"code": f"{t.code} {t.version}".strip()}
    if t.single is None or t.sweep is None or not core.single or not core.sweep:
        return row | {
            "one speed": f"○ not run: {t.note}",
            "× core": "",
            "sweep, per speed": "",
            "× core in the sweep": "",
            "error": "",
        }
    return row | {
        "one speed": f"{1e3 * t.single:.1f} ms",
        "× core": f"{t.single / core.single:.1f}",
        "sweep, per speed": f"{1e3 * t.sweep / len(SWEEP):.1f} ms",
        "× core in the sweep": f"{t.sweep / core.sweep:.1f}",
        "error": _percent(t.error),
    }


def _as_accurate(t: Timing) -> dict[str, str]:
    """A code with its error, and core with as few elements as have no larger one."""
    row = {"code": f"{t.code} {t.version}".strip(), "error": _percent(t.error)}
    if t.equal is None or t.single is None or t.sweep is None:
        return row | {"core": f"○ more than {ELEMENTS} elements"}
    return row | {
        "core": f"{t.equal.elements} elements",
        "one speed": f"{1e3 * t.single:.1f} ms",
        "core, one speed": f"{1e3 * t.equal.single:.1f} ms",
        "× core": f"{t.single / t.equal.single:.1f}",
        "sweep, per speed": f"{1e3 * t.sweep / len(SWEEP):.1f} ms",
        "core, sweep": f"{1e3 * t.equal.sweep / len(SWEEP):.1f} ms",
        "× core in the sweep": f"{t.sweep / t.equal.sweep:.1f}",
    }


def _percent(error: float | None) -> str:
    return f"{100 * (error or 0.0):.1g} %"


def _grown(g: Growth) -> dict[str, str]:
    return {"elements": f"{g.elements}", "time": f"{1e3 * g.seconds:.0f} ms", "memory": f"{g.memory / 2**20:.0f} MiB"}
