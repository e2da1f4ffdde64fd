"""Results without an adapter: frequencies in a CSV file, from any program or a test rig, as a column of the matrix.

The file has a header, one line per frequency, and comments after ``#``::

    speed [rpm], frequency [Hz], mode
    0,           0.932,          flapwise 1
    15,          0.9586,         flapwise 1

Speed may be in rad/s, rpm or gamma (dimensionless cases), frequency in rad/s, Hz or gamma. A mode is identified by its
family (chordwise and lag mean edgewise) and its ordinal within the family, or by its number among all modes of the
blade, from the lowest; the family may be in a separate column. Two columns are optional: ``blade`` (as in
``southwell cases``: ``park-blade/windpact``), required if several blades are compared, and ``uncertainty [%]`` (or in
the frequency's unit), by default half a unit of the last digit.

With ``measured [Hz]`` in place of ``frequency [Hz]`` the file holds measurements. Their ``uncertainty`` is one standard
uncertainty; ``input uncertainty [%]`` is that of the simulation due to its inputs. Both may be given for all rows at
once (``Defaults``); the first is required. Speeds need not be among those of the case, only within their range.

BModes' output, ``NAME=FILE.out``, is read as it is; the rotor speed is that of the .bmi file beside it (``bmodes_output``).
"""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...core.participation import MIXED
from ...references.protocol.interface import MOTIONS
from ..input import files
from ..input.errors import CaseError, nearest
from ..judge.uncertainty import Estimate, from_print
from ..linearisation.judged import JudgedSet
from . import bmodes_output

SPEED = {"speed [rad/s]": 1.0, "speed [rpm]": math.pi / 30, "speed [gamma]": 1.0}
UNITS = {"rad/s": 1.0, "Hz": 2 * math.pi, "gamma": 1.0}
FREQUENCY = {f"frequency [{unit}]": size for unit, size in UNITS.items()}
MEASURED = {f"measured [{unit}]": size for unit, size in UNITS.items()}
UNCERTAINTY = ("uncertainty [%]", *(f"uncertainty [{unit}]" for unit in UNITS))
INPUTS = "input uncertainty [%]"
OTHERS = ("mode", "family", "blade", *UNCERTAINTY, INPUTS)
FAMILIES = (*MOTIONS, MIXED)
ALIASES = {"chordwise": "edgewise", "edge": "edgewise", "lag": "edgewise", "flap": "flapwise"}
"""Names of the families in other programs."""

NUMBER = re.compile(r"\d+(\.\d*)?([eE][+-]?\d+)?|\.\d+([eE][+-]?\d+)?")


MAX_NUMBER, MAX_DIGITS = 1e9, 40
"""Largest speed or frequency in any unit, and the maximum number of characters of a number."""


@dataclass(frozen=True)
class UserFrequency:
    """One frequency of the file.

    Attributes:
        line: line number in the file, from 1.
        blade: as in ``southwell cases``; empty if the file has no such column.
        omega: rotor speed, rad/s.
        slack: half a unit of the speed's last digit, rad/s.
        family: empty if the mode is identified by its number among all modes.
        mode: ordinal within the family, or number among all modes, from 1.
        value: frequency, rad/s, and its uncertainty: a bound, or the standard uncertainty of a measurement.
        inputs: for a measurement, the relative standard uncertainty of the simulation due to its inputs.
    """

    line: int
    blade: str
    omega: float
    slack: float
    family: str
    mode: int
    value: Estimate
    inputs: float = 0.0


@dataclass(frozen=True)
class UserResults:
    """The results in a file.

    Attributes:
        name: in tables.
        path: of the file, or the pattern of several.
        rows: its frequencies.
        measured: whether they are measured.
        linearised: linearisations of a turbine, in place of rows.
    """

    name: str
    path: str
    rows: tuple[UserFrequency, ...]
    measured: bool = False
    linearised: tuple[JudgedSet, ...] = ()


