"""What the foreign codes get wrong, each with a reproducer: a script that needs the code alone and prints the defect.

Every script ends with the line ``defect: present`` or ``defect: gone``, so that a new version that mends it is noticed.
"""

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from ..isolated import ENVIRONMENTS


@dataclass(frozen=True)
class Defect:
    """One of them.

    Attributes:
        codes: names of the codes here that it concerns.
        script: name of the reproducer in this folder, without ``.py``.
        what: one sentence.
        avoided: how the adapter here does without.
        environment: of ``references.elsewhere``, where the code has its own.
    """

    codes: tuple[str, ...]
    script: str
    what: str
    avoided: str
    environment: str = ""

    @property
    def python(self) -> str:
        """The interpreter that has the code."""
        return str(ENVIRONMENTS[self.environment].python) if self.environment else sys.executable

    @property
    def path(self) -> Path:
        """The reproducer."""
        return Path(__file__).with_name(f"{self.script}.py")


DEFECTS = (
    Defect(
        ("pinocchio",),
        "pinocchio_composite_joint",
        "`computeRNEADerivatives` is wrong, silently, for a composite joint that translates and rotates.",
        "Four joints a body; derivatives that lack their symmetry are refused.",
    ),
    Defect(
        ("exudyn-ancf", "exudyn-tree", "exudyn-loops"),
        "exudyn_complex_eigenvalues",
        "`ComputeODE2Eigenvalues` raises for complex eigenvalues with constrained coordinates, and leaves damping and "
        "gyroscopic terms out unless they are asked for.",
        "The matrices are taken from `ComputeLinearizedSystem`, and the quadratic eigenproblem is solved here.",
    ),
    Defect(
        ("pybmodes",),
        "pybmodes_names",
        "Modes are named by sums of squared lengths and squared angles: a flap of 99.9 % of its energy is called a torsion.",
        "Its names are not used: modes are paired by shape.",
    ),
    Defect(
        ("pybmodes",),
        "pybmodes_tip_mass",
        "A mass at the tip of a turning blade neither pulls on it nor is softened by the rotation.",
        "Blades with a tip mass are refused.",
    ),
    Defect(
        ("pybmodes",),
        "pybmodes_mass_centre",
        "Mass centres off the axis: turning, the steady moment that they make does not couple flap with torsion.",
        "Blades with mass centres off the axis are refused.",
    ),
    Defect(
        ("pybmodes",),
        "pybmodes_shear_centre",
        "A shear centre off the reference axis moves the tension centre along, but not the mass centre.",
        "Blades with shear centres off the axis are refused.",
    ),
    Defect(
        ("calculix",),
        "calculix_substructure",
        "`*SUBSTRUCTURE GENERATE` holds the nodes that are not retained instead of eliminating them.",
        "Stored matrices are condensed here; a stiffness that resists rigid motions is refused.",
    ),
    Defect(
        ("scikit-fem",),
        "scikit_fem_hermite",
        "An `ElementLineHermite` used on a second mesh keeps the first one's functions, silently.",
        "A new element for every mesh.",
    ),
    Defect(
        ("sharpy",),
        "sharpy_triads",
        "Sections of curved elements are turned wrongly: tangents come in the order of the nodes along the element and are "
        "taken in that of the connectivities.",
        "The sections' rotation vectors are set after the beam is made.",
        environment="sharpy",
    ),
    Defect(
        ("frame3dd",),
        "frame3dd_stodola",
        "Stodola's iteration leaves out all modes of one plane where the planes do not couple, and says nothing.",
        "Subspace iteration first; what Stodola's finds is refused if all of it moves in one plane.",
        environment="frame3dd",
    ),
    Defect(
        ("frame3dd",),
        "frame3dd_subspace",
        "Subspace iteration gives up on some blades: its frequencies are not numbers.",
        "It is asked for other numbers of modes; then Stodola's iteration.",
        environment="frame3dd",
    ),
)


def shown(defect: Defect, timeout: float = 120.0) -> str:
    """What a reproducer prints here and now.

    Raises:
        RuntimeError: it could not run: the code is not installed, or it took longer than ``timeout`` seconds.
    """
    try:
        done = subprocess.run(
            [defect.python, str(defect.path)], capture_output=True, text=True, timeout=timeout, check=False
        )
    except FileNotFoundError:
        raise RuntimeError(f"{defect.script}: not installed: southwell codes install {defect.environment}") from None
    except subprocess.TimeoutExpired:
        raise RuntimeError(f"{defect.script}: no answer within {timeout:g} s") from None
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        raise RuntimeError(f"{defect.script}: {last}")
    return done.stdout.strip()
