"""Tasks taken from the store: each part of the key counts, failures are not stored, damaged answers are computed again."""

import os
import platform
import subprocess
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from southwell.cases.judge.cells import Head, failed
from southwell.cases.judge.results import Cell, Control
from southwell.cases.plan.column import Column
from southwell.cases.run.executors import Serial
from southwell.cases.store import stored
from southwell.cases.store.stored import Stored
from southwell.core.blade import uniform_blade
from southwell.core.effects import ALL_EFFECTS
from southwell.references.protocol import sources, store
from southwell.references.protocol.process import Failure
from southwell.references.protocol.store import Store

from ...support import killing

CALLS: list[Any] = []


def double(x: Any) -> Any:
    CALLS.append(x)
    return 2.0 * x


def lost(head: Head, core: Any) -> tuple[list[Cell], list[Any]]:
    CALLS.append(head.code)
    return [failed(head, 1.0, Failure("timed out", "no answer within 1 s"))], []


@pytest.fixture
def kept(tmp_path: Path) -> Store:
    CALLS.clear()
    return Store(tmp_path / store.NAME)


def test_an_answer_is_computed_once(kept: Store) -> None:
    first = Stored(Serial(), kept)
    assert [first.submit(double, x).result() for x in (1.0, 2.0, 1.0)] == [2.0, 4.0, 2.0]
    assert CALLS == [1.0, 2.0]
    second = Stored(Serial(), kept)
    assert second.submit(double, 2.0).result() == 4.0
    assert (CALLS, second.asked, len(second.taken)) == ([1.0, 2.0], 1, 1)


def test_a_column_that_solves_nothing_starts_no_process(kept: Store) -> None:
    class Refusing(Serial):
        def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Any:
            raise AssertionError("a task was started")

    head = Head("blade", "absent", "", "code", 1e-3)
    column = Column("absent", ALL_EFFECTS, head, partial(lost, head), solves=False)
    stored_tasks = Stored(Refusing(), kept)
    cells, _ = stored_tasks.submit(column, [1.0], [None]).result()
    assert (len(cells), CALLS, stored_tasks.asked) == (1, ["absent"], 0)
    with pytest.raises(AssertionError, match="a task was started"):
        stored_tasks.submit(replace(column, solves=True), [1.0], [None])


def test_versions_of_codes_are_part_of_the_key(kept: Store) -> None:
    for also in (("code 1.0",), ("code 1.1",), ("code 1.0",)):
        Stored(Serial(), kept, also=also).submit(double, 2.0)
    assert CALLS == [2.0, 2.0]


def trial(detected_by: tuple[str, ...]) -> list[Control]:
    CALLS.append(detected_by)
    return [Control("wrong sign", "solver", "reverses a sign", "1 %", "beam", 1.0, detected_by)]


def test_a_fault_that_was_not_detected_is_tried_again(kept: Store) -> None:
    for detected_by in ((), (), ("beam: fail",), ("beam: fail",)):
        assert Stored(Serial(), kept).submit(trial, detected_by).result()[0].detected_by == detected_by
    assert CALLS == [(), (), ("beam: fail",)]


def column(**changed: Any) -> Column:
    head = Head("case", "code", "1.0", "code", 1e-3, "nothing")
    failing_column = Column("code", ALL_EFFECTS, head, partial(lost, head))
    return replace(failing_column, **changed)


def test_every_part_of_the_question_changes_the_key(monkeypatch: pytest.MonkeyPatch) -> None:
    """Question, speed, version, effects, sources of this package, machine, and the kernel that is asked for."""
    head = column().head
    blade, heavier = (
        uniform_blade("a", 6.0, 0.3, EA=1e7, GJ=1e4, EI_y=1e4, EI_z=1e4, mass=m) for m in (1.2, np.nextafter(1.2, 2.0))
    )
    keys = {
        stored.question(column(), [0.0]),
        stored.question(column(), [1.0]),
        stored.question(column(head=replace(head, version="1.1")), [0.0]),
        stored.question(column(head=replace(head, code="other")), [0.0]),
        stored.question(column(adapter="another source"), [0.0]),
        stored.question(column(effects=replace(ALL_EFFECTS, coriolis=False)), [0.0]),
        stored.question(double, 1.0),
        stored.question(double, 2.0),
        stored.question(partial(double, blade)),
        stored.question(partial(double, heavier)),
    }
    assert len(keys) == 10
    for change in (
        lambda m: m.setattr(platform, "machine", lambda: "another"),
        lambda m: m.setenv("OPENBLAS_CORETYPE", "another"),
        lambda m: m.setattr(sources, "package", lambda: "other sources"),
    ):
        with monkeypatch.context() as m:
            change(m)
            assert stored.question(double, 1.0) not in keys
    assert stored.question(double, 1.0) in keys


def test_codes_from_elsewhere_and_of_no_known_version_are_asked_again() -> None:
    assert column().storable
    assert not column(bundled=False).storable
    assert not column(head=replace(column().head, version="")).storable


def test_failures_are_not_stored(kept: Store) -> None:
    for _ in range(2):
        Stored(Serial(), kept).submit(column(), [1.0], [None]).result()
    assert CALLS == ["code", "code"]
    assert kept.kept() == []


@pytest.mark.slow
def test_a_second_run_takes_its_answers_from_the_store(tmp_path: Path) -> None:
    """And says how many, and from when; with --fresh it computes again. Results are the same but for times."""
    (tmp_path / "case.toml").write_text(killing.BEAM)
    line = ["verify", "case.toml", "--codes", "exact-beam", "--faults", "none", "--workers", "1", "--out"]
    env = {k: v for k, v in os.environ.items() if k != "SOUTHWELL_FRESH"} | {"SOUTHWELL_CACHE": str(tmp_path / "cache")}

    def run(out: str, *more: str) -> str:
        command = [sys.executable, "-m", "southwell", *line, out, *more]
        process = subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, text=True)
        assert process.returncode == 0, process.stderr
        return process.stderr

    assert "from the store" not in run("first")
    # the weight of a model is asked again: the store of the processes of codes has it
    assert "5 of 6 answers are from the store, computed between 20" in run("second")
    assert "from the store" not in run("third", "--fresh")
    assert (tmp_path / "first" / "results.jsonl").read_text() == (tmp_path / "second" / "results.jsonl").read_text()
