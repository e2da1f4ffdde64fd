"""BeamDyn blades: an invented coupled and curved one, published ones against the same blades in other formats, wrong files."""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import CubicSpline

from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers import Mount
from southwell.cases.input.readers.openfast import beamdyn, elastodyn
from southwell.core.blade import straight
from southwell.core.element.sections import frames
from southwell.tests.support.blade_files import assert_same, real

DATA = Path(__file__).parents[4] / "data" / "blades"
BLADE, MAIN, OLD = DATA / "beamdyn_blade.dat", DATA / "beamdyn_main.dat", DATA / "beamdyn_old_main.dat"
Z = np.array([0.0, 10, 20, 30, 40])
X, Y = np.array([0, 0.1, 0, -0.5, -1.5]), np.array([0, -0.05, -0.1, 0, 0.4])
STRAIGHT = Mount(length=40.0)


def test_matrices_keep_their_energy_and_the_centres_their_side() -> None:
    """Their x, y, z are our z, −y, x: so are velocities, strains and centres; energies stay."""
    blade = beamdyn.read(BLADE, Mount(length=40.0, main=MAIN)).blade
    text = BLADE.read_text().split("DISTRIBUTED PROPERTIES---------------------------------\n")[1].split()
    stiffness, mass = (np.array(text[1 + 36 * k : 37 + 36 * k], float).reshape(6, 6) for k in (0, 1))
    rng = np.random.default_rng(1)
    for expected in rng.standard_normal((5, 6)):
        vx, vy, vz, wx, wy, wz = expected
        actual = np.array([vz, -vy, vx, wz, -wy, wx])
        assert actual @ blade.mass[0] @ actual == pytest.approx(expected @ mass @ expected, rel=1e-12)
        assert actual @ blade.stiffness[0] @ actual == pytest.approx(expected @ stiffness @ expected, rel=1e-12)
    m = blade.mass[0]
    assert m[0, 0] == 300.0
    assert (-m[0, 5] / 300, m[0, 4] / 300) == pytest.approx((0.2, 0.05))  # 0.2 m ahead, 0.05 m downwind


def test_positions_and_twist_are_the_splines_through_the_key_points() -> None:
    blade = readers.read(MAIN)
    x, y, _twist = (CubicSpline(Z, v, bc_type="natural") for v in (X, Y, [12.0, 10, 7, 4, 1]))
    length = quad(lambda z: np.sqrt(1 + x(z, 1) ** 2 + y(z, 1) ** 2), 0, 40, epsabs=1e-12, points=Z[1:-1])[0]
    assert blade.length == pytest.approx(length, rel=1e-12)
    at = blade.curve[:, 0]
    assert len(at) == 3 + 3  # stations at 0, 0.4, 1; key points between
    np.testing.assert_allclose(blade.curve, np.stack([at, -y(at), x(at)], axis=1), atol=1e-13)
    k = int(np.argmin(np.abs(blade.stations - 0.4 * length)))
    assert blade.stations[k] == pytest.approx(0.4 * length, rel=1e-14)
    np.testing.assert_allclose(blade.stiffness[k] * 2, blade.stiffness[0], rtol=1e-12)


