"""``southwell condense``: condenses finite element matrices to a compressed model."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from ....cases.condense import condensed, condensing
from ....cases.input import atomic
from ....cases.input.errors import CaseError
from ....cases.input.writing import writable
from ...condense import page
from ...shared.console import output
from ...shared.statuses import PASSED
from ...shared.units import RAD_S
from ..arguments import NumberOfModes, typed
from . import campbell_options

FILE, SEGMENTS = page.FILE, "segments.json"


def command(
    file: str | None = None,
    /,
    *,
    omega: str | None = None,
    rpm: str | None = None,
    modes: NumberOfModes = 6,
    allow_large_strain: bool = False,
    out: Annotated[Path, Parameter(name=["--out", "-o"])] = Path("southwell-condensed"),
) -> int:
    """Condense finite element matrices of a blade to a multibody model.

    The model consists of rigid bodies and complex stiffness elements. The command prints segments and modes, and writes
    segments.json and condensation.md. `southwell report` includes condensation.md if it is in the folder of the report.

    Parameters
    ----------
    file
        TOML file that names matrices, nodes and sections, or segments.json of an earlier run.
    omega
        Rotor speeds in rad/s: one speed, a range `first:last:step` or a list `0,5,10`. Default: 0.
    rpm
        Rotor speeds in rpm, in the same form.
    modes
        Number of modes, from the lowest.
    allow_large_strain
        Accept steady strains above 20 %.
    out
        Output folder.
    """
    if file is None:
        raise CaseError("file: missing: give a TOML file that names matrices, nodes and sections")
    speeds, units = campbell_options.speeds(rpm, omega) or ((0.0,), RAD_S)
    path, spec, blade = Path(file), None, None
    if path.suffix == ".json":
        blade = condensed.read(path)
    else:
        spec = condensing.condense(path)
        blade = spec.blade
    solved = [(speed, condensed.modes(blade, speed, modes, allow_large_strain)) for speed in speeds]
    text = page.own(blade, solved, units, spec, typed())
    with writable(f"--out {out}"):
        out.mkdir(parents=True, exist_ok=True)
        condensed.write(out / SEGMENTS, blade)
        atomic.write(out / FILE, text)
    output().print(text, markup=False, soft_wrap=True)
    output().print(f"{out}: {FILE}, {SEGMENTS}", markup=False, soft_wrap=True)
    return PASSED
