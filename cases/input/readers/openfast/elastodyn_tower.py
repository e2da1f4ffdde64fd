"""ElastoDyn's tower file: mass, fore-aft and side-to-side stiffness along the height.

The tower is read as a ``Blade`` that stands: x up, z downwind, so that fore-aft motion is along z and side-to-side motion
along y. AdjTwMa, AdjFASt and AdjSSSt multiply the table. Axial, torsional and shear strains are rigid, and sections have no
moments of inertia: the format contains none of them. Source: J. Jonkman, M. Buhl, *FAST User's Guide*, NREL/EL-500-38230, 2005.
"""

from pathlib import Path

import numpy as np

from .....core.blade import Blade, BladeError, section_mass, section_stiffness
from ...errors import CaseError
from ..source import Mount, Reading, Source, Unused, unused
from ..text import Text, fractions, integer, keys, leading, load, number, table, tokens, value, word
from . import elastodyn

NAME = "ElastoDyn tower"
AXES = "x up, z downwind, y = z × x"
COLUMNS = ("HtFract", "TMassDen", "TwFAStif", "TwSSStif")
OFFSETS = ("TwFAIner", "TwSSIner", "TwrSFAcgOf", "TwFAcgOf", "TwSScgOf", "TwGJStif", "TwEAStif")
MULTIPLIERS = ("AdjTwMa", "AdjFASt", "AdjSSSt")


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
            f"{path}: length: stations are fractions of the tower's height, and no main file defines it: give --main FILE, or "
            "--length"
        )
    tower, notes = beam(text, height)
    motions = "flapwise is fore-aft, edgewise is side-to-side"
    scope = "the tower alone: nacelle and rotor, and their weight, are included by `southwell campbell TURBINE.fst`"
    files = (path,) if main is None else (path, main)
    return Reading(tower, Source(NAME, files, AXES, (motions, *notes, scope), of_tower(text)), speed=0.0)


def tower_file(main: Text) -> Path:
    """Path of the tower's file in a main file.

    Raises:
        CaseError: if it is missing.
    """
    return main.path.parent / word(main, keys(main), "TwrFile").replace("\\", "/")


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
            f"{main.path}: TowerHt {top:g} is not above TowerBsHt {base:g}: no tower between them; correct one"
        )
    return top - base


def beam(text: Text, height: float) -> tuple[Blade, tuple[str, ...]]:
    """The tower of this height, m, and notes on its multipliers and missing data.

    Raises:
        CaseError: naming the file and line at fault.
    """
    entries = keys(text)
    count = integer(text, entries, "NTwInpSt")
    factors = [value(text, entries, name) for name in MULTIPLIERS]
    for name, factor in zip(MULTIPLIERS, factors, strict=True):
        if factor <= 0:
            raise CaseError(
                f"{text.at(entries[name.lower()][0])}: {name}: {factor:g}: a factor must be positive: correct it"
            )
    heads = [k for k in range(len(text.lines)) if (tokens(text.lines[k]) or [""])[0].lower() == "htfract"]
    first = heads[0] + 1 if heads else max(entries[name.lower()][0] for name in MULTIPLIERS) + 1
    start = next((k for k in range(first, len(text.lines)) if leading(text.lines[k])), len(text.lines))
    names = tokens(text.lines[heads[0]]) if heads else list(COLUMNS)
    by_lower_case = {name.lower(): name for name in (*COLUMNS, *OFFSETS)}
    sections = table(text, start, count, tuple(by_lower_case.get(name.lower(), name) for name in names))
    missing = [name for name in COLUMNS if name not in sections.columns]
    if missing:
        raise CaseError(f"{text.at(heads[0])}: no column {missing[0]}: the table needs {', '.join(COLUMNS)}; add it")
    sections.positive(*COLUMNS[1:])
    try:
        tower = Blade(
            name=text.path.stem,
            stations=fractions(sections, "HtFract") * height,
            stiffness=section_stiffness(
                np.inf, np.inf, factors[1] * sections["TwFAStif"], factors[2] * sections["TwSSStif"]
            ),
            mass=section_mass(factors[0] * sections["TMassDen"]),
            twist=np.zeros(count),
        )
    except BladeError as error:
        raise CaseError(f"{text.path}: {error}") from error
    factors_text = ", ".join(f"{name} = {factor:g}" for name, factor in zip(MULTIPLIERS, factors, strict=True))
    rigid = (
        "axial, torsional and shear stiffness and moments of inertia of the tower's sections: not used by this format"
    )
    return tower, (f"{factors_text}: multiply the table", rigid)


def of_tower(text: Text) -> tuple[Unused, ...]:
    """Non-zero quantities of a tower file that are not used."""
    entries = keys(text)
    out: list[Unused] = []
    groups = (
        (
            "TwrFADmp(1), TwrFADmp(2), TwrSSDmp(1), TwrSSDmp(2)",
            ("twrfadmp1", "twrfadmp2", "twrssdmp1", "twrssdmp2"),
            "%",
        ),
    )
    for name, keyed, unit in groups:
        values = [number(entries[k][1]) or 0.0 for k in keyed if k in entries]
        out += unused(name, values, unit, text.path, "modes are undamped")
    shapes = [k for k in entries if k.startswith(("twfam", "twssm"))]
    values = [number(entries[k][1]) or 0.0 for k in shapes]
    out += unused("TwFAM1Sh … TwSSM2Sh", values, "", text.path, "ElastoDyn's own mode shapes; they are computed")
    tuned = [number(entries[k][1]) or 0.0 for k in entries if k.startswith(("fasttunr", "ssstunr", "fastunr"))]
    if {*tuned} - {1.0}:
        out += unused("FAStTunr, SSStTunr", tuned, "", text.path, "they scale ElastoDyn's modal stiffness")
    return tuple(out)
