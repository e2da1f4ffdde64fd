"""Answers of codes taken from the store: every part of the key counts, and only what is missing is requests for."""

import json
import platform
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from southwell.core.blade import uniform_blade
from southwell.core.modes import STATIONS, Modes
from southwell.references.protocol import sources, store, worker
from southwell.references.protocol.process import Failure, Limits
from southwell.references.protocol.wire import encode
from southwell.references.protocol.worker import Answer, answers

BLADE = uniform_blade("beam", 6.0, 0.3, EA=1e7, GJ=1e3, EI_y=1 / 3, EI_z=1.4e4, mass=1.2)
RUNS = [(0.0, 10, 3), (2.0, 10, 3), (0.5, 20, 3)]
REUSE = Limits(60.0, reuse=True)

Requests = list[list[list[float]]]


@pytest.fixture
def requests(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Requests:
    """The runs of every request that reaches a process; it answers with the speed in its frequencies."""
    observed: Requests = []

    def converse(module: str, request: bytes, expected: int, limits: Limits) -> tuple[list[bytes], Failure]:
        runs = json.loads(request)["runs"]
        observed.append(runs)
        lines = [json.dumps({"run": k, "modes": encode(_modes(*run))}).encode() for k, run in enumerate(runs)]
        return lines[:expected], Failure("crashed", "ended")

    monkeypatch.delenv(store.FRESH, raising=False)
    monkeypatch.setenv("SOUTHWELL_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(worker, "converse", converse)
    return observed


def _modes(omega: float, elements: int, count: int) -> Modes:
    shapes = np.full((count, len(STATIONS), 4), 1.0 / 3.0 + 2.0j / 7.0)
    return Modes(omega, omega + np.arange(1.0, count + 1), shapes, elements, seconds=0.25)


def ask(**changed: Any) -> list[Answer]:
    given: dict[str, Any] = {"name": "exact-beam", "blade": BLADE, "runs": RUNS, "limits": REUSE, "version": "1.0"}
    return answers(**(given | changed))


def test_only_missing_answers_are_requested(requests: Requests) -> None:
    ask(runs=RUNS[:1])
    more = ask(runs=[RUNS[1], RUNS[0], RUNS[2]])
    assert requests == [[[0.0, 10, 3]], [[2.0, 10, 3], [0.5, 20, 3]]]
    for run, modes in zip([RUNS[1], RUNS[0], RUNS[2]], more, strict=True):
        assert isinstance(modes, Modes)
        assert (modes.omega, modes.elements) == run[:2]
        np.testing.assert_array_equal(modes.frequencies, _modes(*run).frequencies)
        np.testing.assert_array_equal(modes.shapes, _modes(*run).shapes)
    ask()
    assert len(requests) == 2


@pytest.mark.parametrize(
    "changed",
    [
        {"blade": replace(BLADE, hub_radius=np.nextafter(0.3, 1.0))},
        {"runs": [(np.nextafter(2.0, 3.0), 10, 3)]},
        {"runs": [(2.0, 11, 3)]},
        {"runs": [(2.0, 10, 4)]},
        {"name": "yoo-shin"},
        {"version": "1.1"},
    ],
)
def test_every_part_of_the_question_changes_the_key(requests: Requests, changed: dict[str, Any]) -> None:
    request = {"runs": [RUNS[1]]}
    ask(**request)
    ask(**request)
    assert len(requests) == 1
    ask(**(request | changed))
    assert len(requests) == 2


@pytest.mark.parametrize(
    "change",
    [
        lambda m: m.setattr(sources, "package", lambda: "another source"),
        lambda m: m.setattr(platform, "machine", lambda: "another machine"),
    ],
)
def test_sources_and_machine_change_the_key(
    requests: Requests, monkeypatch: pytest.MonkeyPatch, change: Callable[[pytest.MonkeyPatch], None]
) -> None:
    ask()
    change(monkeypatch)
    ask()
    assert len(requests) == 2


@pytest.mark.parametrize(
    "changed", [{"limits": replace(REUSE, reuse=False)}, {"version": ""}, {"name": "elsewhere:CODE"}]
)
def test_answers_without_version_or_of_other_packages_are_not_stored(
    requests: Requests, changed: dict[str, Any]
) -> None:
    """Answers when reuse is not wanted, of a code of unknown version, and of a code that is not part of this package."""
    ask(**changed)
    ask(**changed)
    ask()
    assert len(requests) == 3


def test_failures_are_not_stored(requests: Requests, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(module: str, request: bytes, expected: int, limits: Limits) -> tuple[list[bytes], Failure]:
        reply = {"run": 0, "kind": "refused", "reason": "no steady state"}
        return [json.dumps(reply).encode()], Failure("timed out", "no answer within 60 s")

    with monkeypatch.context() as m:
        m.setattr(worker, "converse", fails)
        assert [a.kind for a in ask() if isinstance(a, Failure)] == ["refused", "timed out", "timed out"]
    assert all(isinstance(a, Modes) for a in ask())
    assert requests == [[list(run) for run in RUNS]]


def test_the_time_of_a_stored_answer_is_not_reported_as_measured(requests: Requests) -> None:
    first, second = ask(runs=RUNS[:1]), ask(runs=RUNS[:1])
    assert isinstance(first[0], Modes)
    assert isinstance(second[0], Modes)
    assert (first[0].seconds, np.isnan(second[0].seconds)) == (0.25, True)


def test_an_array_is_computed_once_for_each_question(requests: Requests, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[float] = []

    def array(x: float, label: str = "array") -> Any:
        return store.array(label, (x,), lambda: made.append(x) or np.array([[x, 1.0 / 3.0]]))

    for _ in range(2):
        np.testing.assert_array_equal(array(2.0), [[2.0, 1.0 / 3.0]])
    array(np.nextafter(2.0, 3.0))
    array(2.0, "another")
    assert made == [2.0, np.nextafter(2.0, 3.0), 2.0]
    monkeypatch.setenv(store.FRESH, "1")
    array(2.0)
    assert len(made) == 4
