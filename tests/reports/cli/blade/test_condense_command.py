"""``southwell condense``: a user's own matrices give what the package's give; wrong input is one line."""

from pathlib import Path

import numpy as np
import pytest
import scipy.io
import scipy.sparse as ss

from southwell.cases.condense import condensed, condensing
from southwell.cases.input.errors import CaseError
from southwell.cases.judge.results import Run
from southwell.core.condense.compressed import mesh_from_segments
from southwell.core.solve import chain_modes
from southwell.references.solid import calculix, hexahedra
from southwell.references.solid.mesh import Bricks, clamped_section, straight_bricks
from southwell.reports.cli import app as cli
from southwell.reports.condense import page as condense_page
from southwell.reports.shared.certain import certain, relative
from southwell.reports.verification import report as matrix_report
from southwell.tests.support import solid_blades
from southwell.tests.support.solid_blades import ROOT, SPAN, SPEED, STEEL, at

pytestmark = pytest.mark.skipif(hexahedra.version() is None, reason=f"not installed: {hexahedra.HINT}")

Array = np.ndarray

LAYERS, ACROSS, SEGMENTS = 20, (2, 1), 5


def bricks() -> Bricks:
    return solid_blades.twisted(LAYERS, ACROSS)


def exported(folder: Path, bricks: Bricks, stem: str = "blade", unit: float = 1.0) -> None:
    """Matrices in Matrix Market node by node, and the nodes; ``unit`` is that of length, m (and t for kg at 1e-3)."""
    s = hexahedra.solid(bricks, STEEL)
    n = len(s.nodes)
    by_node = np.arange(3 * n).reshape(3, n).T.ravel()
    M = ss.csr_array(ss.kron(ss.eye_array(3), hexahedra.mass(s), format="csr"))
    for name, matrix in (("k", hexahedra.tangent(s)), ("m", M)):
        own = unit * ss.csr_array(matrix)[by_node][:, by_node]
        scipy.io.mmwrite(folder / f"{stem}-{name}.mtx", ss.coo_array(own), precision=17)
    rows = [f"{k},{x!r},{y!r},{z!r}" for k, (x, y, z) in enumerate((s.nodes / unit).tolist(), 7)]
    (folder / f"{stem}-nodes.csv").write_text("id,x,y,z\n" + "\n".join(rows) + "\n")


def toml(folder: Path, text: str) -> Path:
    path = folder / "blade.toml"
    path.write_text(text)
    return path


STATIONS = [round(ROOT + SPAN * k / SEGMENTS, 6) for k in range(SEGMENTS + 1)]
WHOLE = f"""
name = "twisted"
stiffness = "blade-k.mtx"
mass = "blade-m.mtx"
nodes = "blade-nodes.csv"
freedoms = [1, 2, 3]
sections = {STATIONS}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("exported")
    exported(out, bricks())
    return out


@pytest.fixture(scope="module")
def whole(folder: Path) -> condensed.Condensed:
    return condensing.condense(toml(folder, WHOLE)).blade


def in_house() -> list:
    model = solid_blades.finite_elements(bricks(), STEEL)
    return solid_blades.segments_in_place(model, bricks(), SEGMENTS)


def assert_same(
    condensed_segments: list,
    expected: list,
    within: float = 1e-8,
    fields: str = "undeformed stiffness inertia body_twist",
) -> None:
    for a, b in zip(condensed_segments, expected, strict=True):
        for field in fields.split():
            x, y = getattr(a, field), getattr(b, field)
            np.testing.assert_allclose(x, y, rtol=within, atol=within * np.abs(y).max(), err_msg=field)


@pytest.mark.slow
def test_a_written_out_model_condenses_to_the_same_segments(whole: condensed.Condensed) -> None:
    """The share that each side of a section has in its nodes' mass comes from the mass matrix alone: 5e-4 with this taper."""
    expected = in_house()
    assert_same(whole.segments, expected, 1e-7, "undeformed stiffness")
    assert_same(whole.segments, expected, 1e-3, "inertia")
    expected = chain_modes(mesh_from_segments(expected, at(ROOT)), SPEED, 5).frequencies
    np.testing.assert_allclose(condensed.modes(whole, SPEED, 5).frequencies, expected, rtol=2e-5)


