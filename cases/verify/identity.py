"""Digests of tasks: the same question to the same version of the same code has the same digest.

A task of the matrix is a pure function of its arguments. Its digest covers the function's name, the arguments by value
(every bit of every array), the sources on which all functions and classes among them depend, and the versions of Python and
the libraries these use. A column also has the digest of the source of its code. It does not depend on the process, the folder
or the number of workers.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import partial
from hashlib import sha256
from pathlib import PurePath
from types import FunctionType
from typing import Any

import msgspec
import numpy as np

from ...references.protocol import sources

TIME = "seconds"
"""The field with the time an answer took; not part of a digest."""


def digest(task: Callable[..., Any], *arguments: Any) -> str:
    """The digest of a task: 64 hexadecimal digits.

    Raises:
        TypeError: if an argument has no value to digest, such as a lambda or an open file.
    """
    made, modules = sha256(), set[str]()
    for part in _parts((task, arguments), modules):
        made.update(b"%d:" % len(part))
        made.update(part)
    made.update(sources.digest(frozenset(modules)).encode())
    return made.hexdigest()


def _parts(value: Any, modules: set[str]) -> Iterator[bytes]:
    """The value as a sequence of byte strings; containers include type and length, so that different values differ.

    The modules of all functions and classes in it are added to ``modules``.
    """
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
        yield from _tagged("partial", (value.func, value.args, value.keywords), modules)
    elif isinstance(value, Enum | FunctionType | type):
        name = value.name if isinstance(value, Enum) else ""
        of = kind if isinstance(value, Enum) else value
        if "<" in of.__qualname__:
            raise TypeError(f"{of.__qualname__}: an anonymous function cannot be identified")
        modules.add(of.__module__)
        yield f"named {of.__module__}.{of.__qualname__}.{name}".encode()
    elif is_dataclass(value):
        modules.add(kind.__module__)
        yield from _tagged(_name(kind), tuple(getattr(value, f.name) for f in fields(value) if f.name != TIME), modules)
    elif isinstance(value, msgspec.Struct):
        modules.add(kind.__module__)
        yield from _tagged(_name(kind), tuple(getattr(value, name) for name in value.__struct_fields__), modules)
    elif isinstance(value, Mapping):
        yield from _tagged("mapping", tuple(value.items()), modules)
    elif isinstance(value, list | tuple):
        yield from _tagged("sequence", tuple(value), modules)
    elif isinstance(value, set | frozenset):
        yield from _tagged("set", tuple(sorted(b"".join(_parts(member, modules)) for member in value)), modules)
    elif kind is type(msgspec.UNSET):
        yield b"unset"
    else:
        modules.add(kind.__module__)
        yield from _tagged(_name(kind), _state(value), modules)


def _tagged(name: str, members: tuple[Any, ...], modules: set[str]) -> Iterator[bytes]:
    yield f"{name} {len(members)}".encode()
    for member in members:
        yield from _parts(member, modules)


def _name(kind: type) -> str:
    return f"{kind.__module__}.{kind.__qualname__}"


def _state(value: Any) -> tuple[Any, ...]:
    """The state from which pickle would rebuild an object."""
    reduced = value.__reduce_ex__(2)
    if isinstance(reduced, str):
        raise TypeError(f"{_name(type(value))}: cannot be identified by its value")
    return reduced[1:3]
