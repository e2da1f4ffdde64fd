"""ElastoDyn's blade file, written."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....core.blade import AXIAL, BEND_Y, BEND_Z, SHEAR_Y, SHEAR_Z, TORSION, Blade, straight
from ..errors import CaseError
from .elastodyn import COLUMNS, MULTIPLIERS
from .source import Mount
from .text import fortran

Array = NDArray[np.float64]


def write(blade: Blade, path: Path, shapes: Array | None = None) -> Mount:
    """Write the blade file, and return what the main file must say for it to be read again.

    Args:
        blade: uncoupled, straight, without stretch, torsion, rotary inertia and tip inertia: what the format can hold.
        path: of the file.
        shapes: (3, 5) coefficients of x² … x⁶ for flap 1, flap 2, edge 1; without, x² stands for all, which is no mode.

    Raises:
        CaseError: naming what the format cannot hold.
    """
    diagonal = np.diagonal(blade.stiffness, axis1=1, axis2=2)
    off = ~np.eye(6, dtype=bool)
    lacks = {
        "finite stiffness in stretch, shear or torsion": not np.isinf(
            diagonal[:, [AXIAL, SHEAR_Y, SHEAR_Z, TORSION]]
        ).all(),
        "coupled sections": bool(blade.stiffness[:, off].any() or blade.mass[:, off].any()),
        "sectional moments of inertia": bool(blade.mass[:, 3:, 3:].any()),
        "a curved reference axis": not straight(blade),
        "a root that is not clamped": not np.isinf(blade.root).all(),
        "a tip mass (the main file has it)": bool(blade.tip_mass.any()),
    }
    for what, here in lacks.items():
        if here:
            raise CaseError(f"{path}: ElastoDyn cannot hold {what}: write TOML or BeamDyn, or take it out first")
    rows = np.column_stack(
        [
            blade.stations / blade.length,
            np.zeros(len(blade.stations)),
            -np.degrees(blade.twist),
            blade.mass[:, 0, 0],
            diagonal[:, BEND_Y],
            diagonal[:, BEND_Z],
        ]
    )
    columns = [*COLUMNS]
    units = ["(-)", "(-)", "(deg)", "(kg/m)", "(Nm^2)", "(Nm^2)"]
    polynomials = np.tile([1.0, 0, 0, 0, 0], (3, 1)) if shapes is None else np.asarray(shapes, float)
    what = "x^2, not a mode: replace" if shapes is None else "mode shape"
    lines = [
        "------- ELASTODYN V1.00.* INDIVIDUAL BLADE INPUT FILE --------------------------",
        f"{blade.name}: {blade.length!r} m long",
        "---------------------- BLADE PARAMETERS ----------------------------------------",
        f"{len(rows)}  NBlInpSt - Number of blade input stations (-)",
        *(f"0.0  {name} - Structural damping in percent of critical (%)" for name in _DAMPING),
        "---------------------- BLADE ADJUSTMENT FACTORS --------------------------------",
        *(f"1.0  {name} - Multiplier (-)" for name in ("FlStTunr(1)", "FlStTunr(2)", *MULTIPLIERS)),
        "---------------------- DISTRIBUTED BLADE PROPERTIES ----------------------------",
        "  ".join(f"{name:>23}" for name in columns),
        "  ".join(f"{name:>23}" for name in units),
        *("  ".join(f"{fortran(x):>23}" for x in row) for row in rows),
        "---------------------- BLADE MODE SHAPES ---------------------------------------",
        *(
            f"{x!r}  {name}({power}) - {what}, coefficient of x^{power}"
            for name, row in zip(("BldFl1Sh", "BldFl2Sh", "BldEdgSh"), polynomials.tolist(), strict=True)
            for power, x in enumerate(row, 2)
        ),
    ]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return Mount(length=blade.length, hub_radius=blade.hub_radius, precone=blade.precone, pitch=blade.pitch)


_DAMPING = ("BldFlDmp(1)", "BldFlDmp(2)", "BldEdDmp(1)")
