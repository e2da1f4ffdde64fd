"""Blades and modes as JSON, the one thing that crosses the border between processes.

Every float survives the trip bit for bit (shortest round-trip representation); ``Infinity`` stands for a rigid strain.
A complex array ends in an axis of length two, real and imaginary part.
"""

from dataclasses import fields
from typing import Any

import numpy as np

from ...core.blade import Blade
from ...core.modes import STATIONS, Modes
from .mechanism_interface import MechanismModes


def encode(value: Blade | Modes | MechanismModes) -> dict[str, Any]:
    """A dictionary of plain lists, numbers and strings, ready for ``json.dumps``."""
    return {f.name: _plain(getattr(value, f.name)) for f in fields(value)}


def decode_blade(data: dict[str, Any]) -> Blade:
    """The blade that ``encode`` was given.

    Raises:
        BladeError: if it is not a possible blade.
    """
    return Blade(**data)


def decode_modes(data: dict[str, Any]) -> Modes:
    """The modes that ``encode`` was given.

    Raises:
        ValueError: if frequencies or shapes are not finite or do not fit each other.
    """
    pairs = np.array(data["shapes"], dtype=float).reshape(len(data["frequencies"]), len(STATIONS), 4, 2)
    arrays = {name: np.array(data[name], dtype=float) for name in ("frequencies", "damping", "uncertainty", "rounding")}
    return Modes(**{**data, **arrays, "shapes": pairs[..., 0] + 1j * pairs[..., 1]})


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return (np.stack([value.real, value.imag], axis=-1) if np.iscomplexobj(value) else value).tolist()
    return value.item() if isinstance(value, np.generic) else value
