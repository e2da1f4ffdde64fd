"""windIO 1 and 2: the coupled, curved blade of the BeamDyn samples told in YAML is the same blade."""

import copy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from southwell.cases.input import readers
from southwell.cases.input.readers import Mount
from southwell.tests.cases.input.readers.test_readers_elastodyn import same

DATA = Path(__file__).parents[3] / "data" / "blades"
ROWS, COLUMNS = np.triu_indices(6)


def samples() -> tuple[dict[str, Any], dict[str, Any]]:
    """The BeamDyn samples as windIO 1 and as windIO 2."""
    numbers = (DATA / "beamdyn_blade.dat").read_text().split("PROPERTIES---------------------------------\n")[1].split()
    stations = np.array(numbers, float).reshape(3, 73)
    eta = stations[:, 0].tolist()
    stiffness, mass = (stations[:, k : k + 36].reshape(3, 6, 6) for k in (1, 37))
    lines = (DATA / "beamdyn_main.dat").read_text().splitlines()
    points = np.array([line.split() for line in lines if line.count("E+") + line.count("E-") == 4], float)
    grid = np.linspace(0, 1, len(points)).tolist()
    x, y, z, twist = points.T
    axis = {c: {"grid": grid, "values": v.tolist()} for c, v in zip("xyz", (x, y, z), strict=True)}
    one = {
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
    two = {
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
    return one, two


def written(path: Path, data: dict[str, Any]) -> Path:
    path.write_text(yaml.safe_dump(copy.deepcopy(data)), encoding="utf-8")
    return path


@pytest.mark.parametrize("version", [1, 2])
def test_it_is_the_beamdyn_blade(tmp_path: Path, version: int) -> None:
    found = readers.reading(written(tmp_path / "b.yaml", samples()[version - 1]))
    expected = readers.read(DATA / "beamdyn_main.dat", Mount(hub_radius=1.5, precone=-0.04))
    same(found.blade, expected, 1e-13)
    assert found.blade.name == "invented"
    assert found.source.format == f"windIO {version}"


def test_numbers_without_a_point_in_their_exponent_are_numbers(tmp_path: Path) -> None:
    """``1e9`` is a string to YAML 1.1."""
    path = written(tmp_path / "b.yaml", samples()[0])
    path.write_text(path.read_text().replace("9000000000.0", "9e9"))
    assert "9e9" in path.read_text()
    same(readers.read(path), readers.read(written(tmp_path / "c.yml", samples()[0])))