@dataclass(frozen=True)
class Defaults:
    """Default relative standard uncertainties, for measured frequencies without uncertainties in the file.

    Attributes:
        data: u_D over D; None if not given.
        inputs: u_input over S: the uncertainty of the frequencies due to that of the blade's properties.
    """

    data: float | None = None
    inputs: float = 0.0


@dataclass(frozen=True)
class _Columns:
    """Names of a file's columns; ``uncertainty`` is empty if the column is missing."""

    speed: str
    frequency: str
    uncertainty: str

    @property
    def measured(self) -> bool:
        return self.frequency in MEASURED

    @property
    def unit(self) -> float:
        return (FREQUENCY | MEASURED)[self.frequency]


def read(name: str, path: Path, defaults: Defaults | None = None) -> UserResults:
    """Read the results in a CSV file or in BModes' output; ``defaults`` apply to measured ones.

    Raises:
        CaseError: if the file is invalid; one line with the file, line, field, value, likely cause and remedy.
    """
    if path.suffix.lower() == ".out":
        return UserResults(name, str(path), tuple(UserFrequency(*row) for row in bmodes_output.read(path)))
    (first, header), *table = files.table(path, remedy="give NAME=FILE.csv")
    columns = _header(header, f"{path}: line {first}")
    if not table:
        raise CaseError(f"{path}: only a header: add a line for every frequency, as `0, 0.932, flapwise 1`")
    rows = []
    for k, cells in table:
        where = f"{path}: line {k}"
        if len(cells) != len(header):
            raise CaseError(
                f"{where}: {len(cells)} columns instead of {len(header)}: check for a missing or stray comma"
            )
        rows.append(_given(where, k, dict(zip(header, cells, strict=True)), columns, defaults or Defaults()))
    _no_repeats(rows, path, columns.measured)
    return UserResults(name, str(path), tuple(rows), columns.measured)


def _header(header: Sequence[str], where: str) -> _Columns:
    """Names of the speed, frequency and uncertainty columns."""
    column_names = (*SPEED, *FREQUENCY, *MEASURED, *OTHERS)
    for column in header:
        if column not in column_names:
            raise CaseError(f"{where}: unknown column {column!r}: {nearest(column, column_names)}")
        if header.count(column) > 1:
            raise CaseError(f"{where}: column {column!r} occurs {header.count(column)} times: give it once")
    columns = []
    for quantity, units in (("speed", SPEED), ("frequency", (*FREQUENCY, *MEASURED))):
        matches = [column for column in header if column in units]
        if len(matches) != 1:
            raise CaseError(f"{where}: {len(matches)} columns of {quantity}: give exactly one of {', '.join(units)}")
        columns.append(matches[0])
    if "mode" not in header:
        raise CaseError(f"{where}: column 'mode' is missing: name the mode of each frequency, as in flapwise 1, or 3")
    speed, frequency = columns
    allowed = ("uncertainty [%]", f"uncertainty {frequency.partition(' ')[2]}")
    uncertainties = [column for column in header if column in UNCERTAINTY]
    if len(uncertainties) > 1 or not set(uncertainties) <= set(allowed):
        message = (
            f"{where}: columns of uncertainty: {', '.join(uncertainties)}: give one at most, {' or '.join(allowed)}"
        )
        raise CaseError(message)
    if INPUTS in header and frequency not in MEASURED:
        raise CaseError(
            f"{where}: column {INPUTS!r} is for measured frequencies: leave it out, or name the column of "
            "frequencies 'measured [Hz]'"
        )
    return _Columns(speed, frequency, uncertainties[0] if uncertainties else "")


