"""Digests of tasks: the same question to the same version of the same code has the same digest.

A task of the matrix is a pure function of its arguments. Its digest covers the function's name, the arguments by value
(every bit of every array), the sources of this package, the versions of the libraries it uses, and the source of the
code that answers. It does not depend on the process, the folder or the number of workers.
"""

import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import lru_cache, partial
from hashlib import sha256
from importlib.machinery import PathFinder
from importlib.metadata import version
from pathlib import Path, PurePath
from platform import python_version
from types import FunctionType
from typing import Any

import msgspec
import numpy as np

from ...references.protocol.registry import locate

FLOORS = ("core", "references", "cases")
"""Parts of this package that compute answers; the others present them."""

LIBRARIES = ("numpy", "scipy", "numba")

TIME = "seconds"
"""The field with the time an answer took; not part of a digest."""


def digest(task: Callable[..., Any], *arguments: Any) -> str:
    """The digest of a task: 64 hexadecimal digits.

    Raises:
        TypeError: if an argument has no value to digest, such as a lambda or an open file.
    """
    made = sha256(package().encode())
    for part in _parts((task, arguments)):
        made.update(b"%d:" % len(part))
        made.update(part)
    return made.hexdigest()


def _parts(value: Any) -> Iterator[bytes]:
    """The value as a sequence of byte strings; containers include type and length, so that different values differ."""
    kind = type(value)
    if value is None or kind in (bool, int, float, complex):
        yield kind.__name__.encode()
        yield repr(value).encode()
    elif isinstance(value, str | PurePath):
        yield b"str"
        yield str(value).encode("utf-8", "surrogatepass")
    elif isinstance(value, bytes):
        yield b"bytes"
        yield value
    elif isinstance(value, np.ndarray | np.generic):
        yield f"array {value.dtype.str} {value.shape}".encode()
        yield np.ascontiguousarray(value).tobytes()
    elif isinstance(value, partial):
        yield from _tagged("partial", (value.func, value.args, value.keywords))
    elif isinstance(value, Enum | FunctionType | type):
        name = value.name if isinstance(value, Enum) else ""
        of = kind if isinstance(value, Enum) else value
        if "<" in of.__qualname__:
            raise TypeError(f"{of.__qualname__}: an anonymous function cannot be identified")
        yield f"named {of.__module__}.{of.__qualname__}.{name}".encode()
    elif is_dataclass(value):
        yield from _tagged(_name(kind), tuple(getattr(value, f.name) for f in fields(value) if f.name != TIME))
    elif isinstance(value, msgspec.Struct):
        yield from _tagged(_name(kind), tuple(getattr(value, name) for name in value.__struct_fields__))
    elif isinstance(value, Mapping):
        yield from _tagged("mapping", tuple(value.items()))
    elif isinstance(value, list | tuple):
        yield from _tagged("sequence", tuple(value))
    elif isinstance(value, set | frozenset):
        yield from _tagged("set", tuple(sorted(b"".join(_parts(member)) for member in value)))
    elif kind is type(msgspec.UNSET):
        yield b"unset"
    else:
        yield from _tagged(_name(kind), _state(value))


def _tagged(name: str, members: tuple[Any, ...]) -> Iterator[bytes]:
    yield f"{name} {len(members)}".encode()
    for member in members:
        yield from _parts(member)


def _name(kind: type) -> str:
    return f"{kind.__module__}.{kind.__qualname__}"


def _state(value: Any) -> tuple[Any, ...]:
    """The state from which pickle would rebuild an object."""
    reduced = value.__reduce_ex__(2)
    if isinstance(reduced, str):
        raise TypeError(f"{_name(type(value))}: cannot be identified by its value")
    return reduced[1:3]


@lru_cache
def package() -> str:
    """The digest of this package's sources and data, and of the versions of Python and the libraries it uses."""
    root = Path(__file__).parents[2]
    made = sha256(repr([python_version(), *((name, version(name)) for name in LIBRARIES)]).encode())
    for floor in FLOORS:
        for path in sorted(p for p in (root / floor).rglob("*") if p.is_file() and "__pycache__" not in p.parts):
            made.update(path.relative_to(root).as_posix().encode() + b"\0" + path.read_bytes())
    return made.hexdigest()


def adapter(name: str) -> str:
    """The digest of a code's source, found without importing it: the modules of its folder, or its whole package.

    Empty for codes of this package, whose sources are covered by ``package``, and for codes without source.

    Raises:
        UnknownCodeError: if no such code is known.
    """
    module = locate(name).partition(":")[0].partition(".")[0]
    if module == __name__.partition(".")[0]:
        return ""
    spec = PathFinder.find_spec(module, sys.path)
    if spec is None:
        return ""
    folders = [Path(place) for place in spec.submodule_search_locations or ()]
    files = [p for folder in folders for p in folder.rglob("*.py")]
    if not folders and spec.origin:
        files = list(Path(spec.origin).resolve().parent.glob("*.py"))
    made = sha256()
    for path in sorted(files):
        made.update(path.name.encode() + b"\0" + path.read_bytes())
    return made.hexdigest()
