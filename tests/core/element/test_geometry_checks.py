"""A reference curve must begin at the root and have the arc length of its stations; rounding in files is tolerated."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers import reading
from southwell.core.blade import Blade, BladeError, section_mass, section_stiffness
from southwell.core.element.sections import frames, root
from southwell.core.solve import mesh_modes

from ...support.beams import curved, tapered

FILE = """
name = "beam"
[blade]
kind = "sections"
hub_radius = 1.0
s = [{root}, 10.0]
stiffness = [{k}, {k}]
mass = [{m}, {m}]
curve = {curve}
"""
DATA = Path(__file__).parents[2] / "data" / "blades"
K = "[1e7, 0, 0, 0, 0, 0, 4e6, 0, 0, 0, 0, 4e6, 0, 0, 0, 1e4, 0, 0, 1e4, 0, 4e4]"
M = "[10, 0, 0, 0, 0, 0, 10, 0, 0, 0, 0, 10, 0, 0, 0, 0.03, 0, 0, 0.01, 0, 0.02]"


def blade(s: np.ndarray, curve: np.ndarray) -> Blade:
    n = len(s)
    stiffness, mass = section_stiffness(1e7, 1e4, 1e4, 4e4), section_mass(10.0, 0.01, 0.02)
    return Blade("beam", s, np.repeat(stiffness, n, axis=0), np.repeat(mass, n, axis=0), np.zeros(n), curve=curve)


def from_file(folder: Path, curve: object, root: float = 0.0) -> Blade:
    path = folder / "blade.toml"
    path.write_text(FILE.format(k=K, m=M, curve=curve, root=root))
    return reading(path).blade


def arc(s: np.ndarray, radius: float = 20.0) -> np.ndarray:
    return radius * np.stack([np.sin(s / radius), 1 - np.cos(s / radius), 0 * s], axis=1)


@pytest.mark.parametrize(
    ("curve", "match"),
    [
        (
            [[0.0, 0.0, 0.0], [20.0, 0.0, 0.0]],
            r"blade\.curve: its points at 0 m and 10 m are 20 m apart.*10 m.*arc length",
        ),
        (
            [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]],
            r"blade\.curve: between 0 m and 10 m it is 5 m long, but the stations differ by 10 m",
        ),
        (
            [[5.0, 0.0, 0.0], [15.0, 0.0, 0.0]],
            r"blade\.curve: begins at \(5, 0, 0\) m.*x = 0.*subtract its first point",
        ),
        ([[0.0, 5.0, 0.0], [10.0, 5.0, 0.0]], r"blade\.curve: begins at \(0, 5, 0\) m"),
        ([[0.0, 0.0, 0.0], [-10.0, 0.0, 0.0]], r"blade\.curve: turns back towards the hub at 0 m"),
        ([[0.0, 0.0, 0.0], [1e29, 0.0, 0.0]], r"blade\.curve: its points.*1e\+29 m apart"),
        ([[0.0, 0.0, 0.0], [1e308, 0.0, 0.0]], r"1e\+308: implausibly large"),
    ],
    ids=["longer", "shorter", "starts at 5 m", "starts 5 m off the axis", "backwards", "1e29", "1e308"],
)
def test_a_file_whose_curve_does_not_match_its_stations_is_refused(tmp_path: Path, curve: object, match: str) -> None:
    with pytest.raises(CaseError, match=match):
        from_file(tmp_path, curve)


@pytest.mark.parametrize("value", ["1e308", "-1e308", "1e160"])
@pytest.mark.parametrize("line", [13, 14, 15, 17])
@pytest.mark.parametrize("column", range(4))
def test_a_huge_key_point_is_refused_in_one_line(tmp_path: Path, value: str, line: int, column: int) -> None:
    """BeamDyn's reference axis and its twist: such numbers overflowed in the splines."""
    for name in ("beamdyn_main.dat", "beamdyn_blade.dat"):
        (tmp_path / name).write_text((DATA / name).read_text())
    path = tmp_path / "beamdyn_main.dat"
    lines = path.read_text().splitlines()
    words = lines[line].split()
    words[column] = value
    lines[line] = "  ".join(words)
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(CaseError, match=f"line {line + 1}: .*{value}: implausibly large"):
        reading(path)


def test_a_beamdyn_curve_of_few_points_is_followed(tmp_path: Path) -> None:
    """Key points 10 m apart and a tip that bends by 20°: the file's curve is a spline, and so are the stations between."""
    for name in ("beamdyn_main.dat", "beamdyn_blade.dat"):
        (tmp_path / name).write_text((DATA / name).read_text())
    path = tmp_path / "beamdyn_main.dat"
    path.write_text(
        path.read_text().replace("-1.5000000E+00  4.0000000E-01  4.00", "-6.0000000E+00  4.0000000E-01  4.00")
    )
    result = reading(path).blade
    assert result.curve[-1, 2] == -6.0
    z = np.linspace(0.0, 40.0, 5)
    expected = CubicSpline(z, [[0, 0], [0.1, -0.05], [0, -0.1], [-0.5, 0], [-6, 0.4]], bc_type="natural")
    s = 0.5 * (result.stations[1:] + result.stations[:-1])
    pose = frames(result, s)
    slope = expected(pose[:, 0, 3] - result.hub_radius, 1)
    tangent = np.column_stack([np.ones_like(s), -slope[:, 1], slope[:, 0]])
    tangent = tangent @ root(result)[:3, :3].T / np.linalg.norm(tangent, axis=1)[:, None]
    np.testing.assert_allclose(pose[:, :3, 0], tangent, atol=2e-3)


