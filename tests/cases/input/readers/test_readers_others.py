"""HAWC2, BModes and our own TOML: invented files worked out by hand, one blade in two formats, wrong files."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import trapezoid

from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.properties import sections
from southwell.cases.input.readers import Mount, bmodes, southwell_toml
from southwell.cases.input.readers.hawc2 import blade as hawc2
from southwell.cases.input.readers.openfast import elastodyn
from southwell.core.blade import uniform_blade
from southwell.core.solve import modes
from southwell.tests.support.blade_files import BEAM, assert_same, real

DATA = Path(__file__).parents[3] / "data" / "blades"
ST, HTC, BMI, SECTIONS = (DATA / n for n in ("hawc2_st.dat", "hawc2.htc", "bmodes.bmi", "bmodes_sections.dat"))
ON, OFF = Mount(subset=(1, 1), hub_radius=1.0), Mount(subset=(1, 2), hub_radius=1.0)


def copied(tmp_path: Path, file: Path, old: str, new: str, count: int = 1) -> Path:
    """All samples in a folder, one of them edited."""
    for path in (ST, HTC, BMI, SECTIONS):
        (tmp_path / path.name).write_text(path.read_text())
    text = file.read_text()
    assert old in text
    (tmp_path / file.name).write_text(text.replace(old, new, count), newline="")
    return tmp_path / file.name


def test_hawc2_uniform_section_is_the_beam_of_its_materials() -> None:
    blade = readers.read(ST, ON)
    expected = uniform_blade(
        "beam", 20.0, 1.0, EA=1e9, GJ=1.2e7, EI_y=1e7, EI_z=8e7, mass=100.0, I_y=0.25, I_z=4.0, GA_y=2e8, GA_z=2e8
    )
    np.testing.assert_allclose(blade.stiffness, np.repeat(expected.stiffness[:1], 3, axis=0), rtol=1e-14, atol=1e-3)
    np.testing.assert_allclose(blade.mass, np.repeat(expected.mass[:1], 3, axis=0), rtol=1e-14, atol=1e-10)


def test_hawc2_centres_off_the_half_chord_line() -> None:
    blade = readers.read(ST, OFF)
    centres = sections(blade)
    for where in (centres.mass_centre, centres.tension_centre, centres.shear_centre):
        np.testing.assert_allclose(where, [[0.3, -0.1]] * 3, atol=1e-12)
    np.testing.assert_allclose(centres.GJ, 1.2e7)
    np.testing.assert_allclose(centres.EA, 1e9)


def test_a_section_moved_across_keeps_its_frequencies_at_rest() -> None:
    """All centres together off the reference axis: the same beam beside the line; twisted, it would not be."""
    a, b = (modes(readers.read(ST, mount), 0.0, 24, 6).frequencies for mount in (ON, OFF))
    np.testing.assert_allclose(a, b, rtol=1e-9)


def test_hawc2_radii_of_gyration_are_about_the_elastic_centre(tmp_path: Path) -> None:
    """100 kg/m at 0.4 m, 0.1 m ahead of the elastic centre: 4 − 1 about itself, 16 more about the half-chord line."""
    path = copied(tmp_path, ST, "1.000000e+02\t3.000000e-01", "1.000000e+02\t4.000000e-01", -1)
    m = readers.read(path, OFF).mass[0]
    assert m[5, 5] == pytest.approx(4.0 - 1.0 + 16.0)
    assert m[0, 5] == pytest.approx(-40.0)
    assert m[4, 4] == pytest.approx(0.25 + 100 * 0.1**2)  # both centres 0.1 m upwind
    copied(tmp_path, ST, "1.000000e+02\t3.000000e-01", "1.000000e+02\t6.000000e-01", -1)
    with pytest.raises(CaseError, match=r"line 10: ri_x, ri_y: 0.2: less than the mass centre's distance"):
        readers.read(path, OFF)


def test_hawc2_curve_and_twist_of_the_htc() -> None:
    reading = readers.reading(HTC, Mount(hub_radius=2.0))
    assert {p.name for p in reading.source.files} == {ST.name, HTC.name}
    blade = reading.blade
    assert blade.hub_radius == 2.0
    np.testing.assert_allclose(blade.curve[-1], [19.988, -0.10, -0.50], atol=1e-12)  # z, x, y of HAWC2's
    np.testing.assert_allclose(np.degrees(blade.twist[[0, -1]]), [-12.0, 1.0])
    assert blade.length == pytest.approx(20.0, abs=0.01)
    assert np.abs(blade.stations / blade.length - 0.6).min() < 1e-12
    for x, y, z, turn in ((0.0, 0.0, 5.0, -10.0), (-0.02, -0.05, 10.0, -6.0), (-0.06, -0.20, 15.0, -2.0)):
        k = int(np.abs(blade.curve[:, 0] - z).argmin())  # every section of c2_def is a station
        np.testing.assert_allclose(blade.curve[k], [z, x, y], atol=1e-9)
        assert np.degrees(blade.twist[k]) == pytest.approx(turn, abs=1e-7)
    np.testing.assert_allclose(blade.mass, np.repeat(blade.mass[:1], 6, axis=0), rtol=1e-12, atol=1e-12)
    (note,) = (n for n in reading.source.notes if n.startswith("stations: "))
    assert note.startswith(
        "stations: 3 of the structural file and 3 more of c2_def; between them curve and twist stray"
    )
    assert_same(blade, readers.read(ST, Mount(main=HTC, hub_radius=2.0)))


def test_hawc2_structural_pitch_turns_bending_about_the_elastic_centre(tmp_path: Path) -> None:
    path = copied(tmp_path, ST, "1.000000e-01\t0.000000e+00\t3.0", "1.000000e-01\t9.000000e+01\t3.0", -1)
    blade, before = readers.read(path, OFF), readers.read(ST, OFF)
    rotated, plain = sections(blade), sections(before)
    np.testing.assert_allclose(rotated.tension_centre, plain.tension_centre, atol=1e-12)
    np.testing.assert_allclose(rotated.EI_flap, plain.EI_edge)
    np.testing.assert_allclose(rotated.EI_edge, plain.EI_flap)


def test_iea_15_in_hawc2_and_in_beamdyn_is_one_blade() -> None:
    """Two files from one section analysis, other reference lines and orientations: what does not depend on those agrees.

    To 1 % but for the outermost stations, which the files resolve differently; the shear centres of the full matrices are
    those that the file of 19 columns prints.
    """
    full = readers.read(real("iea15/IEA_15MW_RWT_Blade_st_FPM.st"))
    plain_file = real("iea15/IEA_15MW_RWT_Blade_st_noFPM.st")
    plain = readers.read(plain_file, Mount(subset=(1, 1)))
    beamdyn = readers.read(real("iea15/IEA-15-240-RWT_BeamDyn_blade.dat"), Mount(length=full.length))
    np.testing.assert_allclose(full.stations, beamdyn.stations, rtol=1e-9)
    inner = slice(0, -3)
    a, b, c = sections(full), sections(beamdyn), sections(plain)
    np.testing.assert_allclose(full.mass[inner, 0, 0], beamdyn.mass[inner, 0, 0], rtol=2e-3)
    for name in ("GJ", "EI_flap", "EI_edge", "EA"):
        np.testing.assert_allclose(getattr(a, name)[inner], getattr(b, name)[inner], rtol=1e-2, err_msg=name)
        if name != "EA":  # of which the file of 19 columns has up to 5 % less or more
            np.testing.assert_allclose(getattr(a, name)[inner], getattr(c, name)[inner], rtol=2e-2, err_msg=name)
    # the triangle of mass, tension and shear centre: its sides, and which way round it goes
    for first, second in (("mass", "tension"), ("tension", "shear"), ("shear", "mass")):
        sides = [
            np.linalg.norm(getattr(k, f"{first}_centre") - getattr(k, f"{second}_centre"), axis=1)[inner]
            for k in (a, b)
        ]
        np.testing.assert_allclose(sides[0], sides[1], atol=0.01)  # of up to 1 m
    legs = [(k.tension_centre - k.mass_centre, k.shear_centre - k.mass_centre) for k in (a, b)]
    areas = [(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])[inner] for first, second in legs]
    assert np.abs(areas[0]).max() > 0.01
    np.testing.assert_allclose(areas[0], areas[1], atol=5e-3)
    rows = [line.split() for line in plain_file.read_text().splitlines() if len(line.split()) == 19]
    printed = np.array([row[6:8] for row in rows if row[0][0].isdigit()][:26], float)
    np.testing.assert_allclose(a.shear_centre, printed, atol=2e-3)


def test_nrel_5mw_has_the_same_mass_in_hawc2_and_elastodyn() -> None:
    st, ed = real("nrel5mw/NREL_5MW_st.txt"), real("nrel5mw/NRELOffshrBsline5MW_Blade.dat")
    with pytest.raises(CaseError, match=r"subsets 1:1, 1:2, .*5:2: choose one with --subset"):
        readers.read(st)
    actual = readers.read(st, Mount(subset=(5, 1)))
    expected = elastodyn.read(ed, Mount(length=61.5)).blade
    weights = [trapezoid(b.mass[:, 0, 0], b.stations) for b in (actual, expected)]
    assert weights[0] == pytest.approx(weights[1], rel=0.01)


def test_every_number_of_a_bmodes_file_is_in_its_field() -> None:
    reading = readers.reading(BMI)
    blade = reading.blade
    assert (blade.hub_radius, blade.length) == (2.0, 20.0)
    np.testing.assert_allclose(np.degrees([blade.precone, blade.pitch]), [3.0, 4.0])
    np.testing.assert_allclose(np.degrees(blade.twist), [-10.0, -5.0, 0.0], atol=1e-14)
    np.testing.assert_array_equal(blade.root, [np.inf] * 4 + [0, 0])
    k, m = blade.stiffness[0], blade.mass[0]
    assert np.isinf(k[1, 1])
    assert np.isinf(k[2, 2])
    centres = sections(blade)
    np.testing.assert_allclose(
        centres.mass_centre, [[-0.3, 0], [-0.2, 0], [-0.1, 0]], atol=1e-14
    )  # to the trailing edge
    np.testing.assert_allclose(centres.tension_centre, [[-0.1, 0], [-0.05, 0], [0, 0]], atol=1e-14)
    assert (m[0, 0], m[4, 4]) == pytest.approx((200.0, 1.0))  # sec_mass_mult 2
    assert m[5, 5] == pytest.approx(4.0 + 200 * 0.3**2)
    assert k[4, 4] == pytest.approx(4e8)
    assert k[5, 5] == pytest.approx(1.5 * 8e8 + 2e9 * 0.1**2)  # edge_stff_mult 1.5
    # sections' inertia stands 3 degrees further upwind than the elastic axes at midspan
    np.testing.assert_allclose(np.degrees(centres.mass_axes)[:2], [0.0, -3.0], atol=1e-12)
    np.testing.assert_allclose(np.diag(blade.tip_mass), [5, 5, 5, 4, 3, 2])  # along, to the leading edge, downwind
    assert blade.tip_mass[3:, :3][2, 0] == pytest.approx(-5 * -0.1)  # the first moments of (0.2, −0.1, 0)
    assert blade.tip_mass[3:, :3][1, 2] == pytest.approx(-5 * 0.2)
    assert any("sec_mass_mult = 2, edge_stff_mult = 1.5" in note for note in reading.source.notes)
    assert any("BModes 3 itself takes them about the mass centre" in note for note in reading.source.notes)


def test_bmodes_products_of_inertia_of_the_tip(tmp_path: Path) -> None:
    """∫ x y dm in axes downwind, to the trailing edge and along the blade; ours are along, to the leading edge, downwind."""
    shutil.copy(SECTIONS, tmp_path)
    text = BMI.read_text()
    for name, product in (("ixy_tip", 0.1), ("izx_tip", 0.2), ("iyz_tip", 0.3)):
        text = text.replace(f"0.        {name}", f"{product}       {name}")
    (tmp_path / "tip.bmi").write_text(text)
    tip = readers.read(tmp_path / "tip.bmi").tip_mass
    assert (tip[4, 5], tip[3, 5], tip[3, 4]) == pytest.approx((0.1, -0.2, 0.3))
    np.testing.assert_array_equal(tip, tip.T)


def test_bmodes_centres_are_measured_from_the_shear_centres(tmp_path: Path) -> None:
    shutil.copy(BMI, tmp_path)
    (tmp_path / SECTIONS.name).write_text(
        re.sub(r"\t0\.0\t(\S+)$", r"\t0.04\t\1", SECTIONS.read_text(), flags=re.MULTILINE)
    )
    centres = sections(readers.read(tmp_path / BMI.name))
    np.testing.assert_allclose(centres.mass_centre[:, 0], [-0.26, -0.16, -0.06], atol=1e-14)
    np.testing.assert_allclose(centres.tension_centre[:, 0], [-0.06, -0.01, 0.04], atol=1e-14)


def test_bmodes_decks_are_read_as_pybmodes_reads_them() -> None:
    pybmodes = pytest.importorskip("pybmodes")
    from pybmodes.io.sec_props import read_sec_props

    decks = sorted((Path(pybmodes.__file__).parent / "_examples" / "sample_inputs").glob("**/*blade.bmi"))
    assert len(decks) >= 10
    for deck in decks:
        reading = readers.reading(deck)
        expected = read_sec_props(reading.source.files[1])
        np.testing.assert_allclose(reading.blade.mass[:, 0, 0], expected.mass_den, rtol=1e-14)
        np.testing.assert_allclose(np.degrees(reading.blade.twist), -expected.str_tw, atol=1e-12)
        np.testing.assert_allclose(sections(reading.blade).GJ, expected.tor_stff, rtol=1e-12)


@pytest.mark.parametrize(
    ("root", "free"),
    [('"clamped"', []), ('"flap hinge"', [4]), ('"lag hinge"', [5]), ('"both hinges"', [4, 5]), ("{ lag = 0.0 }", [5])],
)
def test_root_joints_by_name(tmp_path: Path, root: str, free: list[int]) -> None:
    (tmp_path / "b.toml").write_text(BEAM + f"root = {root}\n")
    expected = np.full(6, np.inf)
    expected[free] = 0.0
    np.testing.assert_array_equal(readers.read(tmp_path / "b.toml").root, expected)


def test_root_springs_and_a_tip_body(tmp_path: Path) -> None:
    """A box at the tip: moments about the tip by Steiner."""
    tip = "tip_mass = { mass = 3.0, offset = [0.1, 0.2, -0.3], inertia = [1.0, 2.0, 3.0, 0.0, 0.0, 0.0] }\n"
    (tmp_path / "b.toml").write_text(BEAM + "root = { flap = 1e5, torsion = 2e4 }\nprecone_deg = 2.0\n" + tip)
    blade = readers.read(tmp_path / "b.toml", Mount(pitch=0.1))
    np.testing.assert_array_equal(blade.root, [np.inf, np.inf, np.inf, 2e4, 1e5, np.inf])
    assert (blade.precone, blade.pitch) == (np.radians(2.0), 0.1)
    x, y, z = 0.1, 0.2, -0.3
    steiner = 3.0 * np.array(
        [[y * y + z * z, -x * y, -x * z], [-x * y, x * x + z * z, -y * z], [-x * z, -y * z, x * x + y * y]]
    )
    np.testing.assert_allclose(blade.tip_mass[3:, 3:], np.diag([1.0, 2, 3]) + steiner, atol=1e-15)
    velocity, turning = np.array([1.0, -2, 3]), np.array([0.5, 0.7, -0.2])
    momentum = blade.tip_mass @ np.concatenate([velocity, turning])
    np.testing.assert_allclose(momentum[:3], 3.0 * (velocity + np.cross(turning, [x, y, z])), rtol=1e-14)


def test_a_file_of_another_format_in_a_toml(tmp_path: Path) -> None:
    (tmp_path / "ed.dat").write_text((DATA / "elastodyn_blade.dat").read_text())
    text = (
        'name = "here"\n[blade]\nkind = "file"\nfile = "ed.dat"\nlength = 50.0\nhub_radius = 2.0\nroot = "flap hinge"\n'
    )
    (tmp_path / "b.toml").write_text(text)
    blade = readers.read(tmp_path / "b.toml")
    plain = readers.read(tmp_path / "ed.dat", Mount(length=50.0, hub_radius=2.0))
    assert (blade.name, blade.root[4]) == ("here", 0.0)
    np.testing.assert_array_equal(blade.mass, plain.mass)


def test_csv_stations(tmp_path: Path) -> None:
    path = Path(readers.__file__).parents[2] / "data" / "windpact-3.0.csv"
    blade = readers.read(path, Mount(length=47.025, hub_radius=2.475))
    assert blade.mass[0, 0, 0] == 2514.272879
    with pytest.raises(CaseError, match="give --length"):
        readers.read(path)


BAD = {
    "st count": (ST, "$1 3", "$1 4", ON, r"hawc2_st.dat: line 9: the table ends after 3 of 4 rows"),
    "st column": (ST, "\t3.000000e-03", "", ON, r"line 6: 18 numbers instead of 19"),
    "st NaN": (ST, "1.000000e+10", "nan", ON, r"line 6: E: nan: not a finite number"),
    "st negative": (ST, "1.000000e+10", "-1e10", ON, r"line 6: E: -1e\+10: it must be positive"),
    "st duplicate": (ST, "1.200000e+01", "0.0", ON, r"line 7: r: 0: not beyond the previous station"),
    "st root": (ST, "0.000000e+00\t1.0", "1.0\t1.0", ON, r"line 6: r: 1: the first station is the root"),
    "st subset": (ST, "$1 3", "$7 3", ON, r"no set 1, subset 1: it has 1:7, 1:2: correct --subset"),
    "st twice": (ST, "$2 3", "$1 3", ON, r"line 9: set 1, subset 1: there already is one: renumber or remove it"),
    "st factor": (ST, "5.000000e-01\t5.000000e-01", "0\t0.5", ON, r"line 6: k_x: 0: it must be positive"),
    "htc twice": (
        HTC,
        "name shaft ;",
        "name blade1 ;",
        Mount(),
        r"line 16: main_body: there already is one whose name is",
    ),
    "htc order": (HTC, "sec 3 ", "sec 4 ", Mount(), r"hawc2.htc: line 26: sec: number 4, but it is section 3"),
    "htc sec": (HTC, "-0.05   10.0", "ten", Mount(), r"hawc2.htc: line 26: sec: not x, y, z and twist"),
    "htc file": (
        HTC,
        "./hawc2_st.dat",
        "./other.dat",
        Mount(),
        r"hawc2.htc: line 19: filename: ./other.dat: not found",
    ),
    "htc set NaN": (HTC, "set 1 2 ;", "set 1 nan ;", Mount(), r"hawc2.htc: line 20: set: 1 nan: not set and subset"),
    "htc set infinite": (
        HTC,
        "set 1 2 ;",
        "set inf 2 ;",
        Mount(),
        r"hawc2.htc: line 20: set: inf 2: not set and subset",
    ),
    "htc short": (HTC, "19.988", "16.0", Mount(), r"c2_def is 16\.\d+ m long, the stations end at 20 m"),
    "htc body": (HTC, "blade1 ;", "wing1 ;", Mount(), r"no main_body whose name begins with blade"),
    "bmi tower": (
        BMI,
        "1         beam_type",
        "2         beam_type",
        Mount(),
        r"bmodes.bmi: line 6: beam_type: not 1: this is the file of a tower",
    ),
    "bmi hub": (BMI, "4         hub_conn", "2         hub_conn", Mount(), r"line 13: hub_conn: 2: a blade needs a hub"),
    "bmi radius": (
        BMI,
        "22.0      radius:",
        "big      radius:",
        Mount(),
        r"line 9: radius: 'big' is not a finite number",
    ),
    "bmi no length": (
        BMI,
        "22.0      radius:",
        "2.0      radius:",
        Mount(),
        r"line 9: radius: 2 m is not beyond hub_rad, 2 m",
    ),
    "sec count": (SECTIONS, "3         n_secs", "4         n_secs", Mount(), None),
}


@pytest.mark.parametrize("kind", BAD)
def test_invalid_files_are_refused_with_line_and_value(tmp_path: Path, kind: str) -> None:
    file, old, new, mount, message = BAD[kind]
    path = copied(tmp_path, file, old, new)
    with pytest.raises(
        CaseError, match=message or r"bmodes_sections.dat: line 8: the table ends after 3 of 4"
    ) as caught:
        readers.read(tmp_path / BMI.name if file == SECTIONS else path, mount)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("length = 6.0", "length = -6.0", r"blade.length: -6.0: .*check sign, unit and type"),
        ("length = 6.0", "lenght = 6.0", r"blade.lenght: unknown key: did you mean length\?"),
        ("E = 7e10", "E = nan", r"blade.E: nan: not a finite number"),
        ("J = 4e-7", 'J = 4e-7\nroot = "loose"', r"blade.root: 'loose'"),
        ("[blade]", "[blade", "not TOML"),
    ],
)
def test_invalid_toml_is_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    (tmp_path / "b.toml").write_text(BEAM.replace(old, new))
    with pytest.raises(CaseError, match=message):
        readers.read(tmp_path / "b.toml")


def test_invalid_sections_are_refused(tmp_path: Path) -> None:
    southwell_toml.write(readers.read(HTC), tmp_path / "b.toml")
    text = (tmp_path / "b.toml").read_text()
    for old, new, message in (
        ("twist_deg = [", "twist_deg = [1.0, ", r"b.toml: blade.twist_deg: 7 entries for 6 stations"),
        ("s = [0.0, ", "s = [0.0, 0.0, ", r"b.toml: blade.stiffness: 6 entries for 7 stations"),
        ("rigid = []", 'rigid = ["axial"]', r"b.toml: blade.rigid: axial: its stiffnesses are not zero"),
    ):
        assert old in text
        (tmp_path / "b.toml").write_text(text.replace(old, new, 1))
        with pytest.raises(CaseError, match=message):
            readers.read(tmp_path / "b.toml")


def test_modules_read_what_the_package_reads() -> None:
    assert_same(hawc2.read(HTC).blade, readers.read(HTC))
    assert_same(bmodes.read(BMI).blade, readers.read(BMI))


def test_bmodes_tip_moments_of_no_body_are_reported_in_the_main_file(tmp_path: Path) -> None:
    """Moments of 2, 3 and 40 kg m² violate the triangle inequality: no body has them."""
    shutil.copy(SECTIONS, tmp_path)
    (tmp_path / "tip.bmi").write_text(BMI.read_text().replace("4.        izz_tip", "40.       izz_tip"))
    with pytest.raises(
        CaseError, match=r"tip.bmi: line 21: .*izz_tip: .*none can be larger than the sum .*moments of 0 leave out"
    ):
        readers.read(tmp_path / "tip.bmi")


def test_bmodes_rotor_speed_by_its_older_name(tmp_path: Path) -> None:
    shutil.copy(SECTIONS, tmp_path)
    (tmp_path / "old.bmi").write_text(
        BMI.read_text().replace("rot_rpm:", "romg:   ").replace("1.0       rpm_mult:", "1.5       romg_mult:")
    )
    assert readers.reading(tmp_path / "old.bmi").speed == pytest.approx(15.0 * np.pi / 30)


def test_bmodes_own_mesh_is_noted(tmp_path: Path) -> None:
    shutil.copy(SECTIONS, tmp_path)
    (tmp_path / "mesh.bmi").write_text(BMI.read_text() + "4   nselt   number of elements\n")
    assert any("BModes' own mesh (nselt = 4)" in note for note in readers.reading(tmp_path / "mesh.bmi").source.notes)


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        (
            "\nLinearized model: Predictions were generated by OpenFAST\n",
            r"a linearisation that OpenFAST has written, .*give the .fst file",
        ),
        (
            "BModes v3.00\n -------- Mode No.   1  (freq =   0.3 Hz)\n",
            r"frequencies that BModes has printed, .*give the .bmi file",
        ),
        ("------- SERVODYN v1.05.* INPUT FILE ----\nx\n", r"an input file of OpenFAST's SERVODYN, .*or the .fst"),
    ],
)
def test_other_kinds_of_files_are_named_in_the_refusal(tmp_path: Path, text: str, kind: str) -> None:
    (tmp_path / "file.dat").write_text(text)
    with pytest.raises(CaseError, match=rf"file.dat: {kind}"):
        readers.read(tmp_path / "file.dat")
