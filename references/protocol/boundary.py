"""Validate the replies of foreign codes: types, lengths, finite, ascending and plausible values.

The checks run in this process and do not rely on the other one. A violation raises ``NonsenseError``, which quotes the value.
"""

import json
import re
from collections.abc import Sequence
from typing import Annotated, Any, Literal, TypeVar

import msgspec
import numpy as np
from msgspec import Meta, Struct
from numpy.typing import NDArray

from ...core.modes import STATIONS, Modes
from .fingerprint import Elements, Fingerprint
from .interface import MechanismModes, TextLine
from .process import Failure, one_line
from .turbines import TurbineModes
from .wire import decode_complex, decode_modes

T = TypeVar("T")

Seconds = Annotated[float, Meta(ge=0, le=1e9)]

LARGEST = 1e100
"""Largest magnitude of any number in an answer; its square is finite."""

SAME_SPEED = 1e-9
"""Largest relative difference between the requested speed and the one in the answer."""


class NonsenseError(ValueError):
    """Invalid answer; the message names the field and quotes its value."""


class Failed(Struct, frozen=True, forbid_unknown_fields=True):
    """A reply that gives a reason instead of modes."""

    kind: Literal["nonsense", "refused", "not installed", "unsupported", "unknown"]
    reason: str


class _Complex(Struct, frozen=True, forbid_unknown_fields=True):
    sizes: list[Annotated[int, Meta(ge=0, le=10**7)]]
    base64: str


class _Modes(Struct, frozen=True, forbid_unknown_fields=True):
    omega: float
    frequencies: list[float]
    shapes: _Complex
    elements: Elements
    damping: list[float]
    uncertainty: list[float]
    rounding: list[float]
    strain: float
    seconds: Seconds


class _MechanismModes(Struct, frozen=True, forbid_unknown_fields=True):
    coordinates: list[TextLine]
    steady: list[float]
    values: _Complex
    shapes: _Complex


class _TurbineModes(Struct, frozen=True, forbid_unknown_fields=True):
    values: _Complex
    shapes: _Complex
    elements: Elements


def reply(line: bytes, number: int) -> dict[str, Any]:
    """Decode one line as the reply with this number.

    Raises:
        NonsenseError: if the line is not that reply; the lines after it cannot be trusted either.
    """
    try:
        data = json.loads(line)
    except (ValueError, RecursionError):
        data = None
    if not isinstance(data, dict) or data.pop("run", None) != number:
        raise NonsenseError(f"not an answer: {_quoted(line)}; the code must not write to the pipe for answers")
    return data


def failure(data: dict[str, Any]) -> Failure | None:
    """The failure in a reply; None if the reply has no ``kind``.

    Raises:
        NonsenseError: if the failure is invalid.
    """
    if "kind" not in data:
        return None
    failed = convert(data, Failed)
    return Failure(failed.kind, one_line(failed.reason))


def modes(data: Any, omega: float, count: int) -> Modes:
    """Validate a blade's modes, at most ``count``, at rotor speed ``omega`` (rad/s).

    Raises:
        NonsenseError: if the data are invalid.
    """
    answer = convert(data, _Modes)
    m = len(answer.frequencies)
    _keep(1 <= m <= count, f"frequencies: {m} returned, {count} requested")
    shapes = _array("shapes", answer.shapes, 3)
    _keep(len(shapes) == m, f"shapes: {len(shapes)} for {m} frequencies")
    _keep(shapes.shape[1:] == (len(STATIONS), 4), f"shapes: each must be {len(STATIONS)} stations by 4 columns")
    for name in ("damping", "uncertainty", "rounding"):
        values = getattr(answer, name)
        _keep(len(values) in (0, m), f"{name}: {len(values)} values for {m} frequencies")
        _finite(name, values)
    _finite("frequencies", answer.frequencies)
    _finite("shapes", shapes.view(float))
    _keep(min(answer.frequencies) >= 0.0, f"frequencies: {_quoted(answer.frequencies)}: negative")
    _ascending("frequencies", answer.frequencies)
    for name in ("uncertainty", "rounding"):
        _keep(min(getattr(answer, name), default=0.0) >= 0.0, f"{name}: {_quoted(getattr(answer, name))}: negative")
    _keep(max(np.abs(answer.damping), default=0.0) <= 1.0, f"damping: {_quoted(answer.damping)}: ratios above 1")
    same_speed = abs(answer.omega - omega) <= SAME_SPEED * abs(omega)
    _keep(same_speed, f"omega: {answer.omega!r}: the requested speed is {omega!r} rad/s")
    _keep(np.isnan(answer.strain) or 0.0 <= answer.strain <= LARGEST, f"strain: {answer.strain!r}: not a strain")
    return decode_modes(data)


