"""ElastoDyn's tower file: mass, fore-aft and side-to-side stiffness along the height.

The tower is read as a ``Blade`` that stands: x up, z downwind, so that fore-aft motion is along z and side-to-side motion
along y. AdjTwMa, AdjFASt and AdjSSSt multiply the table. Axial, torsional and shear strains are rigid, and sections have no
moments of inertia: the format contains none of them. Source: J. Jonkman, M. Buhl, *FAST User's Guide*, NREL/EL-500-38230, 2005.
"""

from pathlib import Path

import numpy as np

from .....core.blade import Blade, section_mass, section_stiffness
from ...errors import CaseError, located
from ..source import Mount, Reading, Source
from ..text import Text, fractions, keys, load, path_named, value
from . import elastodyn, elastodyn_table, elastodyn_unused
from .mode_shapes import TOWER

NAME = "ElastoDyn tower"
AXES = "x up, z downwind, y = z × x"
COLUMNS = ("HtFract", "TMassDen", "TwFAStif", "TwSSStif")
OFFSETS = ("TwFAIner", "TwSSIner", "TwrSFAcgOf", "TwFAcgOf", "TwSScgOf", "TwGJStif", "TwEAStif")
LAYOUT = elastodyn_table.Layout("NTwInpSt", ("AdjTwMa", "AdjFASt", "AdjSSSt"), COLUMNS, COLUMNS, (*COLUMNS, *OFFSETS))


def is_tower(text: Text) -> bool:
    """Whether these are lines of a tower file."""
    return "ntwinpst" in keys(text)


def read(path: Path, mount: Mount | None = None) -> Reading:
    """Read a tower, clamped at its base, without the nacelle and rotor that it carries.

    Args:
        path: path of the file. Its height is in the main file: ``mount.main``, or the only one in the same folder that
            references it; or ``mount.length``.
        mount: data that the file does not contain.

    Raises:
        CaseError: naming the file and line at fault.
    """
    mount, text = mount or Mount(), load(path)
    main = mount.main or (None if mount.length else elastodyn.sibling_file(path, elastodyn.is_main, tower_file))
    height = mount.length or (tower_height(load(main)) if main else None)
    if height is None:
        raise CaseError(
            f"{path}: length: missing: stations are fractions of the tower's height, and no main file defines it: "
            "give --main FILE, or --length"
        )
    tower, notes = beam(text, height)
    motions = "flapwise is fore-aft, edgewise is side-to-side"
    scope = "the tower alone: nacelle and rotor, and their weight, are included by `southwell campbell TURBINE.fst`"
    files = (path,) if main is None else (path, main)
    source = Source(NAME, files, AXES, (motions, *notes, scope), elastodyn_unused.of_shapes(text, TOWER))
    return Reading(tower, source, speed=0.0)


def tower_file(main: Text) -> Path:
    """Path of the tower's file in a main file.

    Raises:
        CaseError: if it is missing.
    """
    return path_named(main, "TwrFile")


def tower_height(main: Text) -> float:
    """Height of the flexible tower in a main file, m: TowerHt − TowerBsHt, or − TwrRBHt in FAST 7.

    Raises:
        CaseError: if a value is missing, or the top is not above the base.
    """
    entries = keys(main)
    top = value(main, entries, "TowerHt")
    base = next((value(main, entries, name) for name in ("TowerBsHt", "TwrRBHt") if name.lower() in entries), 0.0)
    if top <= base:
        raise CaseError(
            f"{main.path}: TowerHt {top:g} is not above TowerBsHt {base:g}: the tower has no height; correct one of them"
        )
    return top - base


def beam(text: Text, height: float) -> tuple[Blade, tuple[str, ...]]:
    """The tower of this height, m, and notes on its multipliers and missing data.

    Raises:
        CaseError: naming the file and line at fault.
    """
    sections, factors = elastodyn_table.read(text, LAYOUT)
    sections.positive(*COLUMNS[1:])
    mass, fore_aft, side_side = factors.values()
    with located(f"{text.path}: "):
        tower = Blade(
            name=text.path.stem,
            stations=fractions(sections, "HtFract") * height,
            stiffness=section_stiffness(
                np.inf, np.inf, fore_aft * sections["TwFAStif"], side_side * sections["TwSSStif"]
            ),
            mass=section_mass(mass * sections["TMassDen"]),
            twist=np.zeros(len(sections.lines)),
        )
    factors_text = ", ".join(f"{name} = {factor:g}" for name, factor in factors.items())
    rigid = (
        "axial, torsional and shear stiffness and moments of inertia of the tower's sections: not used by this format"
    )
    return tower, (f"{factors_text}: multiply the table", rigid)
