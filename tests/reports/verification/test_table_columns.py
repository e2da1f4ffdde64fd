"""Tables in the terminal: no number and no word is broken, whatever the width."""

import re
from io import StringIO

import pytest
from rich.console import Console

from southwell.reports.shared.console import _Output
from southwell.reports.shared.sheets import Sheet, terminal

HEAD = ("mode", "kinetic energy", "Hz at rest", "Hz at 15 rpm", "± relative", "change", "residual")
ROWS = tuple(
    (f"flapwise {k}", f"{90 + k} % flapwise", f"0.677621{k}", f"0.754889{k}", f"{k}e-10", f"+1{k}.40 %", f"0.0{k}4 %")
    for k in range(1, 5)
)


@pytest.mark.parametrize("width", [30, 45, 60, 80, 120])
def test_every_field_is_whole_and_lines_fit(width: int) -> None:
    console = Console(width=width, highlight=False, color_system=None)
    with console.capture() as captured:
        console.print(terminal(Sheet("Modes", HEAD, ROWS, "A note of some length that is wrapped."), width))
    lines = captured.get().splitlines()
    assert all(len(line) <= width for line in lines)
    words = set(re.split(r"\s+", captured.get()))
    for row in (HEAD, *ROWS):
        assert {word for field in row for word in field.split()} <= words
    numbers = [field for row in ROWS for field in row[2:]]
    assert all(any(field in line for line in lines) for field in numbers)


def test_a_long_line_in_a_terminal_breaks_between_words_and_leaves_paths_whole() -> None:
    out = StringIO()
    path = "/a/folder/whose/name/is/longer/than/the/line/campbell.md"
    _Output(file=out, width=40, force_terminal=True, color_system=None).print(
        f"{'frequency 0.6777006 Hz; ' * 5}{path}", soft_wrap=True
    )
    lines = out.getvalue().splitlines()
    assert path in lines
    assert all(len(line) <= 40 for line in lines if line != path)
    assert out.getvalue().count("0.6777006") == 5