def test_a_sections_mass_is_shared_by_what_lies_on_either_side(tmp_path: Path) -> None:
    """A prism cut between layers of 0.1 and 0.3 m: each segment has its own length's mass, and its centre in its middle."""
    ends = [0.0, 0.1, 0.4]
    exported(tmp_path, bricks=straight_bricks(np.array(ends), 0.2, 0.1, across=(1, 1)))
    model = condensing.condense(toml(tmp_path, WHOLE.replace(str(STATIONS), str(ends)))).blade
    masses, centres, _ = zip(*(condensed.body(s) for s in model.segments), strict=True)
    np.testing.assert_allclose(masses, STEEL.density * 0.02 * np.diff(ends), rtol=1e-10)
    np.testing.assert_allclose([c[0] for c in centres], np.diff(ends) / 2, rtol=1e-10)


def turned_folder(folder: Path) -> None:
    """The same in mm and t, with the span along z and the rotor's axis along x, and freedoms in a table of their own."""
    exported(folder, bricks(), unit=1e-3)
    rows = [line.split(",") for line in (folder / "blade-nodes.csv").read_text().splitlines()[1:]]
    (folder / "blade-nodes.csv").write_text("id,x,y,z\n" + "".join(f"{k},{z},{x},{y}\n" for k, x, y, z in rows))
    (folder / "freedoms.csv").write_text("node,freedom\n" + "".join(f"{k},{f}\n" for k, *_ in rows for f in (2, 3, 1)))


@pytest.mark.slow
def test_units_and_axes_make_no_difference(whole: condensed.Condensed, tmp_path: Path) -> None:
    """x, y, z of the blade are y, z, x here; the hub's radius is given instead of being where the model lies."""
    turned_folder(tmp_path)
    text = WHOLE.replace("[1, 2, 3]", '"freedoms.csv"').replace(str(STATIONS), str([1e3 * x for x in STATIONS]))
    text += f'units = "mm t s"\nspan = "y"\nrotor = "x"\nhub_radius = {ROOT}\n'
    model = condensing.condense(toml(tmp_path, text)).blade
    assert_same(model.segments, whole.segments, 1e-7)
    np.testing.assert_allclose(model.root, whole.root, atol=1e-12)


@pytest.mark.slow
def test_a_model_a_segment_is_each_condensed_alone(tmp_path: Path) -> None:
    text = f'name = "apart"\nfreedoms = [1, 2, 3]\nsections = {STATIONS}\nroot = "average"\n'
    for k in range(SEGMENTS):
        exported(tmp_path, bricks().part(k * LAYERS // SEGMENTS, (k + 1) * LAYERS // SEGMENTS), f"part{k}")
        text += f'[[segments]]\nstiffness = "part{k}-k.mtx"\nmass = "part{k}-m.mtx"\nnodes = "part{k}-nodes.csv"\n'
    model = condensing.condense(toml(tmp_path, text)).blade
    assert_same(model.segments, solid_blades.segments_apart("average", bricks(), SEGMENTS))


def test_a_superelement_of_two_nodes_with_its_body(tmp_path: Path) -> None:
    """12×12 of Przemieniecki's beam by nodes of six freedoms, as a code gives a reduced segment; the body given beside it."""
    length, EI, EA, GJ = 0.5, 2e4, 3e7, 1e4
    K = np.zeros((12, 12))
    for y, spin, sign in ((1, 5, 1.0), (2, 4, -1.0)):
        i = np.array([y, spin, y + 6, spin + 6])
        b = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]) * EI / length**3
        unit = np.array([1, sign * length, 1, sign * length])
        K[np.ix_(i, i)] = b * np.outer(unit, unit)
    for i, k in ((0, EA), (3, GJ)):
        K[np.ix_([i, i + 6], [i, i + 6])] = k / length * np.array([[1, -1], [-1, 1]])
    scipy.io.mmwrite(tmp_path / "beam.mtx", ss.coo_array(K), precision=17)
    (tmp_path / "beam.csv").write_text(f"id,x,y,z\n1,0.2,0,0\n2,{0.2 + length},0,0\n")
    text = f"""
    name = "superelement"
    sections = [0.2, {0.2 + length}]
    tie = "rigid"
    [[segments]]
    stiffness = "beam.mtx"
    nodes = "beam.csv"
    freedoms = [1, 2, 3, 4, 5, 6]
    body = {{mass = 2.0, centre = [0.45, 0.0, 0.01], moments = [0.02, 0.05, 0.05]}}
    """
    model = condensing.condense(toml(tmp_path, text)).blade
    (segment,) = model.segments
    f = np.linalg.inv(segment.stiffness)
    np.testing.assert_allclose(np.diagonal(f)[[0, 3, 4, 5]], length / np.array([EA, GJ, EI, EI]), rtol=1e-9)
    mass, centre, moments = condensed.body(segment)
    assert mass == pytest.approx(2.0)
    np.testing.assert_allclose(centre, [0.25, 0, 0.01], atol=1e-14)
    np.testing.assert_allclose(moments, np.diag([0.02, 0.05, 0.05]), atol=1e-14)


