"""Digests of tasks: the same question to the same version of the same code has the same digest.

A task of the matrix is a pure function of its arguments. Its digest covers the function's name, the arguments by value
(every bit of every array), the sources on which all functions and classes among them depend, and the versions of Python and
the libraries these use. A column also has the digest of the source of its code. It does not depend on the process, the folder
or the number of workers.
"""

from collections import OrderedDict
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

from ...references.protocol import sources

TIME = "seconds"
"""The field with the time an answer took; not part of a digest."""


PLAIN = frozenset({type(None), bool, int, float, complex})
TEXT, ARRAYS, NAMED = (str, PurePath), (np.ndarray, np.generic), (Enum, FunctionType, type)
SETS, SEQUENCES = (set, frozenset), (list, tuple)
CONTAINERS = (partial, Mapping, *SEQUENCES)
"""Kinds of values, as tuples: a union is made anew at each check."""

RECENT = 4096
"""Number of objects whose digests are kept."""


def digest(task: Callable[..., Any], *arguments: Any) -> str:
    """The digest of a task: 64 hexadecimal digits.

    Frozen dataclasses must not be changed in place: the digest of each object is computed once.

    Raises:
        TypeError: if an argument has no value to digest, such as a lambda or an open file.
    """
    made, modules = _digested((task, arguments))
    return sha256(made + sources.digest(modules).encode()).hexdigest()


def _digested(value: Any) -> tuple[bytes, frozenset[str]]:
    """The digest of a value alone, and the modules of all functions and classes in it."""
    made, modules = sha256(), set[str]()

    def add(part: bytes) -> None:
        made.update(b"%d:%b" % (len(part), part))

    _feed(value, add, modules)
    return made.digest(), frozenset(modules)


_recent: OrderedDict[int, tuple[Any, bytes, frozenset[str]]] = OrderedDict()
"""Digests of frozen dataclasses by identity; the object is kept too, so that no other gets its identity."""


def _once(value: Any) -> tuple[bytes, frozenset[str]]:
    """The digest of a frozen dataclass, computed once as long as it is among the ``RECENT`` last ones."""
    if id(value) not in _recent:
        made, modules = _digested(_members(value))
        _recent[id(value)] = value, made, modules | {type(value).__module__}
        if len(_recent) > RECENT:
            _recent.popitem(last=False)
    _, made, found = _recent[id(value)]
    return made, found


def _feed(value: Any, add: Callable[[bytes], None], modules: set[str]) -> None:
    """Add the value as byte strings; containers include type and length, so that different values differ."""
    kind = type(value)
    if kind in PLAIN:
        add(kind.__name__.encode())
        add(repr(value).encode())
    elif isinstance(value, TEXT):
        add(b"str")
        add(str(value).encode("utf-8", "surrogatepass"))
    elif isinstance(value, bytes):
        add(b"bytes")
        add(value)
    elif isinstance(value, ARRAYS):
        add(f"array {value.dtype.str} {value.shape}".encode())
        add(np.ascontiguousarray(value).tobytes())
    elif isinstance(value, NAMED):
        name = value.name if isinstance(value, Enum) else ""
        of = kind if isinstance(value, Enum) else value
        if "<" in of.__qualname__:
            raise TypeError(f"{of.__qualname__}: an anonymous function cannot be identified")
        modules.add(of.__module__)
        add(f"named {of.__module__}.{of.__qualname__}.{name}".encode())
    elif _frozen(kind):
        made, found = _once(value)
        modules |= found
        add(b"frozen")
        add(made)
    elif isinstance(value, SETS):
        found = [_digested(member) for member in value]
        add(f"set {len(found)}".encode())
        for made, its in sorted(found, key=lambda pair: pair[0]):
            modules |= its
            add(made)
    elif kind is type(msgspec.UNSET):
        add(b"unset")
    else:
        name, members = _members(value)
        if not isinstance(value, CONTAINERS):
            modules.add(kind.__module__)
        add(f"{name} {len(members)}".encode())
        for member in members:
            _feed(member, add, modules)


def _members(value: Any) -> tuple[str, tuple[Any, ...]]:
    """The name of a container's kind, and its members."""
    if isinstance(value, partial):
        return "partial", (value.func, value.args, value.keywords)
    if isinstance(value, Mapping):
        return "mapping", tuple(value.items())
    if isinstance(value, SEQUENCES):
        return "sequence", tuple(value)
    names = _fields(type(value))
    return _name(type(value)), tuple(getattr(value, name) for name in names) if names is not None else _state(value)


@cache
def _frozen(kind: type) -> bool:
    return is_dataclass(kind) and kind.__dataclass_params__.frozen  # pyright: ignore[reportAttributeAccessIssue]


@cache
def _fields(kind: type) -> tuple[str, ...] | None:
    """The fields of a dataclass or a structure that count; None for other kinds."""
    if is_dataclass(kind):
        return tuple(f.name for f in fields(kind) if f.name != TIME)
    return kind.__struct_fields__ if issubclass(kind, msgspec.Struct) else None


def _name(kind: type) -> str:
    return f"{kind.__module__}.{kind.__qualname__}"


def _state(value: Any) -> tuple[Any, ...]:
    """The state from which pickle would rebuild an object."""
    reduced = value.__reduce_ex__(2)
    if isinstance(reduced, str):
        raise TypeError(f"{_name(type(value))}: cannot be identified by its value")
    return reduced[1:3]
