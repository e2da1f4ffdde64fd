"""The machine of OpenFAST's primary file, read by weio: what carries the blades.

Quantities are in the file's own directions, downwind, to port and up, from the tower's top. ElastoDyn's shaft tilt raises the
downwind end of the shaft, and its overhang is positive downwind; the tilt moves the hub by OverHang sin(ShftTilt) upwards.
Sources: J. Jonkman, M. Buhl, *FAST User's Guide*, NREL/EL-500-38230, 2005; OpenFAST documentation, *ElastoDyn*.
"""

from math import cos, radians, sin
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .openfast import first_of, has, parsed, text_of
from .stations import NotReadError

Array = NDArray[np.float64]

Quantities = dict[str, tuple[float, str]]
"""Name → value and unit."""


def read(path: Path) -> tuple[Quantities, str]:
    """The quantities of the machine, and the name and version of the reader.

    Raises:
        NotReadError: if weio does not read them.
    """
    try:
        primary, reader = parsed(path)
        main_path = path.parent / text_of(primary, "EDFile")
        main, _ = parsed(main_path)
        tower, _ = parsed(main_path.parent / text_of(main, "TwrFile"))
        return {**_tower(main, tower), **_top(main), **_drive(main)}, reader
    except NotReadError:
        raise
    except Exception as error:  # of a foreign parser, whatever it raises
        raise NotReadError(" ".join(f"{type(error).__name__}: {error}".split())[:300]) from error


def _number(file: Any, *labels: str) -> float:
    return float(first_of(file, *labels))


def tower_table(main: Any, tower: Any) -> tuple[Array, Array]:
    """Heights of the tower's stations above its base, m, and the mass per length there, kg/m."""
    at, table = _table(main, tower)
    return at, _number(tower, "AdjTwMa") * table["tmassden"]


def _table(main: Any, tower: Any) -> tuple[Array, dict[str, Array]]:
    height = _number(main, "TowerHt") - (
        _number(main, "TowerBsHt", "TwrRBHt") if has(main, "TowerBsHt") or has(main, "TwrRBHt") else 0.0
    )
    label = next(entry["label"] for entry in tower.data if "HtFract" in " ".join(entry.get("tabColumnNames") or ()))
    names = next(entry["tabColumnNames"] for entry in tower.data if entry["label"] == label)
    table = {name.lower(): column for name, column in zip(names, np.array(tower[label], float).T, strict=True)}
    return table["htfract"] * height, table


def _tower(main: Any, tower: Any) -> Quantities:
    at, table = _table(main, tower)

    def along(column: str, factor: str) -> float:
        values = _number(tower, factor) * table[column]
        return float(np.sum(0.5 * (values[1:] + values[:-1]) * np.diff(at)))

    return {
        "height of the tower": (float(at[-1]), "m"),
        "mass of the tower": (along("tmassden", "AdjTwMa"), "kg"),
        "fore-aft stiffness along the tower": (along("twfastif", "AdjFASt"), "N m³"),
        "side-to-side stiffness along the tower": (along("twssstif", "AdjSSSt"), "N m³"),
    }


def _top(main: Any) -> Quantities:
    tilt, overhang = radians(_number(main, "ShftTilt")), _number(main, "OverHang")
    mass = _number(main, "NacMass")
    bearing = _number(main, "YawBrMass") if has(main, "YawBrMass") else 0.0
    centre = {name: _number(main, f"NacCM{axis}n") for name, axis in (("downwind", "x"), ("to port", "y"), ("up", "z"))}
    return {
        "hub's centre above the tower's top": (_number(main, "Twr2Shft") + overhang * sin(tilt), "m"),
        "hub's centre downwind of the tower's top": (overhang * cos(tilt), "m"),
        "rise of the shaft downwind": (sin(tilt), ""),
        "mass of the nacelle": (mass + bearing, "kg"),
        **{f"moment of the nacelle's mass {name}": (mass * arm, "kg m") for name, arm in centre.items()},
        "nacelle's inertia about the yaw axis": (_number(main, "NacYIner"), "kg m²"),
        "mass of the hub": (_number(main, "HubMass"), "kg"),
        "hub's inertia about the shaft": (_number(main, "HubIner"), "kg m²"),
    }


def _drive(main: Any) -> Quantities:
    ratio = _number(main, "GBRatio")
    out = {"generator's inertia on the rotor's side": (_number(main, "GenIner") * ratio * ratio, "kg m²")}
    if bool(first_of(main, "DrTrDOF")):
        out["stiffness of the shaft"] = (_number(main, "DTTorSpr"), "N m/rad")
    return out
