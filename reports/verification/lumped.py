"""The effect of the paper's lumped mass and body-fixed beam stiffness on its frequencies, separately and together."""

from dataclasses import dataclass

import numpy as np

from ...cases.judge.results import Run
from ...cases.verify.lumping import CASE, MASSES, STIFFNESSES, variant
from ..shared.style import COLOURS, INK

PAPER = 50
"""Number of elements of the paper's cantilever."""

EXACT, FRAME, MASS, BOTH = (variant(mass, stiffness) for mass in MASSES for stiffness in STIFFNESSES)
"""The four discretisations: neither change, the body-fixed stiffness, the lumped mass, both as in the paper."""

LOOKS = {
    BOTH: ("both (paper)", INK, "o"),
    MASS: ("lumped mass", COLOURS[0], "s"),
    FRAME: ("parent's frame", COLOURS[1], "^"),
    EXACT: ("neither", COLOURS[2], "D"),
}


@dataclass(frozen=True)
class Taken:
    """Relative errors of the four discretisations.

    Attributes:
        elements: (n,) numbers of elements.
        errors: by name, (n, modes) relative errors.
    """

    elements: np.ndarray
    errors: dict[str, np.ndarray]

    def at(self, name: str) -> np.ndarray:
        """The (modes,) errors at the paper's number of elements."""
        return self.errors[name][self.elements.tolist().index(PAPER)]

    @property
    def fractions(self) -> np.ndarray:
        """(modes,) fraction of the whole error due to the lumped mass, at the paper's number of elements."""
        return self.at(MASS) / self.at(BOTH)


def taken(run: Run) -> Taken | None:
    """The errors relative to the finest refinement of ``EXACT``; None if the run has no such rows."""
    rows = {name: [v for v in run.levels if v.case == CASE and v.code == name] for name in LOOKS}
    if not all(rows.values()):
        return None
    elements = sorted({v.elements for v in rows[EXACT]})
    modes = sorted({v.mode for v in rows[EXACT]})
    table = {name: {(v.elements, v.mode): v.frequency for v in found} for name, found in rows.items()}
    grid = {name: np.array([[f[n, m] for m in modes] for n in elements]) for name, f in table.items()}
    exact = grid[EXACT][-1]
    return Taken(np.array(elements), {name: f / exact - 1.0 for name, f in grid.items()})


def sentence(found: Taken) -> str:
    """One sentence: how much of the paper's error is due to lumping."""
    percent = ", ".join(f"{100 * s:.0f} %" for s in found.fractions)
    return (
        f"With {PAPER} elements, lumping the mass causes {percent} of the error of edgewise modes 1 to {len(found.fractions)}; "
        "the rest is due to a beam stiffness that is linear in the parent body's frame."
    )
