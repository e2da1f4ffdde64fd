"""Numbers in exported matrices, as Fortran and Nastran write them."""

import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .exported import MatrixFileError

LARGEST_LABEL = 2**31
"""Limit for the label of a node, row or column."""

LARGEST_ENTRY = 1e30
"""Magnitude of a matrix entry; beyond it, products overflow."""

_FORM = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([EeDd][+-]?\d+|[+-]\d+)?")


def integer(name: str, number: int, word: str) -> int:
    """Parse a label or an index, positive or negative.

    Args:
        name: of the file.
        number: of the line.
        word: to parse.

    Raises:
        MatrixFileError: naming the line.
    """
    if not re.fullmatch(r"[+-]?\d{1,20}", word):
        raise MatrixFileError(f"{name}, line {number}: {word[:40]!r} is not a whole number: columns may be shifted")
    if abs(value := int(word)) >= LARGEST_LABEL:
        raise MatrixFileError(f"{name}, line {number}: {value}: too large for a node or row: columns may be shifted")
    return value


def real(name: str, number: int, word: str) -> float:
    """Parse a number of at most ``LARGEST_ENTRY``; also as 1.5D+03 and 1.5+3.

    Raises:
        MatrixFileError: naming the line.
    """
    if not (form := _FORM.fullmatch(word)):
        raise MatrixFileError(f"{name}, line {number}: {word[:40]!r} is not a number: columns may be shifted")
    mantissa, exponent = form[1], (form[2] or "").lstrip("EeDd")
    value = float(f"{'-' if word.startswith('-') else ''}{mantissa}E{exponent or 0}")
    if abs(value) > LARGEST_ENTRY:
        raise MatrixFileError(f"{name}, line {number}: {word[:40]}: implausibly large: check the exponent")
    return value


def integers(name: str, numbers: Sequence[int], words: Sequence[str]) -> NDArray[np.intp]:
    """As ``integer``, for many words and the numbers of their lines: (n,)."""
    return _many(integer, np.intp, "+-0123456789", LARGEST_LABEL - 1, name, numbers, words)


def reals(name: str, numbers: Sequence[int], words: Sequence[str]) -> NDArray[np.float64]:
    """As ``real``, for many words and the numbers of their lines: (n,)."""
    return _many(real, np.float64, "+-.0123456789Ee", LARGEST_ENTRY, name, numbers, words)


def _many(
    parse: Callable[[str, int, str], float],
    kind: type,
    characters: str,
    limit: float,
    name: str,
    numbers: Sequence[int],
    words: Sequence[str],
) -> NDArray[Any]:
    """All words at once if they have only these ``characters``, else each by ``parse``, which names the line of a wrong one."""
    if set("".join(words)) <= set(characters):
        with suppress(ValueError, OverflowError):
            values = np.array(words, dtype=kind)
            if (np.abs(values) <= limit).all():
                return values
    return np.array([parse(name, k, word) for k, word in zip(numbers, words, strict=True)], dtype=kind)
