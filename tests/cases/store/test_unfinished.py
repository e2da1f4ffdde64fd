"""The file of an unfinished run: which answers belong to it, and which are asked again."""

from dataclasses import replace
from pathlib import Path

import pytest

from southwell.cases.judge import results
from southwell.cases.store import codec, unfinished
from southwell.cases.store.unfinished import Unfinished

PARTIAL = unfinished.NAME


def put(file: Unfinished, key: str, *cells: results.Cell) -> None:
    file.put(key, True, codec.encode((list(cells), [])))


CELL = results.Cell("case", 1.0, 1, "flapwise", "first", "1.0", "code", 1.0, 1.0, 0.0, 0.0, 1e-3, "pass", ordinal=1)
PLAN = tuple(results.Planned("case", code, 1, 1) for code in ("first", "second", "third"))


def test_a_damaged_answer_is_asked_again(tmp_path: Path) -> None:
    with Unfinished(tmp_path) as file:
        file.begin(results.Run((), command="a", plan=PLAN))
        put(file, "first", CELL)
        put(file, "second", replace(CELL, code="second"))
        file.store.base.execute("update answers set value = substr(value, 2) where key = 'first'")
        with pytest.raises(KeyError):
            file.get("first")
        assert codec.decode(file.get("second")) == ([replace(CELL, code="second")], [])
    run = unfinished.read(tmp_path / PARTIAL)
    assert [cell.code for cell in run.cells] == ["second"]
    assert "cells of case × first and 1 more are missing, of 3 planned" in run.unfinished


def test_an_answer_belongs_to_the_runs_that_use_it(tmp_path: Path) -> None:
    """One of an earlier plan is shown only if the later run has taken it; rows are in the order of the plan."""
    with Unfinished(tmp_path) as file:
        file.begin(results.Run((), command="a", plan=PLAN))
        for code in ("third", "second", "first"):
            put(file, code, replace(CELL, code=code))
    assert [cell.code for cell in unfinished.read(tmp_path / PARTIAL).cells] == ["first", "second", "third"]
    with Unfinished(tmp_path) as file:
        file.begin(results.Run((), command="b", plan=PLAN))
        file.get("third")
        file.get("second")
    run = unfinished.read(tmp_path / PARTIAL)
    assert ([cell.code for cell in run.cells], run.command) == (["second", "third"], "b")
    with Unfinished(tmp_path) as file:
        file.begin(results.Run((), command="b", plan=PLAN))
    assert len(unfinished.read(tmp_path / PARTIAL).cells) == 2


def test_a_run_that_was_killed_before_its_plan_has_no_answer(tmp_path: Path) -> None:
    Unfinished(tmp_path).close()
    assert unfinished.read(tmp_path / PARTIAL).unfinished == "the run was stopped before its first answer"
    (tmp_path / PARTIAL).write_bytes(b"not a database, " * 100)
    with pytest.raises(OSError, match="not a database"):
        unfinished.read(tmp_path / PARTIAL)
