"""``southwell convert``: a blade in any format that is read, written as TOML, for BeamDyn or for ElastoDyn."""

from pathlib import Path
from typing import Literal

import numpy as np
from rich.markup import escape

from ...cases.input.errors import CaseError
from ...cases.input.readers import Mount, beamdyn_write, elastodyn_write, southwell_toml
from ...core.blade import Blade
from ..shared.console import output
from .mounting import Mounting
from .subjects import subjects as find_subjects

Format = Literal["toml", "beamdyn", "elastodyn"]


def command(blade: str, out: Path, /, *, to: Format | None = None, mounting: Mounting | None = None) -> int:
    """Write a blade in another format; what the format cannot hold is refused, never dropped.

    TOML holds any blade. BeamDyn holds curved and coupled ones on a clamped root, without tip mass (two files are written);
    ElastoDyn only straight, uncoupled ones without stretch, torsion and moments of inertia.

    Parameters
    ----------
    blade
        A blade file (ElastoDyn, BeamDyn, HAWC2, BModes, windIO, TOML, CSV), or a case's blade (`southwell cases`).
    out
        File to write; there must be none.
    to
        Format; TOML if the file ends in .toml.
    """
    chosen = to or ("toml" if out.suffix.lower() == ".toml" else None)
    if chosen is None:
        raise CaseError(f"{out}: ends in {out.suffix or 'nothing'}: say the format by --to toml, beamdyn or elastodyn")
    if out.exists():
        raise CaseError(f"{out}: is there already: give another name, or remove it")
    subjects = find_subjects(blade, (mounting or Mounting()).mount())
    if len(subjects) > 1:
        names = ", ".join(s.blade.name for s in subjects)
        raise CaseError(f"{blade}: {len(subjects)} blades ({names}): say which")
    console = output()
    try:
        written, left = _write(subjects[0].blade, out, chosen)
    except OSError as error:
        raise CaseError(f"{out}: cannot be written ({error.strerror}): give another name") from error
    console.print(", ".join(str(path) for path in written), markup=False, soft_wrap=True)
    if left is not None:
        console.print(escape(_told(left)), soft_wrap=True)
    return 0


def _write(blade: Blade, out: Path, to: Format) -> tuple[list[Path], Mount | None]:
    """The files, and what is left to a main file."""
    if to == "toml":
        southwell_toml.write(blade, out)
        return [out], None
    if to == "beamdyn":
        left = beamdyn_write.write(blade, out)
        return [out, beamdyn_write.blade_file(out)], left
    return [out], elastodyn_write.write(blade, out)


def _told(left: Mount) -> str:
    """What ElastoDyn's main file must say, in its names, units and signs."""
    values = {
        "HubRad": left.hub_radius or 0.0,
        "PreCone(1)": float(np.degrees(left.precone or 0.0)),
        "BlPitch(1)": 0.0 - float(np.degrees(left.pitch or 0.0)),
    }
    if left.length is not None:
        values = {"TipRad": left.length + values["HubRad"], **values}
    return "ElastoDyn's main file must say " + ", ".join(f"{name} = {value:.10g}" for name, value in values.items())
