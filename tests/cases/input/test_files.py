"""Files as editors, spreadsheets and downloads leave them: the same content, or one line that says why not."""

import os
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import readers, toml
from southwell.cases.input.blades import read_table
from southwell.cases.input.errors import CaseError
from southwell.cases.input.files import table, text
from southwell.cases.input.readers import Mount
from southwell.cases.plan import user_results

DATA = Path(__file__).parents[2] / "data" / "blades"
COLUMNS = ("fraction [-]", "mass [kg/m]")
CSV = "fraction [-],mass [kg/m]\n0,5.5\n1,2.5\n"
RESULTS = "speed [rpm], frequency [Hz], mode\n0, 0.932, flapwise 1\n"
TOML = '# Blattlänge\nname = "ä"\nlength = 2.0\n'

SAVED = {
    "UTF-8": str.encode,
    "UTF-8 with a mark": lambda s: s.encode("utf-8-sig"),
    "UTF-16": lambda s: s.encode("utf-16"),
    "UTF-16 from the big end": lambda s: "\ufeff".encode("utf-16-be") + s.encode("utf-16-be"),
    "Windows' line ends": lambda s: s.replace("\n", "\r\n").encode(),
}


@pytest.fixture(params=SAVED.values(), ids=list(SAVED))
def saved(request: pytest.FixtureRequest, tmp_path: Path):
    def save(content: str, name: str) -> Path:
        (tmp_path / name).write_bytes(request.param(content))
        return tmp_path / name

    return save


def test_toml_is_read_in_every_encoding_and_line_end(saved) -> None:
    assert toml.document(saved(TOML, "a.toml")) == {"name": "ä", "length": 2.0}


def test_a_blade_file_is_read_in_every_encoding_and_line_end(saved) -> None:
    mount = Mount(length=50.0)
    content = (DATA / "elastodyn_blade.dat").read_text(encoding="utf-8")
    blade = readers.read(saved(content, "blade.dat"), mount)
    expected = readers.read(DATA / "elastodyn_blade.dat", mount)
    np.testing.assert_array_equal(blade.stiffness, expected.stiffness)
    np.testing.assert_array_equal(blade.mass, expected.mass)


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_tables_are_read_in_every_encoding_and_line_end(saved, separator: str) -> None:
    result = read_table(saved(CSV.replace(",", separator), "a.csv"), COLUMNS)
    np.testing.assert_array_equal(result["mass [kg/m]"], [5.5, 2.5])
    (row,) = user_results.read("rig", saved(RESULTS.replace(",", separator), "rig.csv")).rows
    assert row.line == 2
    assert (row.family, row.mode) == ("flapwise", 1)
    assert row.value.value == pytest.approx(0.932 * 2 * np.pi)


def test_decimal_commas_between_semicolons_are_refused_not_split(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(CSV.replace(",", ";").replace(".", ","))
    with pytest.raises(CaseError, match=r"line 2: mass \[kg/m\]: '5,5' is not a number"):
        read_table(path, COLUMNS)


def test_a_row_keeps_its_line_behind_comments_and_quotes(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text('# one\n\nx;y\n"1";2 # two\n"3\n')
    assert table(path, "give it") == [(3, ["x", "y"]), (4, ["1", "2"]), (5, ["3"])]


BAD = {
    "empty": (b"", "empty: check that it was written to the end"),
    "blank": (b"\xef\xbb\xbf \r\n\t\n", "empty"),
    "binary": (b"\x7fELF\x02\x01\x00\x00", "not a text file"),
    "UTF-16 without a mark": ("name".encode("utf-16-le"), "UTF-16"),
    "UTF-32": ("name".encode("utf-32"), "save it as UTF-8"),
    "half a character of UTF-16": ("name".encode("utf-16") + b"\x00", "line 1: not UTF-8"),
    "Latin-1": ("a\n# Länge\n".encode("latin-1"), "line 2: not UTF-8"),
    "a pointer of Git LFS": (b"version https://git-lfs.github.com/spec/v1\noid sha256:12\nsize 9\n", "git lfs pull"),
    "a web page": (b"\n<!DOCTYPE html>\n<html>", "download the raw file"),
}


@pytest.mark.parametrize(("content", "phrase"), BAD.values(), ids=BAD)
def test_a_binary_file_is_reported_in_one_line(content: bytes, phrase: str, tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(content)
    with pytest.raises(CaseError) as caught:
        text(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert phrase in message
    assert "\n" not in message


@pytest.mark.parametrize("suffix", [".toml", ".csv", ".dat", ".yaml"])
def test_a_folder_is_not_a_file(suffix: str, tmp_path: Path) -> None:
    folder = tmp_path / f"blade{suffix}"
    folder.mkdir()
    with pytest.raises(CaseError, match="cannot be read"):
        readers.read(folder, Mount(length=50.0))


def test_latin_1_is_read_in_the_formats_of_programs(tmp_path: Path) -> None:
    content = (DATA / "elastodyn_blade.dat").read_bytes()
    path = tmp_path / "blade.dat"
    path.write_bytes(content.replace(b"\n", " Größe\n".encode("latin-1"), 1))
    assert readers.read(path, Mount(length=50.0)).length == 50.0


def test_a_file_without_read_permission_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "blade.toml"
    path.write_text("x = 1\n")

    def refuse(*_: object) -> int:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(CaseError, match=r"blade.toml: cannot be read \(Permission denied\)"):
        toml.document(path)
