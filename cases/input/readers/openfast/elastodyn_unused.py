"""Quantities in ElastoDyn's files that modes do not use: damping, shapes, aerodynamics, teeter, initial state."""

import math
from collections.abc import Iterable

from ..source import Unused, unused
from ..text import Table, Text, flag, keys, number, number_or
from .fast7_offsets import COLUMNS as OFFSETS
from .mode_shapes import BLADE, Names


def _listed(names: Iterable[str]) -> str:
    """Names with their numbers in brackets, as in the files: ``BldFlDmp(1), BldFlDmp(2)``."""
    return ", ".join(f"{name[:-1]}({name[-1]})" for name in names)


DAMPING = _listed(names.damping for names in BLADE.values())
"""Name of the damping ratios of a blade file."""

AERODYNAMIC = "aerodynamics only"
COLUMNS = {
    "PitchAxis": ("", AERODYNAMIC),
    "AeroCent": ("", AERODYNAMIC),
    "Alpha": ("", "its coupling of bending and torsion is not modelled"),
}
"""Known columns of a blade table that are not used: unit and reason."""

TEETER = {
    "UndSling": "m",
    "Delta3": "deg",
    "TeetDefl": "deg",
    "TeetMod": "",
    "TeetDmpP": "deg",
    "TeetDmp": "N m s/rad",
    "TeetCDmp": "N m",
    "TeetSStP": "deg",
    "TeetHStP": "deg",
    "TeetSSSp": "N m/rad",
    "TeetHSSp": "N m/rad",
}
CLAMPED = "the teeter hinge is treated as clamped: modes in which the rotor teeters are not those of this blade"


def of_table(sections: Table, used_columns: tuple[str, ...], offsets: bool) -> tuple[Unused, ...]:
    """Non-zero columns of a blade table not among ``used_columns``; ``offsets``: whether the offset columns are used."""
    out: list[Unused] = []
    for name, values in sections.columns.items():
        if name in used_columns or (name in OFFSETS and offsets):
            continue
        unit, why = COLUMNS.get(name, ("", "not a column that is known here"))
        if name in OFFSETS:
            unit, why = "m", "switched off by `offsets`"
        out += unused(name, values, unit, sections.text.path, why)
    return tuple(out)


def of_shapes(text: Text, motions: dict[str, Names]) -> tuple[Unused, ...]:
    """Unused non-zero values of a blade or tower file outside its table: what belongs to the assumed shapes."""
    dampings = [names.damping for names in motions.values()]
    coefficients = [name for names in motions.values() for name in names.coefficients]
    tuned = [names.tuner for names in motions.values() if names.tuner]
    tuners = _values(text, tuned)
    scaled = "they scale ElastoDyn's modal stiffness, which sections do not have"
    computed = "ElastoDyn's own mode shapes; they are computed"
    return (
        *unused(_listed(dampings), _values(text, dampings), "% of critical", text.path, "modes are undamped"),
        *unused(
            ", ".join(names.shape for names in motions.values()), _values(text, coefficients), "", text.path, computed
        ),
        *(unused(_listed(tuned), tuners, "", text.path, scaled) if {*tuners} != {1.0} else ()),
    )


def of_main(text: Text) -> tuple[Unused, ...]:
    """Unused non-zero values of a main file for the rotor."""
    out: list[Unused] = []
    pitch = _each(text, "BlPitch")
    how = f"use it by --pitch {pitch[0]:g} --pitch-convention openfast" if pitch else ""
    for name, values, unit, why in (
        ("BlPitch", pitch, "deg", f"the initial pitch of a simulation, taken as 0 here; {how}"),
        ("RotSpeed", _values(text, ("RotSpeed",)), "rpm", "the initial rotor speed; speeds are given by --rpm"),
    ):
        out += unused(name, values, unit, text.path, why)
    for name, unit in (("PreCone", "deg"), ("TipMass", "kg")):
        values = _each(text, name)
        if len({*values}) > 1:
            out += unused(
                f"{name}(2), …", values[1:], unit, text.path, "only the first blade is read; the others differ"
            )
    if flag(text, "TeetDOF") and 2.0 in _values(text, ("NumBl",)):
        out += unused("TeetDOF", (1.0,), "", text.path, CLAMPED)
        for name, unit in TEETER.items():
            out += unused(name, _values(text, (name,)), unit, text.path, "the teeter hinge is treated as clamped")
    return tuple(out)


def other_blades(text: Text, name: str, count: int = 3) -> tuple[str, ...]:
    """A note if the files of the blades, of which there are ``NumBl`` or ``count``, have different names."""
    number_of_blades = int(number_or(text, "NumBl", count))
    entries = keys(text)
    files = [
        entries[f"{name}{k}".lower()][1] for k in range(1, number_of_blades + 1) if f"{name}{k}".lower() in entries
    ]
    if len(set(files)) < 2:
        return ()
    return (f"only the blade of {name}(1) is read; {text.path.name} names other files for other blades",)


def _each(text: Text, name: str) -> tuple[float, ...]:
    """The values for all blades."""
    (count,) = _values(text, ("NumBl",)) or (3.0,)
    return _values(text, (*(f"{name}{k}" for k in (1, 2, 3) if k <= count), name))


def _values(text: Text, names: Iterable[str]) -> tuple[float, ...]:
    """The finite numbers of the names that are present."""
    entries = keys(text)
    numbers = (number(entries[name.lower()][1]) for name in names if name.lower() in entries)
    return tuple(value for value in numbers if value is not None and math.isfinite(value))
