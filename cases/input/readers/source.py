"""What every reader is given beside its file, and what it tells beside its blade."""

from dataclasses import dataclass
from pathlib import Path

from ....core.blade import Blade

LONGEST = 1e4
"""No blade's length or hub's radius is more, m."""


@dataclass(frozen=True)
class Source:
    """Where a blade came from, and what was done to it at the door.

    Attributes:
        format: the format's name.
        files: all that were read.
        axes: the format's axes and centres, and what became of them in ours (see ``core.blade``).
        notes: what the file does not say and how that was settled, multipliers applied, what was left out.
    """

    format: str
    files: tuple[Path, ...]
    axes: str
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Reading:
    """A blade and its source."""

    blade: Blade
    source: Source


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
    """

    main: Path | None = None
    length: float | None = None
    hub_radius: float | None = None
    precone: float | None = None
    pitch: float | None = None
    subset: tuple[int, int] | None = None
    multipliers: tuple[float, float, float] | None = None


OPENFAST_AXES = (
    "OpenFAST: x downwind, y to the trailing edge, z along the blade, twist and pitch positive with the leading edge "
    "upwind; here x = its z, y = its −y, z = its x, and twist, pitch change sign"
)
