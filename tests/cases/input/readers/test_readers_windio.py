"""windIO: wrong files are told with their line; what the two versions say differently; the published IEA-15."""

import copy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.properties import sections
from southwell.cases.input.readers import Mount, text, yaml_fields
from southwell.tests.support.blade_files import assert_same, real, samples, written

MB = "components.blade.elastic_properties_mb.six_x_six"
EP = "components.blade.structure.elastic_properties"
BLADE = "components.blade"


def put(data: dict[str, Any], key: str, value: object) -> dict[str, Any]:
    """A copy with a value at a dotted key; without the key if the value is None."""
    out = copy.deepcopy(data)
    *path, last = key.split(".")
    node: Any = out
    for part in path:
        node = node[int(part) if isinstance(node, list) else part]
    if value is None:
        del node[last]
    else:
        node[int(last) if isinstance(node, list) else last] = value
    return out


BAD: list[tuple[int, str, object, str]] = [
    (
        1,
        f"{BLADE}.elastic_properties_mb",
        {},
        "components.blade: no 6×6 matrices: .* compute them from the layers first",
    ),
    (1, f"{MB}.stiff_matrix.grid", [0, 0.4, 0.9], "stiff_matrix.grid: 0.9: .*begin at 0 and end at 1"),
    (1, f"{MB}.stiff_matrix.grid", [0.1, 0.4, 1], "stiff_matrix.grid: 0.1: .*begin at 0 and end at 1"),
    (1, f"{MB}.stiff_matrix.grid", [0, 0, 1], "stiff_matrix.grid: 0: not beyond the previous one: sort them"),
    (1, f"{MB}.inertia_matrix.grid", [0, 1], "inertia_matrix.values: 3 values for 2 grid points"),
    (1, f"{MB}.stiff_matrix.values.1", [1.0] * 20, r"values\[1\]: 20 numbers instead of 21: check the row"),
    (1, f"{MB}.inertia_matrix", None, "six_x_six: no key inertia_matrix: .*; add it"),
    (2, f"{BLADE}.outer_shape.twist.values", [1, 2, float("nan"), 3, 4], "twist.values: '.nan' is not a finite number"),
    (2, f"{BLADE}.outer_shape.twist.values.3", "1.0O", "twist.values: '1.0O' is not a finite number"),
    (2, f"{BLADE}.reference_axis.x.values", [0, 1], "reference_axis.x.values: 2 values for 5 grid points"),
    (2, f"{BLADE}.reference_axis.z.values", [0, 10, 5, 30, 40], "reference_axis.z: does not rise at grid 0.5"),
    (2, f"{BLADE}.reference_axis.x.values.0", 0.5, "reference_axis: begins 0.5 m from the root"),
    (2, f"{BLADE}.reference_axis", None, "components.blade: no key reference_axis"),
    (2, f"{BLADE}.reference_axis", "straight", "components.blade.reference_axis: expected keys with values"),
    (2, f"{EP}.stiffness_matrix.K55.1", -4.5e9, r"at station 2: diagonal entry 5 is -4.5e\+09: it must be positive"),
    (2, f"{EP}.inertia_matrix.mass.0", -1.0, "at station 1: diagonal entry 1 is -1: it must be positive"),
    (
        2,
        f"{EP}.stiffness_matrix.K54",
        [1e8] * 3,
        r"stiffness_matrix: K54: .* upper triangle, K11 … K66: correct the key",
    ),
    (2, f"{EP}.inertia_matrix.i_xy", [1.0] * 3, "inertia_matrix: i_xy: not an entry in windIO 2, which has mass, cm_x"),
    (2, "assembly", {"rotor_orientation": "down-wind"}, "rotor_orientation: down-wind: give upwind or downwind"),
    (2, f"{EP}.point_mass", {"grid": [0.0, 1.0], "mass": [0.0]}, "point_mass.mass: 1 values for 2 grid points"),
    (2, f"{EP}.stiffness_matrix.K55", None, "stiffness_matrix: no K55: a blade must resist bending"),
    (2, f"{EP}.stiffness_matrix.K33", None, "stiffness_matrix: K33 is missing, although couplings with it are given"),
    (
        2,
        f"{EP}.point_mass",
        {"grid": [0.5, 1], "mass": [100.0, 0]},
        "point_mass.mass: 100 kg at grid 0.5: only a point mass at the tip",
    ),
    (2, "components", None, "no key components"),
]


