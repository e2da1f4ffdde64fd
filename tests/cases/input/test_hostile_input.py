"""Files that are to do harm: one line each, in bounded time; a file that a file names is read from its folder only."""

import os
from pathlib import Path

import numpy as np
import pytest
import scipy.io
import scipy.sparse as ss

import southwell
from southwell.cases.condense import condensed, condensing
from southwell.cases.input import files, mechanisms, readers, schema, toml
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers.text import MAX_LINES
from southwell.cases.plan import user_results
from southwell.cases.regression import history
from southwell.cases.store import results_file
from southwell.core.condense import matrix_files
from southwell.core.condense.exported import MatrixFileError
from southwell.core.regular_files import FileRefusedError, read_bytes
from southwell.reports.cli import app
from southwell.tests.support import fuzz


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "it").mkdir()
    fuzz.seeds(tmp_path / "it")
    return tmp_path / "it"


def changed(path: Path, old: str, new: str) -> Path:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("name", "why"),
    [("/dev/zero", "a device, not a file"), ("pipe", "a pipe, not a file"), ("folder", "a folder, not a file")],
)
def test_only_regular_files_are_opened(folder: Path, name: str, why: str) -> None:
    with pytest.raises(FileRefusedError, match=why):
        read_bytes(folder / name)
    changed(folder / "elastodyn_main.dat", "elastodyn_blade.dat", name)
    with files.outside_allowed(), pytest.raises(CaseError, match=why):
        readers.read(folder / "elastodyn_main.dat")


def test_decks_of_too_many_lines_are_refused(tmp_path: Path) -> None:
    (tmp_path / "long.dat").write_text("1\n" * (MAX_LINES + 1))
    with pytest.raises(CaseError, match=r"long.dat: more than 250000 lines: check that it is the right file"):
        readers.read(tmp_path / "long.dat")


def test_files_larger_than_stated_are_not_read(tmp_path: Path) -> None:
    with (tmp_path / "large.dat").open("wb") as file:
        file.truncate(1 << 30)  # takes no room on the disk
    with pytest.raises(CaseError, match=r"larger than 16 MB"):
        readers.read(tmp_path / "large.dat")
    with pytest.raises(OSError, match=r"larger than 256 MB"):
        results_file.read(tmp_path / "large.dat")


@pytest.mark.parametrize(
    ("first", "old"),
    [
        ("elastodyn_main.dat", "elastodyn_blade.dat"),
        ("beamdyn_main.dat", "beamdyn_blade.dat"),
        ("bmodes.bmi", "bmodes_sections.dat"),
        ("case.toml", "stations.csv"),
    ],
)
def test_a_file_names_files_of_its_folder_only(folder: Path, first: str, old: str) -> None:
    (folder / old).rename(folder.parent / old)
    changed(folder / first, old, f"../{old}")
    read = schema.read if first == "case.toml" else readers.read
    with pytest.raises(CaseError, match=r"outside .* give --allow-outside"):
        read(folder / first)
    with files.outside_allowed():
        read(folder / first)
    (folder / old).symlink_to(folder.parent / old)  # nor by a link
    changed(folder / first, f"../{old}", old)
    with pytest.raises(CaseError, match=r"outside .* give --allow-outside"):
        read(folder / first)


def deck(folder: Path, blade: str) -> Path:
    """OpenFAST's layout: a model's folder, and its blade in a folder beside it."""
    for name in ("model", "5MW_Baseline", ".hidden"):
        (folder / name).mkdir(parents=True)
    main = fuzz.seeds(folder / "model")["elastodyn"]
    for place in ("5MW_Baseline", ".hidden", "."):
        (folder / place / "blade.dat").write_bytes((folder / "model" / "elastodyn_blade.dat").read_bytes())
    return changed(main, "elastodyn_blade.dat", blade)


def test_a_deck_names_files_in_the_folders_beside_its_own(tmp_path: Path) -> None:
    main = deck(tmp_path, "../5MW_Baseline/blade.dat")
    primary = tmp_path / "model" / "Main.fst"
    primary.write_text('1 CompElast - switch\n"elastodyn_main.dat" EDFile - name\n')
    shared = readers.read(tmp_path / "5MW_Baseline" / "blade.dat", readers.Mount(main=main))
    for path in (main, primary):
        np.testing.assert_array_equal(readers.read(path).mass, shared.mass)


@pytest.mark.parametrize("blade", ["../blade.dat", "../.hidden/blade.dat", "../../other/blade.dat", "link/blade.dat"])
def test_a_deck_names_no_other_files(tmp_path: Path, blade: str) -> None:
    """Not in the folder above, in a hidden folder, two folders above, or where a link leads."""
    main = deck(tmp_path / "tree", blade)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "blade.dat").write_bytes((tmp_path / "tree" / "blade.dat").read_bytes())
    (main.parent / "link").symlink_to(tmp_path / "other")
    with pytest.raises(CaseError, match=r"outside .* give --root FOLDER .* give --allow-outside"):
        readers.read(main)
    with files.root_allowed(tmp_path):
        readers.read(main)


