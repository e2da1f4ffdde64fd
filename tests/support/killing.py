"""A verification that is killed and run again: how, and what it must leave."""

import os
import signal
import sqlite3
import subprocess
import sys
from collections.abc import Callable, Sequence
from contextlib import closing, suppress
from pathlib import Path
from time import monotonic, sleep

from southwell.cases.judge import results  # noqa: F401 # a type of answers
from southwell.cases.store import codec

SUPPORT = Path(__file__).parent

BEAM = """
name = "stub"
title = "A short beam"
description = "For commands that are run and killed."
source = "nowhere"
[blade]
kind = "beam"
length = 2.0
hub_radius = 0.1
E = 7e10
G = 2.7e10
density = 2700.0
A = 4e-4
I_y = 2e-8
I_z = 5e-8
J = 7e-8
[speeds]
rad_s = [0.0, 10.0]
[compare]
modes = 2
"""

CASE = BEAM + "[variants.a]\n[variants.b]\nlength = 2.5\n"

CODES = "counted:FIRST,counted:SECOND,exact-beam"


def command() -> list[str]:
    """``verify`` of ``case.toml`` with codes that write down every question they are asked."""
    options = ["--codes", CODES, "--out", "out", "--faults", "none", "--workers", "1"]
    return [sys.executable, "-m", "southwell", "verify", "case.toml", *options]


def write(folder: Path) -> None:
    """Put the case into a folder."""
    (folder / "case.toml").write_text(CASE)


def start(folder: Path) -> subprocess.Popen[str]:
    """Begin ``command`` in a folder."""
    write(folder)
    return subprocess.Popen(
        command(),
        cwd=folder,
        env=environment(folder),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def environment(folder: Path) -> dict[str, str]:
    """That of the run: it finds the codes, and its processes can be found."""
    return {**os.environ, "PYTHONPATH": str(SUPPORT), "SOUTHWELL_TEST": str(folder), "MPLBACKEND": "agg"}


def ended(child: subprocess.Popen[str]) -> tuple[int, str, str]:
    """Status, standard output and standard error."""
    out, err = child.communicate(timeout=300)
    return child.returncode, out, err


def kill(child: subprocess.Popen[str], when: Callable[[], bool]) -> bool:
    """Kill the main process, and it alone, as soon as ``when`` says; whether it was still running."""
    while child.poll() is None and not when():
        sleep(0.02)
    alive = child.poll() is None
    if alive:
        os.kill(child.pid, signal.SIGKILL)
    child.communicate(timeout=60)
    return alive


def running(folder: Path) -> list[str]:
    """Processes that runs in ``folder`` have started and that are still there, a few seconds for them to go."""
    until = monotonic() + 20
    while (result := processes(folder)) and monotonic() < until:
        sleep(0.05)
    return result


def processes(folder: Path) -> list[str]:
    """Processes that runs in ``folder`` have started."""
    result = []
    for entry in Path("/proc").glob("[0-9]*/environ"):
        try:
            text = entry.read_bytes()
        except OSError:
            continue
        if f"SOUTHWELL_TEST={folder}\0".encode() in text:
            result.append(entry.parent.name)
    return result


def asked(folder: Path) -> list[str]:
    """Every question that the codes were asked, in their order."""
    path = folder / "asked.txt"
    return path.read_text().splitlines() if path.exists() else []


def answers(path: Path) -> int:
    """Number of answers in the file of an unfinished run."""
    return len(_rows(path, "label != 'run'"))


def stored(path: Path) -> list[str]:
    """Code and blade of each of these codes' columns in the file of an unfinished run."""
    first = [cells[0] for (value,) in _rows(path, "label = 'rows'") if (cells := codec.decode(value)[0])]
    return [f"{cell.code} {cell.case}" for cell in first if cell.code.startswith(("first", "second"))]


def _rows(path: Path, where: str) -> list[tuple[bytes]]:
    if not path.exists():
        return []
    with closing(sqlite3.connect(path, timeout=20)) as base, suppress(sqlite3.OperationalError):  # no table yet
        return base.execute(f"select value from answers where {where} order by computed").fetchall()
    return []


def files(folder: Path) -> Sequence[str]:
    """Every file in a folder and below, by its path in it."""
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())
