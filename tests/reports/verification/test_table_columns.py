"""Tables in the terminal: no number and no word is broken, whatever the width."""

import re

import pytest
from rich.console import Console

from southwell.reports.campbell.tables import Sheet, terminal

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
