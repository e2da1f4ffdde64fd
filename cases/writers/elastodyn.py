"""Writer of ElastoDyn's blade file: sections, and the mode shapes computed from them.

Damping and PitchAxis are no properties of a blade here; they are written as the blade's own ElastoDyn file has them, else 0.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...core.blade import AXIAL, BEND_Y, BEND_Z, SHEAR_Y, SHEAR_Z, TORSION, Blade, straight
from ..input import atomic
from ..input.errors import CaseError
from ..input.readers.openfast.elastodyn import LAYOUT
from ..input.readers.openfast.elastodyn_unused import DAMPING
from ..input.readers.source import Mount, Unused
from ..input.readers.text import fortran
from .elastodyn_shapes import polynomials

Array = NDArray[np.float64]


CARRIED = (DAMPING, "PitchAxis")
"""Names of the unused quantities that are carried over."""


def write(blade: Blade, path: Path, omega: float = 0.0, unused: Sequence[Unused] = ()) -> Mount:
    """Write the blade file, and return the mounting that the main file must contain.

    Args:
        blade: uncoupled, straight, without stretch, torsion, rotary inertia and tip inertia, as the format requires.
        path: path of the file.
        omega: rotor speed, rad/s, at which the mode shapes are computed (``cases.writers.elastodyn_shapes``).
        unused: quantities of the blade's original file; those in ``CARRIED`` are written.

    Raises:
        CaseError: if the format does not support a property of the blade, or a mode is not found.
    """
    diagonal = np.diagonal(blade.stiffness, axis1=1, axis2=2)
    off = ~np.eye(6, dtype=bool)
    unrepresented = {
        "finite stiffness in stretch, shear or torsion": not np.isinf(
            diagonal[:, [AXIAL, SHEAR_Y, SHEAR_Z, TORSION]]
        ).all(),
        "coupled sections": bool(blade.stiffness[:, off].any() or blade.mass[:, off].any()),
        "sectional moments of inertia": bool(blade.mass[:, 3:, 3:].any()),
        "a curved reference axis": not straight(blade),
        "a root that is not clamped": not np.isinf(blade.root).all(),
        "a tip mass (the main file has it)": bool(blade.tip_mass.any()),
    }
    for feature, present in unrepresented.items():
        if present:
            raise CaseError(f"{path}: ElastoDyn cannot represent {feature}: write TOML or BeamDyn, or remove it first")
    n = len(blade.stations)
    damping, pitch_axis = (_given(unused, name, count) for name, count in zip(CARRIED, (3, n), strict=True))
    shapes = [shape.coefficients.tolist() for shape in polynomials(blade, omega)]
    rows = np.column_stack(
        [
            blade.stations / blade.length,
            pitch_axis,
            -np.degrees(blade.twist),
            blade.mass[:, 0, 0],
            diagonal[:, BEND_Y],
            diagonal[:, BEND_Z],
        ]
    )
    columns = [*LAYOUT.columns]
    units = ["(-)", "(-)", "(deg)", "(kg/m)", "(Nm^2)", "(Nm^2)"]
    lines = [
        "------- ELASTODYN V1.00.* INDIVIDUAL BLADE INPUT FILE --------------------------",
        f"{blade.name}: {blade.length!r} m long",
        "---------------------- BLADE PARAMETERS ----------------------------------------",
        f"{len(rows)}  NBlInpSt - Number of blade input stations (-)",
        *(
            f"{x!r}  {name} - Structural damping in percent of critical (%)"
            for x, name in zip(damping, DAMPING.split(", "), strict=True)
        ),
        "---------------------- BLADE ADJUSTMENT FACTORS --------------------------------",
        *(f"1.0  {name} - Multiplier (-)" for name in ("FlStTunr(1)", "FlStTunr(2)", *LAYOUT.multipliers)),
        "---------------------- DISTRIBUTED BLADE PROPERTIES ----------------------------",
        "  ".join(f"{name:>23}" for name in columns),
        "  ".join(f"{name:>23}" for name in units),
        *("  ".join(f"{fortran(x):>23}" for x in row) for row in rows),
        "---------------------- BLADE MODE SHAPES ---------------------------------------",
        *(
            f"{x!r}  {name}({power}) - mode shape at {omega * 30 / np.pi:.6g} rpm, coefficient of x^{power}"
            for name, row in zip(("BldFl1Sh", "BldFl2Sh", "BldEdgSh"), shapes, strict=True)
            for power, x in enumerate(row, 2)
        ),
    ]
    atomic.write(path, "\n".join(lines) + "\n")
    return Mount(length=blade.length, hub_radius=blade.hub_radius, precone=blade.precone, pitch=blade.pitch)


def _given(unused: Sequence[Unused], name: str, count: int) -> tuple[float, ...]:
    """The values of a quantity that is carried over; zeros if it is not given, or not for these stations."""
    columns = [u.values for u in unused if u.name == name and len(u.values) == count]
    return columns[0] if columns else (0.0,) * count