def mechanism_modes(data: Any) -> MechanismModes:
    """Validate a mechanism's modes.

    Raises:
        NonsenseError: if the data are invalid.
    """
    answer = convert(data, _MechanismModes)
    values, shapes = _array("values", answer.values, 1), _array("shapes", answer.shapes, 2)
    m, k = len(values), len(answer.coordinates)
    _keep(m >= 1, "values: none")
    _keep(
        k >= 1 and len(set(answer.coordinates)) == k,
        f"coordinates: {_quoted(answer.coordinates)}: empty, or a duplicate name",
    )
    _keep(len(answer.steady) == k, f"steady: {len(answer.steady)} values for {k} coordinates")
    _keep(shapes.shape == (m, k), f"shapes: must be {m} shapes of {k} coordinates each")
    for name, numbers in (("steady", answer.steady), ("values", values.view(float)), ("shapes", shapes.view(float))):
        _finite(name, numbers)
    _ascending("values, by modulus", np.abs(values) * (1.0 + 1e-9 * np.arange(m)))
    return MechanismModes(tuple(answer.coordinates), np.array(answer.steady), values, shapes)


def turbine_modes(data: Any, count: int, stations: int) -> TurbineModes:
    """Validate a turbine's modes, at most ``count``, of which each shape has this number of stations.

    Raises:
        NonsenseError: if the data are invalid.
    """
    answer = convert(data, _TurbineModes)
    values, shapes = _array("values", answer.values, 1), _array("shapes", answer.shapes, 3)
    m = len(values)
    _keep(1 <= m <= count, f"values: {m} returned, {count} requested")
    _keep(shapes.shape == (m, stations, 4), f"shapes: must be {m} of {stations} stations by 4 columns")
    for name, numbers in (("values", values.view(float)), ("shapes", shapes.view(float))):
        _finite(name, numbers)
    _ascending("values, by modulus", np.abs(values) * (1.0 + 1e-9 * np.arange(m)))
    return TurbineModes(values, shapes, answer.elements)


def fingerprint(data: Any) -> Fingerprint | None:
    """Validate the fingerprint of a model; None if the code reports none.

    Raises:
        NonsenseError: if the data are invalid.
    """
    if data is None:
        return None
    answer = convert(data, Fingerprint)
    for name in ("mass", "first_moments", "rotor_inertia", "start"):
        _finite(name, getattr(answer, name))
    _finite("flexibility", answer.flexibility or ())
    _finite("inertia", answer.inertia or ())
    return answer


def convert(data: Any, kind: type[T]) -> T:
    """Convert plain data to a structure.

    Raises:
        NonsenseError: with msgspec's message and the value of the invalid field.
    """
    try:
        return msgspec.convert(data, kind)
    except (msgspec.ValidationError, RecursionError, OverflowError) as error:
        field = re.search(r"\$\.(\w+)", str(error))
        location = f"{field[1]}: {_quoted(data.get(field[1]))}: " if field and isinstance(data, dict) else ""
        raise NonsenseError(f"{location}{one_line(error)}") from None


def _array(name: str, encoded: _Complex, dimensions: int) -> NDArray[np.complex128]:
    try:
        array = decode_complex(encoded.sizes, encoded.base64)
    except ValueError as error:
        raise NonsenseError(f"{name}: not {encoded.sizes} complex numbers in base64: {one_line(error)}") from None
    _keep(array.ndim == dimensions, f"{name}: {array.ndim} dimensions instead of {dimensions}")
    return array


def _finite(name: str, values: Any) -> None:
    flat = np.array(values, dtype=float).ravel()
    invalid = flat[~(np.abs(flat) <= LARGEST)]
    _keep(not invalid.size, f"{name}: {invalid[:1].tolist()}: not finite, or above {LARGEST:g}")


def _ascending(name: str, values: Any) -> None:
    _keep(np.all(np.diff(values) >= 0.0), f"{name}: {_quoted(list(values))}: not ascending")


def _keep(true: Any, message: str) -> None:
    if not true:
        raise NonsenseError(message)


def _quoted(value: Any) -> str:
    if isinstance(value, Sequence):  # repr of a whole answer is long
        value = value[:100]
    text = one_line(repr(value))
    return text if len(text) <= 80 else f"{text[:79]}…"
