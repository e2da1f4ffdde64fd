"""A code whose frequencies are those of core times a factor of the package ``tinybeam``, which has several releases."""

from dataclasses import dataclass, replace
from importlib import metadata

from southwell.core.blade import Blade
from southwell.core.effects import ALL_EFFECTS, Effects
from southwell.core.modes import Modes
from southwell.core.solve import modes
from southwell.references.protocol.interface import Independence, Shares


@dataclass(frozen=True)
class Tiny:
    """See the module."""

    name: str = "tiny"
    title: str = "Tiny"
    shares: Shares = "nothing"
    independence: Independence = Independence("tiny", "tiny", "tiny")  # noqa: RUF009
    effects: Effects = ALL_EFFECTS
    levels: tuple[int, ...] = (10, 20, 40)
    order: int = 4
    hint: str = ""
    distribution: str = "tinybeam"

    def version(self) -> str | None:
        return metadata.version(self.distribution)

    def unsupported(self, blade: Blade) -> str | None:
        return None

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        import tinybeam  # pyright: ignore[reportMissingImports]

        found = modes(blade, omega, elements, count)
        return replace(found, frequencies=found.frequencies * tinybeam.FACTOR)


CODE = Tiny()
