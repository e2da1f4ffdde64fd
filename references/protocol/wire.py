"""What the processes exchange: blades, mechanisms and modes as JSON, and the side of the process that answers.

Floats are preserved exactly (shortest round-trip representation); ``Infinity`` stands for a rigid strain. A complex
array, which has thousands of numbers, is ``{"sizes": […], "base64": …}``: little-endian pairs of 64-bit floats.
"""

import json
import os
import sys
from base64 import b64decode, b64encode
from collections.abc import Iterator
from dataclasses import fields
from typing import TYPE_CHECKING, Any, TextIO

import msgspec
import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade
from ...core.mechanism.description import Mechanism
from ...core.modes import Modes
from . import portable
from .fingerprint import Fingerprint
from .interface import MechanismModes
from .process import raised
from .turbines import TurbineModes

if TYPE_CHECKING:
    from ...core.turbine.turbine import Turbine

Reply = dict[str, Any]

COMPLEX = np.dtype("<c16")


def encode(value: Blade | Modes | MechanismModes | TurbineModes | Fingerprint) -> dict[str, Any]:
    """Encode as a dictionary of lists, numbers and strings, for ``json.dumps``."""
    return {f.name: _plain(getattr(value, f.name)) for f in fields(value)}


def decode_blade(data: dict[str, Any]) -> Blade:
    """Decode a blade; the inverse of ``encode``.

    Raises:
        BladeError: if the blade is invalid.
    """
    return Blade(**data)


def encode_mechanism(mechanism: Mechanism) -> Any:
    """Encode a mechanism as dictionaries, lists, numbers and strings."""
    return msgspec.to_builtins(mechanism, enc_hook=_plain)


def decode_mechanism(data: Any) -> Mechanism:
    """Decode a mechanism; the inverse of ``encode_mechanism``."""
    return msgspec.convert(data, Mechanism, dec_hook=lambda _, value: np.array(value, dtype=float))


def encode_turbine(turbine: "Turbine") -> Any:
    """Encode a turbine as dictionaries, lists, numbers and strings."""
    return msgspec.to_builtins(turbine, enc_hook=_plain)


def decode_turbine(data: Any) -> "Turbine":
    """Decode a turbine; the inverse of ``encode_turbine``."""
    from ...core.turbine.turbine import Turbine

    return msgspec.convert(data, Turbine, dec_hook=lambda _, value: np.array(value, dtype=float))


def decode_modes(data: dict[str, Any]) -> Modes:
    """Decode a blade's modes; the inverse of ``encode``.

    Raises:
        ValueError: if frequencies or shapes are not finite, or their sizes differ.
    """
    arrays = {name: np.array(data[name], dtype=float) for name in ("frequencies", "damping", "uncertainty", "rounding")}
    return Modes(**{**data, **arrays, "shapes": decode_complex(**data["shapes"])})


def decode_complex(sizes: list[int], base64: str) -> NDArray[np.complex128]:
    """Decode a complex array.

    Raises:
        ValueError: if the text is not base64, or not of an array of these sizes.
    """
    return np.frombuffer(b64decode(base64, validate=True), COMPLEX).astype(complex).reshape(sizes)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray) and np.iscomplexobj(value):
        return {"sizes": list(value.shape), "base64": b64encode(value.astype(COMPLEX).tobytes()).decode()}
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value


def serve(answer: Any) -> None:
    """Write each reply that ``answer(request)`` yields as one line, immediately."""
    request = json.loads(sys.stdin.buffer.readline())
    with answers_pipe() as pipe:
        pipe.write("\n")  # ready: the time limit of the first answer starts
        pipe.flush()
        replies: Iterator[Reply] = answer(request)
        for number, reply in enumerate(replies):
            pipe.write(_line({"run": number, **reply}) + "\n")
            pipe.flush()


def answers_pipe() -> TextIO:
    """Reserve standard output for answers: redirect prints of the code to standard error, and its input to the null device."""
    pipe = os.fdopen(portable.duplicate(1), "w", encoding="utf-8")
    portable.end_with_input()
    os.dup2(2, 1)
    null_device = os.open(os.devnull, os.O_RDONLY)
    os.dup2(null_device, 0)
    os.close(null_device)
    return pipe


def failed(kind: str, reason: str) -> Reply:
    """A reply that gives a reason instead of an answer."""
    return {"kind": kind, "reason": reason}


def foreign_exception(error: BaseException, where: str = "") -> Reply:
    """The reply for an exception that a code must not raise, including ``SystemExit``."""
    return failed("nonsense", f"{where}: {raised(error)}" if where else raised(error))


def _line(reply: Reply) -> str:
    try:
        return json.dumps(reply)
    except Exception as error:  # whatever a code puts into its answer
        return json.dumps({"run": reply["run"], **foreign_exception(error, "its answer")})