def test_orientations_of_sections_are_beamdyns(tmp_path: Path) -> None:
    """Its x has no y-component before both turn about the tangent; the shortest swing would roll by 0.017 at the tip."""
    z = np.linspace(0, 40, 81)
    u = z / 40
    rows = np.stack([-3 * u**3, 2 * u**3, z, 12 - 11 * u], axis=1)
    text = MAIN.read_text().replace("          5   kp_total", "         81   kp_total")
    first, last = text.index("0.0000000E+00"), text.index("---------------------- MESH")
    table = "\n".join(" ".join(f"{v:.12f}" for v in row) for row in rows)
    (tmp_path / "m.dat").write_text(text[:first] + table + "\n" + text[last:])
    (tmp_path / BLADE.name).write_text(BLADE.read_text())
    blade = readers.read(tmp_path / "m.dat")
    at = blade.curve[:, 0] / 40
    t = np.stack([np.ones_like(at), -6 * at**2 / 40, -9 * at**2 / 40], axis=1)
    t /= np.linalg.norm(t, axis=1)[:, None]
    flat = np.cross(t, [0.0, 1.0, 0.0])
    flat /= np.linalg.norm(flat, axis=1)[:, None]
    turn = np.radians(12 - 11 * at)[:, None]
    expected = np.cos(turn) * flat - np.sin(turn) * np.cross(t, flat)
    assert 6 * 9 / 40**2 / 2 > 0.015
    # the natural end of the splines bends the tangent over the last piece, 3/8 m
    np.testing.assert_allclose(frames(blade, blade.stations)[:-4, :3, 2], expected[:-4], atol=3e-4)


def test_old_and_new_headers_are_read_alike() -> None:
    assert_same(beamdyn.read(OLD).blade, beamdyn.read(MAIN).blade)


def test_two_main_files_beside_a_blade_file_are_ambiguous() -> None:
    with pytest.raises(CaseError, match="2 main files in its folder name it"):
        beamdyn.read(BLADE, STRAIGHT)


def test_elastodyns_main_file_says_how_it_is_mounted(tmp_path: Path) -> None:
    for path in (MAIN, BLADE):
        (tmp_path / path.name).write_text(path.read_text())
    hub = tmp_path / "ElastoDyn.dat"
    hub.write_text((DATA / "elastodyn_main.dat").read_text().replace("         52   Tip", "       42.1   Tip"))
    blade = beamdyn.read(tmp_path / MAIN.name, Mount(main=hub)).blade
    assert (blade.hub_radius, np.degrees(blade.precone), blade.tip_mass[0, 0]) == pytest.approx((2.0, -2.5, 40.0))
    hub.write_text((DATA / "elastodyn_main.dat").read_text())
    with pytest.raises(CaseError, match=r"length: 50 m by the main file or --length, 40\.\d+ m by the key points"):
        beamdyn.read(tmp_path / MAIN.name, Mount(main=hub))


def test_nrel_5mw_is_the_blade_of_its_elastodyn_file() -> None:
    """Two files of one blade by other hands: the same mass, flap and edge stiffness and twist, to the printed digit."""
    actual = beamdyn.read(real("nrel5mw/NRELOffshrBsline5MW_BeamDyn.dat")).blade
    other = elastodyn.read(
        real("nrel5mw/NRELOffshrBsline5MW_Blade.dat"), Mount(length=61.5, multipliers=(1.0, 1.0, 1.0))
    ).blade
    assert straight(actual)
    assert actual.length == 61.5
    at = [int(np.abs(actual.stations - s).argmin()) for s in other.stations]
    np.testing.assert_allclose(actual.stations[at], other.stations, atol=1e-9)
    for i in (4, 5):
        np.testing.assert_allclose(actual.stiffness[at, i, i], other.stiffness[:, i, i], rtol=1e-6)
    np.testing.assert_allclose(actual.mass[at, 0, 0], other.mass[:, 0, 0], rtol=1e-6)
    assert np.abs(np.degrees(actual.twist[at] - other.twist)).max() < 0.2  # given at key points, between which it bends


def edited(tmp_path: Path, file: Path, old: str, new: str, count: int = 1) -> Path:
    for path in (MAIN, BLADE):
        (tmp_path / path.name).write_text(path.read_text())
    text = file.read_text()
    assert old in text
    (tmp_path / file.name).write_bytes(text.replace(old, new, count).encode())
    return tmp_path / MAIN.name


