"""OpenFAST's linearisation files (``.lin``), versions 2.3 to 5.0.

Read are the header, the tables of states and their derivatives, and the matrix A; tables of inputs and outputs, B, C, D and
Jacobians are skipped. Files may be compressed (``.gz``).
"""

import gzip
import io
import math
import re
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...core.regular_files import LARGEST_DATA, MEGABYTE, read_bytes
from ..input import files
from ..input.errors import CaseError
from .states import State, parse

Array = NDArray[np.float64]

MAX_STATES = 3000
"""Maximum number of continuous states; 3000 take 100 MB of text."""

_TABLE = re.compile(r"Order of ([\w ]+):")
_ROW = re.compile(r"\s*(\S+)\s+(\S+)\s+([TF])\s+(?:(\d+|\*+)\s+)?(\S.*)")
_MATRIX = re.compile(r"(\w+):\s*(\S+)\s+x\s+(\S+)\s*")
_VERSION = re.compile(r"at commit (\S+)|using OpenFAST \(([^\s,)]+)")
_DATE = re.compile(r"generated on (\S+ at \S+)")
_MANTISSA = re.compile(r"[+-]?(\d*)\.?(\d*)(?:[EeDd]([+-]?\d+))?")


@dataclass(frozen=True)
class LinFile:
    """A linearisation about one azimuth.

    Attributes:
        path: path of the file.
        version: version of the program, as ``v3.5.1``.
        date: day and time of the run.
        title: description from the main input file.
        modules: names of the linked modules.
        azimuth: rad.
        rotor_speed: rad/s.
        unit: half a unit in the last printed digit of azimuth and rotor speed.
        wind_speed: m/s.
        time: s.
        states: the continuous states.
        derivatives: the table of their derivatives, as states; empty if the file has none.
        A: state matrix.
        half_unit: half a unit in the last printed digit of every entry of A; 0 for exact zeros and ones.
        digits: significant digits of the entries of A.
        overflowed: places of the file outside A where a value is printed as asterisks.
    """

    path: Path
    version: str
    date: str
    title: str
    modules: tuple[str, ...]
    azimuth: float
    rotor_speed: float
    unit: float
    wind_speed: float
    time: float
    states: tuple[State, ...]
    derivatives: tuple[State, ...]
    A: Array
    half_unit: Array
    digits: int
    overflowed: tuple[str, ...]


def matches_format(content: str) -> bool:
    """Whether the text is a linearisation of OpenFAST."""
    return any(line.startswith("Linearized model") for line in content.split("\n", 6)[:6])


def text(path: Path) -> str:
    """Text of a file, which may be compressed.

    Raises:
        CaseError: if it cannot be read, is damaged, is not text, or is larger than 256 MB.
    """
    with files.readable(path):
        raw = read_bytes(path, LARGEST_DATA)
    if raw.startswith(b"\x1f\x8b"):
        try:
            with gzip.open(io.BytesIO(raw)) as compressed:
                raw = compressed.read(LARGEST_DATA + 1)
        except (OSError, EOFError, zlib.error) as error:
            raise CaseError(f"{path}: damaged gzip file: copy or compress it again") from error
        if len(raw) > LARGEST_DATA:
            raise CaseError(
                f"{path}: larger than {LARGEST_DATA // MEGABYTE} MB when unpacked: check that it is the right file"
            )
    if b"\0" in raw:
        raise CaseError(f"{path}: not a text file: check that it is the right one")
    content = raw.decode("utf-8-sig", errors="replace")
    if not content.strip():
        raise CaseError(f"{path}: empty: check that it was written to the end")
    return content


def read(path: Path) -> LinFile:
    """Read a linearisation.

    Raises:
        CaseError: one line with the file and the line, the value, the likely cause and the remedy.
    """
    return parsed(path, text(path))


