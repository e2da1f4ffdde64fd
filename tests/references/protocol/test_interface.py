"""The base class of adapters: refusal, version, limits, and what is shared with core."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.core.blade import Blade
from southwell.core.modes import Modes
from southwell.references.protocol.interface import CORE, BladeAdapter, CodeError, Independence, shares

from ...support.beams import PARK


class Declining(BladeAdapter):
    name = "declining"
    title = "Declining"
    levels = (1, 2)
    order = 2
    max_elements = 10
    distribution = "no-such-distribution"

    def unsupported(self, blade: Blade) -> str | None:
        return "never" if blade.name == "declined" else None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        self.limit(elements)
        raise AssertionError("solved")


def test_a_refused_blade_is_not_solved() -> None:
    with pytest.raises(CodeError, match=r"^declined: never$"):
        Declining().solve(replace(PARK, name="declined"), 1.0, 1, 1)


def test_a_mesh_above_the_limit_is_an_error() -> None:
    with pytest.raises(CodeError, match="elements: 11: declining allows 10"):
        Declining().solve(PARK, 1.0, 11, 1)
    with pytest.raises(AssertionError, match="solved"):
        Declining().solve(PARK, 1.0, 10, 1)


def test_the_version_is_that_of_the_installed_distribution() -> None:
    class Installed(Declining):
        distribution = "numpy"

    assert Installed().version() == np.__version__
    assert Declining().version() is None


@pytest.mark.parametrize(
    ("origins", "expected"),
    [
        (None, "undeclared"),
        (Independence("a", "b", "c"), "nothing"),
        (Independence("a", CORE, "c"), "discretisation"),
        (Independence("a", "b", CORE), "mechanical model"),
        (Independence("a", "b", "c", sections=CORE), "mechanical model"),
    ],
)
def test_what_is_shared_follows_from_the_origins(origins: Independence | None, expected: str) -> None:
    assert shares(origins) == expected


def test_an_adapter_without_its_methods_cannot_be_made() -> None:
    class Half(BladeAdapter):
        name = "half"

    with pytest.raises(TypeError, match="abstract"):
        Half()  # pyright: ignore[reportAbstractUsage]
