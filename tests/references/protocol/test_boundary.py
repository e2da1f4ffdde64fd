"""Answers of turbine codes and fingerprints are checked where they come in; the others are in ``test_misdeeds``."""

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from southwell.references.protocol import wire
from southwell.references.protocol.boundary import NonsenseError, fingerprint, turbine_modes
from southwell.references.protocol.fingerprint import Fingerprint
from southwell.references.protocol.turbines import TurbineModes

MODES = TurbineModes(np.array([1j, -0.1 + 2j, 3j]), np.ones((3, 21, 4), complex), 10)
FLEXIBLE = Fingerprint(2.0, (1.0, 0.0, 0.0), 3.0, 10, flexibility=(1.0,) * 21, inertia=(1.0, 2.0, 3.0))


def sent(value: TurbineModes | Fingerprint) -> Any:
    return json.loads(json.dumps(wire.encode(value)))


def test_modes_of_a_turbine_are_transferred_unchanged() -> None:
    back = turbine_modes(sent(MODES), 3, 21)
    np.testing.assert_array_equal(back.values, MODES.values)
    np.testing.assert_array_equal(back.shapes, MODES.shapes)
    assert back.elements == 10


VALUES, SHAPES = MODES.values, MODES.shapes
WRONG = [
    ({"values": VALUES[:0], "shapes": SHAPES[:0]}, "values: 0 returned, 3 requested"),
    ({"values": VALUES[:2]}, "shapes: must be 2 of 21 stations by 4 columns"),
    ({"shapes": SHAPES[:, :20]}, "shapes: must be 3 of 21 stations"),
    ({"values": VALUES * [1, np.nan, 1]}, "values: "),
    ({"shapes": np.where(SHAPES == 1, np.inf, SHAPES)}, "shapes: "),
    ({"values": VALUES[::-1]}, "values, by modulus"),
    ({"elements": 0}, "elements: 0: "),
]


@pytest.mark.parametrize(("changes", "phrase"), WRONG)
def test_wrong_modes_of_a_turbine_are_refused(changes: dict[str, Any], phrase: str) -> None:
    with pytest.raises(NonsenseError) as refused:
        turbine_modes(wire.encode(MODES) | {name: wire._plain(value) for name, value in changes.items()}, 3, 21)
    assert phrase in str(refused.value)


def test_more_modes_than_requested_are_refused() -> None:
    with pytest.raises(NonsenseError, match="values: 3 returned, 2 requested"):
        turbine_modes(sent(MODES), 2, 21)


def test_a_fingerprint_is_transferred_unchanged() -> None:
    assert fingerprint(None) is None
    for value in (FLEXIBLE, replace(FLEXIBLE, flexibility=None, inertia=None)):
        assert fingerprint(sent(value)) == value


@pytest.mark.parametrize("field", ["mass", "first_moments", "rotor_inertia", "start", "flexibility", "inertia"])
def test_a_fingerprint_that_is_not_finite_is_refused(field: str) -> None:
    value = getattr(FLEXIBLE, field)
    altered = (np.nan, *value[1:]) if isinstance(value, tuple) else np.nan
    with pytest.raises(NonsenseError, match=field):
        fingerprint(wire.encode(FLEXIBLE) | {field: altered})


def test_a_value_of_the_wrong_kind_is_quoted() -> None:
    with pytest.raises(NonsenseError, match=r"^mass: 'two': "):
        fingerprint(wire.encode(FLEXIBLE) | {"mass": "two"})
