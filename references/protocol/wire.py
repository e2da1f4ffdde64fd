"""Encode blades and modes as JSON for exchange between processes.

Floats are preserved exactly (shortest round-trip representation); ``Infinity`` stands for a rigid strain. A complex
array has a last axis of length two, real and imaginary part.
"""

from dataclasses import fields
from typing import Any

import numpy as np

from ...core.blade import Blade
from ...core.modes import STATIONS, Modes
from .mechanism_interface import MechanismModes


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
    pairs = np.array(data["shapes"], dtype=float).reshape(len(data["frequencies"]), len(STATIONS), 4, 2)
    arrays = {name: np.array(data[name], dtype=float) for name in ("frequencies", "damping", "uncertainty", "rounding")}
    return Modes(**{**data, **arrays, "shapes": pairs[..., 0] + 1j * pairs[..., 1]})


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return (np.stack([value.real, value.imag], axis=-1) if np.iscomplexobj(value) else value).tolist()
    return value.item() if isinstance(value, np.generic) else value