@pytest.mark.slow
def test_what_is_kept_is_the_model(whole: condensed.Condensed, tmp_path: Path) -> None:
    condensed.write(tmp_path / "segments.json", whole)
    kept = condensed.read(tmp_path / "segments.json")
    assert_same(kept.segments, whole.segments, 0.0)
    np.testing.assert_array_equal(kept.root, whole.root)
    (tmp_path / "segments.json").write_text(
        (tmp_path / "segments.json").read_text().replace('"undeformed"', '"deformed"', 1)
    )
    with pytest.raises(CaseError, match=r"segments.json: .*unknown field .deformed.*condense again"):
        condensed.read(tmp_path / "segments.json")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("stiffness =", "stifness =", "stifness: unknown key: did you mean stiffness"),
        ('"blade-k.mtx"', '"blade.mtx"', "blade.mtx: no such file"),
        ('stiffness = "blade-k.mtx"', "", "stiffness: missing: name the file of a stiffness"),
        ('mass = "blade-m.mtx"', "", "mass: missing: name the file of a mass matrix"),
        ('nodes = "blade-nodes.csv"', "", "nodes: missing: name a CSV of id, x, y, z"),
        ("freedoms = [1, 2, 3]", "", "freedoms: missing: blade-k.mtx does not name its freedoms"),
        ("[1, 2, 3]", "[1, 2]", r"615 nodes with 2 each are 1230, blade-k.mtx has 1845 rows"),
        ("[1, 2, 3]", "[2, 1, 3]", "resists the rotation about . of the whole as a rigid body .*order, units"),
        ("[1, 2, 3]", "[1, 2, 7]", r"freedoms\[2\]: 7: expected int <= 6"),
        ("[0.3, 0.5,", "[0.3, 0.507,", r"section '0.507 m': no nodes .* nearest are"),
        ("[0.3, 0.5,", "[0.5,", r"sections\[0\]: \d+ freedoms .* lie up to 0.2 m beyond it"),
        ("1.1, 1.3]", "1.1]", r"sections\[4\]: 360 freedoms .* lie up to 0.2 m beyond it"),
        ("[0.3, 0.5, 0.7", "[0.3, 0.7, 0.5", r"sections\[2\]: 0.5 m is not beyond 0.7 m"),
        ("sections =", 'tie = "rigid"\nsections =', "section '0.5 m': a rigid tie prevents warping"),
        ("sections =", 'rotor = "x"\nsections =', "rotor: parallel to the span: give another direction"),
        ("sections =", "span = [0, 0, 0]\nsections =", r"span: \[0.0, 0.0, 0.0\]: not a direction"),
        ("sections =", 'tie = "glued"\nsections =', "tie: 'glued': not one of its values: give one of average, rigid"),
    ],
)
def test_wrong_files_are_one_line(folder: Path, old: str, new: str, message: str) -> None:
    path = folder / "wrong.toml"
    assert old in WHOLE
    path.write_text(WHOLE.replace(old, new))
    with pytest.raises(CaseError, match=message) as caught:
        condensing.condense(path)
    assert str(caught.value).startswith(str(folder))
    assert "\n" not in str(caught.value)


# Another code's files


