"""Isolated environments: created with pinned versions, called by JSON, and reported if missing."""

import ast
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from southwell.references import isolated
from southwell.references.isolated import ENVIRONMENTS, READY, SHARPY, Environment
from southwell.references.isolated.hashes import HASHES, requirements
from southwell.references.protocol.interface import CodeError
from southwell.reports.cli import app as cli

ECHO = Environment("echo", ("one==1.0",), ("echo==2.5",), "echo")


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("SOUTHWELL_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def made(environment: Environment) -> None:
    """Make the environment look installed, with this interpreter."""
    environment.python.parent.mkdir(parents=True)
    environment.python.symlink_to(sys.executable)
    (environment.folder / READY).touch()


def module(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, text: str) -> None:
    """Let the environment run a module with this text."""
    (tmp_path / "echo.py").write_text(text)
    shutil.copy(Path(isolated.__file__).with_name("answer.py"), tmp_path)
    monkeypatch.setattr(isolated, "__file__", str(tmp_path / "__init__.py"))


def test_the_cache_folder_can_be_set(cache: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    assert isolated.cache() == cache
    monkeypatch.delenv("SOUTHWELL_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert isolated.cache() == tmp_path / "southwell"
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert isolated.cache() == Path.home() / ".cache" / "southwell"


def test_other_pinned_versions_use_another_environment() -> None:
    assert ECHO.folder != replace(ECHO, requires=("one==1.1",)).folder
    assert ECHO.folder == replace(ECHO, module="other").folder


def test_every_requirement_is_pinned() -> None:
    for environment in ENVIRONMENTS.values():
        lines = requirements((*environment.requires, *environment.bare)).splitlines()
        assert all(re.fullmatch(r"[\w-]+==[\d.]+( --hash=sha256:[0-9a-f]{64})+", line) for line in lines)
        assert len(lines) == len(environment.requires) + len(environment.bare)


def test_an_incomplete_environment_is_not_installed() -> None:
    assert ECHO.version() is None
    made(ECHO)
    assert ECHO.version() == "2.5"
    (ECHO.folder / READY).unlink()
    assert ECHO.version() is None


def test_request_and_answer(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    made(ECHO)
    module(monkeypatch, tmp_path, "def solve(request):\n    print('noise')\n    return {'got': request}")
    assert isolated.ask(ECHO, {"x": [0.1, 2.0]}) == {"got": {"x": [0.1, 2.0]}}


@pytest.mark.parametrize(
    ("text", "reported"),
    [
        ("import sys; sys.exit('library: not found')", "its process ended with exit status 1: library: not found"),
        ("def solve(_): raise ValueError('no steady\\nstate')", "echo: ValueError: no steady state"),
        ("", "echo: AttributeError: module 'echo' has no attribute 'solve'"),
        ("import os; os._exit(0)", "its process ended with exit status 0: no message"),
    ],
)
def test_errors_of_the_module_are_reported(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, text: str, reported: str
) -> None:
    made(ECHO)
    module(monkeypatch, tmp_path, text)
    with pytest.raises(CodeError, match=reported):
        isolated.ask(ECHO, {})


def test_the_installation_hint_if_missing() -> None:
    with pytest.raises(CodeError, match="sharpy is not installed: southwell codes install sharpy"):
        isolated.ask(SHARPY, {})


def test_an_environment_whose_system_libraries_are_missing_is_not_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before the packages are fetched, and in an environment that another machine has made."""
    commands = pip(monkeypatch)
    needing = replace(ECHO, libraries=("lapack", "gfortran"), packages=("liblapack3", "libgfortran5"))
    result = {"lapack": "liblapack.so.3", "gfortran": "libgfortran.so.5"}
    monkeypatch.setattr(isolated, "find_library", result.get)
    made(needing)
    assert needing.version() == "2.5"
    del result["lapack"]
    remedy = r"apt-get install liblapack3 libgfortran5 \(not found: liblapack\)"
    assert needing.version() is None
    assert re.fullmatch(remedy, needing.hint)
    with pytest.raises(CodeError, match=f"echo is not installed: {remedy}"):
        isolated.ask(needing, {})
    with pytest.raises(isolated.EnvironmentMissingError, match=f"echo: {remedy}"):
        isolated.install(needing)
    assert not commands


def pip(monkeypatch: pytest.MonkeyPatch, fails: str = "") -> list[list[str]]:
    """Record the pip commands, with the contents of requirements files; ``fails``: a package that is not found."""
    commands: list[list[str]] = []
    for pin in (*ECHO.requires, *ECHO.bare):
        monkeypatch.setitem(HASHES, pin, ("ab" * 32,))

    def run(command: list[str], **_: Any) -> subprocess.CompletedProcess[str]:
        command = [*command[:-1], *Path(command[-1]).read_text().splitlines()]
        commands.append(command)
        bad = bool(fails) and any(word.startswith(fails) for word in command)
        return subprocess.CompletedProcess(
            command, int(bad), "", f"noise\nERROR: No matching distribution found for {fails}\n"
        )

    monkeypatch.setattr(isolated.subprocess, "run", run)
    monkeypatch.setattr(isolated, "find_library", lambda name: name)  # whatever this system has
    monkeypatch.setattr(isolated.venv, "create", lambda folder, with_pip: folder.mkdir(parents=True))
    return commands


def test_installation_pins_versions_and_skips_dependencies(monkeypatch: pytest.MonkeyPatch) -> None:
    commands = pip(monkeypatch)
    (ECHO.folder / "left over").mkdir(parents=True)
    assert isolated.install(ECHO) == ECHO.folder
    ((python, *words),) = commands
    assert python == str(ECHO.python)
    assert {"--require-hashes", "--no-deps", "--only-binary=:all:"} <= set(words)
    assert words[-2:] == [f"{pin} --hash=sha256:{'ab' * 32}" for pin in ("one==1.0", "echo==2.5")]
    assert ECHO.version() == "2.5"
    assert not (ECHO.folder / "left over").exists()


def test_a_failed_installation_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    pip(monkeypatch, fails="echo")
    with pytest.raises(
        isolated.EnvironmentMissingError, match=r"echo==2\.5: ERROR: No matching .*CPython 3\.11 and 3\.12 on Linux"
    ):
        isolated.install(ECHO)
    assert ECHO.version() is None


def southwell(*arguments: str) -> int:
    with pytest.raises(SystemExit) as exit_info:
        cli.main(arguments)
    return int(exit_info.value.code or 0)


def test_the_command_line_installs(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    pip(monkeypatch)
    assert southwell("codes", "install", "sharpy") == 0
    assert capsys.readouterr().out.strip() == f"sharpy 2.4 in {SHARPY.folder}"
    assert southwell("codes", "install", "sharpie") == 2
    assert "did you mean sharpy" in capsys.readouterr().err
    pip(monkeypatch, fails="ic-sharpy")
    assert southwell("codes", "install", "sharpy") == 1
    assert "No matching distribution found for ic-sharpy" in capsys.readouterr().err


def test_modules_run_in_environments_import_nothing_of_this_package() -> None:
    for name in ("answer", *(environment.module for environment in ENVIRONMENTS.values())):
        path = Path(isolated.__file__).with_name(f"{name}.py")
        tree = ast.parse(path.read_text(encoding="utf-8"))
        imported = {a.name for n in ast.walk(tree) if isinstance(n, ast.Import) for a in n.names}
        imported |= {n.module or "" for n in ast.walk(tree) if isinstance(n, ast.ImportFrom)}
        expected = {"base64", "importlib", "json", "os", "pathlib", "sys", "numpy", "sharpy", "pyframe3dd"}
        assert {name.partition(".")[0] for name in imported} <= expected
