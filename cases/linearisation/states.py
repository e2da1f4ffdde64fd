"""States of a linearisation, understood from their descriptions and never from their order."""

import re
from dataclasses import dataclass
from functools import cached_property

MODULES = (
    "ED",
    "BD",
    "SED",
    "AD",
    "SrvD",
    "HD",
    "SD",
    "MD",
    "MAP",
    "FEAM",
    "IfW",
    "ExtPtfm",
    "SeaSt",
    "IceD",
    "IceF",
    "ADsk",
)
"""Prefixes of OpenFAST's modules in descriptions; those of several instances end in a number, as ``BD_1``."""

RATE = "First time derivative of "

_MODULE = re.compile(rf"({'|'.join(MODULES)})(?:_(\d+))?\s+(.*)", re.DOTALL)
_UNIT = re.compile(r"[^\s,]{1,10}")
_INDEX = re.compile(r"internal DOF index = (DOF_\w+(?:\([^)]*\))?)")
_BLADE = re.compile(r"\bblade\s*(\d+)|DOF_B[FE]\((\d+)\s*,", re.IGNORECASE)
_BLADE_NUMBER = re.compile(r"(\bblade\s*)\d+|(DOF_B[FE]\()\d+(?=\s*,)", re.IGNORECASE)
_STRUCTURAL_CONTROL = re.compile(r"(.* StC \d+ )local displacement state (d?)([XYZ])(?:/dt)?\s+(\S+)")
_VELOCITY = re.compile(r"\bvelocity\b")
_NODE = re.compile(r"\bnode (\d+)")
_ORDER = re.compile(r"\belement order = (\d+)")
_DIRECTION = re.compile(r"(translational|rotational) displacement in ([XYZ])")

_FAMILIES = (
    (re.compile(r"DOF_TFA(\d)|(\d)\w\w tower fore-aft"), "tower fore-aft {}"),
    (re.compile(r"DOF_TSS(\d)|(\d)\w\w tower side-to-side"), "tower side-side {}"),
    (re.compile(r"DOF_Yaw|Nacelle yaw"), "yaw"),
    (re.compile(r"DOF_GeAz|Variable speed generator"), "generator"),
    (re.compile(r"DOF_DrTr|Drivetrain rotational-flexibility"), "drivetrain"),
    (re.compile(r"DOF_BF\(\d+\s*,\s*(\d)\)|(\d)\w\w flapwise"), "flapwise {}"),
    (re.compile(r"DOF_BE\(\d+\s*,\s*(\d)\)|(\d)\w\w edgewise"), "edgewise {}"),
    (re.compile(r"DOF_Teet|teeter", re.IGNORECASE), "teeter"),
    (re.compile(r"DOF_RFrl|Rotor-furl"), "rotor furl"),
    (re.compile(r"DOF_TFrl|Tail-furl"), "tail furl"),
    (re.compile(r"DOF_Sg\b|Platform horizontal surge"), "platform surge"),
    (re.compile(r"DOF_Sw\b|Platform horizontal sway"), "platform sway"),
    (re.compile(r"DOF_Hv\b|Platform vertical heave"), "platform heave"),
    (re.compile(r"DOF_R\b|Platform roll"), "platform roll"),
    (re.compile(r"DOF_P\b|Platform pitch"), "platform pitch"),
    (re.compile(r"DOF_Y\b|Platform yaw"), "platform yaw"),
    (re.compile(r"translational displacement in X"), "flapwise"),
    (re.compile(r"translational displacement in Y"), "edgewise"),
    (re.compile(r"translational displacement in Z"), "axial"),
    (re.compile(r"rotational displacement in X"), "edgewise"),
    (re.compile(r"rotational displacement in Y"), "flapwise"),
    (re.compile(r"rotational displacement in Z"), "torsion"),
    (re.compile(r"\bDBEMT\b|\bvind\b"), "dynamic inflow"),
    (re.compile(r"\bUA\b|^x\d blade\b"), "unsteady airfoil"),
    (re.compile(r"Blade \d+ StC (.+)"), "blade StC {}"),
    (re.compile(r"ExctnPtfm"), "wave excitation"),
    (re.compile(r"RdtnPtfm"), "wave radiation"),
    (re.compile(r"C(?:raig-)?B(?:ampton)? mode (\d+)"), "substructure {}"),
)
"""Pattern in a description → name of the motion; ``{}`` is the number that the pattern matches."""

