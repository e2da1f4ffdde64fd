"""Known defects of the foreign codes, each with a reproducer: a script that needs only the code and prints the defect.

Every script ends with the line ``defect: present`` or ``defect: gone``, so that a fix in a new version is noticed.
"""

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from southwell.references.isolated import ENVIRONMENTS


@dataclass(frozen=True)
class Defect:
    """One defect.

    Attributes:
        codes: names of the adapters concerned.
        script: name of the reproducer in this folder, without ``.py``.
        what: one sentence.
        avoided: how the adapter avoids it.
        environment: name of the environment in ``references.isolated``; empty if the code has none.
    """

    codes: tuple[str, ...]
    script: str
    what: str
    avoided: str
    environment: str = ""

    @property
    def python(self) -> str:
        """The interpreter with the code."""
        return str(ENVIRONMENTS[self.environment].python) if self.environment else sys.executable

    @property
    def path(self) -> Path:
        """Path of the reproducer."""
        return Path(__file__).with_name(f"{self.script}.py")


DEFECTS = (
    Defect(
        ("pinocchio",),
        "pinocchio_composite_joint",
        "`computeRNEADerivatives` returns wrong derivatives, without an error, for a composite joint that "
        "translates and rotates.",
        "Each body has four joints; derivatives that lack their symmetry raise an error.",
    ),
    Defect(
        ("exudyn-ancf", "exudyn-tree", "exudyn-loops"),
        "exudyn_complex_eigenvalues",
        "`ComputeODE2Eigenvalues` raises for complex eigenvalues with constrained coordinates, and omits damping and "
        "gyroscopic terms by default.",
        "The matrices are taken from `ComputeLinearizedSystem`, and the adapter solves the quadratic eigenproblem.",
    ),
    Defect(
        ("pybmodes",),
        "pybmodes_names",
        "Modes are named by sums of squared lengths and angles: a mode with 99.9 % flap energy is called torsion.",
        "Its names are not used: modes are paired by shape.",
    ),
    Defect(
        ("pybmodes",),
        "pybmodes_tip_mass",
        "In rotation, a mass at the tip causes neither tension nor spin softening.",
        "Blades with a tip mass are declined.",
    ),
    Defect(
        ("pybmodes",),
        "pybmodes_mass_centre",
        "In rotation, the steady moment of mass centres off the axis does not couple flap with torsion.",
        "Blades with mass centres off the axis are declined.",
    ),
    Defect(
        ("pybmodes",),
        "pybmodes_shear_centre",
        "A shear centre off the reference axis shifts the tension centre, but not the mass centre.",
        "Blades with shear centres off the axis are declined.",
    ),
    Defect(
        ("calculix",),
        "calculix_substructure",
        "`*SUBSTRUCTURE GENERATE` fixes the nodes that are not retained instead of eliminating them.",
        "Southwell condenses the stored matrices itself; a stiffness that resists rigid motions raises an error.",
    ),
    Defect(
        ("scikit-fem",),
        "scikit_fem_hermite",
        "An `ElementLineHermite` used on a second mesh keeps the functions of the first mesh, without an error.",
        "The adapter creates a new element for every mesh.",
    ),
    Defect(
        ("sharpy",),
        "sharpy_triads",
        "Sections of curved elements have wrong axes: tangents are stored in the order of the nodes along the "
        "element and read in the order of the connectivities.",
        "The sections' rotation vectors are set after the beam is built.",
        environment="sharpy",
    ),
    Defect(
        ("frame3dd",),
        "frame3dd_stodola",
        "Stodola's iteration misses all modes of one plane where the planes do not couple, without a message.",
        "Subspace iteration is used first; Stodola's result is rejected if all modes are in one plane.",
        environment="frame3dd",
    ),
    Defect(
        ("frame3dd",),
        "frame3dd_subspace",
        "Subspace iteration fails for some blades: its frequencies are not numbers.",
        "Other numbers of modes are tried, then Stodola's iteration.",
        environment="frame3dd",
    ),
)


def shown(defect: Defect, timeout: float = 120.0) -> str:
    """Run a reproducer and return its output.

    Raises:
        RuntimeError: the code is not installed, or the script took longer than ``timeout`` seconds.
    """
    try:
        process = subprocess.run(
            [defect.python, str(defect.path)], capture_output=True, text=True, timeout=timeout, check=False
        )
    except FileNotFoundError:
        raise RuntimeError(f"{defect.script}: not installed: southwell codes install {defect.environment}") from None
    except subprocess.TimeoutExpired:
        raise RuntimeError(f"{defect.script}: no answer within {timeout:g} s") from None
    if process.returncode:
        last = (process.stderr.strip().splitlines() or ["no message"])[-1]
        raise RuntimeError(f"{defect.script}: {last}")
    return process.stdout.strip()
