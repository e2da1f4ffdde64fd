"""Defects that occur in linearisations, each planted into a healthy set."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .linearised_machines import Lin, Machine, NodeMachine, Row, beamdyn, elastodyn, without

MACHINE = Machine(omega=1.1)
NODES = NodeMachine()
OFFSET = 0.05
"""Azimuth of the first file, rad."""


def healthy(machine: Machine = MACHINE, n: int = 12, **options: object) -> list[Lin]:
    """A set of ElastoDyn's states at n azimuths."""
    return [elastodyn(machine, OFFSET + 2 * np.pi * k / n, **options) for k in range(n)]


def healthy_nodes(machine: NodeMachine = NODES, n: int = 5, frozen: bool = False) -> list[Lin]:
    """A set of BeamDyn's states at n azimuths."""
    return [beamdyn(machine, OFFSET + 2 * np.pi * k / n, frozen) for k in range(n)]


HEALTHY: dict[str, Callable[[], list[Lin]]] = {
    "12 azimuths": healthy,
    "36 azimuths, faster": lambda: healthy(Machine(omega=1.267, pitch=0.3), 36),
    "9 azimuths, slow": lambda: healthy(Machine(omega=0.5), 9),
    "in vacuo without gravity": lambda: healthy(Machine(gravity=0.0), 10),
    "aerodynamic damping": lambda: healthy(Machine(aerodynamic=2.0)),
    "soft tower": lambda: healthy(Machine(tower=(0.2, 0.19), nacelle=600e3)),
    "large rotor": lambda: healthy(Machine(omega=0.7, radius=110.0, mass=600.0, nacelle=900e3, generator=6e7), 8),
    "many digits": lambda: healthy(Machine(omega=0.9), decimals=9),
    "generator locked": lambda: [
        replace(without(lin, "DOF_GeAz"), A=MACHINE.locked()(lin.azimuth)) for lin in healthy(MACHINE)
    ],
    "BeamDyn": healthy_nodes,
}
"""Sets without a defect."""


def _states(lin: Lin, *words: str) -> list[int]:
    return [k for k, row in enumerate(lin.rows) if any(word in row.text for word in words)]


def _rows(lin: Lin, change: Callable[[Row], Row]) -> Lin:
    return replace(lin, rows=tuple(change(row) for row in lin.rows))


def frame_flag() -> list[Lin]:
    """The edgewise states are flagged as fixed."""
    return [
        _rows(lin, lambda row: replace(row, rotating=row.rotating and "edgewise" not in row.text)) for lin in healthy()
    ]


def frozen_frame() -> list[Lin]:
    """Nodes in a frozen frame, flagged as rotating."""
    return healthy_nodes(frozen=True)


def index_shift() -> list[Lin]:
    """The blades' columns of the stiffness are stored one node further on."""
    out = []
    for lin in healthy_nodes():
        A, half = lin.A.copy(), len(lin.A) // 2
        for b in range(3):
            first = 2 + 6 * NODES.nodes * b
            columns = np.arange(first, first + 6 * NODES.nodes)
            A[half:, columns] = np.roll(A[half:, columns], 6, axis=1)
        out.append(replace(lin, A=A))
    return out


def index_shift_of_rates() -> list[Lin]:
    """The columns of the blades' rates are stored one node further on."""
    out = []
    for lin in healthy_nodes():
        A, half = lin.A.copy(), len(lin.A) // 2
        columns = np.arange(half + 2, len(A))
        A[:, columns] = np.roll(A[:, columns], 6, axis=1)
        out.append(replace(lin, A=A))
    return out


def zero_column() -> list[Lin]:
    """The column of the first edgewise displacement of blade 2 is zero."""
    out = []
    for lin in healthy():
        A = lin.A.copy()
        A[:, 9] = 0.0
        out.append(replace(lin, A=A))
    return out


def drift_of_an_inertia() -> list[Lin]:
    """A third of the files are of a version with 4 % more inertia of the generator."""
    return [*healthy()[:8], *healthy(replace(MACHINE, generator_factor=1.04))[8:]]


def truncated_digits() -> list[Lin]:
    """Two significant digits, padded with zeros."""
    out = []
    for lin in healthy():
        A = np.array([[float(f"{value:.1e}") for value in row] for row in lin.A])
        out.append(replace(lin, A=A))
    return out


def header_overflow() -> list[Lin]:
    """The number of states is printed as asterisks."""
    return [replace(lin, states="***") for lin in healthy()]


def missing_azimuths() -> list[Lin]:
    """A third of the revolution is missing."""
    return healthy()[:8]