def parsed(path: Path, content: str) -> LinFile:
    """The linearisation with the text ``content``; errors as ``read``."""
    if not matches_format(content):
        raise CaseError(
            f"{path}: not a linearisation of OpenFAST: its first lines lack `Linearized model`: give a .lin file"
        )
    lines = content.splitlines()
    overflowed: list[str] = []
    fields, unit = _header(lines, overflowed)
    tables = {
        match[1]: k for k, line in enumerate(lines) if line.startswith("Order of ") and (match := _TABLE.match(line))
    }
    if "continuous states" not in tables:
        raise CaseError(f"{path}: no table of continuous states: give a file of a model with degrees of freedom")
    states = _table(path, lines, tables["continuous states"], overflowed)
    derivatives = (
        _table(path, lines, tables["continuous state derivatives"], overflowed)
        if "continuous state derivatives" in tables
        else ()
    )
    declared = fields.get("Number of continuous states", math.nan)
    if math.isfinite(declared) and declared != len(states):
        raise CaseError(
            f"{path}: {len(states)} states in the table, {declared:g} in the header: give the file as OpenFAST wrote it"
        )
    rows = _matrix(path, lines, len(states))
    A = _numbers(path, rows)
    decimals, exponents = _format(rows)
    half_unit, digits = _rounding(A, decimals, exponents)
    head = " ".join(lines[:4])
    version, date = _VERSION.search(head), _DATE.search(head)
    for name in ("Rotor Speed", "Azimuth"):
        if not math.isfinite(fields.get(name, math.nan)):
            problem = "overflowed its format" if name in fields else "missing"
            raise CaseError(f"{path}: {name}: {problem} in the header: give the file as OpenFAST wrote it")
    return LinFile(
        path,
        (version[1] or version[2]) if version else "unknown",
        date[1] if date else "",
        next((line.partition(":")[2].strip() for line in lines[:12] if line.startswith("Description")), ""),
        tuple(name.strip() for name in head.partition("linked with")[2].split(";")[1:]),
        fields["Azimuth"],
        fields["Rotor Speed"],
        unit,
        fields.get("Wind Speed", math.nan),
        fields.get("Simulation time", math.nan),
        states,
        derivatives,
        A,
        half_unit,
        digits,
        tuple(overflowed),
    )


def _header(lines: list[str], overflowed: list[str]) -> tuple[dict[str, float], float]:
    """Numbers of the header by name, NaN where asterisks are printed, and half a unit in the last digit of the speed."""
    out: dict[str, float] = {}
    unit = 0.0
    for line in lines[:60]:
        if line.startswith("Order of "):
            break
        match = re.fullmatch(r"\s+([A-Z][^:]*):\s+(\S+).*", line)
        if match and "**" in match[2]:
            overflowed.append(match[1])
            out[match[1]] = math.nan
        elif match and (value := _number(match[2])) is not None:
            out[match[1]] = value
            if match[1] == "Rotor Speed":
                unit = 0.5 * 10.0 ** -len(match[2].partition(".")[2].rstrip("EeDd+-"))
    return out, unit


def _number(token: str) -> float | None:
    try:
        return float(token.lower().replace("d", "e"))
    except ValueError:
        # Fortran leaves out the E of an exponent with three digits
        if match := re.fullmatch(r"([+-]?\d*\.\d*)([+-]\d{3})", token):
            return float(f"{match[1]}e{match[2]}")
        return None


def _table(path: Path, lines: list[str], start: int, overflowed: list[str]) -> tuple[State, ...]:
    """The states of the table whose heading is line ``start`` (from 0)."""
    out: list[State] = []
    for k in range(start + 3, len(lines)):
        if not lines[k].strip():
            break
        row = _ROW.fullmatch(lines[k])
        if not row:
            raise CaseError(
                f"{path}: line {k + 1}: not a row of the table of states (number, operating point, T or F, order, "
                "description): give the file as OpenFAST wrote it"
            )
        value = math.nan if "**" in row[2] else _number(row[2])
        if value is None or not (math.isfinite(value) or "**" in row[2]):
            raise CaseError(f"{path}: line {k + 1}: operating point: {row[2]!r} is not a finite number: run it again")
        if any("**" in (row[i] or "") for i in (1, 2, 4)):
            overflowed.append(f"line {k + 1}")
        order = int(row[4]) if row[4] and row[4].isdigit() else None
        out.append(parse(row[5], row[3] == "T", order, value))
        if len(out) > MAX_STATES:
            raise CaseError(f"{path}: more than {MAX_STATES} states: check that it is the right file")
    if not out:
        raise CaseError(f"{path}: line {start + 1}: an empty table of states: give a model with degrees of freedom")
    keys = [state.text for state in out]
    if len(set(keys)) < len(keys):
        twice = next(key for key in keys if keys.count(key) > 1)
        raise CaseError(f"{path}: state {twice[:80]!r} is in the table twice: give the file as OpenFAST wrote it")
    return tuple(out)


