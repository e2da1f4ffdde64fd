"""A turbine's deck as its linearisation sees it: the machine, ElastoDyn's assumed mode shapes, nodes and damping.

ElastoDyn's shapes are polynomials Σ c_k x^k, k = 2 … 6, of the distance from the root, 0 to 1. Source: J. Jonkman, M. Buhl,
*FAST User's Guide*, NREL/EL-500-38230, 2005.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....core.turbine.turbine import Turbine
from ...input import files
from ...input.errors import CaseError
from ...input.readers.openfast import elastodyn, elastodyn_tower, fst
from ...input.readers.openfast import turbine as reader
from ...input.readers.source import Mount
from ...input.readers.text import Text, keys, load, number, value, whole

Array = NDArray[np.float64]

BLADE = {"flapwise 1": "BldFl1Sh", "flapwise 2": "BldFl2Sh", "edgewise 1": "BldEdgSh"}
"""Motions of a blade and the names of their coefficients."""

TOWER = {
    "tower fore-aft 1": "TwFAM1Sh",
    "tower fore-aft 2": "TwFAM2Sh",
    "tower side-side 1": "TwSSM1Sh",
    "tower side-side 2": "TwSSM2Sh",
}
"""Motions of the tower and the names of their coefficients."""

_BLADE_DAMPING = {"flapwise 1": "BldFlDmp1", "flapwise 2": "BldFlDmp2", "edgewise 1": "BldEdDmp1"}
_BLADE_TUNERS = {"flapwise 1": "FlStTunr1", "flapwise 2": "FlStTunr2"}
_TOWER_DAMPING = {
    "tower fore-aft 1": "TwrFADmp1",
    "tower fore-aft 2": "TwrFADmp2",
    "tower side-side 1": "TwrSSDmp1",
    "tower side-side 2": "TwrSSDmp2",
}
_TOWER_TUNERS = {
    "tower fore-aft 1": "FAStTunr1",
    "tower fore-aft 2": "FAStTunr2",
    "tower side-side 1": "SSStTunr1",
    "tower side-side 2": "SSStTunr2",
}


@dataclass(frozen=True)
class Shape:
    """An assumed mode shape.

    Attributes:
        coefficients: (5,) of x² … x⁶.
        damping: ratio of critical damping.
        tuner: factor on the modal stiffness.
    """

    coefficients: Array
    damping: float
    tuner: float

    def at(self, x: Array, derivative: int = 0) -> Array:
        """The polynomial or its derivative at x, 0 to 1."""
        powers = np.polynomial.Polynomial([0.0, 0.0, *self.coefficients])
        return np.asarray(powers.deriv(derivative)(x) if derivative else powers(x))


@dataclass(frozen=True)
class Deck:
    """A turbine and what ElastoDyn assumes of it.

    Attributes:
        turbine: the machine; its blades may be fewer than three.
        tilt: of the shaft, rad, positive if the downwind end is higher.
        blade_shapes: by motion; empty if the blades are BeamDyn's.
        tower_shapes: by motion.
        blade_nodes, tower_nodes: numbers of ElastoDyn's nodes.
        shaft_stiffness, shaft_damping: of the drivetrain, N m/rad and N m s/rad.
        pitch: of the blades, rad, positive as in ``core.blade``; initial pitch of the deck.
    """

    turbine: Turbine
    tilt: float
    blade_shapes: dict[str, Shape]
    tower_shapes: dict[str, Shape]
    blade_nodes: int
    tower_nodes: int
    shaft_stiffness: float
    shaft_damping: float
    pitch: float


def read(path: Path) -> Deck:
    """The deck of a primary file (.fst).

    Raises:
        CaseError: if the deck cannot be read, or describes no turbine.
    """
    with files.reading(path, deck=True):
        primary = load(path)
        if not fst.matches_format(primary):
            raise CaseError(f"--fst {path}: not a primary file of OpenFAST (no EDFile): give the turbine's .fst file")
        main = load(fst.file_named(primary, "EDFile"))
        named = keys(main)
        if not elastodyn_tower.tower_file(main).is_file():
            raise CaseError(
                f"--fst {path}: {elastodyn_tower.tower_file(main)}: no such file: put the tower's file there"
            )
        pitch = -np.radians(value(main, named, "BlPitch1")) if "blpitch1" in named else 0.0
        made = reader.read(path, Mount(pitch=pitch))
        blade = elastodyn.blade_file(main)
        compelast = keys(primary).get("compelast", (0, "1"))[1]
        return Deck(
            made.turbine,
            float(np.radians(value(main, named, "ShftTilt"))),
            _shapes(load(blade), BLADE, _BLADE_DAMPING, _BLADE_TUNERS) if compelast == "1" else {},
            _shapes(load(elastodyn_tower.tower_file(main)), TOWER, _TOWER_DAMPING, _TOWER_TUNERS),
            whole(main, named, "BldNodes") if "bldnodes" in named else 0,
            whole(main, named, "TwrNodes") if "twrnodes" in named else 0,
            value(main, named, "DTTorSpr"),
            _number(main, "DTTorDmp", 0.0),
            float(pitch),
        )


def _shapes(text: Text, names: dict[str, str], damping: dict[str, str], tuners: dict[str, str]) -> dict[str, Shape]:
    """The shapes in a blade or tower file; those that it does not have are left out."""
    named = keys(text)
    out: dict[str, Shape] = {}
    for motion, name in names.items():
        numbered = [f"{name}{k}" for k in range(2, 7)]
        if not all(each.lower() in named for each in numbered):
            continue
        coefficients = np.array([value(text, named, each) for each in numbered])
        if abs(coefficients.sum()) < 1e-6:
            raise CaseError(f"{text.path}: {name}: the coefficients sum to 0, but a shape is 1 at its end: correct one")
        out[motion] = Shape(
            coefficients,
            0.01 * _number(text, damping[motion], 0.0),
            _number(text, tuners[motion], 1.0) if motion in tuners else 1.0,
        )
    return out


def _number(text: Text, name: str, otherwise: float) -> float:
    entry = keys(text).get(name.lower())
    out = number(entry[1]) if entry else None
    return out if out is not None and np.isfinite(out) else otherwise


def for_states(deck: Deck, families: set[str]) -> Turbine:
    """The turbine with the joints that a linearisation's states have: yaw, generator and drivetrain."""
    turbine = deck.turbine
    drive = replace(
        turbine.drivetrain,
        stiffness=deck.shaft_stiffness if "drivetrain" in families else np.inf,
        free="generator" in families,
    )
    return replace(turbine, drivetrain=drive, yaw=turbine.yaw if "yaw" in families else np.inf)
