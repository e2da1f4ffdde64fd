"""Digests of sources: of this package, one for all, and of each code of another package.

A user does not change the sources of this package, so that one digest serves every answer; a developer's change makes every
earlier answer a different one.
"""

import sys
from collections.abc import Iterable
from functools import lru_cache
from hashlib import sha256
from importlib.machinery import PathFinder
from importlib.metadata import version
from pathlib import Path
from platform import python_version

from . import registry

ROOT = Path(__file__).parents[2]

FLOORS = ("core", "references", "cases", "reports")

SUFFIXES = frozenset({".py", ".hpp", ".cpp", ".toml", ".csv", ".dat"})
"""Files that determine answers. Of compiled modules the sources count."""

LIBRARIES = ("numpy", "scipy", "matplotlib")


@lru_cache
def package() -> str:
    """Digest of the sources of this package, and of the versions of Python and the libraries they use."""
    files = (path for floor in FLOORS for path in (ROOT / floor).rglob("*") if path.suffix in SUFFIXES)
    versions = [python_version(), *((name, version(name)) for name in LIBRARIES)]
    return _digest(ROOT, files, repr(versions))


def bundled(code: str) -> bool:
    """Whether a code, by name or import path, is one of this package.

    Raises:
        UnknownCodeError: if no such code is known.
    """
    return registry.bundled(registry.locate(code))


def adapter(code: str) -> str:
    """Digest of the source of a code: of this package for its codes, of the code's own package for others.

    Empty for a code without source.

    Raises:
        UnknownCodeError: if no such code is known.
    """
    if bundled(code):
        return package()
    top = registry.locate(code).partition(":")[0].partition(".")[0]
    spec = PathFinder.find_spec(top, sys.path)
    if spec is None:
        return ""
    if spec.submodule_search_locations:
        folders = [Path(name) for name in spec.submodule_search_locations]
        return sha256("".join(_digest(f, f.rglob("*.py")) for f in folders).encode()).hexdigest()
    folder = Path(spec.origin or "").resolve().parent
    return _digest(folder, folder.glob("*.py")) if spec.origin else ""


def _digest(root: Path, files: Iterable[Path], prefix: str = "") -> str:
    checksum = sha256(prefix.encode())
    for path in sorted(files):
        checksum.update(path.relative_to(root).as_posix().encode() + b"\0" + sha256(path.read_bytes()).digest())
    return checksum.hexdigest()
