"""Answers come back as they were, but for their times; nothing that is stored is executed."""

import math
from typing import Any

import msgspec
import numpy as np
import pytest

from southwell.cases.store.codec import decode, encode
from southwell.core.effects import ALL_EFFECTS
from southwell.core.modes import STATIONS, Modes
from southwell.references.protocol.process import Failure

MODES = Modes(2.0, np.array([1.0, 1 / 3 + 1.0]), np.full((2, len(STATIONS), 4), 1 / 3 + 2j / 7), 10, seconds=0.25)


@pytest.mark.parametrize(
    "value",
    [
        None,
        True,
        3,
        0.1,
        -0.0,
        math.inf,
        "text",
        [1, (2.0,)],
        {"a": [1], (1, 2): "b"},
        ALL_EFFECTS,
        Failure("crashed", "x"),
    ],
)
def test_plain_values_and_dataclasses_are_restored(value: Any) -> None:
    second = decode(encode(value))
    assert (second, type(second), repr(second)) == (value, type(value), repr(value))


def test_arrays_are_restored_bit_for_bit_and_times_are_not() -> None:
    second = decode(encode(MODES))
    assert second.shapes.tobytes() == MODES.shapes.tobytes()
    assert second.frequencies.tobytes() == MODES.frequencies.tobytes()
    assert (second.shapes.dtype, second.elements) == (MODES.shapes.dtype, 10)
    assert math.isnan(second.seconds)


@pytest.mark.parametrize(
    "stored",
    [
        ["os:system", "true"],
        ["subprocess:Popen", ["list", "true"]],
        ["southwell.no_such_module:Modes"],
        ["southwell.core.modes:np"],
        ["southwell.core.effects:ALL_EFFECTS", True, True, True, True],
        ["southwell.cases.store.codec:decode", "null"],
        ["southwell.core.effects:Effects", True],
        ["array", "<f8", [2], "AAAA"],
        ["unknown"],
        [],
    ],
)
def test_data_of_other_programs_are_refused(stored: list[Any]) -> None:
    with pytest.raises(ValueError, match="not a stored answer"):
        decode(msgspec.json.encode(stored))


def test_an_object_of_another_package_is_not_stored() -> None:
    with pytest.raises(TypeError, match="Decoder: not an answer"):
        encode([msgspec.json.Decoder()])
