"""Encode blades and modes as JSON for exchange between processes.

Floats are preserved exactly (shortest round-trip representation); ``Infinity`` stands for a rigid strain. A complex
array, which has thousands of numbers, is ``{"sizes": […], "base64": …}``: little-endian pairs of 64-bit floats.
"""

from base64 import b64decode, b64encode
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade
from ...core.modes import Modes
from .mechanism_interface import MechanismModes

COMPLEX = np.dtype("<c16")


def encode(value: Blade | Modes | MechanismModes) -> dict[str, Any]:
    """Encode as a dictionary of lists, numbers and strings, for ``json.dumps``."""
    return {f.name: _plain(getattr(value, f.name)) for f in fields(value)}


def decode_blade(data: dict[str, Any]) -> Blade:
    """Decode a blade; the inverse of ``encode``.

    Raises:
        BladeError: if the blade is invalid.
    """
    return Blade(**data)


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
