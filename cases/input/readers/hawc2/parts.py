"""Which bodies of an htc are the tower, the nacelle, the shaft, the hubs and the blades of a turbine, and how they are joined.

The bodies from a blade down to the ground follow from the ``relative`` blocks. The shaft is the body that turns
(``ini_rotvec_d1``), or the last one that carries all blades. What is between it and the tower belongs to the nacelle. Source:
T. J. Larsen, A. M. Hansen, *How 2 HAWC2, the user's manual*, Risø-R-1597, ch. 6.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import CaseError
from ..text import Text, number
from . import bodies, orientation
from .orientation import Relative

Array = NDArray[np.float64]

MIN_BLADES = 3

JOINTS = ("fix1", "bearing1", "bearing2", "bearing3")
"""Constraints between two bodies: rigid, turning freely, at an angle, and at a speed that the simulation prescribes."""


@dataclass(frozen=True)
class Joint:
    """A constraint: its kind, the bodies that it joins, and the vector (3,) of a bearing with the number of its axes."""

    kind: str
    parent: str
    child: str
    vector: tuple[int, Array] | None


@dataclass(frozen=True)
class Parts:
    """The bodies of a turbine.

    Attributes:
        commands: of each body, by name.
        relatives: the ``relative`` block of each.
        base: (3, 3) axes of the tower in the ground's.
        tower, shaft: names.
        nacelle: names of the bodies between tower and shaft, upwards.
        blades: names.
        hubs: names of the bodies from the shaft to each blade, outwards.
        fixed_bodies: names of further bodies, and of the body of these that each is fixed to.
        joints: the constraints, by parent and child.
    """

    commands: dict[str, bodies.Body]
    relatives: dict[str, Relative]
    base: Array
    tower: str
    nacelle: tuple[str, ...]
    shaft: str
    blades: tuple[str, ...]
    hubs: tuple[tuple[str, ...], ...]
    fixed_bodies: dict[str, str]
    joints: dict[tuple[str, str], Joint]

    @property
    def rotating(self) -> tuple[str, ...]:
        """Shaft and hubs."""
        return tuple(dict.fromkeys([self.shaft, *(name for hub in self.hubs for name in hub)]))


def parts(htc: Text, commands: bodies.Body) -> Parts | str:
    """The bodies of the turbine in an htc, or what it lacks for a whole turbine.

    Raises:
        CaseError: a file that the htc continues in is missing.
    """
    by_name, relatives = bodies.main_bodies(commands), orientation.relatives(commands)
    carriers = {block.parent for block in relatives.values()}
    blades = tuple(name for name in by_name if name.startswith("blade") and name in relatives.keys() - carriers)
    if len(blades) < MIN_BLADES:
        return f"the htc has {len(blades)} oriented bodies whose name begins with blade; a turbine needs {MIN_BLADES} or more"
    if altered := bodies.altered_copy(commands):
        return altered
    chains = []
    for blade in blades:
        chain = [blade]
        while chain[0] in relatives and len(chain) <= orientation.MAX_BODIES:
            chain.insert(0, relatives[chain[0]].parent)
        chains.append(chain)
    base = orientation.base(commands)
    if base is None:
        return "the htc has no `base` block that orients the tower"
    name, axes = base
    if not name.startswith("tower"):
        return f"the body on the ground is {name}, not the tower: foundations and floaters are not read"
    if (other_root := next((chain[0] for chain in chains if chain[0] != name), None)) is not None:
        return f"the orientation of {other_root} from {name} is not defined by `relative` blocks"
    if (undefined := next((part for chain in chains for part in chain if part not in by_name), None)) is not None:
        return f"the htc has no main_body {undefined}"
    common = [part for k, part in enumerate(chains[0]) if all(len(c) > k and c[k] == part for c in chains)][1:]
    turning = next((part for part in common if relatives[part].axis is not None), common[-1] if common else None)
    if turning is None:
        return "the htc has no main_body between tower and hubs that is a shaft"
    if not _fixed(commands, name):
        return f"{name} is not clamped to the ground by fix0: foundations and floaters are not read"
    k = chains[0].index(turning)
    for part in dict.fromkeys(part for chain in chains for part in chain):
        if missing_command := _lacking(htc, by_name[part]):
            return f"{missing_command} of {part} is not there"
    inside = {part for chain in chains for part in chain}
    fixed_bodies = {
        child: block.parent for child, block in relatives.items() if child not in inside and child in by_name
    }
    return Parts(
        by_name,
        relatives,
        axes,
        name,
        tuple(chains[0][1:k]),
        turning,
        blades,
        tuple(tuple(chain[k + 1 : -1]) for chain in chains),
        fixed_bodies,
        {(j.parent, j.child): j for j in _joints(commands)},
    )


def of_file(htc: Text) -> Parts | str:
    """``parts`` of an htc; a file that is missing is what it lacks."""
    try:
        return parts(htc, bodies.commands(htc))
    except CaseError as error:
        return str(error)


def _lacking(htc: Text, body: bodies.Body) -> str:
    """What a body lacks of its structural file and c2_def; empty if nothing."""
    try:
        bodies.properties(htc, body)
    except CaseError:
        return next((c.words[1] for c in body if c.words[0] == "filename" and len(c.words) > 1), "the structural file")
    return "" if any(c.words[0] == "sec" for c in body) else "c2_def"


def _fixed(commands: bodies.Body, tower: str) -> bool:
    names = [c.words[1].lower() for _, b in bodies.blocks(commands, "fix0") for c in b if len(c.words) > 1]
    return tower in names


def _joints(commands: bodies.Body) -> list[Joint]:
    out = []
    for kind, block in bodies.blocks(commands, *JOINTS):
        commands_of = {c.words[0].removeprefix("m").replace("bdy", "body"): c.words[1:] for c in block}
        if not (commands_of.get("body1") and commands_of.get("body2")):
            continue
        values = [number(word) for word in commands_of.get("bearing_vector", ())[:4]]
        vector = None
        if len(values) == 4 and all(v is not None and np.isfinite(v) for v in values):
            reference, *components = (float(v) for v in values if v is not None)
            vector = (round(reference), np.array(components)) if any(components) else None
        out.append(Joint(kind, commands_of["body1"][0].lower(), commands_of["body2"][0].lower(), vector))
    return out
