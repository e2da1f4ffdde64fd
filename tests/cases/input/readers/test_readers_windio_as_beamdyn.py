"""windIO 1 and 2: the coupled, curved blade of the BeamDyn samples told in YAML is the same blade."""

from pathlib import Path

import pytest

from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers import Mount
from southwell.tests.support.blade_files import BLADES as DATA
from southwell.tests.support.blade_files import assert_same, samples, written


@pytest.mark.parametrize("version", [1, 2])
def test_it_is_the_beamdyn_blade(tmp_path: Path, version: int) -> None:
    reading = readers.reading(written(tmp_path / "b.yaml", samples()[version - 1]))
    expected = readers.read(DATA / "beamdyn_main.dat", Mount(hub_radius=1.5, precone=-0.04))
    assert_same(reading.blade, expected, 1e-13)
    assert reading.blade.name == "invented"
    assert reading.source.format == f"windIO {version}"


def test_numbers_without_a_point_in_their_exponent_are_numbers(tmp_path: Path) -> None:
    """``1e9`` is a string to YAML 1.1."""
    path = written(tmp_path / "b.yaml", samples()[0])
    path.write_text(path.read_text().replace("9000000000.0", "9e9"))
    assert "9e9" in path.read_text()
    assert_same(readers.read(path), readers.read(written(tmp_path / "c.yml", samples()[0])))


def test_a_hub_of_another_unit_is_refused(tmp_path: Path) -> None:
    data = samples()[0]
    data["components"]["hub"] = {"outer_shape_bem": {"diameter": 4e6}}
    with pytest.raises(CaseError, match=r"hub_radius: 2e\+06 m: .*check the unit"):
        readers.read(written(tmp_path / "b.yaml", data))
