"""Schema of a study file, and the study that it describes."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from msgspec import Meta, Struct

from ...core.blade import Blade
from ...core.blade_checks import MAX_LENGTH, MAX_PITCH, MAX_PRECONE, MIN_LENGTH
from ..input import files, library, readers
from ..input.errors import CaseError
from ..input.names import Typed
from ..input.readers import Mount, Unused
from ..input.schema import Speeds, rad_s
from ..input.toml import convert, document, finite
from .sampling import Distribution, distributions

MOST_SAMPLES = 1_000_000
"""Largest number of samples; their values are kept in memory, 8 bytes each."""

Length = Annotated[float, Meta(ge=0, le=MAX_LENGTH)]


class BladeFile(Struct, frozen=True, forbid_unknown_fields=True):
    """A blade file and what it does not define; see ``readers.Mount``."""

    file: str
    main: Annotated[str, Meta(description="main file that defines how the blade is mounted")] = ""
    length: Annotated[float, Meta(ge=MIN_LENGTH, le=MAX_LENGTH, description="m")] | None = None
    hub_radius: Annotated[Length, Meta(description="m")] | None = None
    precone: (
        Annotated[float, Meta(ge=-MAX_PRECONE, le=MAX_PRECONE, description="degrees, positive downwind")] | None
    ) = None
    pitch: Annotated[float, Meta(ge=-MAX_PITCH, le=MAX_PITCH, description="degrees, leading edge downwind")] | None = (
        None
    )

    def mount(self, folder: Path) -> Mount:
        """The mount for a reader, in radians."""
        return Mount(
            main=folder / self.main if self.main else None,
            length=self.length,
            hub_radius=self.hub_radius,
            precone=None if self.precone is None else math.radians(self.precone),
            pitch=None if self.pitch is None else math.radians(self.pitch),
        )


class StudyFile(Struct, frozen=True, forbid_unknown_fields=True):
    """A study file."""

    name: Typed
    blades: Annotated[
        tuple[str | BladeFile, ...],
        Meta(min_length=1, description="cases, blades of cases (case/blade), or blade files"),
    ]
    speeds: Speeds
    modes: Annotated[int, Meta(ge=1, le=100, description="number of modes, from the lowest")] = 6
    samples: Annotated[int, Meta(ge=1, le=MOST_SAMPLES)] = 1
    seed: Annotated[int, Meta(ge=0, le=2**63 - 1)] = 0
    properties: Annotated[dict[str, dict[str, Any]], Meta(description="property → its distribution")] = {}
    elements: Annotated[int, Meta(ge=1, le=20_000, description="default: as many as accuracy requires")] | None = None
    accuracy: Annotated[float, Meta(ge=1e-12, le=0.1, description="largest relative uncertainty, without elements")] = (
        1e-6
    )
    allow_large_strain: bool = False


@dataclass(frozen=True)
class Study:
    """A study.

    Attributes:
        blades: nominal blades, of different names.
        speeds: rotor speeds, rad/s, ascending.
        properties: distribution of each sampled property.
        text: the contents of the study file.
    """

    blades: tuple[Blade, ...]
    speeds: tuple[float, ...]
    properties: dict[str, Distribution]
    text: StudyFile


def read(path: Path) -> tuple[Study, tuple[Unused, ...]]:
    """Read a study file and its blades, and the non-zero quantities of the blades' files that are not used.

    Raises:
        CaseError: one line with file, field, value, cause and remedy.
    """
    data = document(path)
    finite(data, str(path))
    text = convert(data, StudyFile, str(path))
    if text.samples > 1 and not text.properties:
        raise CaseError(f"{path}: samples: {text.samples}: no sampled properties: add [properties], or leave it out")
    properties = distributions(text.properties, str(path))
    speeds = rad_s(text.speeds, str(path))
    pairs = [pair for entry in text.blades for pair in _blades(entry, path)]
    blades = tuple(blade for blade, _ in pairs)
    for k, blade in enumerate(blades):
        if blade.name in [earlier.name for earlier in blades[:k]]:
            raise CaseError(f"{path}: blades: {blade.name!r} twice: rows are found by its name: rename one, or drop it")
    return Study(blades, tuple(speeds.tolist()), properties, text), tuple(
        entry for _, unused in pairs for entry in unused
    )


def _blades(source: str | BladeFile, study: Path) -> list[tuple[Blade, tuple[Unused, ...]]]:
    """Blades of a case or a file, with the quantities that are not used; files are in the folder of the study file."""
    if isinstance(source, str) and source.partition("/")[0] in library.names():
        return [(variant.blade, variant.unused) for variant in library.select(source).variants]
    with files.reading(study):
        folder = study.parent
        if isinstance(source, str):
            path = str(folder / source)
            if not library.is_blade_file(path):
                case = library.select(path if source.endswith(".toml") else source)
                return [(variant.blade, variant.unused) for variant in case.variants]
            source = BladeFile(source)
        reading = readers.reading(folder / source.file, source.mount(folder))
        return [(reading.mounted(folder / source.file), reading.source.unused)]