def _given(where: str, line: int, row: dict[str, str], columns: _Columns, defaults: Defaults) -> UserFrequency:
    def number(column: str, minimum: float = 0.0, maximum: float = MAX_NUMBER) -> float:
        text = row[column]
        if len(text) > MAX_DIGITS or not NUMBER.fullmatch(text) or not minimum <= float(text) <= maximum:
            required = "a number above 0" if minimum else "a number, 0 or more"
            raise CaseError(
                f"{where}: {column}: {text!r} is not {required}, and at most {maximum:g}: correct it, with a decimal point"
            )
        return float(text)

    omega = number(columns.speed)
    size = number(columns.frequency, minimum=1e-9)
    value = from_print(row[columns.frequency], columns.unit)
    least = 1e-9 if columns.measured else 0.0  # measurements are never exact
    if row.get(columns.uncertainty, ""):
        relative = columns.uncertainty == "uncertainty [%]"
        u = number(columns.uncertainty, least, 100.0 if relative else size) / (100.0 if relative else size)
        value = Estimate(value.value, u)
    elif columns.measured:
        if defaults.data is None:
            raise CaseError(
                f"{where}: uncertainty: missing for a measured frequency: add a column 'uncertainty [%]' (one standard "
                "uncertainty), or give it for all rows with --data-uncertainty 1%"
            )
        value = Estimate(value.value, defaults.data)
    inputs = number(INPUTS, maximum=100.0) / 100.0 if row.get(INPUTS, "") else defaults.inputs
    family, mode = _mode(where, row.get("family", ""), row["mode"])
    slack = from_print(row[columns.speed]).uncertainty if omega else 0.0
    unit = SPEED[columns.speed]
    return UserFrequency(
        line, row.get("blade", ""), omega * unit, (slack or 0.0) * omega * unit, family, mode, value, inputs
    )


def _mode(where: str, family: str, text: str) -> tuple[str, int]:
    words = text.split()
    if not family and len(words) == 2:
        family, text = words[0], words[1]
    family = ALIASES.get(family, family)
    if family and family not in FAMILIES:
        raise CaseError(f"{where}: mode: {family!r} is no family: {nearest(family, FAMILIES)}")
    if not re.fullmatch(r"[1-9]\d*", text):
        raise CaseError(f"{where}: mode: {text!r}: give a family and a whole number from 1, as flapwise 1, or a number")
    return family, int(text)


def _no_repeats(rows: Sequence[UserFrequency], path: Path, measured: bool) -> None:
    lines: dict[tuple[str, float, str, int], int] = {}
    for row in rows:
        key = row.blade, row.omega, row.family, row.mode
        if key in lines:
            mode = f"{row.family} {row.mode}".strip()
            remedy = "give their mean, and their scatter as its uncertainty" if measured else "keep one"
            raise CaseError(
                f"{path}: line {row.line}: mode: {mode} at this speed is in line {lines[key]} too: {remedy}"
            )
        lines[key] = row.line


def check(user_results: Sequence[UserResults], speeds: Mapping[str, Sequence[float]]) -> None:
    """Check that the run has the blade and speed of every row.

    The speed of a row only has to be within the range of the run's speeds.

    Args:
        user_results: results of all files.
        speeds: name of each blade of the run → its speeds, rad/s.

    Raises:
        CaseError: if not; one line, as for ``read``.
    """
    for results in user_results:
        for row in results.rows:
            where = f"{results.path}: line {row.line}"
            if row.blade and row.blade not in speeds:
                raise CaseError(f"{where}: blade: {row.blade!r} is not in this run: {nearest(row.blade, speeds)}")
            if not row.blade and len(speeds) != 1:
                raise CaseError(
                    f"{where}: blade: not given, and the run has {len(speeds)}: add a column, or choose one"
                )
            blade = row.blade or next(iter(speeds))
            highest = max(speeds[blade])
            if row.omega > highest + row.slack:
                raise CaseError(
                    f"{where}: speed: {row.omega:.6g} rad/s is above the highest speed of {blade}, {highest:.6g} rad/s: "
                    "correct it, or add a speed to the case"
                )


def at(row: UserFrequency, omega: float) -> bool:
    """Whether a row's speed equals ``omega`` (rad/s) within its rounding."""
    return abs(row.omega - omega) <= max(row.slack * (1 + 1e-9), 1e-9 * omega)
