"""A results file that is not whole is not taken for a whole one, whatever is missing from it."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from southwell.cases.input import atomic
from southwell.cases.judge.results import Planned
from southwell.cases.store import results_file

from ...support.samples import SPEEDS, empty
from ...support.samples import run as sample

CODES = ("alpha", "beta", "gamma")
WHOLE = replace(sample(), plan=tuple(Planned("beam", code, len(SPEEDS), 4) for code in CODES))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    results_file.write(tmp_path / "results.jsonl", WHOLE)
    return tmp_path / "results.jsonl"


def test_a_whole_file_is_complete(path: Path) -> None:
    assert results_file.read(path) == WHOLE
    first, *_, last = path.read_text().splitlines()
    assert first.startswith('{"kind":"plan"')
    assert last.startswith('{"kind":"end"')


def test_a_truncated_file_is_incomplete(path: Path) -> None:
    content = path.read_bytes()
    for size in range(0, len(content), 997):
        path.write_bytes(content[:size])
        assert results_file.read(path).unfinished, size
    path.write_bytes(content[:-1])
    assert results_file.read(path).unfinished


@pytest.mark.parametrize(
    ("change", "phrase"),
    [
        (lambda lines: lines[1:], "does not begin with the plan"),
        (lambda lines: lines[:-1], "does not end with the completion record"),
        (lambda lines: [*lines, lines[3]], "does not end with the completion record"),
        (lambda lines: lines[:5] + lines[6:], "the number of lines differs from that in the completion record"),
        (lambda lines: lines[:5] + lines[4:], "the number of lines differs from that in the completion record"),
        (lambda lines: lines + lines, "does not begin with the plan"),
    ],
)
def test_missing_cells_are_named(path: Path, change: Callable[[list[str]], list[str]], phrase: str) -> None:
    path.write_text("".join(change(path.read_text().splitlines(keepends=True))))
    assert phrase in results_file.read(path).unfinished


def test_a_column_of_the_plan_without_its_cells_is_a_gap(tmp_path: Path) -> None:
    more = replace(WHOLE, plan=(*WHOLE.plan, Planned("beam", "epsilon", 1, 4)))
    assert results_file.gaps(more) == "cells of beam × epsilon are missing, of 4 planned"
    less = replace(WHOLE, cells=tuple(c for c in WHOLE.cells if (c.code, c.omega, c.mode) != ("beta", 20.0, 3)))
    assert "beam × beta" in results_file.gaps(less)
    slower = replace(WHOLE, cells=tuple(c for c in WHOLE.cells if (c.code, c.omega) != ("beta", 20.0)))
    assert "beam × beta" in results_file.gaps(slower)
    excused = replace(slower, cells=(*slower.cells, empty("inconclusive", "crashed", code="beta", omega=20.0)))
    assert results_file.gaps(excused) == ""
    with pytest.raises(ValueError, match="not written: cells of beam × beta"):
        results_file.write(tmp_path / "results.jsonl", less)
    assert not list(tmp_path.iterdir())


def test_a_file_that_cannot_be_written_wholly_leaves_the_earlier_one(tmp_path: Path) -> None:
    path = tmp_path / "file"
    atomic.write(path, "before")

    def fails(file) -> None:
        file.write(b"half")
        raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="No space left on device") as phrase:
        atomic.through(path, fails)
    assert phrase.value.filename == str(path)
    assert path.read_text() == "before"
    assert [p.name for p in tmp_path.iterdir()] == ["file"]
