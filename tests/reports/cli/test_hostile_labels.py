"""Labels of files: as paths they lead nowhere, in a log they are no commands, in a table they are no markup."""

import io
from pathlib import Path

import pytest

from southwell.reports.cli import app as cli
from southwell.reports.shared.log_safe import LogSafe
from southwell.reports.shared.paths import file_name
from southwell.tests.support import fuzz


def southwell(*arguments: str) -> int:
    with pytest.raises(SystemExit) as exit_info:
        cli.main(arguments)
    return int(exit_info.value.code or 0)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "a" / "b").mkdir(parents=True)
    fuzz.seeds(tmp_path / "a" / "b")
    return tmp_path / "a" / "b"


def variants(folder: Path, label: str) -> str:
    path = folder / "case.toml"
    path.write_text(path.read_text().replace("variants.plain", f"variants.'{label}'").replace("plain = 1, ", ""))
    return str(path)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "label"),
    [("show", "../../x"), ("show", "{absolute}/escaped"), ("show", "<img src=x>"), ("campbell", "../../x")],
)
def test_a_label_stays_in_the_folder_given(folder: Path, command: str, label: str) -> None:
    out, label = folder / "out", label.format(absolute=folder.parent)
    before = set(folder.parents[1].rglob("*"))
    more = ["--rpm", "10,20", "--modes", "1", "--elements", "3"] if command == "campbell" else []
    assert southwell(command, variants(folder, label), *more, "--out", str(out)) == 0
    new = set(folder.parents[1].rglob("*")) - before
    assert all(p == out or p.is_relative_to(out) for p in new)
    assert len([p for p in out.iterdir() if p.is_dir()]) == 2


def test_two_labels_never_share_a_folder() -> None:
    labels = ["a b", "a-b", "a_b", "a/b", "..", ".", "", "x" * 300, "x" * 301, "é", "è", "CON:", "a\n"]
    names = [file_name(label) for label in labels]
    assert len(set(names)) == len(labels) - 1  # a/b is a-b: `case/blade` has one name
    assert all(len(name) < 100 and not set(name) & set("/\\:\n") and name.strip(".") for name in names)
    assert file_name("windpact-3.0") == "windpact-3.0"


@pytest.mark.parametrize(
    "text",
    [
        "::error::x",
        "  ::error file=a::x",
        "ok\n::error::x",
        "a\r::error::x",
        "x ##[error]y",
        "\t::set-output::",
        "a\u2028::x",
    ],
)
def test_no_line_is_a_command_to_ci(text: str) -> None:
    out = io.StringIO()
    stream = LogSafe(out)
    for piece in ("before\n", "  ", text, "\n"):  # also after blanks that were written alone
        stream.write(piece)
    assert not any(line.lstrip().startswith("::") or "##[" in line for line in out.getvalue().splitlines())


def test_lines_without_a_command_are_unchanged() -> None:
    out = io.StringIO()
    print("a::b", "C::D ## [x]", "", "  x ::y", sep="\n", file=LogSafe(out))  # pyright: ignore[reportArgumentType]
    assert out.getvalue() == "a::b\nC::D ## [x]\n\n  x ::y\n"


def test_a_title_is_no_command(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = folder / "case.toml"
    path.write_text(path.read_text().replace("A tapered blade", "::error::A blade [/] [bold]"))
    assert southwell("show", str(path)) == 0
    output = capsys.readouterr().out
    assert "error::A blade [/] [bold]" in output
    assert not [line for line in output.splitlines() if line.lstrip().startswith("::")]


def test_annotations_remain_commands(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "folder.toml").mkdir()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        assert southwell("gate", "results.jsonl", "--annotations") in (1, 3)
    assert [line for line in capsys.readouterr().out.splitlines() if line.startswith("::error")]
