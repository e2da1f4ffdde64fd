"""The table of the paper's equations in docs/theory.md: each row names the line of ``park2010`` that computes the equation."""

import re
from pathlib import Path

import pytest

import southwell

ROOT = Path(southwell.__file__).parent
NUMBERS = range(1, 26)
PAGE = (ROOT / "core" / "park2010.py").read_text(encoding="utf-8").splitlines()

Table = dict[int, tuple[int, str]]


def table(text: str) -> Table:
    """Equation → line of the page and the solver's file, from the rows ``| 10 | … | 171 | `core/x.py` |``; each once."""
    rows = re.findall(r"^\| (\d+) \|.*\| (\d+) \| `([\w/]+\.py)` \|$", text, flags=re.MULTILINE)
    assert len({n for n, _, _ in rows}) == len(rows)
    return {int(n): (int(line), file) for n, line, file in rows}


def missing(rows: Table, page: list[str] = PAGE) -> list[int]:
    """Equations that have no row, or whose number is not in a comment on the line named."""
    return [n for n in NUMBERS if n not in rows or f"(eq. {n})" not in page[rows[n][0] - 1].partition("#")[2]]


ROWS = table((ROOT / "docs" / "theory.md").read_text(encoding="utf-8"))


def test_every_equation_is_on_the_line_that_the_table_says() -> None:
    assert missing(ROWS) == []
    assert len(PAGE) <= 250


def test_the_files_of_the_solver_exist() -> None:
    assert [file for _, file in ROWS.values() if not (ROOT / file).is_file()] == []


@pytest.mark.parametrize("n", NUMBERS)
def test_a_number_that_is_removed_is_detected(n: int) -> None:
    assert missing({k: v for k, v in ROWS.items() if k != n}) == [n]
    assert missing(ROWS, [line.replace(f"(eq. {n})", "") for line in PAGE]) == [n]
    assert n in missing(ROWS, ["", *PAGE])
