"""The default case for a blade given only by a file."""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...core.blade import Blade
from .readers.sections import FromFile
from .readers.source import BladeFile, Unused
from .schema import Case, CaseFile, Compare, Speeds, Variant

MODES, TARGET = 6, 1e-3
"""Number of modes compared, from the lowest, and the largest relative difference."""


def default_case(
    blade: Blade,
    speeds: Sequence[float],
    *,
    rpm: bool,
    source: str,
    modes: int = MODES,
    unused: Sequence[Unused] = (),
    file: BladeFile | None = None,
) -> Case:
    """A blade at given speeds as a case: the lowest modes, within 0.1 %, confirmed by at least one independent group.

    Args:
        blade: as every code is given it.
        speeds: rotor speeds, rad/s, ascending.
        rpm: whether reports give speeds in rpm and frequencies in Hz; otherwise both in rad/s.
        source: the files, and how they were read.
        modes: number of modes compared.
        unused: non-zero quantities of the files that the blade does not use.
        file: the blade's file as read.
    """
    name = re.sub(r"[^a-z0-9.-]+", "-", Path(blade.name).stem.lower()).strip("-.") or "blade"
    omega = np.asarray(speeds, dtype=float)
    typed = np.round(omega * 30 / np.pi, 9).tolist() if rpm else omega.tolist()
    text = CaseFile(
        name=name,
        title=f"The blade {blade.name}",
        description=f"The lowest {modes} modes, each to be confirmed within {100 * TARGET:g} %.",
        source=source,
        blade=FromFile(file=blade.name),
        speeds=Speeds(rpm=typed) if rpm else Speeds(rad_s=typed),
        compare=Compare(modes=modes, target=TARGET),
    )
    return Case(source, text, (Variant(name, blade, omega, tuple(unused), file),))
