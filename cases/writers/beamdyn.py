"""Writer of BeamDyn's main and blade files."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ...core.blade import Blade
from ..input import atomic
from ..input.errors import CaseError
from ..input.readers.matrices import BEAMDYN, in_axes
from ..input.readers.openfast.beamdyn import DAMPING
from ..input.readers.openfast.beamdyn_axis import Axis, measured, roll
from ..input.readers.source import Mount, Unused
from ..input.readers.text import fortran

Array = NDArray[np.float64]


CARRIED = (DAMPING,)
"""Names of the unused quantities that are carried over."""


def write(blade: Blade, path: Path, unused: Sequence[Unused] = ()) -> Mount:
    """Write the main file at ``path`` and the blade file next to it; return the mounting for ElastoDyn's main file.

    Between stations BeamDyn interpolates twist and curve by a natural spline in z. ``unused`` are the unused quantities of
    the blade's original file; those in ``CARRIED`` are written.

    Raises:
        CaseError: if the format does not support a property: rigid strains, root joints, tip masses, kinks, curves that
            turn back.
    """
    unrepresented = {
        "rigid strains": bool(np.isinf(blade.stiffness).any()),
        "a root that is not clamped": not np.isinf(blade.root).all(),
        "a tip mass (ElastoDyn's main file has it)": bool(blade.tip_mass.any()),
        "a kink in the curve": bool(blade.kinks),
        "a curve that turns back": bool((np.diff(blade.curve[:, 0]) <= 0).any()),
        "a curve that begins beside the root": bool(blade.curve[0].any()),
    }
    for feature, present in unrepresented.items():
        if present:
            raise CaseError(f"{path}: BeamDyn cannot represent {feature}: write TOML, which can represent any blade")
    axis = _axis(blade)
    z = axis.z
    degrees = np.degrees(roll(axis, z) - blade.twist)
    sections = blade_file(path)
    points = np.stack([blade.curve[:, 2], -blade.curve[:, 1], z, degrees], axis=1)
    atomic.write(path, _main_text(blade.name, points, sections.name))
    atomic.write(sections, _blade_text(blade, axis.arc / axis.arc[-1], unused))
    return Mount(hub_radius=blade.hub_radius, precone=blade.precone, pitch=blade.pitch)


def spline_error(blade: Blade) -> float:
    """Largest displacement of stations along the axis by BeamDyn's spline, as a fraction of the length."""
    return float(np.abs(_axis(blade).arc - blade.stations).max() / blade.length)


def _axis(blade: Blade) -> Axis:
    """BeamDyn's curve with key points at the stations."""
    z = blade.curve[:, 0]
    values = np.stack([blade.curve[:, 2], -blade.curve[:, 1], np.zeros_like(z)], axis=1)
    return measured(CubicSpline(z, values, bc_type="natural"), z)


def blade_file(path: Path) -> Path:
    """Path of the blade file of a main file at ``path``."""
    return path.with_name(f"{path.stem}_blade{path.suffix or '.dat'}")


_MAIN = """\
--------- BEAMDYN with OpenFAST INPUT FILE -------------------------------------------
{name}
---------------------- SIMULATION CONTROL --------------------------------------
False         Echo             - Echo input data to "<RootName>.ech"? (flag)
True          QuasiStaticInit  - Quasi-static start under centripetal acceleration? (flag)
          0   rhoinf           - Numerical damping (-)
          2   quadrature       - 1: Gauss, 2: trapezoidal (switch)
"DEFAULT"     refine           - Refinement for trapezoidal quadrature (-)
"DEFAULT"     n_fact           - Factorization frequency (-)
"DEFAULT"     DTBeam           - Time step (s)
"DEFAULT"     load_retries     - Load retries (-)
"DEFAULT"     NRMax            - Newton-Raphson iterations (-)
"DEFAULT"     stop_tol         - Tolerance (-)
"DEFAULT"     tngt_stf_fd      - Finite-difference tangent? (flag)
"DEFAULT"     tngt_stf_comp    - Compare tangents? (flag)
"DEFAULT"     tngt_stf_pert    - Perturbation (-)
"DEFAULT"     tngt_stf_difftol - Allowed difference of tangents (-)
True          RotStates        - States in the rotating frame? (flag)
---------------------- GEOMETRY PARAMETER --------------------------------------
          1   member_total     - Total number of members (-)
{count:>11}   kp_total         - Total number of key points (-)
     1  {count}                - Member number; its key points
   kp_xr  kp_yr  kp_zr  initial_twist
   (m)    (m)    (m)    (deg)
{points}
---------------------- MESH PARAMETER ------------------------------------------
          5   order_elem       - Order of interpolation (-)
---------------------- MATERIAL PARAMETER --------------------------------------
"{sections}"    BldFile        - File of the blade's properties
---------------------- PITCH ACTUATOR PARAMETERS -------------------------------
False         UsePitchAct      - Pitch actuator? (flag)
          1   PitchJ           - Its inertia (kg-m^2)
          0   PitchK           - Its stiffness (kg-m^2/s^2)
          0   PitchC           - Its damping (kg-m^2/s)
---------------------- OUTPUTS -------------------------------------------------
False         SumPrint         - Summary file? (flag)
"ES10.3E2"    OutFmt           - Format
          0   NNodeOuts        - Number of nodes to output (-)
          1   OutNd            - Nodes to output (-)
          OutList              - Output channels
END of input file (the word "END" must appear in the first 3 columns of this last OutList line)
"""


def _main_text(name: str, points: Array, sections: str) -> str:
    lines = "\n".join("  ".join(fortran(x) for x in point) for point in points)
    return _MAIN.format(name=name, count=len(points), points=lines, sections=sections)


def _blade_text(blade: Blade, eta: Array, unused: Sequence[Unused]) -> str:
    damping = next((u.values for u in unused if u.name == DAMPING and len(u.values) == 6), (0.0,) * 6)
    lines = [
        "------- BEAMDYN V1.00.* INDIVIDUAL BLADE INPUT FILE --------------------------",
        blade.name,
        "---------------------- BLADE PARAMETERS --------------------------------------",
        f"{len(blade.stations)}  station_total - Number of blade input stations (-)",
        f"{int(any(damping))}  damp_type - Damping type: 0: no damping; 1: damped",
        "---------------------- DAMPING COEFFICIENT------------------------------------",
        "mu1  mu2  mu3  mu4  mu5  mu6",
        "(-)  (-)  (-)  (-)  (-)  (-)",
        "  ".join(fortran(mu) for mu in damping),
        "---------------------- DISTRIBUTED PROPERTIES---------------------------------",
    ]
    matrices = [in_axes(m, BEAMDYN.T) for m in (blade.stiffness, blade.mass)]
    for k, fraction in enumerate(eta):
        lines.append(fortran(fraction))
        for matrix in matrices:
            lines += ["  ".join(fortran(x) for x in line) for line in matrix[k]] + [""]
    return "\n".join(lines) + "\n"