@pytest.mark.parametrize("home", ["tree", "tree/5MW_Baseline"])
def test_the_folders_of_the_users_home_are_not_those_of_a_deck(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, home: str
) -> None:
    main = deck(tmp_path / "tree", "../5MW_Baseline/blade.dat")
    monkeypatch.setenv("HOME", str(tmp_path / home))
    with pytest.raises(CaseError, match=r"outside .* give --root FOLDER"):
        readers.read(main)


def test_a_case_names_no_files_in_the_folders_beside_it(folder: Path) -> None:
    """Only decks have that layout."""
    (folder.parent / "beside").mkdir()
    (folder / "stations.csv").rename(folder.parent / "beside" / "stations.csv")
    changed(folder / "case.toml", "stations.csv", "../beside/stations.csv")
    with pytest.raises(CaseError, match=r"outside .* give --root FOLDER"):
        schema.read(folder / "case.toml")


def test_the_root_of_a_deck_is_a_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main = deck(tmp_path / "a" / "tree", "../../blade.dat")
    (tmp_path / "a" / "blade.dat").write_bytes((tmp_path / "a" / "tree" / "blade.dat").read_bytes())
    for options, status in (
        ([], 2),
        (["--root", str(tmp_path / "a")], 0),
        ([f"--root={tmp_path / 'a'}"], 0),
        (["--root", str(main)], 2),
        (["--root"], 2),
    ):
        with pytest.raises(SystemExit, match=f"^{status}$"):
            app.main(["show", str(main), *options])
        assert capsys.readouterr().err.count("\n") == bool(status)
    by_root, by_permission = southwell.read(main, root=tmp_path / "a"), southwell.read(main, allow_outside=True)
    np.testing.assert_array_equal(by_root.mass, by_permission.mass)
    with pytest.raises(CaseError, match="outside"):
        southwell.read(main)


def test_the_named_file_itself_may_be_a_link(folder: Path) -> None:
    link = folder.parent / "link.toml"
    link.symlink_to(folder / "sections.toml")
    assert readers.read(link).name == "sections"


def test_matrices_and_tables_of_condense_lie_beside_it(folder: Path) -> None:
    for name in ("K.mtx", "nodes.csv"):
        (folder / name).rename(folder.parent / name)
        changed(folder / "bar.toml", f'"{name}"', f'"../{name}"')
        with pytest.raises(CaseError, match=r"outside .* give --allow-outside"):
            condensing.condense(folder / "bar.toml")
    with files.outside_allowed():
        condensing.condense(folder / "bar.toml")


def test_an_htc_file_leads_to_a_bounded_number_of_files(folder: Path) -> None:
    """Nine files that each go on in the next, twelve times."""
    for k in range(9):
        (folder / f"bomb{k}.htc").write_text(f"continue_in_file bomb{k + 1}.htc ;\n" * 12)
    (folder / "bomb9.htc").write_text("begin main_body ;\n")
    (folder / "bomb0.htc").write_text("begin main_body ;\n" + (folder / "bomb0.htc").read_text())
    with pytest.raises(CaseError, match=r"at most 100 files"):
        readers.read(folder / "bomb0.htc")


