"""``southwell convert``: writes a blade of any readable format as TOML, BeamDyn or ElastoDyn files."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from rich.markup import escape

from ....cases.input.errors import CaseError
from ....cases.input.readers import Mount, Unused, southwell_toml
from ....cases.input.writing import writable
from ....cases.writers import beamdyn, elastodyn
from ...shared import not_used
from ...shared.console import output
from ...shared.units import RPM
from ..mounting import Mounting
from .subjects import Subject
from .subjects import subjects as find_subjects

Format = Literal["toml", "beamdyn", "elastodyn"]


KEPT = 1e-7
"""Tolerance on the reference axis, relative to the length.

Removing stations that deviate less from BeamDyn's curve changes no frequency by more than 1e-6.
"""

CARRIED: dict[Format, tuple[str, ...]] = {
    "toml": (),
    "beamdyn": beamdyn.CARRIED,
    "elastodyn": elastodyn.CARRIED,
}
"""Quantities that are not part of a blade but are kept by a format."""


def command(
    blade: str,
    out: Path,
    /,
    *,
    to: Format | None = None,
    rpm: float = 0.0,
    mounting: Mounting | None = None,
) -> int:
    """Write a blade in another format.

    A blade that the format cannot represent is refused. TOML represents any blade. BeamDyn (two files) represents curved and
    coupled blades with a clamped root and no tip mass. ElastoDyn represents straight, uncoupled blades without axial, torsional
    and rotary-inertia properties. Damping, mode shapes and pitch axis are copied if the format has them, and listed otherwise.

    Parameters
    ----------
    blade
        Blade file (ElastoDyn, BeamDyn, BModes, HAWC2, windIO, Southwell's TOML or CSV), or a case (listed by
        `southwell cases`).
    out
        Output file, which must not exist.
    to
        Output format. Default: TOML if the file ends in .toml.
    rpm
        Rotor speed in rpm for the mode shapes of an ElastoDyn file.
    """
    if not 0.0 <= rpm < 1e6:
        raise CaseError(f"--rpm {rpm:g}: not a rotor speed: give 0 or more revolutions per minute, as in 12.1")
    format = to or ("toml" if out.suffix.lower() == ".toml" else None)
    if format is None:
        raise CaseError(
            f"{out}: ends in {out.suffix or 'nothing'}: give the format with --to toml, beamdyn or elastodyn"
        )
    if os.path.lexists(out):
        raise CaseError(f"{out}: exists already: give another name, or remove it")
    subjects = find_subjects(blade, (mounting or Mounting()).mount(), rotating=format != "beamdyn")
    if len(subjects) > 1:
        names = ", ".join(s.blade.name for s in subjects)
        raise CaseError(f"{blade}: {len(subjects)} blades ({names}): name one of them")
    console = output()
    with writable(str(out), "name"):
        paths, mount = _write(subjects[0], out, format, rpm / RPM.speeds)
    console.print(", ".join(str(path) for path in paths), markup=False, soft_wrap=True)
    if mount is not None:
        console.print(escape(_main_file(mount)), soft_wrap=True)
    not_used.show((u for u in subjects[0].unused if u.name not in CARRIED[format]), console)
    if format == "beamdyn" and (change := beamdyn.spline_error(subjects[0].blade)) > KEPT:
        message = f"the curve between stations changes: BeamDyn's spline moves stations by {change:.2g} of the length"
        console.print(f"{message}: give more stations where it bends", style="yellow", markup=False, soft_wrap=True)
    for name in _unknown(subjects[0].unused, format):
        console.print(f"not given or zero, written as 0: {name}", style="yellow", markup=False, soft_wrap=True)
    return 0


def _write(subject: Subject, out: Path, to: Format, omega: float) -> tuple[list[Path], Mount | None]:
    """Write the files; return their paths and the mount that a main file must define."""
    blade, unused = subject.blade, subject.unused
    if to == "toml":
        southwell_toml.write(blade, out)
        return [out], None
    if to == "beamdyn":
        mount = beamdyn.write(blade, out, unused)
        return [out, beamdyn.blade_file(out)], mount
    return [out], elastodyn.write(blade, out, omega, unused)


def _unknown(unused: Sequence[Unused], to: Format) -> list[str]:
    """List the quantities that the format has and the blade's files do not define."""
    return [name for name in CARRIED[to] if name not in {u.name for u in unused}]


def _main_file(mount: Mount) -> str:
    """Describe the mount in the names, units and signs of ElastoDyn's main file, and how to read the blade again."""
    values = {"HubRad": mount.hub_radius or 0.0, "PreCone(1)": float(np.degrees(mount.precone or 0.0))}
    if mount.length is not None:
        values = {"TipRad": mount.length + values["HubRad"], **values}
    message = "ElastoDyn's main file must say " + ", ".join(f"{name} = {value:.10g}" for name, value in values.items())
    if mount.pitch:
        pitch = 0.0 - float(np.degrees(mount.pitch))
        message += (
            f"; the pitch is in none of the files: BlPitch(1) = {pitch:.10g} in OpenFAST, --pitch {-pitch:.10g} here"
        )
    return message