@pytest.mark.slow
@pytest.mark.skipif(calculix.version() is None, reason=f"not installed: {calculix.HINT}")
def test_matrices_that_calculix_stored(tmp_path: Path) -> None:
    """Its .sti, .mas and .dof as they are, condensed in place, against its own modes of the whole, without Coriolis forces.

    Corners of its 8-node faces have negative lumped mass, which the default refuses.
    """
    mesh = solid_blades.twisted(LAYERS, (2, 2))
    places, nodes = calculix.numbered(mesh)
    steps = ["*STEP", "*FREQUENCY,SOLVER=MATRIXSTORAGE", "1", "*END STEP"]
    with calculix.run([*calculix.deck(places, nodes, STEEL), *steps]) as folder:
        for kind in ("sti", "mas", "dof"):
            (tmp_path / f"blade.{kind}").write_bytes((folder / f"blade.{kind}").read_bytes())
    rows = [f"{k},{x!r},{y!r},{z!r}" for k, (x, y, z) in enumerate(nodes.tolist(), 1)]
    (tmp_path / "nodes.csv").write_text("id,x,y,z\n" + "\n".join(rows))
    text = 'name = "ccx"\nstiffness = "blade.sti"\nmass = "blade.mas"\nnodes = "nodes.csv"\n'
    text += f"sections = {[round(ROOT + SPAN * k / 10, 6) for k in range(11)]}\n"
    with pytest.raises(CaseError, match=r"smallest weight -.* \(lumped mass\)"):
        condensing.condense(toml(tmp_path, text))
    whole = calculix.modes(mesh, STEEL, 0.0, 5, clamped_section(ROOT)).frequencies
    for weights in ("even", "mass matrix"):
        model = condensing.condense(toml(tmp_path, f'{text}weights = "{weights}"\n')).blade
        np.testing.assert_allclose(condensed.modes(model, 0.0, 5).frequencies[:4], whole[:4], rtol=5e-3)


# The command


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as exit_info:
        cli.main(["condense", *arguments])
    out, err = capsys.readouterr()
    return int(exit_info.value.code or 0), out, err


@pytest.mark.slow
def test_a_file_by_the_command(
    folder: Path, whole: condensed.Condensed, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Tables in the page; the same modes again, in other units, from the segments kept."""
    path = toml(folder, WHOLE)
    status, out, _ = run(capsys, str(path), "--omega", "0:100:100", "--modes", "3", "-o", str(tmp_path))
    assert status == 0
    page = (tmp_path / "condensation.md").read_text()
    assert page.strip() in out
    solved = condensed.modes(whole, 100.0, 3)
    expected = list(zip(solved.frequencies, solved.uncertainty, strict=True))
    rows = [[c.strip() for c in line.split("|")[1:-1]] for line in page.splitlines() if line.startswith("|")]
    assert [row[3:5] for row in rows if row[0] == "100"] == [[certain(f, u), relative(u)] for f, u in expected]
    assert sum(float(row[2]) for row in rows if len(row) == 11 and row[0].isdigit()) == pytest.approx(11.1353, rel=1e-4)
    status, out, _ = run(capsys, str(tmp_path / "segments.json"), "--rpm", "954.9296585", "-o", str(tmp_path / "again"))
    assert status == 0
    second = [line.split("|")[4].strip() for line in out.splitlines() if line.startswith("| 954.93")]
    assert second[:2] == [certain(f / (2 * np.pi), u) for f, u in expected[:2]]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), "file: missing: give a TOML file"),
        (("nowhere.toml",), "nowhere.toml: no such file"),
        (("nowhere.json",), "nowhere.json: no such file"),
        (("x.toml", "--rpm", "fast"), "--rpm: 'fast' is neither a speed"),
    ],
)
def test_wrong_arguments(arguments: tuple[str, ...], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = run(capsys, *arguments)
    assert (status, out) == (2, "")
    assert err.startswith(f"southwell: {message}")
    assert err.count("\n") == 1


def test_the_report_takes_the_page_up(tmp_path: Path) -> None:
    assert condense_page.include_page(tmp_path) == ""
    (tmp_path / "condensation.md").write_text("# Title\n\n## Part\n\ntext # no heading\n")
    text = condense_page.include_page(tmp_path)
    assert text == "## Title\n\n### Part\n\ntext # no heading\n"
    assert text in matrix_report.render(Run(()), {}, text)
