"""No two cases, blades or codes of a run may have one name: their rows could not be told apart."""

import re
import shutil
from pathlib import Path

import pytest

from southwell.reports.cli import app as cli

from ...support.killing import CASE, SUPPORT


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "phrase"),
    [
        ("a.toml b.toml", r"case: 'stub/a' is given twice, by a\.toml and by b\.toml: leave one out"),
        ("a.toml ./a.toml", r"case: 'stub/a' is given twice"),
        (
            "park-blade park-blade/surrogate",
            r"case: 'park-blade/surrogate' is given twice, by .*park-blade\.toml and by ",
        ),
        (
            "a.toml --codes twins:ONE,twins:TWO",
            r"code: 'twin' is given twice, by --codes twins:ONE and by --codes twins:TWO",
        ),
        ("a.toml --codes exact-beam,twins:EXACT", r"code: 'exact-beam' is given twice, by --codes exact-beam and by"),
        ("a.toml --codes twins:CORE", r"code: 'southwell' is given twice, by this package and by --codes twins:CORE"),
    ],
)
def test_a_name_given_twice_is_reported_in_one_line(
    arguments: str, phrase: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(SUPPORT / "counted.py", tmp_path)  # the codes' own processes look in the current folder
    for name in ("a.toml", "b.toml"):
        (tmp_path / name).write_text(CASE)
    names = {"ONE": "twin", "TWO": "twin", "EXACT": "exact-beam", "CORE": "southwell"}
    lines = [f"{key} = Counted({name!r})" for key, name in names.items()]
    (tmp_path / "twins.py").write_text("\n".join(["from counted import Counted", *lines]))
    with pytest.raises(SystemExit) as exit_info:
        cli.main(["verify", *arguments.split(), "--out", "out"])
    out, err = capsys.readouterr()
    assert (exit_info.value.code, out, err.count("\n")) == (2, "", 1)
    assert re.search(phrase, err)
    assert not (tmp_path / "out").exists()
