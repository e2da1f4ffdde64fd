"""Every command works with processes that are started, not forked, and without the modules that Windows lacks."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.references.protocol import portable, process, worker
from southwell.references.protocol.process import Failure, Limits
from southwell.reports.cli.app import COMMANDS

from ...reports.cli.test_cli import BEAM

BLADE = library.load("park-cantilever").variants[0].blade

AS_ON_WINDOWS = """
import os, select, signal, socket, sys
# these have other code for Windows
import asyncio, multiprocessing.popen_spawn_posix, multiprocessing.resource_tracker, portalocker, selectors, subprocess
multiprocessing.resource_tracker._HAVE_SIGMASK = False
sys.modules.update(dict.fromkeys(("fcntl", "resource", "pwd", "grp", "termios")))
for module, names in (
    (os, ("fork", "setsid", "killpg", "waitstatus_to_exitcode")),
    (signal, ("pthread_sigmask",)),
    (socket, ("send_fds", "recv_fds")),
    (select, ("poll",)),
):
    for name in names:
        delattr(module, name)
from southwell.references.protocol import portable
portable.duplicate = os.dup
"""


@pytest.fixture
def spawn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(portable.SPAWN, "1")
    monkeypatch.setattr(process.launch, "prepare", lambda: pytest.fail("a process was forked"))


@pytest.mark.usefixtures("spawn")
def test_a_spawned_code_gives_the_answers_of_a_forked_one(monkeypatch: pytest.MonkeyPatch) -> None:
    runs = [(10.0, 8, 2), (0.0, 8, 2)]
    spawned = worker.answers("exact-beam", BLADE, runs, Limits())
    monkeypatch.undo()
    forked = worker.answers("exact-beam", BLADE, runs, Limits())
    for answer, counterpart in zip(spawned, forked, strict=True):
        assert not isinstance(answer, Failure)
        assert not isinstance(counterpart, Failure)
        np.testing.assert_array_equal(answer.frequencies, counterpart.frequencies)


MODULES = {
    "crashes": ("import os\ndef main():\n  print(flush=True); os._exit(7)", "crashed", "exit status 7"),
    "sleeps": ("import time\ndef main():\n  print(flush=True); time.sleep(60)", "timed out", "no answer within 0.3 s"),
    "shouts": ("def main():\n  print(); print('x' * 2000000, flush=True)", "nonsense", "an answer of more than 1 MiB"),
}


@pytest.mark.usefixtures("spawn")
@pytest.mark.parametrize("name", MODULES)
def test_a_spawned_process_is_limited(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text, kind, reason = MODULES[name]
    (tmp_path / f"{name}.py").write_text(text)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(process, "LONGEST_LINE", 2**20)
    lines, ended = process.converse(name, b"{}", 1, Limits(seconds=0.3))
    assert (lines, ended.kind) == ([], kind)
    assert reason in ended.reason


@pytest.mark.nightly
def test_every_command_imports_without_the_modules_that_windows_lacks() -> None:
    targets = sorted({target.partition(":")[0] for commands in COMMANDS.values() for _, target, _ in commands})
    program = (
        AS_ON_WINDOWS + f"import importlib\nfor name in {targets}: importlib.import_module('southwell.reports.' + name)"
    )
    process = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert process.returncode == 0, process.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    "line",
    [
        "modes park-cantilever --rpm 0 --modes 2",
        *(
            pytest.param(line, marks=pytest.mark.nightly)
            for line in (
                "campbell park-cantilever --rpm 0:30:30 --modes 2 --elements 8 -o out",
                "verify beam.toml --codes exact-beam --faults none --out out",
            )
        ),
    ],
)
def test_commands_work_with_spawn_alone(line: str, tmp_path: Path) -> None:
    program = (
        AS_ON_WINDOWS + f"from southwell.reports.cli.app import main\nif __name__ == '__main__': main({line.split()})"
    )
    (tmp_path / "start.py").write_text(program)
    beam = BEAM.replace("rad_s = [0.0, 10.0]", "rad_s = [0.0]")
    (tmp_path / "beam.toml").write_text(beam)
    command = [sys.executable, "-P", "start.py"]
    process = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, timeout=300)
    assert process.returncode == 0, process.stderr + process.stdout
    assert {"modes": "at rest", "campbell": "campbell.csv", "verify": "Yes: nothing contradicts"}[
        line.split()[0]
    ] in process.stdout