STRUCTURAL = ("ED", "BD", "SD", "SED")
"""Modules whose states are displacements of structures, and their rates."""


@dataclass(frozen=True)
class State:
    """A continuous state.

    Attributes:
        text: description in the file.
        module: module without its number, as ``BD``; empty if unknown.
        name: description without module, unit and ``RATE``; equal for a displacement and its rate.
        unit: unit in the file; empty if not stated.
        rotating: the file's flag of the rotating frame.
        order: derivative order in the file; None if not stated.
        rate: whether it is the time derivative of another state.
        blade: number of the blade; None if it belongs to none.
        value: value at the operating point.
    """

    text: str
    module: str
    name: str
    unit: str
    rotating: bool
    order: int | None
    rate: bool
    blade: int | None
    value: float

    @cached_property
    def family(self) -> str:
        """Name of the motion, as ``flapwise 1``; the description if it is unknown."""
        for pattern, name in _FAMILIES:
            if match := pattern.search(self.name):
                return name.format(next((group for group in match.groups() if group), ""))
        return self.name

    @cached_property
    def kind(self) -> str:
        """Identifies the state among those of its blade: the same text for blades 1, 2 and 3."""
        return f"{self.module} {_BLADE_NUMBER.sub(lambda m: (m[1] or m[2]) + '#', self.name)}"

    @cached_property
    def key(self) -> tuple[str, int | None, bool]:
        """Identifies the state within a file."""
        return self.kind, self.blade, self.rate

    @property
    def label(self) -> str:
        """Short name for messages, as ``flapwise 1 of blade 2`` or ``rate of yaw``."""
        node, direction = _NODE.search(self.name), _DIRECTION.search(self.name)
        motion = f"node {node[1]} {direction[1][:5]} {direction[2]}" if node and direction else self.family
        return ("rate of " if self.rate else "") + motion + (f" of blade {self.blade}" if self.blade else "")

    @cached_property
    def direction(self) -> tuple[str, int, int] | None:
        """Kind of displacement, direction 0 to 2 and node of a state of a finite element node; else None."""
        node, direction = _NODE.search(self.name), _DIRECTION.search(self.name)
        return (direction[1], "XYZ".index(direction[2]), int(node[1])) if node and direction else None

    @property
    def element_order(self) -> int | None:
        """Order of the only finite element of a blade, to which a node's state belongs; None if there are several."""
        order = _ORDER.search(self.name)
        return int(order[1]) if order and "number of elements = 1;" in self.name else None

    @property
    def expected_rotating(self) -> bool | None:
        """Whether the physics places the state in the rotating frame; None if the description does not tell."""
        if self.module in ("ED", "BD", "SED"):
            return self.blade is not None or self.family == "teeter"
        return False if self.module in ("SD", "HD", "MD", "MAP") else None


def parse(text: str, rotating: bool, order: int | None, value: float) -> State:
    """The state of a description such as ``ED 1st flapwise bending-mode DOF of blade 1 (…), m``."""
    text = " ".join(text.split())
    match = _MODULE.fullmatch(text)
    module, instance, name = (match[1], match[2], match[3]) if match else ("", None, text)
    body, comma, unit = name.rpartition(", ")
    if comma and _UNIT.fullmatch(unit):
        name = body
    else:
        unit = ""
    rate = RATE in name
    name = name.replace(RATE, "")
    if damper := _STRUCTURAL_CONTROL.fullmatch(name):
        name, rate, unit = f"{damper[1]}displacement {damper[3]}", bool(damper[2]), damper[4]
    if not rate and _VELOCITY.search(name) and module in ("SrvD", "MD"):
        rate, name = True, _VELOCITY.sub("displacement", name)
    blade = int(instance) if module == "BD" and instance else None
    if blade is None and (numbered := _BLADE.search(name)):
        blade = int(numbered[1] or numbered[2])
    if index := _INDEX.search(name):
        name = f"{name[: index.start()].rstrip(' (')} {index[1]}"
    return State(text, module, name, unit, rotating, order, rate, blade, value)