def _matrix(path: Path, lines: list[str], n: int) -> list[tuple[int, list[str]]]:
    """Line numbers and tokens of the rows of A."""
    for name in ("A", "dXdx"):
        at = next((k for k, line in enumerate(lines) if line.startswith(f"{name}:")), None)
        if at is not None:
            break
    else:
        raise CaseError(f"{path}: no matrix A: give the whole file")
    shape = _MATRIX.match(lines[at])
    if shape and "*" not in shape[2] + shape[3] and (shape[2], shape[3]) != (str(n), str(n)):
        raise CaseError(
            f"{path}: line {at + 1}: A is {shape[2][:9]} x {shape[3][:9]}, the table has {n} states: give the file as "
            "OpenFAST wrote it"
        )
    rows = [(k + 1, lines[k].split()) for k in range(at + 1, min(at + 1 + n, len(lines)))]
    for k, row in rows:
        if len(row) != n:
            raise CaseError(
                f"{path}: line {k}: {len(row)} numbers instead of {n} in a row of A: give the file whole; for numbers "
                "that run together, use a wider OutFmt"
            )
    if len(rows) < n:
        raise CaseError(f"{path}: the file ends after {len(rows)} of {n} rows of A: give the whole file")
    return rows


def _numbers(path: Path, rows: list[tuple[int, list[str]]]) -> Array:
    """The matrix of the tokens."""
    out = np.empty((len(rows), len(rows)))
    for i, (k, row) in enumerate(rows):
        try:
            out[i] = row
        except ValueError:
            for j, token in enumerate(row):
                value = _number(token)
                if value is None:
                    cause = "it overflowed its format; use a wider OutFmt" if "*" in token else "give the file whole"
                    raise CaseError(
                        f"{path}: line {k}: A[{i + 1},{j + 1}]: {token[:20]!r} is not a number: {cause}"
                    ) from None
                out[i, j] = value
        if not np.isfinite(out[i]).all() or np.abs(out[i]).max() > 1e100:
            j = int(np.argmax(~np.isfinite(out[i]) | (np.abs(out[i]) > 1e100)))
            raise CaseError(
                f"{path}: line {k}: A[{i + 1},{j + 1}]: {row[j][:20]}: not a finite number: the linearisation may have "
                "failed: use a steady operating point"
            )
    return out


def _format(rows: list[tuple[int, list[str]]]) -> tuple[int, bool]:
    """Decimals of the printed mantissas, and whether they have exponents."""
    decimals, exponents = 0, False
    for _, row in rows:
        for token in (row[0], max(row, key=len)):
            if match := _MANTISSA.fullmatch(token):
                decimals = max(decimals, len(match[2]) - (match[1] in ("", "0") and float(token) != 0))
                exponents = exponents or match[3] is not None
    return decimals, exponents


def _rounding(A: Array, decimals: int, exponents: bool) -> tuple[Array, int]:
    """Half a unit in the last digit of every entry, and the number of significant digits.

    Digits that are zero in every entry do not count: they were cut off before the file was written.
    """
    size = np.abs(A)
    inexact = (size > 0) & (size != 1)
    if not exponents:
        largest = float(size.max(initial=0.0))
        digits = decimals + (math.floor(math.log10(largest)) + 1 if largest > 0 else 0)
        return np.where(inexact, 0.5 * 10.0**-decimals, 0.0), max(digits, 1)
    power = np.floor(np.log10(np.where(inexact, size, 1.0)) + 1e-12)
    mantissa = np.where(inexact, size, 1.0) / 10.0**power
    if np.count_nonzero(inexact) >= 10:
        for fewer in range(decimals):
            scaled = mantissa[inexact] * 10.0**fewer
            if np.abs(scaled - np.round(scaled)).max() < 1e-6:
                decimals = fewer
                break
    return np.where(inexact, 0.5 * 10.0 ** (power - decimals), 0.0), decimals + 1
