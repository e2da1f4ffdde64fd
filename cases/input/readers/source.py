"""What every reader is given beside its file, and what it returns beside its blade."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from ....core.blade import Blade

LONGEST = 1e4
"""No blade's length or hub's radius is more, m."""


@dataclass(frozen=True)
class Unused:
    """A non-zero quantity in a file that the blade does not hold.

    Attributes:
        name: as the file calls it.
        values: as they stand in the file: one for each station, mode or blade.
        unit: of the values; empty if there is none.
        file: that holds them.
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
    found = tuple(float(value) for value in values)
    return (Unused(name, found, unit, file, why),) if any(found) else ()


@dataclass(frozen=True)
class Source:
    """Where a blade came from, and what was done to it at the door.

    Attributes:
        format: the format's name.
        files: all that were read.
        axes: the format's axes and centres, and what became of them in ours (see ``core.blade``).
        notes: what the file does not say and how that was decided, multipliers applied.
        unused: non-zero quantities of the files that the blade does not hold.
    """

    format: str
    files: tuple[Path, ...]
    axes: str
    notes: tuple[str, ...] = ()
    unused: tuple[Unused, ...] = ()


@dataclass(frozen=True)
class Reading:
    """A blade, its source, and the rotor speed that the file states for the analysis (rad/s; None: none)."""

    blade: Blade
    source: Source
    speed: float | None = None


@dataclass(frozen=True)
class Mount:
    """What a blade's file leaves to others: how long it is and how it sits on the hub. None: as the files say, else 0.

    Attributes:
        main: the main input file that says so (ElastoDyn's, also for a BeamDyn blade; a HAWC2 htc).
        length: arc length from root to tip, m.
        hub_radius: from the rotor's axis to the root, m.
        precone: rad, towards +z (downwind).
        pitch: rad, in the sense of our twist (y towards z: the leading edge downwind).
        subset: set and subset of a HAWC2 structural file that has several.
        multipliers: of an ElastoDyn table, in place of the file's AdjBlMs, AdjFlSt, AdjEdSt.
        offsets: whether the offset columns of a FAST 7 table are used; None: they are.
    """

    main: Path | None = None
    length: float | None = None
    hub_radius: float | None = None
    precone: float | None = None
    pitch: float | None = None
    subset: tuple[int, int] | None = None
    multipliers: tuple[float, float, float] | None = None
    offsets: bool | None = None


OPENFAST_AXES = (
    "OpenFAST: x downwind, y to the trailing edge, z along the blade, twist and pitch positive with the leading edge "
    "upwind; here x = its z, y = its −y, z = its x, and twist, pitch change sign"
)
