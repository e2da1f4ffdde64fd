"""Lossless conversion of answers to bytes and back: JSON of rows, references of core, and other results of a run's tasks.

Only dataclasses of imported modules of this package are rebuilt, from their fields; no content is executed. The time that an
answer took is not restored: it was measured in another run, perhaps on a busy machine.
"""

import sys
import zlib
from base64 import b64decode, b64encode
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from math import isfinite, nan
from typing import Any

import msgspec
import numpy as np

from .digest import TIME

PACKAGE = __name__.partition(".")[0]


def encode(value: Any) -> bytes:
    """Encode a value.

    Raises:
        TypeError: if it contains an object that is neither plain, an array, nor a dataclass of this package.
    """
    return msgspec.json.encode(_plain(value))


def decode(content: bytes) -> Any:
    """Decode a value written by ``encode``; a field ``seconds`` is nan.

    Raises:
        ValueError: if ``encode`` does not write such content.
    """
    try:
        return _decoded(msgspec.json.decode(content))
    except (ValueError, TypeError, KeyError, AttributeError, zlib.error) as error:
        raise ValueError(f"not a stored answer: {error}") from error


def _plain(value: Any) -> Any:
    """Lists, strings and numbers; types that JSON lacks become a list that begins with the type."""
    if isinstance(value, np.ndarray):
        compressed = zlib.compress(np.ascontiguousarray(value).tobytes(), 1)
        return ["array", value.dtype.str, list(value.shape), b64encode(compressed).decode()]
    if isinstance(value, np.generic):
        return _plain(value.item())
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return float(value) if isfinite(value) else ["float", repr(float(value))]
    if isinstance(value, dict):
        return ["dict", *([_plain(k), _plain(v)] for k, v in value.items())]
    if isinstance(value, list | tuple):
        return ["list" if isinstance(value, list) else "tuple", *map(_plain, value)]
    kind = type(value)
    if is_dataclass(kind) and kind.__module__.startswith(f"{PACKAGE}."):
        return [f"{kind.__module__}:{kind.__qualname__}", *(_plain(getattr(value, f.name)) for f in fields(kind))]
    raise TypeError(f"{kind.__name__}: not an answer that can be stored")


def _decoded(value: Any) -> Any:
    if not isinstance(value, list):
        return value
    kind, *members = value
    return CONTAINERS[kind](*members) if kind in CONTAINERS else _dataclass(kind, members)


def _dataclass(name: str, members: list[Any]) -> Any:
    module, _, kind = name.partition(":")
    if not module.startswith(f"{PACKAGE}."):
        raise ValueError(f"{name}: not a type of this package")
    type_ = getattr(sys.modules[module], kind)
    names = [f.name for f in fields(type_)]
    return type_(**{n: nan if n == TIME else _decoded(member) for n, member in zip(names, members, strict=True)})


def _array(dtype: str, shape: list[int], compressed: str) -> np.ndarray:
    content = zlib.decompress(b64decode(compressed))
    return np.frombuffer(content, dtype=np.dtype(dtype)).reshape(shape).copy()


CONTAINERS: dict[str, Callable[..., Any]] = {
    "array": _array,
    "float": float,
    "dict": lambda *pairs: {_decoded(k): _decoded(v) for k, v in pairs},
    "list": lambda *members: [_decoded(m) for m in members],
    "tuple": lambda *members: tuple(_decoded(m) for m in members),
}
"""Kind → constructor, for kinds that are not dataclasses."""
