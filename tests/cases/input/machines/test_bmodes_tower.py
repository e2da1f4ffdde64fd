"""BModes' files of a tower: the certification tests 3 and 4, and a base on springs."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg

from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.machines import towers
from southwell.core.turbine.tower_modes import tower_modes
from southwell.tests.core.turbine.test_tower import BMODES_ELEMENTS, BMODES_SECTIONS, HEIGHT

AXIAL = (61.868e9, 55.222e9, 48.953e9, 43.061e9, 37.548e9, 32.411e9, 27.653e9, 23.272e9, 19.268e9, 15.643e9)

FACTORS = (
    *("sec_mass_mult", "flp_iner_mult", "lag_iner_mult", "flp_stff_mult", "edge_stff_mult", "tor_stff_mult"),
    *("axial_stff_mult", "cg_offst_mult", "sc_offst_mult", "tc_offst_mult"),
)

MAIN = """BModes main file
2 beam_type
0. romg
{height} radius
0. hub_rad
{kind} hub_conn
78055.8 tip_mass
-3.3 cm_loc
2960437. ixx_tip
3253223. iyy_tip
3264220. izz_tip
0. ixy_tip
-18400. izx_tip
0. iyz_tip
'sections.dat' sec_props_file
{factors}
12 nselt
boundaries of elements
{elements}
{more}
"""

WIRES = """2 n_attachments: number
3 3 n_wires: number at each
6 10 node_attach: nodes
9.0e9 1.6e9 wire_stfness: N/m
45. 30. th_wire: degrees
"""


def write(folder: Path, factor: float = 1.0, more: str = "0 n_attachments:", kind: int = 1) -> Path:
    rows = [
        f"{k / 9:.5f} 0 0 {m} {i} {i} {b} {b} {t} {a} 0 0 0"
        for k, ((m, i, b, t), a) in enumerate(zip(BMODES_SECTIONS.tolist(), AXIAL, strict=True))
    ]
    (folder / "sections.dat").write_text("sections\n10 n_secs\n\nsec_loc ...\n(-) ...\n" + "\n".join(rows) + "\n")
    text = MAIN.format(
        height=HEIGHT,
        kind=kind,
        factors="\n".join(f"{factor} {name}" for name in FACTORS),
        elements=" ".join(str(x) for x in BMODES_ELEMENTS),
        more=more,
    )
    path = folder / "tower.bmi"
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    ("factor", "more", "printed"),
    [
        (1.0, "0 n_attachments:", (0.41908, 0.42087, 2.1977, 2.4880, 2.5800)),
        (0.25, WIRES, (0.55780, 0.58291, 1.1727)),
    ],
    ids=["3", "4"],
)
def test_certification_cases_of_bmodes_are_reproduced(
    tmp_path: Path, factor: float, more: str, printed: tuple[float, ...]
) -> None:
    """Test03_tower.out and Test04_wires_supported_tower.out of BModes 1.03, read with properties linear between sections."""
    path = write(tmp_path, factor, more)
    assert towers.is_tower(path)
    tower, source = towers.read(path)
    solution = tower_modes(tower, len(printed))
    np.testing.assert_allclose(solution.frequencies / (2 * np.pi), printed, rtol=5e-3)
    assert solution.names[:2] == ("1st side-side", "1st fore-aft")
    assert "without weight, as in BModes" in source.notes
    exact = [(0.40 * HEIGHT, 1.5 * 9.0e9 * 0.5), (0.72 * HEIGHT, 1.5 * 1.6e9 * 0.75)] if "wire_stfness" in more else []
    wires = [(height, float(S[2, 2])) for height, S in tower.support.springs]
    np.testing.assert_allclose(wires, exact, rtol=1e-12)


def test_moments_are_about_the_mass_centre_from_bmodes_3_on(tmp_path: Path) -> None:
    path = write(tmp_path)
    before = towers.read(path)[0].beam.tip_mass
    path.write_text(path.read_text().replace("2960437. ixx_tip", "1.1 cm_axial\n2960437. ixx_tip"))
    after = towers.read(path)[0].beam.tip_mass
    # ours: up, to starboard, downwind
    np.testing.assert_allclose(np.diagonal(before)[3:], [3264220.0, 3253223.0, 2960437.0])
    arms = 78055.8 * np.array([3.3**2, 3.3**2 + 1.1**2, 1.1**2])
    np.testing.assert_allclose(np.diagonal(after)[3:], np.diagonal(before)[3:] + arms)
    assert after[1, 5] == pytest.approx(78055.8 * 1.1)


def test_properties_may_jump(tmp_path: Path) -> None:
    """Two sections at one height: a tower of two uniform parts has the frequencies of one with a steep change there."""
    path = write(tmp_path)
    file = tmp_path / "sections.dat"
    head, rows = file.read_text().splitlines()[:5], file.read_text().splitlines()[5:]
    lower, upper = rows[0].split(), rows[4].split()
    result = []
    for step in (0.0, 1e-4):
        parts = [(0.0, lower), (0.4, lower), (0.4 + step, upper), (1.0, upper)]
        text = "\n".join(" ".join([f"{at:g}", *row[1:]]) for at, row in parts)
        file.write_text("\n".join(head).replace("10 n_secs", "4 n_secs") + "\n" + text + "\n")
        tower, source = towers.read(path)
        assert ("properties jump at 32.956" in " ".join(source.notes)) == (step == 0.0)
        result.append(tower_modes(tower, 3).frequencies)
    np.testing.assert_allclose(*result, rtol=2e-4)


def matrix(name: str, values: np.ndarray) -> str:
    return f"6x6 matrix ({name}):\n" + "\n".join(" ".join(f"{v:g}" for v in row) for row in values) + "\n"


def test_a_base_on_springs_below_the_sea(tmp_path: Path) -> None:
    """mooring_K is about a point 5 m below the base: lifted there, its translations tilt with it."""
    lateral, rocking = 2e9, 3e11
    K = np.diag([lateral, lateral, 0.0, rocking, rocking, 0.0])
    more = f"10. draft\n15. ref_msl\n{matrix('hydro_K', np.zeros((6, 6)))}{matrix('mooring_K', K)}"
    tower, _ = towers.read(write(tmp_path, more=more, kind=3))
    assert tower.beam.length == pytest.approx(HEIGHT + 10.0)
    base = tower.support.base
    assert base is not None
    assert np.isinf(base[[0, 3], [0, 3]]).all()
    # rotation ω about a horizontal axis at the base displaces the point below by 5 m ω
    assert base[4, 4] == pytest.approx(rocking + 25.0 * lateral)
    assert base[2, 4] == pytest.approx(5.0 * lateral)
    assert base[1, 5] == pytest.approx(-5.0 * lateral)
    assert tower.support.mass is None
    assert tower_modes(tower, 1).frequencies[0] > 0


SPAR_K = np.diag([4e4, 4e4, 3e5, 2e9, 2e9, 1e8])
SPAR_K[0, 4] = SPAR_K[4, 0] = -2.8e6
SPAR_K[1, 3], SPAR_K[3, 1] = 2.8e6, 2.803e6  # as in a linearisation


def platform(K: np.ndarray) -> str:
    """A platform with its base 10 m above the sea, its mass centre 80 m and its point of reference 2 m below."""
    added = np.diag([7e6, 7e6, 2e5, 4e10, 4e10, 0.0])
    own = "6x6 of 3 rows (i_matrix_pform):\n4e9 0. 0.\n0. 4e9 0.\n0. 0. 1.6e8\n"
    sea = "-10. draft\n80. cm_pform\n7e6 mass_pform\n2. ref_msl\n"
    return f"{sea}{own}{matrix('hydro_M', added)}{matrix('hydro_K', 0 * K)}{matrix('mooring_K', K)}"


def test_a_tower_on_a_platform(tmp_path: Path) -> None:
    """The lowest modes are those of a rigid body of the same inertia, of which the tower is a small part; source: BldVib."""
    tower, source = towers.read(write(tmp_path, more=platform(SPAR_K), kind=2))
    assert tower.beam.length == pytest.approx(HEIGHT - 10.0)
    mass, base = tower.support.mass, tower.support.base
    assert mass is not None
    assert base is not None
    assert np.diagonal(mass)[:3] == pytest.approx([7.2e6, 14e6, 14e6])  # ours: up, to starboard, downwind
    assert mass[4, 4] == pytest.approx(4e9 + 7e6 * 90.0**2 + 4e10 + 7e6 * 12.0**2)
    assert mass[2, 4] == pytest.approx(90.0 * 7e6 + 12.0 * 7e6)
    assert base[1, 5] == base[5, 1]
    stiff = replace(tower, beam=replace(tower.beam, stiffness=1e4 * tower.beam.stiffness, tip_mass=1e-6 * np.eye(6)))
    light = replace(stiff, beam=replace(stiff.beam, mass=1e-6 * stiff.beam.mass))
    modes = tower_modes(light, 6)
    exact = np.sqrt(scipy.linalg.eigh(base, mass, eigvals_only=True))
    np.testing.assert_allclose(modes.frequencies, exact, rtol=1e-4)
    assert sorted(modes.names) == [f"platform {n}" for n in ("heave", "pitch", "roll", "surge", "sway", "yaw")]
    names = tower_modes(tower, 8).names
    assert names[:6] == modes.names
    assert names[6:] == ("1st side-side", "1st fore-aft")
    assert not source.unused
    assert "free in all directions" in " ".join(source.notes)
    K = SPAR_K.copy()
    K[3, 1] = 3.5e6
    with pytest.raises(CaseError, match="hydro_K \\+ mooring_K: entries differ by 700000 from those across"):
        towers.read(write(tmp_path, more=platform(K), kind=2))


@pytest.mark.slow
def test_pybmodes_has_the_same_modes_on_a_platform(tmp_path: Path) -> None:
    """The two agree as far as BModes' mesh, whose elements have the properties at their middle."""
    models = pytest.importorskip("pybmodes.models")
    example = "sample_inputs/reference_turbines/07_nrel5mw_oc3hywind_spar/07_nrel5mw_oc3hywind_spar_tower.bmi"
    path = Path(models.__file__).parent.parent / "_examples" / example
    if not path.is_file():
        pytest.skip("this pybmodes has no example of a spar")
    modes = tower_modes(towers.read(path)[0], 8)
    other = np.array(models.Tower(path).run(n_modes=8).frequencies)
    np.testing.assert_allclose(modes.frequencies / (2 * np.pi), other, rtol=3e-4)
    assert modes.names[:3] == ("platform surge", "platform sway", "platform heave")


@pytest.mark.parametrize(
    ("kind", "more", "message"),
    [
        (2, "", "moves freely"),
        (4, "", "hub_conn: 4"),
        (3, "", "moves freely"),
        (1, WIRES.replace("6 10", "6 99"), "node_attach: 99"),
    ],
)
def test_other_supports_of_a_bmodes_tower_are_refused(tmp_path: Path, kind: int, more: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        towers.read(write(tmp_path, more=more, kind=kind))


def test_a_bmodes_tower_is_not_read_as_a_blade(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="this is the file of a tower: give the file of"):
        readers.reading(write(tmp_path))
