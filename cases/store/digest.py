"""The digest of a task: the same question has the same digest in every process, folder and order.

A task of the matrix is a pure function of its arguments. Its digest covers the function's name and the arguments by value:
every bit of every array. Together with the digest of this package (``references.protocol.store.key``) it is the key of an
answer.
"""

from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache, partial
from hashlib import sha256
from pathlib import PurePath
from types import FunctionType
from typing import Any

import msgspec
import numpy as np

TIME = "seconds"
"""The field with the time that an answer took; not part of a digest."""


def digest(task: Callable[..., Any], *arguments: Any) -> str:
    """The digest of a task and its arguments: 64 hexadecimal digits.

    Raises:
        TypeError: if an argument has no value to digest, such as a lambda or an open file.
    """
    return _digested((task, arguments)).hex()


def _digested(value: Any) -> bytes:
    checksum = sha256()

    def add(part: bytes) -> None:
        checksum.update(b"%d:%b" % (len(part), part))

    _feed(value, add)
    return checksum.digest()


def _feed(value: Any, add: Callable[[bytes], None]) -> None:
    """Add a value as byte strings; each includes its kind, and containers their length, so that different values differ."""
    kind = type(value)
    if kind in (type(None), bool, int, float, complex):
        add(f"{kind.__name__} {value!r}".encode())
    elif isinstance(value, str | PurePath):
        add(b"str")
        add(str(value).encode("utf-8", "surrogatepass"))
    elif isinstance(value, bytes):
        add(b"bytes")
        add(value)
    elif isinstance(value, np.ndarray | np.generic):
        add(f"array {value.dtype.str} {value.shape}".encode())
        add(np.ascontiguousarray(value).tobytes())
    elif isinstance(value, Enum):
        add(f"enum {_name(kind)}.{value.name}".encode())
    elif isinstance(value, FunctionType | type):
        add(f"named {_name(value)}".encode())
    elif isinstance(value, set | frozenset):
        add(f"set {len(value)}".encode())
        for member in sorted(map(_digested, value)):
            add(member)
    else:
        name, members = _members(value)
        add(f"{name} {len(members)}".encode())
        for member in members:
            _feed(member, add)


def _members(value: Any) -> tuple[str, tuple[Any, ...]]:
    """The name of a container's kind, and its members."""
    if isinstance(value, partial):
        return "partial", (value.func, value.args, value.keywords)
    if isinstance(value, Mapping):
        return "mapping", tuple(value.items())
    if isinstance(value, list | tuple):
        return "sequence", tuple(value)
    names = _fields(type(value))
    return _name(type(value)), _state(value) if names is None else tuple(getattr(value, name) for name in names)


@cache
def _fields(kind: type) -> tuple[str, ...] | None:
    """The fields of a dataclass or a structure that count; None for other kinds."""
    if is_dataclass(kind):
        return tuple(f.name for f in fields(kind) if f.name != TIME)
    return kind.__struct_fields__ if issubclass(kind, msgspec.Struct) else None


def _name(kind: Any) -> str:
    if "<" in kind.__qualname__:
        raise TypeError(f"{kind.__qualname__}: an anonymous function cannot be identified")
    return f"{kind.__module__}.{kind.__qualname__}"


def _state(value: Any) -> tuple[Any, ...]:
    """The state from which pickle would rebuild an object."""
    reduced = value.__reduce_ex__(2)
    if isinstance(reduced, str):
        return (reduced,)
    return reduced[1:3]
