"""Blade files: published ones where they are installed, invented ones, and how two blades are compared."""

import copy
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from southwell.core.blade import Blade

BEAM = """name = "beam"
[blade]
kind = "beam"
length = 6.0
hub_radius = 0.3
E = 7e10
G = 2.7e10
density = 3000.0
A = 4e-4
I_y = 2e-7
I_z = 2e-7
J = 4e-7
"""
"""A uniform beam in Southwell's own format; a table may follow."""

BLADES = Path(__file__).parents[1] / "data" / "blades"
FIELDS = ("stations", "stiffness", "mass", "twist", "curve", "hub_radius", "precone", "pitch", "tip_mass", "root")


def real(name: str) -> Path:
    """A published blade file, where the environment says they are."""
    folder = os.environ.get("SOUTHWELL_BLADES")
    if not folder or not (Path(folder) / name).is_file():
        pytest.skip(f"SOUTHWELL_BLADES has no {name}")
    return Path(folder) / name


def assert_same(a: Blade, b: Blade, rtol: float = 1e-14) -> None:
    for field in FIELDS:
        x, y = np.array(getattr(a, field)), np.array(getattr(b, field))
        elsewhere = np.isfinite(x)
        np.testing.assert_array_equal(elsewhere, np.isfinite(y), err_msg=field)
        scale = np.abs(x[elsewhere]).max(initial=0.0)
        np.testing.assert_allclose(x[elsewhere], y[elsewhere], rtol=rtol, atol=rtol * scale, err_msg=field)


ROWS, COLUMNS = np.triu_indices(6)


def samples() -> tuple[dict[str, Any], dict[str, Any]]:
    """The BeamDyn samples as windIO 1 and as windIO 2."""
    numbers = (
        (BLADES / "beamdyn_blade.dat").read_text().split("PROPERTIES---------------------------------\n")[1].split()
    )
    stations = np.array(numbers, float).reshape(3, 73)
    eta = stations[:, 0].tolist()
    stiffness, mass = (stations[:, k : k + 36].reshape(3, 6, 6) for k in (1, 37))
    lines = (BLADES / "beamdyn_main.dat").read_text().splitlines()
    points = np.array([line.split() for line in lines if line.count("E+") + line.count("E-") == 4], float)
    grid = np.linspace(0, 1, len(points)).tolist()
    x, y, z, twist = points.T
    axis = {c: {"grid": grid, "values": v.tolist()} for c, v in zip("xyz", (x, y, z), strict=True)}
    version_1 = {
        "name": "invented",
        "assembly": {"rotor_orientation": "Upwind"},
        "components": {
            "blade": {
                "outer_shape_bem": {
                    "twist": {"grid": grid, "values": np.radians(twist).tolist()},
                    "reference_axis": axis,
                },
                "elastic_properties_mb": {
                    "six_x_six": {
                        "stiff_matrix": {"grid": eta, "values": [k[ROWS, COLUMNS].tolist() for k in stiffness]},
                        "inertia_matrix": {"grid": eta, "values": [m[ROWS, COLUMNS].tolist() for m in mass]},
                    }
                },
            },
            "hub": {"diameter": 3.0, "cone_angle": 0.04},
        },
    }
    m = mass[:, 0, 0]
    lists = {f"K{i + 1}{j + 1}": stiffness[:, i, j].tolist() for i, j in zip(ROWS, COLUMNS, strict=True)}
    inertia = {
        "mass": m,
        "cm_x": mass[:, 1, 5] / m,
        "cm_y": -mass[:, 0, 5] / m,
        "i_edge": mass[:, 3, 3],
        "i_flap": mass[:, 4, 4],
        "i_plr": mass[:, 5, 5],
        "i_cp": -mass[:, 3, 4],
    }
    version_2 = {
        "windIO_version": "2.0",
        "name": "invented",
        "components": {
            "blade": {
                "reference_axis": axis,
                "outer_shape": {"twist": {"grid": grid, "values": twist.tolist()}},
                "structure": {
                    "elastic_properties": {
                        "stiffness_matrix": {"grid": eta, **lists},
                        "inertia_matrix": {"grid": eta, **{k: v.tolist() for k, v in inertia.items()}},
                    }
                },
            },
            "hub": {"diameter": 3.0, "cone_angle": float(np.degrees(0.04))},
        },
    }
    return version_1, version_2


def written(path: Path, data: dict[str, Any]) -> Path:
    path.write_text(yaml.safe_dump(copy.deepcopy(data)), encoding="utf-8")
    return path
