"""The page of public cases holds what its commands print."""

import os
import re
from pathlib import Path

import pytest

from southwell.reports.site import public_cases as page

TEXT = page.PAGE.read_text(encoding="utf-8")
PUBLIC = os.environ.get("SOUTHWELL_PUBLIC")


def test_every_case_has_commands_with_output() -> None:
    sections = re.findall(r"^## .+?(?=^## |\Z)", TEXT, re.M | re.S)
    table = re.findall(r"^\| \[", TEXT, re.M)
    assert len(sections) == len(table) - 1  # two codes share a blade
    for section in sections:
        blocks = list(page.BLOCK.finditer(section))
        assert blocks, section[:40]
        for block in blocks:
            assert page.commands(block["lines"])
            printed = [line for line in block["lines"].splitlines() if not line.startswith("$ ")]
            assert printed
            assert all(re.search(block["pattern"], line) for line in printed)


def test_output_is_replaced_by_the_matching_lines(tmp_path: Path) -> None:
    (tmp_path / "one").mkdir()
    (tmp_path / "one" / "file").write_text("frequency 1\nother\nfrequency 2\n", encoding="utf-8")
    block = "<!-- run in one: ^freq -->\n```text\n$ cat file\n{}$ echo frequency\n```\n"
    assert page.refreshed("before\n" + block.format("old\n"), tmp_path) == (
        "before\n"
        + block.format("frequency 1\nfrequency 2\n").replace("echo frequency\n", "echo frequency\nfrequency\n")
    )


@pytest.mark.nightly
@pytest.mark.slow
@pytest.mark.skipif(not PUBLIC, reason="set SOUTHWELL_PUBLIC to the folder of public cases")
def test_the_page_is_that_of_this_version() -> None:
    assert page.refreshed(TEXT, Path(str(PUBLIC))) == TEXT
