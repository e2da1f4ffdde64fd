"""Numbers in exported matrices, as Fortran and Nastran write them."""

import re

from .exported import MatrixFileError

LARGEST_LABEL = 2**31
"""Limit for the label of a node, row or column."""

LARGEST_ENTRY = 1e30
"""Magnitude of a matrix entry; beyond it, products overflow."""

_FORM = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([EeDd][+-]?\d+|[+-]\d+)?")


def whole(name: str, number: int, word: str) -> int:
    """Parse a label or an index, positive or negative.

    Args:
        name: of the file.
        number: of the line.
        word: to parse.

    Raises:
        MatrixFileError: naming the line.
    """
    if not re.fullmatch(r"[+-]?\d{1,20}", word):
        raise MatrixFileError(f"{name}, line {number}: {word[:40]!r} is not a whole number: columns shifted?")
    if abs(value := int(word)) >= LARGEST_LABEL:
        raise MatrixFileError(f"{name}, line {number}: {value}: too large for a node or row: columns shifted?")
    return value


def real(name: str, number: int, word: str) -> float:
    """Parse a number of at most ``LARGEST_ENTRY``; also as 1.5D+03 and 1.5+3.

    Raises:
        MatrixFileError: naming the line.
    """
    if not (found := _FORM.fullmatch(word)):
        raise MatrixFileError(f"{name}, line {number}: {word[:40]!r} is not a number: columns shifted?")
    mantissa, exponent = found[1], (found[2] or "").lstrip("EeDd")
    value = float(f"{'-' if word.startswith('-') else ''}{mantissa}E{exponent or 0}")
    if abs(value) > LARGEST_ENTRY:
        raise MatrixFileError(f"{name}, line {number}: {word[:40]}: implausibly large: check the exponent")
    return value
