"""Compiled loops, and the products of small matrices they are made of.

Functions that run for every element at every speed are compiled by numba at their first call and cached on disk. The cache
folder is named after a digest of their sources, so a change to one of them invalidates all.
"""

import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import numpy as np
from numba.core import config, event
from numpy.typing import NDArray

from . import compiled_files
from .first_use import FirstUse

Array = NDArray[np.float64]
F = TypeVar("F", bound=Callable[..., Any])

_HERE = Path(__file__).parent
_HOW: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}, "no_cfunc_wrapper": True}
_REORDERED: dict[str, Any] = {**_HOW, "fastmath": {"contract", "reassoc"}}

_MARKS = (b"@compiled", b"@inlined", b"@inner", b"@reduction")  # of files with compiled code


@cache
def _folder() -> Path | None:
    """The cache folder: next to the sources if they are writable, else in the user's cache, else in a temporary folder. Only
    folders that nobody else can write to are used, since their content is executed. None: there is no such folder."""
    sources = [p.read_bytes() for p in sorted(_HERE.rglob("*.py"))]
    loops = (s for s in sources if any(mark in s for mark in _MARKS))
    name = "compiled-" + hashlib.sha256(b"".join(loops)).hexdigest()[:12]
    for place in _places():
        if folder := compiled_files.folder(place, name):
            if place.parent == _HERE:  # other places may hold the cache of another installation
                for old in set(place.glob("compiled-*")) - {folder}:
                    shutil.rmtree(old, ignore_errors=True)
            return folder
    return None


def _places() -> Iterator[Path]:
    yield _HERE / "__pycache__"
    if chosen := os.environ.get("SOUTHWELL_CACHE"):
        yield Path(chosen)
    else:
        with suppress(RuntimeError):  # neither HOME nor an entry in the system's list of users
            yield Path.home() / ".cache" / "southwell"
    with suppress(OSError):  # no temporary folder either
        yield Path(tempfile.gettempdir()) / f"southwell-{os.getuid() if hasattr(os, 'getuid') else 'user'}"


event.register("numba:compile", FirstUse(_folder))


def compiled(f: F) -> F:
    """Compile ``f`` to machine code: arrays must be C-contiguous; division by zero gives inf or nan, as in numpy."""
    folder = _folder()
    if folder is None or config.DISABLE_JIT:  # type: ignore[attr-defined]
        return cast(F, numba.njit(f, **_HOW))
    before = config.CACHE_DIR  # type: ignore[attr-defined]
    config.CACHE_DIR = str(folder)  # type: ignore[attr-defined]
    try:
        out: Any = numba.njit(f, cache=True, **_HOW)
    finally:
        config.CACHE_DIR = before  # type: ignore[attr-defined]
    compiled_files.check(out)
    return cast(F, out)


def inlined(f: F) -> F:
    """Inline ``f`` where compiled code calls it: for a few lines called very often."""
    return cast(F, numba.njit(f, inline="always", **_HOW))


def inner(f: F) -> F:
    """``compiled`` for functions that only compiled code calls; it is not stored by itself."""
    return cast(F, numba.njit(f, **_HOW))


def reduction(f: F) -> F:
    """``inner`` for sums over long rows: the order of the terms may be changed, for vector instructions."""
    return cast(F, numba.njit(f, **_REORDERED))


@compiled
def clear(out: Array) -> None:
    """out = 0 for a matrix."""
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            out[i, j] = 0.0


@compiled
def product(a: Array, b: Array, out: Array) -> None:
    """out = a b for a (m, 6) and b (6, n), in the columns that ``out`` and b share; further columns of a are ignored."""
    for i in range(a.shape[0]):
        a0, a1, a2, a3, a4, a5 = a[i, 0], a[i, 1], a[i, 2], a[i, 3], a[i, 4], a[i, 5]
        for j in range(min(b.shape[1], out.shape[1])):
            out[i, j] = a0 * b[0, j] + a1 * b[1, j] + a2 * b[2, j] + a3 * b[3, j] + a4 * b[4, j] + a5 * b[5, j]


@compiled
def transposed_product(a: Array, b: Array, out: Array) -> None:
    """out = aᵀ b for a (6, m) and b (6, n), in the columns that ``out`` and b share."""
    for i in range(a.shape[1]):
        a0, a1, a2, a3, a4, a5 = a[0, i], a[1, i], a[2, i], a[3, i], a[4, i], a[5, i]
        for j in range(min(b.shape[1], out.shape[1])):
            out[i, j] = a0 * b[0, j] + a1 * b[1, j] + a2 * b[2, j] + a3 * b[3, j] + a4 * b[4, j] + a5 * b[5, j]


@inner
def add_transposed_product(a: Array, b: Array, out: Array) -> None:
    """Add aᵀ b, for a (6, m) and b (6, n), to the last m rows of ``out``."""
    first = len(out) - a.shape[1]
    for i in range(a.shape[1]):
        a0, a1, a2, a3, a4, a5 = a[0, i], a[1, i], a[2, i], a[3, i], a[4, i], a[5, i]
        for j in range(b.shape[1]):
            more = a0 * b[0, j] + a1 * b[1, j] + a2 * b[2, j] + a3 * b[3, j] + a4 * b[4, j] + a5 * b[5, j]
            out[first + i, j] += more


@compiled
def apply(a: Array, v: Array, out: Array) -> None:
    """out = a v for a (m, 6) and v (6,)."""
    for i in range(a.shape[0]):
        out[i] = a[i, 0] * v[0] + a[i, 1] * v[1] + a[i, 2] * v[2] + a[i, 3] * v[3] + a[i, 4] * v[4] + a[i, 5] * v[5]


@compiled
def transposed_apply(a: Array, v: Array, out: Array) -> None:
    """out = aᵀ v for a (6, n) and v (6,)."""
    for j in range(a.shape[1]):
        out[j] = a[0, j] * v[0] + a[1, j] * v[1] + a[2, j] * v[2] + a[3, j] * v[3] + a[4, j] * v[4] + a[5, j] * v[5]


@compiled
def congruence(a: Array, m: Array, work: Array, out: Array) -> None:
    """out = aᵀ m a for a (6, n) and m (6, 6); ``work`` has the shape of ``a``."""
    product(m, a, work)
    transposed_product(a, work, out)


@compiled
def invert(a: Array, first: int) -> int:
    """Invert the part of a small matrix from row and column ``first`` on in place, by Gauss–Jordan elimination, no pivoting.

    Of ``[[X, Y], [W, Z]]``, Z the part to invert, remains ``[[X − Y Z⁻¹ W, −Y Z⁻¹], [Z⁻¹ W, Z⁻¹]]``.

    Returns 2 if all pivots are positive, 1 if some are negative, and 0, with the inversion incomplete, if one is zero or not
    finite.
    """
    d, kind = len(a), 2
    for p in range(first, d):
        pivot = a[p, p]
        if pivot == 0.0 or not np.isfinite(pivot):
            return 0
        if pivot < 0.0:
            kind = 1
        a[p, p] = 1.0
        for j in range(d):
            a[p, j] /= pivot
        for i in range(d):
            if i != p:
                factor = a[i, p]
                a[i, p] = 0.0
                for j in range(d):
                    a[i, j] -= factor * a[p, j]
    return kind
