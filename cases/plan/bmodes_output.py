"""Frequencies in the output of BModes (G. Bir, NREL, version 3): ``-------- Mode No.   1  (freq =   0.6711E+00 Hz)``.

The file does not state the rotor speed; it is ``rot_rpm`` of the .bmi file of the same name beside it.
"""

import math
import re
from collections.abc import Iterator
from pathlib import Path

from ...core.regular_files import read_bytes
from ..input.errors import CaseError
from ..judge.uncertainty import Estimate, from_print

MODE = re.compile(r"Mode No\.\s*(\d+)\s*\(freq\s*=\s*([0-9.]+(?:[EeDd][+-]?\d+)?)\s*Hz")
SPEED = re.compile(r"^\s*([0-9.+-]+(?:[EeDd][+-]?\d+)?)\s+rot_rpm\b", re.MULTILINE)
MAX_BYTES = 10_000_000
"""Largest size of a file in bytes."""


def read(path: Path) -> Iterator[tuple[int, str, float, float, str, int, Estimate]]:
    """Fields of ``UserFrequency``, one tuple for each mode; modes are numbered among all modes of the blade.

    Raises:
        CaseError: no frequency in the file, or no .bmi file with the rotor speed beside it.
    """
    omega = _speed(path.with_suffix(".bmi"), path)
    is_empty = True
    for line, text in enumerate(_text(path).splitlines(), 1):
        if match := MODE.search(text):
            is_empty = False
            digits = match[2].upper().replace("D", "E")
            yield line, "", omega, 0.0, "", int(match[1]), from_print(digits, 2 * math.pi)
    if is_empty:
        raise CaseError(f"{path}: no line `Mode No. 1 (freq = … Hz)`: give BModes' output, or a CSV file")


def _speed(bmi: Path, path: Path) -> float:
    if not bmi.is_file():
        raise CaseError(
            f"{path}: rotor speed: not in BModes' output, and {bmi.name} is not beside it: add it, or give a CSV"
        )
    match = SPEED.search(_text(bmi))
    if not match:
        raise CaseError(f"{bmi}: rot_rpm: missing: add the rotor speed, or give the frequencies in a CSV file")
    return float(match[1].upper().replace("D", "E")) * math.pi / 30


def _text(path: Path) -> str:
    try:
        return read_bytes(path, MAX_BYTES).decode("utf-8", errors="replace")
    except OSError as error:
        raise CaseError(f"{path}: {error.strerror or error}: give NAME=FILE.out") from error