@pytest.mark.parametrize(
    ("file", "old", "new", "count"),
    [
        (BLADE, "\n", "\r\n", -1),
        (BLADE, "   ", "\t", -1),
        (BLADE, "E+", "D+", -1),
        (BLADE, "\n\n", "\n", -1),
        (BLADE, "---------------------- DISTRIBUTED PROPERTIES---------------------------------\n", "", 1),
        (MAIN, "E+", "d+", -1),
        (MAIN, "   (m)            (m)          (m)            (deg)\n", "", 1),
    ],
    ids=["CRLF", "tabs", "Fortran", "no blank lines", "no ruler", "Fortran key points", "no units"],
)
def test_other_layouts_of_the_file_give_the_same_blade(
    tmp_path: Path, file: Path, old: str, new: str, count: int
) -> None:
    assert_same(readers.read(edited(tmp_path, file, old, new, count)), readers.read(MAIN))


NINE = "9.000000000E+09"
BAD = {
    "count": (
        BLADE,
        "3   station_total",
        "4   station_total",
        r"blade.dat: line 55: .*within station 4 of 4: give the whole file",
    ),
    "too few": (BLADE, "3   station_total", "2   station_total", r"another station after the 2 announced"),
    "no count": (BLADE, "station_total", "stations", r"station_total: missing"),
    "NaN": (BLADE, NINE, "NaN", r"line 16: stiffness 55: NaN: not a finite number"),
    "negative": (
        BLADE,
        NINE,
        "-9E+09",
        r"line 12: stiffness at station_eta 0: diagonal entry 5 is -9e\+09: it must be positive",
    ),
    "lopsided": (BLADE, "1.000000000E+07", "2E+07", r"line 12: .*entries \(1, 2\) and \(2, 1\) are 2e\+07 and 1e\+07"),
    "coupling": (
        BLADE,
        "8.000000000E+08",
        "8E+09",
        r"line 12: stiffness at station_eta 0: (not positive definite|entries)",
    ),
    "column": (BLADE, NINE, "", r"line 16: 5 numbers instead of 6"),
    "eta": (
        BLADE,
        "  0.400000",
        "  0.000000",
        r"line 26: station_eta: 0: not beyond the previous station: sort them",
    ),
    "end": (BLADE, "  1.000000\n", "  0.900000\n", r"line 41: station_eta: 0.9: .*begin at 0 and end at 1"),
    "key points": (
        MAIN,
        "          5   kp_total",
        "          6   kp_total",
        r"main.dat: line 19: the table ends after 5 of 6 rows",
    ),
    "duplicate": (MAIN, "2.0000000E+01  7", "1.0E+01  7", r"line 16: kp_zr: 10: not beyond the previous key point"),
    "root": (MAIN, "0.0000000E+00  1.2", "0.1E+00  1.2", r"line 14: kp_zr: 0.1: the first key point is the root"),
    "file": (MAIN, '"beamdyn_blade.dat"', '"other.dat"', r"other.dat: no such file"),
}


@pytest.mark.parametrize("kind", BAD)
def test_bad_files_are_refused_with_line_and_value(tmp_path: Path, kind: str) -> None:
    file, old, new, message = BAD[kind]
    with pytest.raises(CaseError, match=message) as caught:
        readers.read(edited(tmp_path, file, old, new))
    assert "\n" not in str(caught.value)


def test_a_truncated_file(tmp_path: Path) -> None:
    main = edited(tmp_path, BLADE, "mu1", "mu1")
    path, text = tmp_path / BLADE.name, BLADE.read_text()
    path.write_text(text[: text.index("  1.000000\n") + 300])
    with pytest.raises(CaseError, match=r"beamdyn_blade.dat: line 4\d: .*(numbers instead of 6|give the whole file)"):
        readers.read(main)


def test_a_blade_file_without_length(tmp_path: Path) -> None:
    (tmp_path / BLADE.name).write_text(BLADE.read_text())
    with pytest.raises(
        CaseError, match=r"length: .*give the main file instead, or --length for a straight, untwisted blade"
    ):
        readers.read(tmp_path / BLADE.name)
    assert readers.read(tmp_path / BLADE.name, STRAIGHT).length == 40.0
