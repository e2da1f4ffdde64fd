"""The matrix shows the sign of each angle of a blade: a reversed one changes a compared frequency far beyond the target."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from southwell.cases.input import library
from southwell.core.blade import Blade
from southwell.core.solve import mesh_modes

CASE = library.load("prebent-beam")
BLADE, SPEED = CASE.variants[0].blade, max(CASE.variants[0].speeds)

REVERSED: dict[str, Callable[[Blade], Blade]] = {
    "prebend": lambda b: replace(b, curve=b.curve * [1, 1, -1]),
    "precone": lambda b: replace(b, precone=-b.precone),
    "twist": lambda b: replace(b, twist=-b.twist),
    "pitch": lambda b: replace(b, pitch=-b.pitch),
}


def lowest(blade: Blade) -> list[float]:
    """The compared frequencies at the highest speed."""
    return mesh_modes(blade, SPEED, 20, CASE.text.compare.modes).frequencies.tolist()


@pytest.mark.parametrize("angle", REVERSED)
def test_the_sign_of_an_angle_changes_a_compared_frequency(angle: str) -> None:
    """Ten times the target, in one of them."""
    changes = [abs(b / a - 1) for a, b in zip(lowest(BLADE), lowest(REVERSED[angle](BLADE)), strict=True)]
    assert max(changes) > 10 * CASE.text.compare.target


def test_the_mirror_image_has_the_same_frequencies() -> None:
    """Reversed together, they mirror the blade at the plane of rotation."""
    mirrored = BLADE
    for reverse in REVERSED.values():
        mirrored = reverse(mirrored)
    assert lowest(mirrored) == pytest.approx(lowest(BLADE), rel=1e-10)