@pytest.mark.parametrize(
    ("version", "key", "value", "phrase"), BAD, ids=[f"{v} {k.split('.')[-1]} {o}"[:40] for v, k, o, _ in BAD]
)
def test_wrong_files_are_told_with_line_value_and_remedy(
    tmp_path: Path, version: int, key: str, value: object, phrase: str
) -> None:
    with pytest.raises(CaseError, match=rf"b\.yaml: line \d+: .*{phrase}") as caught:
        readers.read(written(tmp_path / "b.yaml", put(samples()[version - 1], key, value)))
    assert "\n" not in str(caught.value)


def test_the_line_told_is_the_one_with_the_fault(tmp_path: Path) -> None:
    path = written(tmp_path / "b.yaml", put(samples()[1], f"{BLADE}.outer_shape.twist.values.3", 4321.5))
    lines = path.read_text().splitlines()
    (line,) = [k for k, entry in enumerate(lines, 1) if "4321.5" in entry]
    path.write_text("\n".join(entry.replace("4321.5", "4321.5.1") for entry in lines))
    with pytest.raises(CaseError, match=rf"line {line}: components.blade.outer_shape.twist.values: '4321.5.1'"):
        readers.read(path)


@pytest.mark.parametrize(
    ("content", "phrase"),
    [
        ("a: [1, 2\nb: {", r"line \d+: not YAML: .*: correct it"),
        ("# nothing\n", "contains only comments"),
        (
            "components: !include blade.yaml\n",
            r"line 1: components: is in another file \(blade.yaml\): insert its text here",
        ),
        ("components:\n  hub: 1\n  blade: 1\n  blade: 2\n", "line 2: components: key blade is given twice: remove one"),
        ("components:\n\tblade: 1\n", r"line 2: not YAML"),
        ("- 1\n", "expected keys with values"),
    ],
)
def test_what_is_no_such_yaml_is_told(tmp_path: Path, content: str, phrase: str) -> None:
    (tmp_path / "b.yaml").write_text(content)
    with pytest.raises(CaseError, match=phrase):
        readers.read(tmp_path / "b.yaml")


def test_a_truncated_file_is_told(tmp_path: Path) -> None:
    path = written(tmp_path / "b.yaml", samples()[1])
    content = path.read_text()
    for part in (0.3, 0.6, 0.9):
        path.write_text(content[: int(part * len(content))])
        with pytest.raises(CaseError, match=r"b\.yaml: line \d+"):
            readers.read(path)


def test_line_ends_and_fortran_exponents_are_read(tmp_path: Path) -> None:
    path = written(tmp_path / "b.yaml", samples()[0])
    expected = readers.read(path)
    path.write_bytes(path.read_text().replace("9000000000.0", "9.0D+09").replace("\n", "\r\n").encode())
    assert_same(readers.read(path), expected)


def test_twist_in_degrees_in_windio_1_is_noticed_and_said(tmp_path: Path) -> None:
    version_1, version_2 = samples()
    expected = readers.read(written(tmp_path / "c.yaml", version_1))
    version_1["components"]["blade"]["outer_shape_bem"]["twist"] = version_2["components"]["blade"]["outer_shape"][
        "twist"
    ]
    reading = readers.reading(written(tmp_path / "b.yaml", version_1))
    assert_same(reading.blade, expected, 1e-13)
    assert any("taken for degrees" in note for note in reading.source.notes)


def test_twist_in_radians_in_windio_2_is_stated(tmp_path: Path) -> None:
    version_2 = samples()[1]
    for scale, stated in ((1.0, False), (np.pi / 180.0, True), (0.0, False)):
        twist = [scale * degrees for degrees in (12.0, 10.0, 7.0, 4.0, 1.0)]
        data = put(version_2, f"{BLADE}.outer_shape.twist.values", twist)
        notes = readers.reading(written(tmp_path / "b.yaml", data)).source.notes
        assert any("largest twist 0.209°: windIO 2 has degrees" in note for note in notes) is stated


def test_a_reference_axis_whose_grid_is_not_its_length_is_stated(tmp_path: Path) -> None:
    data = put(samples()[1], f"{BLADE}.reference_axis.z.values", [0.0, 5.0, 15.0, 28.0, 40.0])
    notes = readers.reading(written(tmp_path / "b.yaml", data)).source.notes
    assert any("grid 0.5 of the reference axis is at 0.37" in note for note in notes)  # 15 m of 40 m


def test_the_cone_leans_away_from_the_tower(tmp_path: Path) -> None:
    """Upwind of an upwind rotor, downwind of a downwind one; a mount has the last word; no hub, no cone."""
    two = samples()[1]
    for orientation, sign in (("Upwind", -1), ("downwind", 1)):
        data = {**two, "assembly": {"rotor_orientation": orientation}}
        assert readers.read(written(tmp_path / "b.yaml", data)).precone == pytest.approx(sign * 0.04, rel=1e-12)
    assert readers.read(tmp_path / "b.yaml", Mount(precone=0.1, hub_radius=3.0)).precone == 0.1
    bare = readers.reading(written(tmp_path / "b.yaml", put(two, "components.hub", None)))
    assert (bare.blade.precone, bare.blade.hub_radius) == (0.0, 0.0)
    assert "hub_radius, precone, pitch taken as 0 (options: --hub-radius, --precone, --pitch)" in bare.source.notes


