"""A second process compiles the eigensolver's loops at first use: exactly those that a blade needs."""

import subprocess
import sys
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from southwell.core import first_use, solve
from southwell.core.blade import uniform_blade
from southwell.core.chain import completeness, elimination, krylov, matrices, precompile

FLAT = uniform_blade("flat", 10.0, 1.0, EA=1e9, GJ=1e6, EI_y=1e6, EI_z=4e6, mass=10.0, I_y=0.1, I_z=0.3)

LOOPS: list[Any] = [
    *(krylov.extend, krylov.forward, krylov.keep_massive, matrices.times),
    *(elimination.solve, elimination._eliminate, completeness._negative),
]


def signatures() -> list[list[Any]]:
    return [list(loop.signatures) for loop in LOOPS]


def test_it_compiles_what_a_blade_needs() -> None:
    """In either order, the second needs no further combination of argument types."""
    precompile.eigensolver()
    before = signatures()
    assert all(before)
    for _ in solve.mesh_sweep(FLAT, [4.0, 5.0], 4, 3):
        assert signatures() == before


STARTED = [sys.executable, "-P", "-m", "southwell.core.chain.precompile"]


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """Commands of the processes that are started, instead of starting them; this machine has two processors."""
    commands: list[list[str]] = []

    def start(command: list[str], **_: Any) -> SimpleNamespace:
        commands.append(command)
        return SimpleNamespace(kill=lambda: None, wait=lambda: 0)

    monkeypatch.setattr(subprocess, "Popen", start)
    monkeypatch.setattr(first_use, "_processors", lambda: 2)
    monkeypatch.setattr(sys.modules["__main__"], "__spec__", None)
    return commands


def begin(module: str, listener: first_use.FirstUse) -> None:
    def loop() -> None: ...

    loop.__module__ = module
    listener.on_start(SimpleNamespace(data={"dispatcher": SimpleNamespace(py_func=loop)}))


def test_a_second_process_is_started_once_and_for_our_loops_only(started: list[list[str]], tmp_path: Path) -> None:
    listener = first_use.FirstUse(lambda: tmp_path)
    begin("elsewhere", listener)
    assert started == []
    for _ in range(3):
        begin("southwell.core.chain.steady", listener)
    assert started == [STARTED]


@pytest.mark.parametrize("why", ["one processor", "no cache", "an embedded Python", "a worker", "the second process"])
def test_it_is_not_started_where_it_would_not_help(
    why: str, started: list[list[str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if why == "one processor":
        monkeypatch.setattr(first_use, "_processors", lambda: 1)
    if why == "an embedded Python":
        monkeypatch.setattr(sys, "executable", "/opt/cad/cad")
    if why == "a worker":
        monkeypatch.setattr(first_use, "parent_process", lambda: "another")
    if why == "the second process":
        monkeypatch.setattr(sys.modules["__main__"], "__spec__", ModuleSpec(STARTED[-1], None))
    listener = first_use.FirstUse((lambda: None) if why == "no cache" else (lambda: tmp_path))
    begin("southwell.core.chain.steady", listener)
    assert started == []


def test_workers_do_not_announce_what_their_parent_has(
    started: list[list[str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    begin("southwell.core.chain.steady", first_use.FirstUse(lambda: tmp_path))
    monkeypatch.setattr(first_use, "parent_process", lambda: "another")
    begin("southwell.core.chain.steady", first_use.FirstUse(lambda: tmp_path))
    assert [record.getMessage() for record in caplog.records] == [first_use.ANNOUNCEMENT]


def test_without_the_second_process_the_first_compiles_everything(
    started: list[list[str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: Any, **__: Any) -> None:
        raise PermissionError("no more processes")

    monkeypatch.setattr(subprocess, "Popen", refused)
    begin("southwell.core.chain.steady", first_use.FirstUse(lambda: tmp_path))
    assert started == []