@pytest.mark.parametrize("deep", [100, 3000, 100_000])
@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.toml", "x = {0}{1}"),
        ("a.toml", "{2}x = 1"),
        ("a.yaml", "x: {0}{1}"),
        ("results.jsonl", '{{"kind": {0}{1}}}\n'),
        ("history.jsonl", "{0}{1}\n"),
        ("segments.json", '{{"name": {0}{1}}}'),
    ],
)
def test_nesting_is_bounded(tmp_path: Path, name: str, text: str, deep: int) -> None:
    path = tmp_path / name
    path.write_text(text.format("[" * deep, "]" * deep, "a." * deep))
    read = {".toml": toml.document, ".yaml": readers.read, ".json": condensed.read}.get(path.suffix)
    read = read or {"results": results_file.read, "history": history.read}[path.stem]
    with pytest.raises((CaseError, ValueError)) as caught:
        read(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_fields_of_a_table_and_numbers_of_any_length(folder: Path) -> None:
    changed(folder / "stations.csv", "0.5,", f'"{"5" * 200_000}",')
    with pytest.raises(CaseError, match=r"line 3: not CSV: field larger than field limit"):
        schema.read(folder / "case.toml")
    for digits, phrase in ((4400, "integer too large"), (4000, "more than 300 digits: implausibly large")):
        (folder / "a.toml").write_text(f"name = {'9' * digits}\n[blade]\n")
        with pytest.raises(CaseError, match=phrase):
            readers.read(folder / "a.toml")


def test_a_rig_with_hundreds_of_decimals(folder: Path) -> None:
    changed(folder / "rig.csv", "0.932", "0." + "9" * 400)
    with pytest.raises(CaseError, match=r"line 2: frequency \[Hz\]"):
        user_results.read("rig", folder / "rig.csv")
    (folder / "rig.csv").write_text("speed [rpm], frequency [Hz], mode\n0, 1e308, flapwise 1\n")
    with pytest.raises(CaseError, match=r"line 2: frequency \[Hz\]"):
        user_results.read("rig", folder / "rig.csv")


@pytest.mark.parametrize(
    ("old", "new", "phrase"),
    [
        ("target = 2e-3", "target = 1e30", "compare.target"),
        ("target = 2e-3", "target = 0.9", "compare.target"),
        ("precone_deg = 2.5", "precone_deg = -2.5e9", "blade.precone_deg"),
        ("pitch_deg = -3.0", "pitch_deg = 1e6", "blade.pitch_deg"),
        ('name = "seed"', 'name = "seed\\n"', "name: .*not a name"),
        ("[variants.plain]", '[variants."a\\nb"]', "variants: a key that is not a name"),
        ("[variants.plain]", f'[variants."{"x" * 300}"]', "variants: a key that is not a name"),
        ('file = "stations.csv"', f'file = "{"x" * 300}"', "File name too long"),
        ('file = "stations.csv"', 'file = "a\\u0000b"', "impossible name"),
    ],
)
def test_invalid_values_in_a_case_are_refused(folder: Path, old: str, new: str, phrase: str) -> None:
    with pytest.raises(CaseError, match=phrase) as caught:
        schema.read(changed(folder / "case.toml", old, new))
    assert "\n" not in str(caught.value)


def test_an_invalid_precone_of_a_deck_is_refused(folder: Path) -> None:
    text = (folder / "elastodyn_main.dat").read_text()
    (line,) = (line for line in text.splitlines() if "PreCone(1)" in line)
    changed(folder / "elastodyn_main.dat", line, "-2.5e9 PreCone(1)")
    with pytest.raises(CaseError, match=r"precone: -2.5e.09 degrees: beyond ±90"):
        readers.read(folder / "elastodyn_main.dat")


@pytest.mark.parametrize("axis", ["[1e308, 1e308, 0.0]", "[[1.0], 0.0]", "[1.0, 0.0]", "[]", "[0, 0, 0]"])
def test_invalid_axes_are_refused(folder: Path, axis: str) -> None:
    changed(folder / "mechanism.toml", 'at_child = { axis = "-y" }', f"at_child = {{ axis = {axis} }}")
    with pytest.raises(CaseError, match=r"mechanism.toml: "):
        mechanisms.read(folder / "mechanism.toml")


def test_ragged_matrices_and_1e308_in_a_reference_axis(folder: Path) -> None:
    changed(folder / "sections.toml", "[2.5, 0.0, 0.0]", "[2.5, 1e308, 0.0]")
    with pytest.raises(CaseError, match=r"blade.curve\[1\]\[1\]: 1e\+308"):
        readers.read(folder / "sections.toml")
    changed(folder / "sections.toml", "[2.5, 1e308, 0.0]", "[2.5, 0.0]")
    with pytest.raises(CaseError, match=r"blade.curve\[1\]"):
        readers.read(folder / "sections.toml")


MARKET = "%%MatrixMarket matrix"


@pytest.mark.parametrize(
    ("text", "phrase"),
    [
        (f"{MARKET} coordinate real general\n1 1 1\n1 1 1.0e", "line 3: '1.0e' is not a number"),
        (f"{MARKET} coordinate real general\n1 1 1\n1 1 1.0e+", "line 3: '1.0e.' is not a number"),
        (f"{MARKET} array real general\n1000000000000 1000000000000\n1.0\n", "too large for a node or row"),
        (f"{MARKET} array real general\n1000000 1000000\n1.0\n", "1 values, expected 1000000000000"),
        (f"{MARKET} coordinate real general\n9 9 1\n{2**63} 1 1.0\n", "too large for a node or row"),
        (f"{MARKET} coordinate real general\n9 9 1\n10 1 1.0\n", "a matrix with 9 rows"),
        (f"{2**63} 1 1.0\n", "too large for a node or row"),
        (f"1 1 {'9' * 400}\n", "implausibly large: check the exponent"),
        ("1 1 nan\n", "is not a number"),
    ],
)
def test_matrices_cut_short_or_of_any_size(tmp_path: Path, text: str, phrase: str) -> None:
    (tmp_path / "K.mtx").write_text(text)
    with pytest.raises(MatrixFileError, match=phrase):
        matrix_files.read_matrix(tmp_path / "K.mtx")


@pytest.mark.parametrize("symmetry", ["general", "symmetric", "skew-symmetric"])
@pytest.mark.parametrize("sparse", [True, False])
def test_matrix_market_as_scipy_writes_it(tmp_path: Path, symmetry: str, sparse: bool) -> None:
    a = ss.random_array((7, 7), density=0.5, random_state=1).toarray()  # pyright: ignore[reportCallIssue]
    a = {"general": a, "symmetric": a + a.T, "skew-symmetric": a - a.T}[symmetry]
    scipy.io.mmwrite(tmp_path / "a.mtx", ss.coo_array(a) if sparse else a, symmetry=symmetry, precision=17)
    assert (matrix_files.read_matrix(tmp_path / "a.mtx").matrix.toarray() == a).all()


def test_a_negative_mass_on_the_diagonal_is_refused(folder: Path) -> None:
    matrix = scipy.io.mmread(folder / "M.mtx").toarray()  # pyright: ignore[reportAttributeAccessIssue]
    matrix[8, 8] *= -1
    scipy.io.mmwrite(folder / "M.mtx", ss.coo_array(matrix), symmetry="symmetric")
    with pytest.raises(CaseError, match=r"mass: M.mtx: -.* on the diagonal at node 2, freedom 3"):
        condensing.condense(folder / "bar.toml")


@pytest.mark.parametrize(
    ("old", "new", "phrase"),
    [
        ('"mode":2', '"mode":0', "mode: 0 of a cell with an answer"),
        ('"mode":2', '"mode":-1', "mode: -1"),
        ('"cause":"discretisation"', '"cause":"magic"', "cause: 'magic'"),
        ('"code":"b"', '"code":"b\\n::error::x"', "code: .*not one line"),
        ('"target":0.001', '"target":1e30', "target: 1e.30"),
        ('"difference":1e-6', '"difference":1e999', "not a result"),
    ],
)
def test_results_that_no_run_writes_are_refused(folder: Path, old: str, new: str, phrase: str) -> None:
    with pytest.raises(ValueError, match=phrase) as caught:
        results_file.read(changed(folder / "results.jsonl", old, new))
    assert "line " in str(caught.value)


def test_bad_utf8_in_a_history_is_a_torn_line(folder: Path) -> None:
    path = folder / "history.jsonl"
    path.write_bytes(path.read_bytes() + b'{"commit":"\xff\xfe"}\n')
    assert history.read(path).truncated == (2,)


def test_impossible_file_names_are_refused(folder: Path) -> None:
    for name in ("x" * 300, "a\0b", "loop"):
        with pytest.raises(CaseError, match=r"cannot be read"):
            files.text(folder / name)
    os.rename(folder / "hawc2_st.dat", folder / "st\nx.dat")
    with pytest.raises(CaseError, match=r"name: .* one line") as caught:
        readers.read(folder / "st\nx.dat", readers.Mount(subset=(1, 1)))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("blade", "message"),
    [
        ({"E": 1e-320}, r"case: blade: stiffness: .* must be positive"),
        ({"length": 1e-15}, r"case: blade: length: 1e-15 m: not between"),
        ({"hub_radius": 1e4, "length": 1e-9}, r"case: blade: length"),
    ],
)
def test_values_at_the_limits_of_floating_point_are_bad_input(blade: dict[str, float], message: str) -> None:
    beam = {
        "kind": "beam",
        "length": 6.0,
        "E": 7e10,
        "G": 2.7e10,
        "density": 3e3,
        "A": 4e-4,
        "I_y": 7e-13,
        "I_z": 1e-4,
        "J": 4e-7,
    }
    case = {"name": "case", "title": "t", "description": "d", "source": "s", "blade": {**beam, **blade}}
    with pytest.raises(CaseError, match=message):
        schema.decode({**case, "speeds": {"rad_s": [1.0]}, "compare": {"modes": 1}}, "case", Path())


def test_a_ratio_that_makes_an_impossible_blade_is_bad_input() -> None:
    case = {
        "name": "case",
        "title": "t",
        "description": "d",
        "source": "s",
        "blade": {"kind": "dimensionless", "slenderness": 70.0},
    }
    variants = {"far": {"hub_ratio": 2e9}}
    with pytest.raises(
        CaseError, match=r"case: variants\.far: blade\.hub_ratio: 2000000000\.0: expected float <= 10000"
    ):
        schema.decode(
            {**case, "variants": variants, "speeds": {"gamma": [1.0]}, "compare": {"modes": 1}}, "case", Path()
        )
