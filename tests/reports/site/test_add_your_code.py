"""The page on adding a code, followed step by step: what it says to save, install and type is saved, installed and typed."""

import os
import re
import subprocess
import sys
import sysconfig
import tomllib
from pathlib import Path

import pytest

from southwell.cases.judge import results
from southwell.cases.store import results_file

PAGE = (Path(__file__).parents[3] / "docs" / "add-your-code.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.M | re.S)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The adapter, its test and its package's description, saved as the page says; the package as an installer leaves it."""
    here = tmp_path_factory.mktemp("my-code")
    adapter, test = blocks("python")
    (project,) = map(tomllib.loads, blocks("toml"))
    (here / "my_code.py").write_text(adapter, encoding="utf-8")
    (here / "test_my_code.py").write_text(test, encoding="utf-8")
    info = here / f"my_code-{project['project']['version']}.dist-info"
    info.mkdir()
    head = f"Metadata-Version: 2.1\nName: {project['project']['name']}\nVersion: {project['project']['version']}\n"
    (info / "METADATA").write_text(head)
    groups = project["project"]["entry-points"].items()
    lines = [f"[{group}]\n" + "".join(f"{k} = {v}\n" for k, v in entries.items()) for group, entries in groups]
    (info / "entry_points.txt").write_text("\n".join(lines))
    return here


def run(folder: Path, *command: str, installed: bool = False) -> subprocess.CompletedProcess[str]:
    """In the folder; with ``installed`` as if its package were."""
    path = os.pathsep.join([*([str(folder)] if installed else []), os.environ.get("PYTHONPATH", "")])
    environment = {**os.environ, "PYTHONPATH": path, "COLUMNS": "200"}
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environment, timeout=120)


def typed(part: str) -> list[str]:
    """The command of the page that has ``part`` in it; the script, which, unlike ``python -m``, is blind to its folder."""
    lines = [line for block in blocks("console") for line in block.splitlines()]
    (line,) = (line for line in lines if part in line)
    program, *arguments = line.split()
    assert program == "southwell"
    return [str(Path(sysconfig.get_path("scripts"), program)), *arguments]


@pytest.mark.slow
def test_the_example_adapter_conforms(folder: Path) -> None:
    done = run(folder, *typed("conform"))
    assert done.returncode == 0, done.stdout + done.stderr
    assert re.search(r"My finite elements: 1\d pass, \d+ not applicable$", done.stdout.strip())


@pytest.mark.slow
def test_tests_of_the_example_adapter_pass(folder: Path) -> None:
    done = run(folder, sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "test_my_code.py")
    assert done.returncode == 0, done.stdout
    assert re.search(r"^1\d passed, \d+ skipped", done.stdout, re.M)


def cells(folder: Path, part: str, installed: bool = False) -> list[results.Cell]:
    done = run(folder, *typed(part), "--faults", "none", installed=installed)
    assert done.returncode == 0, done.stdout + done.stderr
    return [c for c in results_file.read(folder / "my-report" / "results.jsonl").cells if c.code == "my-code"]


@pytest.mark.slow
def test_the_example_adapter_is_in_the_matrix(folder: Path) -> None:
    """Passes, or known differences by what it says it leaves out; nothing else."""
    rows = cells(folder, "--codes my_code:CODE")
    assert len(rows) == 42
    assert {c.verdict for c in rows} == {"pass", "known difference"}
    assert all("no coriolis" in c.reason for c in rows if c.verdict == "known difference")
    assert sum(c.verdict == "pass" for c in rows) > 38


@pytest.mark.nightly
def test_an_installed_adapter_is_used_by_name(folder: Path) -> None:
    rows = cells(folder, "--codes my-code", installed=True)
    assert len(rows) == 21
    assert {c.verdict for c in rows} == {"pass"}


@pytest.mark.slow
def test_an_installed_adapter_is_listed(folder: Path) -> None:
    listed = run(folder, *typed("southwell codes"), installed=True).stdout
    row = next(line for line in listed.splitlines() if "my-code" in line)  # its longer fields may go on below
    assert re.search(r"my-code\s+My\b.*✔ 1\.0\s+nothing\s+prestretch", row)
