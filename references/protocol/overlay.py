"""Other releases of a code: each in a folder of its own, which a worker process searches before everything else.

The folder holds the release and its dependencies, except the libraries that Southwell itself uses (NumPy, SciPy, …):
these are those of the environment, so that core, the adapter and the release use the same ones. Only wheels are
installed, because a source package would run its own code during installation.
"""

import json
import shutil
import site
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import InvalidVersion, Version

from .cache import cache
from .process import one_line

READY = "ready"
"""Name of the file that marks a complete folder."""


class ReleaseError(RuntimeError):
    """A release could not be installed, or releases not be listed; the message names it and quotes pip."""


def folder(name: str, release: str) -> Path:
    """Folder of a release of the distribution ``name``, for this version of Python; it need not exist."""
    return cache() / "versions" / f"{canonicalize_name(name)}-{Version(release)}-{sys.implementation.cache_tag}"


def install(name: str, release: str) -> Path:
    """Install a release of the distribution ``name`` unless it is there; return its folder.

    Raises:
        ReleaseError: if pip cannot install it (no such release, no wheel for this Python, conflicting dependencies), or
            the cache folder cannot be written.
    """
    to = folder(name, release)
    if complete(to):
        return to
    try:
        _install(f"{name}=={release}", to)
    except ReleaseError:
        shutil.rmtree(to, ignore_errors=True)
        raise
    except OSError as error:
        why = f"cannot be written ({error.strerror}): set SOUTHWELL_CACHE to another folder"
        raise ReleaseError(f"{name}=={release}: {to}: {why}") from error
    return to


def complete(path: Path) -> bool:
    """Whether the folder of a release is completely installed."""
    return (path / READY).exists()


def _install(wanted: str, to: Path) -> None:
    shutil.rmtree(to, ignore_errors=True)  # incomplete
    to.mkdir(parents=True)
    shared = _shared()
    limits = to / "constraints.txt"
    limits.write_text("".join(f"{one}=={known}\n" for one, known in shared.items()), encoding="utf-8")
    options = ["--progress-bar", "off", "--only-binary=:all:"]
    report = to / "resolved.json"
    resolve = ["--dry-run", "--ignore-installed", "--report", str(report), "--constraint", str(limits)]
    _pip(wanted, "install", *options, *resolve, wanted)
    resolved = json.loads(report.read_text(encoding="utf-8"))
    found = {canonicalize_name(one["metadata"]["name"]): one["metadata"]["version"] for one in resolved["install"]}
    pins = [f"{one}=={known}" for one, known in found.items() if one not in shared]
    _pip(wanted, "install", *options, "--no-deps", "--target", str(to), *pins)
    (to / READY).write_text("\n".join(pins) + "\n", encoding="utf-8")


def releases(name: str) -> list[str]:
    """Releases of the distribution ``name`` that pip finds for this Python, oldest first, without pre-releases.

    Raises:
        ReleaseError: if pip finds none.
    """
    said = _pip(name, "index", "versions", name)
    listed = next((line for line in said.splitlines() if line.startswith("Available versions:")), "")
    return sorted((one.strip() for one in listed.partition(":")[2].split(",") if one.strip()), key=Version)


def search_first(path: Path) -> None:
    """Make this process import from the folder of a release before everything else, its path files (.pth) included."""
    for entry in path.iterdir():
        sys.modules.pop(entry.stem, None)  # loaded by the environment's own path files
    before = list(sys.path)
    site.addsitedir(str(path))
    sys.path[:] = [one for one in sys.path if one not in before] + before


def same(one: str | None, other: str) -> bool:
    """Whether two texts name the same release, as ``1.9`` and ``1.9.0`` do."""
    try:
        return one is not None and Version(one) == Version(other)
    except InvalidVersion:
        return one == other


def _pip(about: str, *words: str) -> str:
    """Standard output of pip, which runs outside the current folder's modules."""
    command = [sys.executable, "-P", "-m", "pip", "--disable-pip-version-check", "--no-input", *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise ReleaseError(f"{about}: pip {words[0]}: {one_line(_reason(done.stdout, done.stderr))}")
    return done.stdout


def _reason(out: str, err: str) -> str:
    """What pip says about a failure: the dependencies in conflict, or its error."""
    _, conflict, causes = out.partition("The conflict is caused by:")
    if conflict:
        return "conflicting dependencies: " + "; ".join(causes.strip().partition("\n\n")[0].splitlines())
    lines = err.strip().splitlines() or ["no message"]
    errors = [line.removeprefix("ERROR:").strip() for line in lines if line.startswith("ERROR")]
    return errors[-1] if errors else lines[-1]


def _shared() -> dict[str, str]:
    """Name and version of Southwell and of every installed distribution that it requires, directly or not."""
    found = {"southwell": version("southwell")}
    todo = ["southwell"]
    while todo:
        for text in requires(todo.pop()) or ():
            one = Requirement(text)
            name = canonicalize_name(one.name)
            if name in found or (one.marker and not one.marker.evaluate({"extra": ""})):
                continue
            try:
                found[name] = version(name)
            except PackageNotFoundError:
                continue
            todo.append(name)
    return found