def test_a_huge_curve_from_python_is_refused_without_a_warning() -> None:
    with pytest.raises(BladeError, match="apart"):
        blade(np.array([0.0, 10.0]), np.array([[0.0, 0, 0], [1e308, 1e308, 0]]))


def test_stations_that_are_spans_and_not_arc_lengths_are_refused() -> None:
    """A circle of 20 m radius over its x: 3 % longer than its span. The arc length itself is accepted."""
    s = np.linspace(0.0, 10.0, 11)
    correct = arc(s)
    with pytest.raises(
        BladeError, match=r"curve: its points at .* m apart, but their arc lengths differ .*spans along x"
    ):
        blade(correct[:, 0], correct)
    assert blade(s, correct).length == 10.0


def test_a_misplaced_point_is_located() -> None:
    s = np.linspace(0.0, 10.0, 21)
    r = arc(s)
    r[10, 2] += 0.05
    with pytest.raises(BladeError, match=r"curve:.* (4|4\.5|5|5\.5) m"):
        blade(s, r)


@pytest.mark.parametrize("digits", [3, 4, 5])
def test_rounded_coordinates_are_accepted(digits: int) -> None:
    """A 60 m blade with 3 m of prebend, rounded to millimetres as in published tables."""
    s = np.linspace(0.0, 60.0, 41)
    rounded = np.round(arc(s, 600.0), digits) + 0.0
    np.testing.assert_array_equal(blade(np.round(s, digits), rounded).curve, rounded)


def test_a_curve_may_begin_off_the_pitch_axis() -> None:
    """A reference axis parallel to the pitch axis is another description of the same blade."""
    smooth = curved()
    assert Blade(**{**vars(smooth), "curve": smooth.curve + np.array([0.0, 0.17, -0.09])}).length == smooth.length


@pytest.mark.parametrize("root", [4e-16, 3.6e-12, -2e-13])
def test_a_root_within_rounding_of_zero_is_the_root(tmp_path: Path, root: float) -> None:
    result = from_file(tmp_path, [[root, 0.0, 0.0], [10.0, 0.0, 0.0]], root)
    assert result.stations[0] == 0.0
    exact = from_file(tmp_path, [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]])
    np.testing.assert_allclose(
        mesh_modes(result, 3.0, 10, 5).frequencies, mesh_modes(exact, 3.0, 10, 5).frequencies, rtol=1e-11
    )


def test_a_root_beyond_rounding_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=r"stations: first is 0\.001 m"):
        from_file(tmp_path, [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]], 1e-3)


@pytest.mark.parametrize("last", [1 - 2e-16, 1 + 2e-16, 1 - 1e-12])
def test_a_table_that_ends_within_rounding_of_the_tip_is_complete(tmp_path: Path, last: float) -> None:
    path = tmp_path / "case.csv"
    header = "fraction [-],twist [deg],mass [kg/m],EI_flap [N m^2],EI_edge [N m^2],GJ [N m^2],EA [N]"
    path.write_text(f"{header}\n3.6e-13,0,10,1e4,4e4,1e4,1e7\n{last!r},0,10,1e4,4e4,1e4,1e7\n")
    from southwell.cases.input.readers.source import Mount

    result = reading(path, Mount(length=10.0)).blade
    np.testing.assert_array_equal(result.stations, [0.0, 10.0])


@pytest.mark.parametrize("name", ["precone", "pitch"])
def test_angles_are_finite(name: str) -> None:
    with pytest.raises(BladeError, match=f"{name}: nan"):
        Blade(**{**vars(tapered()), name: np.nan})


@pytest.mark.parametrize("length", [1e30, 2e4, 1e-7, 1e-30])
@pytest.mark.filterwarnings("error")
def test_a_length_in_another_unit_is_refused(length: float) -> None:
    """Before the curve is splined, which loses all digits with such numbers."""
    s = length * np.array([0.0, 0.5, 1.0])
    with pytest.raises(BladeError, match=r"length: .* m: not between 1e-06 and 10000 m: check the unit"):
        blade(s, np.stack([s, 0 * s, 0 * s], axis=1))


@pytest.mark.parametrize("radius", [-1.0, 2e4, np.inf, np.nan])
def test_a_hub_radius_in_another_unit_is_refused(radius: float) -> None:
    s = np.array([0.0, 5.0, 10.0])
    with pytest.raises(BladeError, match=r"hub_radius: .* m: not between 0 and 10000 m: check the unit"):
        replace(blade(s, np.stack([s, 0 * s, 0 * s], axis=1)), hub_radius=radius)


@pytest.mark.parametrize(
    ("name", "angle"), [("precone", 90.5), ("precone", -100.0), ("pitch", 36000.0), ("pitch", np.nan)]
)
def test_an_angle_in_another_unit_is_an_error(name: str, angle: float) -> None:
    with pytest.raises(BladeError, match=rf"{name}: {angle:g} degrees: beyond ±(90|180): check the unit"):
        replace(tapered(), **{name: np.radians(angle)})


@pytest.mark.parametrize(("name", "angle"), [("precone", 90.0), ("pitch", -180.0)])
def test_the_largest_angles_are_accepted(name: str, angle: float) -> None:
    assert getattr(replace(tapered(), **{name: np.radians(angle)}), name) == np.radians(angle)
