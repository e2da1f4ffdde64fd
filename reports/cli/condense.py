"""``southwell condense``: condenses finite element matrices to a compressed model, or runs the example."""

import shlex
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from ...cases.condense import condensed, condensing, example
from ...cases.condense.condensed import Condensed
from ...cases.input import atomic
from ...cases.input.errors import CaseError
from ..condense import page
from ..shared.console import output
from ..shared.units import RAD_S
from ..shared.writing import writable
from . import campbell_options
from .arguments import NumberOfModes

EXAMPLE = "example"
FILE, SEGMENTS, DATA = page.FILE, "segments.json", "condensation.json"
PASSED, MISSED = 0, 1


def command(
    file: str | None = None,
    /,
    *,
    example: bool = False,
    omega: str | None = None,
    rpm: str | None = None,
    modes: NumberOfModes = 6,
    allow_large_strain: bool = False,
    out: Annotated[Path, Parameter(name=["--out", "-o"])] = Path("southwell-condensed"),
) -> int:
    """Condense finite element matrices of a blade to a multibody model.

    The model has rigid bodies and complex stiffness elements. Prints segments and modes; writes segments.json and
    condensation.md, which `southwell report` includes if it is in the folder of the report. The example takes about a
    minute and also writes a figure of the three stages; status 1 if a difference exceeds its target.

    Parameters
    ----------
    file
        TOML file that names matrices, nodes and sections; segments.json of an earlier run; or `example`.
    example
        Compare a tapered, twisted solid blade with its own modes, and a solid cantilever with Timoshenko's.
    omega
        Rotor speeds in rad/s: one, a range `first:last:step` or a list `0,5,10`. Default: at rest.
    rpm
        Rotor speeds in rpm, in the same form.
    modes
        Number of modes, from the lowest.
    allow_large_strain
        Accept steady strains above 20 %.
    out
        Output folder.
    """
    if example or file == EXAMPLE:
        if file not in (None, EXAMPLE) or omega or rpm:
            other = file if file not in (None, EXAMPLE) else f"--omega {omega}" if omega else f"--rpm {rpm}"
            raise CaseError(f"--example: with {other}: the example has its own blade and speeds: leave one of them out")
        return _example(_folder(out))
    if file is None:
        raise CaseError("file: missing: give a TOML file that names matrices, nodes and sections, or --example")
    speeds, units = campbell_options.speeds(rpm, omega) or ((0.0,), RAD_S)
    path, spec, blade = Path(file), None, None
    if path.suffix == ".json":
        blade = condensed.read(path)
    else:
        spec = condensing.condense(path)
        blade = spec.blade
    found = [(speed, condensed.modes(blade, speed, modes, allow_large_strain)) for speed in speeds]
    text = page.own(blade, found, units, spec, _line())
    folder = _folder(out)
    _write(folder, text, blade)
    output().print(text, markup=False, soft_wrap=True)
    output().print(f"{folder}: {FILE}, {SEGMENTS}", markup=False, soft_wrap=True)
    return PASSED


def _example(folder: Path) -> int:
    with _watched() as say:
        found, drawn = example.example(say)
        say("the picture")
        figures = page.picture(found, drawn, folder)
    example.write(folder / DATA, found)
    text = page.example(found, figures[0].relative_to(folder).as_posix(), _line())
    _write(folder, text, Condensed("twisted", drawn.root, drawn.segments))
    output().print(text, markup=False, soft_wrap=True)
    names = ", ".join(str(p.relative_to(folder)) for p in (*figures, folder / FILE, folder / SEGMENTS, folder / DATA))
    output().print(f"{folder}: {names}", markup=False, soft_wrap=True)
    return PASSED if example.within(found) else MISSED


@contextmanager
def _watched() -> Iterator[Callable[[str], None]]:
    """Show the current step on standard error."""
    console = Console(stderr=True, highlight=False)
    columns = SpinnerColumn(), TimeElapsedColumn(), TextColumn("{task.description}", markup=False)
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("starting")
        yield lambda text: bar.update(task, description=text)


def _folder(out: Path) -> Path:
    with writable(f"--out {out}"):
        out.mkdir(parents=True, exist_ok=True)
    return out


def _write(folder: Path, text: str, blade: Condensed) -> None:
    with writable(f"--out {folder}"):
        condensed.write(folder / SEGMENTS, blade)
        atomic.write(folder / FILE, text)


def _line() -> str:
    return shlex.join(["southwell", *sys.argv[1:]])