def test_stiffness_that_is_left_out_is_rigid_and_said(tmp_path: Path) -> None:
    """windIO 2 needs K44 and K55 alone."""
    data = samples()[1]
    stiffness = data["components"]["blade"]["structure"]["elastic_properties"]["stiffness_matrix"]
    for key in [k for k in stiffness if k not in ("grid", "K44", "K55", "K45")]:
        del stiffness[key]
    reading = readers.reading(written(tmp_path / "b.yaml", data))
    held = np.isinf(reading.blade.stiffness[:, range(6), range(6)])
    np.testing.assert_array_equal(held, [[True] * 4 + [False] * 2] * len(held))
    np.testing.assert_allclose(reading.blade.stiffness[0, 4, 4], stiffness["K55"][0])
    np.testing.assert_allclose(reading.blade.stiffness[0, 5, 5], stiffness["K44"][0])
    assert "K11, K22, K33, K66 zero or not given: those strains are rigid" in reading.source.notes


def test_a_point_mass_at_the_tip_is_the_tip_mass(tmp_path: Path) -> None:
    data = put(samples()[1], f"{EP}.point_mass", {"grid": [0.0, 1.0], "mass": [0.0, 120.0]})
    blade = readers.read(written(tmp_path / "b.yaml", data))
    np.testing.assert_array_equal(np.diag(blade.tip_mass), [120.0] * 3 + [0.0] * 3)


def test_grids_of_stiffness_and_mass_may_differ(tmp_path: Path) -> None:
    version_1 = samples()[0]
    expected = readers.read(written(tmp_path / "c.yaml", version_1))
    rows = version_1["components"]["blade"]["elastic_properties_mb"]["six_x_six"]["inertia_matrix"]
    middle = (0.5 * np.array(rows["values"][0]) + 0.5 * np.array(rows["values"][1])).tolist()
    rows["grid"].insert(1, rows["grid"][1] / 2)
    rows["values"].insert(1, middle)
    version_1["components"]["blade"]["elastic_properties_mb"]["six_x_six"]["stiff_matrix"]["grid"] = [0, 0.4, 1]
    blade = readers.read(written(tmp_path / "b.yaml", version_1))
    assert len(blade.stations) == len(expected.stations) + 1
    k = [int(np.abs(blade.stations - s).argmin()) for s in expected.stations]
    for name in ("stiffness", "mass", "twist", "curve"):
        np.testing.assert_allclose(getattr(blade, name)[k], getattr(expected, name), rtol=1e-12, atol=1e-9)


def test_a_field_says_where_it_is() -> None:
    result = yaml_fields.fields(text.Text(Path("b.yaml"), ("a:", "  b: [1,", "      2]"))).get("a", "b")
    assert result.at == "b.yaml: line 2: a.b"
    assert result.item(1) == "b.yaml: line 3: a.b"
    np.testing.assert_array_equal(result.numbers(), [1, 2])


def test_the_published_iea15_is_its_beamdyn_deck() -> None:
    """windIO's own example against the deck of the turbine's repository: the same matrices at the same 26 stations."""
    windio = pytest.importorskip("windIO", reason="its package ships the file: pip install windIO")
    path = Path(windio.__file__).parent / "examples" / "turbine" / "IEA-15-240-RWT.yaml"
    deck = readers.read(real("iea15/IEA-15-240-RWT_BeamDyn_blade.dat"), Mount(length=117.0))
    blade = readers.read(path)
    k = [int(np.abs(blade.stations / blade.length - eta).argmin()) for eta in deck.stations / deck.length]
    for name in ("stiffness", "mass"):
        actual, expected = getattr(blade, name)[k], getattr(deck, name)
        scale = np.sqrt(np.einsum("nii,njj->nij", expected, expected))
        np.testing.assert_allclose(actual / scale, expected / scale, atol=1e-10)
    assert (blade.hub_radius, np.degrees(blade.precone)) == (3.97, pytest.approx(-4.0))
    np.testing.assert_allclose(blade.curve[-1], [117.0, 0.0, -4.0], atol=1e-9)
    ahead = sections(blade).shear_centre[k[15], 0] - sections(blade).mass_centre[k[15], 0]
    assert ahead > 0  # the spar carries the shear, the trailing edge's mass lies behind it