def unsteady() -> list[Lin]:
    """The rotor slows down by 3 % from the first to the last azimuth."""
    return [
        replace(elastodyn(replace(MACHINE, omega=MACHINE.omega * (1 - 0.03 * k / 11)), OFFSET + 2 * np.pi * k / 12))
        for k in range(12)
    ]


def reordered() -> list[Lin]:
    """One file has another order of the states, in tables and matrix."""
    lins = healthy()
    order = np.arange(28)
    order[[0, 1, 14, 15]] = order[[1, 0, 15, 14]]
    lins[3] = replace(lins[3], rows=tuple(lins[3].rows[k] for k in order), A=lins[3].A[np.ix_(order, order)])
    return lins


def reordered_tables() -> list[Lin]:
    """In one file the rates in the table are in another order than in the matrix."""
    lins = healthy()
    order = np.arange(28)
    order[14:18] = order[[16, 17, 14, 15]]
    lins[3] = replace(lins[3], rows=tuple(lins[3].rows[k] for k in order))
    return lins


def exchanged_blades(values: bool = True) -> list[Lin]:
    """Blades 2 and 3 have each other's number; without ``values``, their operating points do not show it."""
    out = []
    for lin in healthy():
        order = np.arange(28)
        for k in (5, 8, 11, 19, 22, 25):
            order[[k + 1, k + 2]] = order[[k + 2, k + 1]]
        rows = tuple(
            replace(row, value=lin.rows[order[k]].value, slope=lin.rows[order[k]].slope)
            for k, row in enumerate(lin.rows)
        )
        out.append(replace(lin, rows=rows if values else lin.rows, A=lin.A[np.ix_(order, order)]))
    return out


def stiff_blade(factor: float = 1.05) -> list[Lin]:
    """Blade 2 is stiffer flapwise by a factor."""
    return healthy(replace(MACHINE, flap_factor=(1.0, factor, 1.0)))


def reversed_pitch() -> list[Lin]:
    """Blade 3 is pitched the other way."""
    return healthy(replace(MACHINE, pitch_sign=(1.0, 1.0, -1.0)))


def tower_in_millimetres() -> list[Lin]:
    """The tower's states are in mm, the tables say m."""
    out = []
    for lin in healthy():
        scale = np.ones(28)
        scale[[0, 1, 14, 15]] = 1000.0
        out.append(replace(lin, A=scale[:, None] * lin.A / scale))
    return out


def locked_generator() -> list[Lin]:
    """The generator is in the table, but its equation is that of a locked one."""
    out = []
    for lin in healthy():
        A = lin.A.copy()
        A[17] = 0.0
        out.append(replace(lin, A=A))
    return out


def removed_mode() -> list[Lin]:
    """The second flapwise mode of blade 3 is missing."""
    return [without(lin, "DOF_BF(3,2)") for lin in healthy()]


@dataclass(frozen=True)
class Defect:
    """A defect: how it is called, how it is planted, and the names under which it counts as recognised."""

    title: str
    plant: Callable[[], Sequence[Lin]]
    names: tuple[str, ...]


DEFECTS = (
    Defect("frame flag", frame_flag, ("frame flag",)),
    Defect("frozen frame flagged as rotating", frozen_frame, ("frame flag",)),
    Defect("stiffness shifted by one node", index_shift, ("index shift",)),
    Defect("rates shifted by one node", index_shift_of_rates, ("index shift",)),
    Defect("zero column", zero_column, ("zero column",)),
    Defect("version drift of one inertia", drift_of_an_inertia, ("version drift",)),
    Defect("truncated digits", truncated_digits, ("truncated digits",)),
    Defect("header overflow", header_overflow, ("header overflow",)),
    Defect("missing azimuths", missing_azimuths, ("missing azimuths",)),
    Defect("unsteady operating point", unsteady, ("unsteady operating point",)),
    Defect("states of one file reordered", reordered, ("states reordered",)),
    Defect("tables reordered, not the matrix", reordered_tables, ("states reordered",)),
    Defect("blades exchanged", exchanged_blades, ("blades exchanged",)),
    Defect("blades exchanged in A alone", lambda: exchanged_blades(False), ("blades exchanged",)),
    Defect("blade 2 stiffer by 5 %", stiff_blade, ("unequal blades",)),
    Defect("pitch axis reversed", reversed_pitch, ("pitch reversed",)),
    Defect("tower states in mm", tower_in_millimetres, ("units of the tower",)),
    Defect("free generator declared locked", locked_generator, ("generator locked",)),
    Defect("a mode removed", removed_mode, ("missing state",)),
)
