"""Codes whose dependencies conflict with this package, in isolated environments: pinned, cached, called by JSON.

There ``answer.py`` runs a module of this folder, which imports nothing but the code and NumPy.
"""

import json
import os
import shutil
import subprocess
import sys
import venv
from ctypes.util import find_library
from dataclasses import dataclass
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from typing import Any

from ..protocol.cache import cache
from ..protocol.interface import CodeError
from .hashes import PLATFORMS, requirements


class EnvironmentMissingError(RuntimeError):
    """An environment could not be created; the message names it and quotes pip."""


@dataclass(frozen=True)
class Environment:
    """The isolated environment of one code.

    Attributes:
        name: name of the code.
        requires: pinned requirements.
        bare: pinned packages installed without their declared dependencies; the code itself is first.
        module: name of the module in this folder that answers a request.
        libraries: names of shared libraries of the system that it loads, without ``lib``.
        packages: Debian packages that have them.
    """

    name: str
    requires: tuple[str, ...]
    bare: tuple[str, ...]
    module: str
    libraries: tuple[str, ...] = ()
    packages: tuple[str, ...] = ()

    @property
    def folder(self) -> Path:
        """Folder of the environment, which depends on the pins and the Python version; it need not exist."""
        pins = sha256("\n".join((sys.version, *self.requires, *self.bare)).encode()).hexdigest()[:12]
        return cache() / f"{self.name}-{pins}"

    @property
    def python(self) -> Path:
        """Its Python interpreter."""
        return self.folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")

    @property
    def created(self) -> bool:
        """Whether the environment is complete."""
        return (self.folder / READY).exists()

    @property
    def lacking(self) -> str:
        """Command that installs the missing libraries of the system; empty if none is missing."""
        libraries = ", ".join(f"lib{name}" for name in self.libraries if find_library(name) is None)
        return f"apt-get install {' '.join(self.packages)} (not found: {libraries})" if libraries else ""

    @property
    def hint(self) -> str:
        """Command that installs the missing part."""
        return (self.created and self.lacking) or f"southwell codes install {self.name}"

    def version(self) -> str | None:
        """The code's version; None if the environment has not been created or the system lacks a library."""
        return self.bare[0].partition("==")[2] if self.created and not self.lacking else None


READY = "ready"
"""Name of the file that marks a complete environment."""

SHARPY = Environment(
    "sharpy",
    ("numpy==1.26.4", "scipy==1.13.1", "colorama==0.4.6"),
    ("ic-sharpy==2.4",),
    "sharpy_worker",
    ("lapack", "gfortran", "gomp"),
    ("liblapack3", "libgfortran5", "libgomp1"),
)

FRAME3DD = Environment("frame3dd", ("numpy==1.26.4",), ("wisdem==4.2.9",), "frame3dd_worker")

ENVIRONMENTS = {e.name: e for e in (SHARPY, FRAME3DD)}
"""Environments by the code's name."""


def install(environment: Environment) -> Path:
    """Create an environment, replacing an earlier incomplete one; return its folder.

    Raises:
        EnvironmentMissingError: the system lacks a library, or pip could not install it.
    """
    if problem := environment.lacking:
        raise EnvironmentMissingError(f"{environment.name}: {problem}")
    folder = environment.folder
    shutil.rmtree(folder, ignore_errors=True)
    venv.create(folder, with_pip=True)
    pip = [str(environment.python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    pins = (*environment.requires, *environment.bare)
    (folder / "requirements.txt").write_text(requirements(pins), encoding="utf-8")
    # no dependencies: all are pinned; no source packages: build requirements would be fetched without a hash
    options = [
        "--require-hashes",
        "--no-deps",
        "--only-binary=:all:",
        "--requirement",
        str(folder / "requirements.txt"),
    ]
    completed = subprocess.run([*pip, *options], capture_output=True, text=True, check=False)
    if completed.returncode:
        errors = [line for line in completed.stderr.splitlines() if line.startswith("ERROR")] or ["no message"]
        raise EnvironmentMissingError(
            f"{environment.name}: pip install {' '.join(pins)}: {errors[0]} (hashes are available for {PLATFORMS} only)"
        )
    (folder / READY).write_text(f"southwell {version('southwell')}\n", encoding="utf-8")
    return folder


def ask(environment: Environment, request: dict[str, Any]) -> dict[str, Any]:
    """Run the environment's module on a request and return its answer; ``process.Limits`` limits its time and memory.

    Raises:
        CodeError: the environment has not been created, or its process crashed or reported an error.
    """
    if environment.version() is None:
        raise CodeError(f"{environment.name} is not installed: {environment.hint}")
    script = Path(__file__).with_name("answer.py")
    completed = subprocess.run(
        [str(environment.python), "-I", str(script), environment.module],
        input=json.dumps(request),
        capture_output=True,
        text=True,
        check=False,
    )
    if completed.returncode or not completed.stdout:
        last = (completed.stderr.strip().splitlines() or ["no message"])[-1]
        raise CodeError(f"{environment.name}: its process ended with exit status {completed.returncode}: {last}")
    answer = json.loads(completed.stdout)
    if "error" in answer:
        raise CodeError(f"{environment.name}: {answer['error']}")
    return answer
