"""Digests of sources: what an answer of this package depends on, found from the import statements without importing.

A module depends on the modules of this package that it imports anywhere, on their packages, on all that these import, and on
the data files beside them.
"""

import ast
import sys
from collections.abc import Iterable, Iterator
from functools import cache, lru_cache
from hashlib import sha256
from importlib.machinery import PathFinder
from importlib.metadata import version
from pathlib import Path
from platform import python_version

from . import registry

PACKAGE = __name__.partition(".")[0]

ROOT = Path(__file__).parents[2]

LIBRARIES = ("numpy", "scipy", "matplotlib")

COMPILED = {".so", ".pyd"}
"""Endings of compiled modules. Their sources count, which lie in the folders that use them."""

PROTOCOL = f"{PACKAGE}.references.protocol"
"""The package of the processes in which codes run; all of it counts, since they start some of its files by path."""


@lru_cache
def digest(modules: frozenset[str]) -> str:
    """Digest of all that modules of this package depend on, and of the versions of Python and the libraries they use.

    Args:
        modules: full names; those of other packages do not count.
    """
    return _digest(files(modules))


def _digest(paths: Iterable[Path]) -> str:
    made = sha256(repr([python_version(), *((name, version(name)) for name in LIBRARIES)]).encode())
    for path in paths:
        made.update(path.relative_to(ROOT).as_posix().encode() + b"\0" + _content(path))
    return made.hexdigest()


@cache
def _content(path: Path) -> bytes:
    return sha256(path.read_bytes()).digest()


def files(modules: Iterable[str]) -> list[Path]:
    """Files of this package on which modules depend, sorted."""
    found: set[str] = set()
    todo = {name for name in modules if _file(name)}
    while todo:
        found |= todo
        todo = {other for name in todo for other in imported(name)} - found
    paths = {path for name in found if (path := _file(name))}
    return sorted(paths.union(*map(_data, {path.parent for path in paths})))


@cache
def _data(folder: Path) -> frozenset[Path]:
    """Files in a folder that are not modules."""
    return frozenset(path for path in folder.iterdir() if path.is_file() and path.suffix not in {".py", *COMPILED})


@cache
def imported(name: str) -> frozenset[str]:
    """Modules of this package that a module imports, in functions too, and the packages that contain them and itself."""
    path = _file(name)
    if path is None:
        return frozenset()
    package = name.split(".") if path.name == "__init__.py" else name.split(".")[:-1]
    found = {other for node in _statements(ast.parse(path.read_bytes())) for other in _named(node, package)}
    found.add(name)
    return frozenset(o for full in found for o in _upwards(full) if _file(o)) - {name}


BLOCKS = ("body", "orelse", "finalbody", "handlers", "cases")
"""Fields of statements that contain statements."""


def _statements(node: ast.AST) -> Iterator[ast.AST]:
    """All statements of a module, those within others too."""
    for block in BLOCKS:
        for child in getattr(node, block, ()):
            yield child
            yield from _statements(child)


def _named(node: ast.AST, package: list[str]) -> Iterator[str]:
    """Full names that an import statement may mean: of a name in a module both the module and a submodule."""
    if isinstance(node, ast.Import):
        yield from (one.name for one in node.names)
    elif isinstance(node, ast.ImportFrom):
        above = package[: len(package) - node.level + 1] if node.level else []
        base = ".".join([*above, *([node.module] if node.module else [])])
        yield base
        yield from (f"{base}.{one.name}" for one in node.names)


def _upwards(name: str) -> Iterator[str]:
    """A module and the packages that contain it, but the root, which imports what it is asked for."""
    parts = name.split(".")
    return (".".join(parts[:k]) for k in range(2, len(parts) + 1))


@cache
def _file(name: str) -> Path | None:
    """The file of a module of this package; None for the root and for names that are no such module."""
    first, *rest = name.split(".")
    if first != PACKAGE or not rest:
        return None
    place = ROOT.joinpath(*rest)
    return next((p for p in (place / "__init__.py", place.with_suffix(".py")) if p.is_file()), None)


FLOORS = ("core", "references", "cases")
"""Parts of this package that compute answers; the others present them."""


def package() -> str:
    """Digest of all sources that compute answers, and of the versions of Python and the libraries they use."""
    paths = (path for floor in FLOORS for path in (ROOT / floor).rglob("*") if "__pycache__" not in path.parts)
    return _digest(sorted(path for path in paths if path.is_file() and path.suffix not in COMPILED))


def bundled(code: str) -> bool:
    """Whether a code, by name or import path, is one of this package.

    Raises:
        UnknownCodeError: if no such code is known.
    """
    return registry.bundled(registry.locate(code))


def adapter(code: str) -> str:
    """Digest of the source of a code: for one of this package of all it depends on, for others of its whole package.

    All modules in the folder of a code of this package count, since some are started by path. Empty for a code without source.

    Raises:
        UnknownCodeError: if no such code is known.
    """
    module = registry.locate(code).partition(":")[0]
    if bundled(code):
        return digest(frozenset(_folder(module.rpartition(".")[0]) + _folder(PROTOCOL)))
    spec = PathFinder.find_spec(module.partition(".")[0], sys.path)
    if spec is None:
        return ""
    folders = [Path(place) for place in spec.submodule_search_locations or ()]
    found = [p for folder in folders for p in folder.rglob("*.py")]
    if not folders and spec.origin:
        found = list(Path(spec.origin).resolve().parent.glob("*.py"))
    made = sha256()
    for path in sorted(found):
        made.update(path.name.encode() + b"\0" + path.read_bytes())
    return made.hexdigest()


@cache
def _folder(package: str) -> tuple[str, ...]:
    """The modules in the folder of a package of this package."""
    folder = ROOT.joinpath(*package.split(".")[1:])
    return package, *(f"{package}.{path.stem}" for path in folder.glob("*.py") if path.stem != "__init__")
