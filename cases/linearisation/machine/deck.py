"""A turbine's deck as its linearisation sees it: the machine, ElastoDyn's assumed mode shapes, nodes and damping."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ....core.turbine.turbine import Turbine
from ...input import files
from ...input.errors import CaseError
from ...input.readers.openfast import elastodyn, elastodyn_tower, fst, mode_shapes
from ...input.readers.openfast import turbine as reader
from ...input.readers.openfast.mode_shapes import Shape
from ...input.readers.source import Mount
from ...input.readers.text import integer, keys, load, number_or, value


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
        entries = keys(main)
        if not elastodyn_tower.tower_file(main).is_file():
            raise CaseError(
                f"--fst {path}: {elastodyn_tower.tower_file(main)}: no such file: put the tower's file there"
            )
        pitch = -np.radians(value(main, entries, "BlPitch1")) if "blpitch1" in entries else 0.0
        reading = reader.read(path, Mount(pitch=pitch))
        blade = elastodyn.blade_file(main)
        compelast = keys(primary).get("compelast", (0, "1"))[1]
        return Deck(
            reading.turbine,
            float(np.radians(value(main, entries, "ShftTilt"))),
            mode_shapes.read(load(blade), mode_shapes.BLADE) if compelast == "1" else {},
            mode_shapes.read(load(elastodyn_tower.tower_file(main)), mode_shapes.TOWER),
            integer(main, entries, "BldNodes") if "bldnodes" in entries else 0,
            integer(main, entries, "TwrNodes") if "twrnodes" in entries else 0,
            value(main, entries, "DTTorSpr"),
            number_or(main, "DTTorDmp", 0.0),
            float(pitch),
        )


def for_states(deck: Deck, families: set[str]) -> Turbine:
    """The turbine with the joints that a linearisation's states have: yaw, generator and drivetrain."""
    turbine = deck.turbine
    drive = replace(
        turbine.drivetrain,
        stiffness=deck.shaft_stiffness if "drivetrain" in families else np.inf,
        free="generator" in families,
    )
    return replace(turbine, drivetrain=drive, yaw=turbine.yaw if "yaw" in families else np.inf)
