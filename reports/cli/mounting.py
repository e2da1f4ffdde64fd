"""Options for what a blade's file does not define: the length, and how the blade is mounted on the hub.

Pitch has two sign conventions. Southwell's rotates y towards z: the leading edge moves downwind, towards stall of an
upwind rotor. OpenFAST's BlPitch rotates the leading edge upwind, to feather: the same angle with the opposite sign.
"""

from dataclasses import dataclass
from math import isfinite, radians
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from ...cases.input.errors import CaseError
from ...cases.input.readers import Mount
from ...core.blade_checks import MAX_LENGTH, MAX_PITCH, MAX_PRECONE, MIN_LENGTH


@Parameter(name="*")
@dataclass(frozen=True)
class Mounting:
    """What a blade's file leaves to others; of a case, none.

    Parameters
    ----------
    main
        Main file that defines how the blade is mounted on the hub (ElastoDyn, BeamDyn, HAWC2 htc).
    length
        Length from root to tip in m. Default: as in the files.
    hub_radius
        Distance from the hub's centre to the root in m, along the coned axis of the blade. Default: as in the files.
    precone
        Precone in degrees, positive downwind. Default: as in the files.
    pitch
        Pitch in degrees, positive with the leading edge downwind (see --pitch-convention). Default: 0. BlPitch of an
        ElastoDyn main file is the initial pitch of a simulation; it is listed as not used.
    pitch_convention
        Sign of --pitch: `southwell`, positive with the leading edge downwind; `openfast`, positive with the leading edge
        upwind (to feather), as BlPitch.
    subset
        Set and subset of a HAWC2 structural file, for example `5:1`. Default: those of the htc, or the only ones.
    multipliers
        Factors of mass, flapwise and edgewise stiffness that replace AdjBlMs, AdjFlSt and AdjEdSt of an ElastoDyn file, for
        example `1.057344,1,1`.
    offsets
        Use the offset columns of a FAST 7 table (PrecrvRef, PreswpRef, FlpcgOf, EdgcgOf, FlpEAOf, EdgEAOf). Default: yes.
    """

    main: Path | None = None
    length: float | None = None
    hub_radius: float | None = None
    precone: float | None = None
    pitch: float | None = None
    pitch_convention: Literal["southwell", "openfast"] = "southwell"
    subset: str | None = None
    multipliers: str | None = None
    offsets: Annotated[bool | None, Parameter(negative="--no-offsets")] = None

    def mount(self) -> Mount:
        """The mount for a reader, in radians.

        Raises:
            CaseError: naming the invalid option.
        """
        for option, value, minimum in (("--length", self.length, MIN_LENGTH), ("--hub-radius", self.hub_radius, 0.0)):
            if value is not None and not minimum <= value <= MAX_LENGTH:
                raise CaseError(f"{option} {value:g}: not a length in metres: give one, as in 61.5")
        if self.pitch is None and self.pitch_convention != "southwell":
            raise CaseError(f"--pitch-convention {self.pitch_convention}: no pitch is given: add --pitch")
        pitch = angle("--pitch", self.pitch, limit=MAX_PITCH)
        return Mount(
            main=self.main,
            length=self.length,
            hub_radius=self.hub_radius,
            precone=angle("--precone", self.precone, limit=MAX_PRECONE),
            pitch=-pitch if pitch and self.pitch_convention == "openfast" else pitch,
            subset=None if self.subset is None else _subset(self.subset),
            multipliers=None if self.multipliers is None else _multipliers(self.multipliers),
            offsets=self.offsets,
        )


def angle(option: str, degrees: float | None, limit: float = 360.0) -> float | None:
    """Convert an angle to radians; None if not given.

    Raises:
        CaseError: if it is not finite, or its absolute value exceeds ``limit`` degrees.
    """
    if degrees is not None and not isfinite(degrees):
        raise CaseError(f"{option} {degrees}: not a finite number of degrees: give one, as in 2.5")
    if degrees is not None and abs(degrees) > limit:
        raise CaseError(f"{option} {degrees:g}: beyond ±{limit:g} degrees: give degrees, as in 2.5")
    return None if degrees is None else radians(degrees)


def _subset(text: str) -> tuple[int, int]:
    try:
        first, second = (int(p) for p in text.split(":"))
    except ValueError:
        raise CaseError(f"--subset: {text!r} is not set:subset, as in 5:1") from None
    return first, second


def _multipliers(text: str) -> tuple[float, float, float]:
    try:
        mass, flap, edge = (float(p) for p in text.split(","))
    except ValueError:
        raise CaseError(f"--multipliers: {text!r} is not mass,flap,edge, as in 1.04536,1,1") from None
    if not all(isfinite(v) and v > 0 for v in (mass, flap, edge)):
        raise CaseError(f"--multipliers: {text!r}: not positive factors: give positive numbers, as in 1.04536,1,1")
    return mass, flap, edge
