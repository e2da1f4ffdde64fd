"""Lossless conversion of answers to JSON and back: rows, references of core, and other results of a run's tasks.

Only the dataclasses listed here are rebuilt, from their fields; no content is executed.
"""

import zlib
from base64 import b64decode, b64encode
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from math import isfinite
from typing import Any

import numpy as np

from ...core.effects import Effects
from ...core.modes import Modes
from ...references.protocol.mechanism_interface import MechanismModes
from ...references.protocol.worker import Failure
from ..judge.pairing import Pair
from ..judge.results import BudgetEntry, Cell, Control, Level
from ..judge.uncertainty import Estimate
from ..judge.verdict import Effect
from . import mechanism_columns
from .core_solver import Converged
from .reference import Reference
from .refinement import RefinedMode, Wanted

TYPES: dict[str, type] = {
    kind.__name__: kind
    for kind in (Cell, Control, Level, BudgetEntry, Effects, Modes, MechanismModes, Failure, Pair, Estimate, Effect)
} | {
    "Converged": Converged,
    "Reference": Reference,
    "MechanismReference": mechanism_columns.Reference,
    "RefinedMode": RefinedMode,
    "Wanted": Wanted,
}
"""Name in the file → dataclass."""

NAMES = {kind: name for name, kind in TYPES.items()}


def encode(value: Any) -> Any:
    """Encode a value as lists, strings and numbers; types that JSON lacks become a list that begins with the type.

    Raises:
        TypeError: if it contains a type that is not listed in ``TYPES``.
    """
    if isinstance(value, np.ndarray):
        packed = zlib.compress(np.ascontiguousarray(value).tobytes(), 1)
        return ["array", value.dtype.str, list(value.shape), b64encode(packed).decode()]
    if isinstance(value, np.generic):
        return encode(value.item())
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return float(value) if isfinite(value) else ["float", repr(float(value))]
    if is_dataclass(value) and type(value) in NAMES:
        return [NAMES[type(value)], *(encode(getattr(value, f.name)) for f in fields(value))]
    if isinstance(value, dict):
        return ["dict", *([encode(k), encode(v)] for k, v in value.items())]
    if isinstance(value, list | tuple):
        return ["list" if isinstance(value, list) else "tuple", *map(encode, value)]
    raise TypeError(f"{type(value).__name__}: not an answer that can be stored")


def decode(value: Any) -> Any:
    """Decode a value written by ``encode``.

    Raises:
        ValueError: if ``encode`` does not write such a value.
    """
    try:
        return _decode(value)
    except (TypeError, KeyError, IndexError, zlib.error) as error:
        raise ValueError(f"not a stored answer: {error}") from error


def _decode(value: Any) -> Any:
    if not isinstance(value, list):
        return value
    kind, *rest = value
    return MAKE[kind](*rest) if kind in MAKE else TYPES[kind](*map(_decode, rest))


def _array(dtype: str, shape: list[int], packed: str) -> np.ndarray:
    content = zlib.decompress(b64decode(packed))
    return np.frombuffer(content, dtype=np.dtype(dtype)).reshape(shape).copy()


MAKE: dict[str, Callable[..., Any]] = {
    "array": _array,
    "float": float,
    "dict": lambda *pairs: {_decode(k): _decode(v) for k, v in pairs},
    "list": lambda *members: [_decode(m) for m in members],
    "tuple": lambda *members: tuple(_decode(m) for m in members),
}
"""Kind → constructor, for kinds that are not dataclasses."""
