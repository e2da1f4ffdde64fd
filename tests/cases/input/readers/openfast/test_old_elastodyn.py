"""FAST 7's blade tables: the offset columns move axis and mass centre as FAST's ADAMS preprocessor does, or are left out."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell import modes
from southwell.cases.input import files, readers, schema
from southwell.cases.input.properties import about_root, sections
from southwell.cases.input.readers import Mount
from southwell.core.blade import Blade, section_mass, section_stiffness
from southwell.tests.support.blade_files import assert_same

DATA = Path(__file__).parents[4] / "data" / "blades"
BLADE, MAIN = DATA / "fast7_blade.dat", DATA / "fast7_main.fst"
MOUNT = Mount(length=40.0, hub_radius=1.5)
OFFSETS = ("PrecrvRef", "PreswpRef", "FlpcgOf", "EdgcgOf", "FlpEAOf", "EdgEAOf")


def table(tmp_path: Path, columns: dict[str, list[float]], twist: float = 0.0) -> Path:
    """A FAST 7 file of a uniform blade with some columns; those not given are 0."""
    head = "BlFract AeroCent StrcTwst BMassDen FlpStff EdgStff GJStff EAStff Alpha FlpIner EdgIner " + " ".join(OFFSETS)
    rows, stations = [], 3
    for k in range(stations):
        offsets = (columns.get(name, [0.0] * stations)[k] for name in OFFSETS)
        rows.append((k / (stations - 1), 0.25, twist, 100.0, 2e8, 8e8, 5e7, 2e9, 0.0, 20.0, 60.0, *offsets))
    lines = [
        "FAST INDIVIDUAL BLADE FILE",
        f"{stations} NBlInpSt",
        *(f"1.0 {name}" for name in ("AdjBlMs", "AdjFlSt", "AdjEdSt")),
        head,
        "(-) (-) (deg)",
        *(" ".join(repr(x) for x in row) for row in rows),
    ]
    path = tmp_path / "uniform.dat"
    path.write_text("\n".join(lines) + "\n")
    return path


def test_columns_are_where_the_table_says() -> None:
    """Station 4 of 6 at 0.8: the axis at PrecrvRef + FlpEAOf n1 …, by hand."""
    blade = readers.read(BLADE, MOUNT)
    t = np.radians(1.0)  # StrcTwst: n1 = x_b cos t − y_b sin t, n2 = x_b sin t + y_b cos t
    x_b = 0.52 + 0.01 * np.cos(t) + 0.04 * np.sin(t)
    y_b = 0.40 - 0.01 * np.sin(t) + 0.04 * np.cos(t)
    np.testing.assert_allclose(blade.curve[4], [32.0, -y_b, x_b], rtol=1e-14)  # x along the blade, y ahead, z downwind
    np.testing.assert_allclose(sections(blade).mass_centre[4], [-(0.10 - 0.04), 0.01 - 0.01], atol=1e-12)
    assert blade.mass[4, 4, 4] == pytest.approx(4.0 + 110.0 * 0.0**2)  # FlpIner about the mass centre
    assert blade.mass[4, 5, 5] == pytest.approx(34.0 + 110.0 * 0.06**2)  # EdgIner, moved by Steiner's theorem


@pytest.mark.parametrize(
    ("twist", "column", "expected_indices"),
    [
        (0.0, "FlpcgOf", [0, 0, 1]),  # towards the suction side: downwind
        (0.0, "EdgcgOf", [0, -1, 0]),  # towards the trailing edge: against the motion
        (90.0, "FlpcgOf", [0, 1, 0]),  # feathered, leading edge upwind: the suction side faces the motion
        (90.0, "EdgcgOf", [0, 0, 1]),  # … and the trailing edge is downwind
        (90.0, "PrecrvRef", [0, 0, 1]),  # in blade axes: not rotated by the twist
        (90.0, "PreswpRef", [0, -1, 0]),
        (90.0, "FlpEAOf", None),  # moves the axis only: the mass stays where it is
    ],
)
def test_the_mass_lies_on_the_side_that_the_column_names(
    tmp_path: Path, twist: float, column: str, expected_indices: list[int] | None
) -> None:
    path = table(tmp_path, {column: [0.1, 0.1, 0.1]}, twist)
    centre = about_root(readers.read(path, MOUNT)).centre
    np.testing.assert_allclose(centre[1:], 0.1 * np.array(expected_indices or [0, 0, 0])[1:], atol=1e-12)
    assert centre[0] == pytest.approx(20.0)


def test_an_axis_parallel_to_the_pitch_axis_is_a_beam_with_its_mass_off_its_axis(tmp_path: Path) -> None:
    """At rest a parallel shift changes nothing: the frequencies are those of sections given by hand about the elastic axis."""
    path = table(tmp_path, {"EdgEAOf": [0.2] * 3, "FlpEAOf": [0.05] * 3, "EdgcgOf": [0.5] * 3})
    y, z = -0.3, -0.05  # of the mass centre from the elastic axis
    m = section_mass(100.0, 20.0, 60.0)[0]
    m[4, 4] += 100 * z**2
    m[5, 5] += 100 * y**2
    m[3, 3] += 100 * (y**2 + z**2)
    m[4, 5] = m[5, 4] = -100 * y * z
    m[0, 4] = m[4, 0] = 100 * z
    m[0, 5] = m[5, 0] = -100 * y
    m[1, 3] = m[3, 1] = -100 * z
    m[2, 3] = m[3, 2] = 100 * y
    by_hand = Blade(
        name="by hand",
        stations=np.array([0.0, 40.0]),
        stiffness=np.repeat(section_stiffness(2e9, 5e7, 2e8, 8e8), 2, axis=0),
        mass=np.stack([m, m]),
        twist=np.zeros(2),
    )
    frequencies = modes(readers.read(path, MOUNT), 0.0, elements=20, modes=6).frequencies
    np.testing.assert_allclose(frequencies, modes(by_hand, 0.0, elements=20, modes=6).frequencies, rtol=1e-9)


def test_the_stations_are_arc_lengths_of_the_axis(tmp_path: Path) -> None:
    """A straight axis that leans by 3 in 40: √(40² + 3²) m long; its sections are rotated with it."""
    path = table(tmp_path, {"PreswpRef": [0.0, 1.5, 3.0]})
    blade = readers.read(path, MOUNT)
    assert blade.length == pytest.approx(np.hypot(40.0, 3.0), rel=1e-12)
    assert about_root(blade).mass == pytest.approx(100.0 * np.hypot(40.0, 3.0), rel=1e-9)


def test_offsets_can_be_left_out_and_are_then_listed(tmp_path: Path) -> None:
    reading = readers.reading(BLADE, replace(MOUNT, offsets=False))
    zero = readers.reading(table(tmp_path, {}), replace(MOUNT, offsets=False))
    np.testing.assert_array_equal(reading.blade.curve[:, 1:], 0.0)
    assert not sections(reading.blade).mass_centre.any()
    unused_by_name = {u.name: u for u in reading.source.unused}
    assert unused_by_name["PrecrvRef"].largest == 0.9
    assert unused_by_name["EdgcgOf"].largest == 0.16  # the file writes Edgcgof
    assert set(OFFSETS) <= set(unused_by_name)
    assert not set(OFFSETS) & {u.name for u in zero.source.unused}


def test_used_offsets_are_noted_and_not_listed() -> None:
    reading = readers.reading(BLADE, MOUNT)
    assert not set(OFFSETS) & {u.name for u in reading.source.unused}
    assert any("PrecrvRef 0.9 m" in note and "EdgcgOf 0.16 m" in note for note in reading.source.notes)


def test_the_same_in_a_case_file(tmp_path: Path) -> None:
    text = f"""
name = "old"
title = "old"
description = "old"
source = "here"
[blade]
kind = "file"
file = "{BLADE}"
main = "{MAIN}"
offsets = false
[speeds]
rpm = "0, 10, 20.5"
[compare]
modes = 2
"""
    (tmp_path / "old.toml").write_text(text)
    with pytest.raises(readers.CaseError, match=r"outside .* --allow-outside"):
        schema.read(tmp_path / "old.toml")
    with files.outside_allowed():
        (variant,) = schema.read(tmp_path / "old.toml").variants
    np.testing.assert_allclose(variant.speeds * 30 / np.pi, [0, 10, 20.5])
    assert_same(variant.blade, readers.read(MAIN, Mount(offsets=False)))
    assert "PrecrvRef" in {u.name for u in variant.unused}


def test_offsets_of_another_format_are_refused() -> None:
    with pytest.raises(readers.CaseError, match="offsets: HAWC2 files have no such option, ElastoDyn files do"):
        readers.read(DATA / "hawc2.htc", Mount(offsets=False))
