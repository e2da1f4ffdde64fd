"""The plan of a study: its tasks by number, and the header that identifies its file."""

from collections.abc import Iterable, Iterator
from importlib.metadata import version

from msgspec import Struct

from ...references.protocol import sources
from ..store.digest import digest
from .rows import Task, solve
from .sampling import changes, sample
from .schema import Study


class Header(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The first line of a study's file.

    Attributes:
        study: digest of the blades, the speeds and the contents of the study file.
        package: digest of this package and the libraries it uses.
        version: of Southwell.
        seed: of the sample.
        blades: names, in the order of the tasks.
        samples: number of samples of each blade.
        speeds_rad_s: rotor speeds.
        modes: largest number of modes at a speed.
        properties: names of the sampled properties.
    """

    study: str
    package: str
    version: str
    seed: int
    blades: tuple[str, ...]
    samples: int
    speeds_rad_s: tuple[float, ...]
    modes: int
    properties: tuple[str, ...]

    @property
    def tasks(self) -> int:
        """Number of tasks."""
        return len(self.blades) * self.samples

    def number(self, blade: str, sample: int) -> int:
        """Number of the task of a blade's sample.

        Raises:
            ValueError: if the study has no such task.
        """
        if not 0 <= sample < self.samples:
            raise ValueError(f"sample {sample} of {self.samples}")
        return self.blades.index(blade) * self.samples + sample


def header(study: Study) -> Header:
    """The header of a study."""
    text = study.text
    return Header(
        study=digest(solve, study.blades, study.speeds, text),
        package=sources.package(),
        version=version("southwell"),
        seed=text.seed,
        blades=tuple(blade.name for blade in study.blades),
        samples=text.samples,
        speeds_rad_s=study.speeds,
        modes=text.modes,
        properties=tuple(study.properties),
    )


def tasks(study: Study, numbers: Iterable[int]) -> Iterator[tuple[int, Task]]:
    """The tasks with these numbers, made one by one. A task depends on its number only, not on the tasks before it.

    Sample k has the same values on every blade.
    """
    text = study.text
    values = sample(study.properties, text.samples, text.seed)
    for number in numbers:
        blade, sample_number = divmod(number, text.samples)
        yield (
            number,
            Task(
                blade=study.blades[blade],
                sample=sample_number,
                changes=changes(study.properties, values[sample_number]),
                speeds=study.speeds,
                text=text,
            ),
        )
