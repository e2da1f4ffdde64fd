"""Additional input and output of every reader, besides the file and the blade."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from ....core.blade import Blade
from ....core.turbine.turbine import Turbine
from ..errors import CaseError


@dataclass(frozen=True)
class Unused:
    """A non-zero quantity in a file that the blade does not use.

    Attributes:
        name: name in the file.
        values: values in the file, one per station, mode or blade.
        unit: unit of the values; empty if there is none.
        file: path of the file.
        why: the reason, and what would use the quantity.
    """

    name: str
    values: tuple[float, ...]
    unit: str
    file: Path
    why: str

    @property
    def largest(self) -> float:
        """The value of largest magnitude, with its sign."""
        return max(self.values, key=abs)

    def __str__(self) -> str:
        value = f"{self.largest:g} {self.unit}".rstrip()
        return (
            f"not used: {self.name} ({'largest ' if len(self.values) > 1 else ''}{value}, {self.file.name}): {self.why}"
        )


def unused(name: str, values: Iterable[float], unit: str, file: Path, why: str) -> tuple[Unused, ...]:
    """The quantity as a tuple of one; empty if every value is zero."""
    numbers = tuple(float(value) for value in values)
    return (Unused(name, numbers, unit, file, why),) if any(numbers) else ()


@dataclass(frozen=True)
class Source:
    """Origin of a blade, and its conversion on reading.

    Attributes:
        format: name of the format.
        files: all files read.
        axes: axes and centres of the format, and their conversion to those of ``core.blade``.
        notes: assumptions about missing data, and multipliers applied.
        unused: non-zero quantities of the files that the blade does not use.
    """

    format: str
    files: tuple[Path, ...]
    axes: str
    notes: tuple[str, ...] = ()
    unused: tuple[Unused, ...] = ()

    @property
    def about(self) -> tuple[str, ...]:
        """The format with the names of the files, the axes, and the notes, one line each."""
        names = ", ".join(path.name for path in self.files)
        return (f"{self.format}: {names}", f"axes: {self.axes}", *self.notes)


@dataclass(frozen=True)
class Reading:
    """A blade and its source.

    Attributes:
        blade: the blade.
        source: its origin.
        speed: rotor speed of the analysis in the file, rad/s; None if not given.
        unstated: names of the fields of ``Mount`` that neither a file nor an option states, taken as 0.
    """

    blade: Blade
    source: Source
    speed: float | None = None
    unstated: tuple[str, ...] = ()

    def mounted(self, path: Path) -> Blade:
        """The blade, for rotation.

        Raises:
            CaseError: if its hub radius, which affects every frequency of a rotating blade, is unknown.
        """
        if "hub_radius" in self.unstated:
            raise CaseError(
                f"{path}: hub_radius: not in the files read ({self.source.format}), but required at speed: give the main "
                "file that states it (--main), or --hub-radius and --precone (0 if there is none)"
            )
        return self.blade


@dataclass(frozen=True)
class TurbineReading:
    """A turbine and its source; ``speed``: the deck's initial rotor speed, rad/s."""

    turbine: Turbine
    source: Source
    speed: float


@dataclass(frozen=True)
class BladeFile:
    """A blade as read from a file, before a case changes it: what a second reading of the file is compared with.

    Attributes:
        path: the file that the user names.
        blade: as read.
        source: its origin.
        mount: what the user states besides the file.
    """

    path: Path
    blade: Blade
    source: Source
    mount: "Mount"


@dataclass(frozen=True)
class Mount:
    """Length and mounting of a blade, which its file may not contain. None: as in the files, else 0.

    Attributes:
        main: main input file with these data (ElastoDyn's, also for a BeamDyn blade; a HAWC2 htc).
        length: arc length from root to tip, m.
        hub_radius: from the hub's centre to the root, m, along the coned axis of the blade.
        precone: rad, towards +z (downwind).
        pitch: rad, positive like twist in ``core.blade`` (y towards z: the leading edge downwind).
        subset: set and subset of a HAWC2 structural file with several.
        multipliers: multipliers of an ElastoDyn table, in place of the file's AdjBlMs, AdjFlSt, AdjEdSt.
        offsets: whether the offset columns of a FAST 7 table are used; None means yes.
    """

    main: Path | None = None
    length: float | None = None
    hub_radius: float | None = None
    precone: float | None = None
    pitch: float | None = None
    subset: tuple[int, int] | None = None
    multipliers: tuple[float, float, float] | None = None
    offsets: bool | None = None

    @property
    def unstated(self) -> tuple[str, ...]:
        """Names of the missing values among hub radius, precone and pitch."""
        return tuple(name for name in ("hub_radius", "precone", "pitch") if getattr(self, name) is None)

    @property
    def assumption(self) -> str:
        """What is assumed for the missing values, and the options that state them; empty if none is missing."""
        options = ", ".join(f"--{name.replace('_', '-')}" for name in self.unstated)
        return f"{', '.join(self.unstated)} taken as 0 (options: {options})" if options else ""


OPENFAST_AXES = (
    "OpenFAST: x downwind, y to the trailing edge, z along the blade, twist and pitch positive with the leading edge "
    "upwind; here x = its z, y = its −y, z = its x, and twist, pitch change sign"
)
