"""Seeded faults on the blade that is verified: faults of core, and of the reader of the blade's file.

A fault of core counts as detected only if a code that shares nothing with core *fails* with it and did not without it; a fault
of a reader only if the second reading of the file differs. A fault that changes no compared frequency of this blade by more
than the target, or no property, is *without effect here*.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.blade import BEND_Y, BEND_Z, Blade
from ...core.space.inertia import transformed
from ...core.space.spatial import pose
from ...references.protocol.description import Description, describe
from ...references.protocol.process import Limits
from ..diagnosis import blade_errors as errors
from ..judge.results import Cell, Control
from ..judge.verdict import unsigned
from ..plan.blade import BladeSubject
from ..plan.column import Column
from ..plan.subject import Subject
from ..plan.user_results import UserResults
from ..run.executors import Serial
from ..solve import properties
from ..verify import matrix
from .seeding import Fault, seeded
from .table import BY_NAME, FAST

ELSEWHERE = ("whole end mass",)
"""Faults of core that do not change its references: they concern the paper's discretisation."""

NAMES = tuple(name for name in FAST if name not in ELSEWHERE)
"""Faults of core that are run on the blade that is verified."""

WITNESSES = 2
"""Number of codes that are asked about each fault."""

NO_WITNESS = "an independent code that agrees on this blade"


@dataclass(frozen=True)
class _Witnessed(BladeSubject):
    """A blade with the columns of independent codes only."""

    def columns(self, codes: Sequence[Description], limits: Limits, added: Sequence[UserResults]) -> list[Column]:
        """See ``Subject``."""
        columns = super().columns(codes, limits, added)
        return [column for column in columns if column.head.role == "code" and column.head.shares == "nothing"]


def is_users(subject: Subject) -> bool:
    """Whether a subject is a blade that does not come with the package."""
    return isinstance(subject, BladeSubject) and subject.users


def witnesses(cells: Iterable[Cell], subject: Subject) -> tuple[str, ...]:
    """Codes that share nothing with core and pass at the highest speed in every mode."""
    fastest = max(subject.points)
    passing: dict[str, bool] = {}
    for cell in cells:
        if cell.case == subject.name and cell.omega == fastest and cell.role == "code" and cell.shares == "nothing":
            passing[cell.code] = passing.get(cell.code, True) and cell.verdict == "pass" and bool(cell.version)
    return tuple(code for code, passes in passing.items() if passes)[:WITNESSES]


def run(subject: BladeSubject, codes: Sequence[str], names: Sequence[str], reuse: bool = False) -> list[Control]:
    """Run faults of core on a blade at its highest speed, against some codes; a task for any process."""
    faults = [BY_NAME[name] for name in names]
    fastest = _Witnessed(subject.case, replace(subject.variant, speeds=np.array([max(subject.points)])))
    if not codes:
        return [replace(_control(fault, fastest), needs=NO_WITNESS) for fault in faults]
    described = describe(codes, [fastest.blade])

    def solve() -> tuple[Cell, ...]:
        return matrix.run([fastest], described, Serial(), reuse=reuse, parts=False).cells

    right, out = solve(), []
    for fault in faults:
        with seeded(fault.seams):
            wrong = solve()
        out.append(judged(_control(fault, fastest), right, wrong))
    return out


def judged(control: Control, right: Sequence[Cell], wrong: Sequence[Cell]) -> Control:
    """The result of a fault from the cells of independent codes without and with it."""
    before = {_key(cell): cell for cell in right}
    bad = [c for c in wrong if c.verdict == "fail" and getattr(before.get(_key(c)), "verdict", "") != "fail"]
    if bad:
        changes = [c.difference for c in bad if c.difference is not None]
        found = tuple(f"{c.case}, {c.code}, {c.name or 'no answer'}, {c.omega:g} rad/s: fail" for c in bad)
        return replace(control, detected_by=found, change=max(changes, key=abs, default=None))
    pairs = [(before[_key(c)], c) for c in wrong if _key(c) in before]
    moved = [abs(b.reference / a.reference - 1.0) for a, b in pairs if a.reference and b.reference]
    target = min((c.target for c in wrong), default=0.0)
    if moved and max(moved) <= target:
        return replace(control, without_effect=f"changes no compared frequency by more than {unsigned(max(moved))}")
    return control


def _key(cell: Cell) -> tuple[str, float, int, str, str]:
    return cell.code, cell.omega, cell.mode, cell.quantity, cell.where


def _control(fault: Fault, subject: BladeSubject) -> Control:
    return Control(fault.name, fault.area, fault.what, fault.size, subject.name, max(subject.points), ())


@dataclass(frozen=True)
class ReaderFault:
    """A mistake of a reader: the blade that it returns instead of the right one.

    Attributes:
        name: short name.
        what: one sentence.
        alter: from the right blade to the wrong one.
        part: the property that a second reading must state to detect it; empty if every second reading does.
    """

    name: str
    what: str
    alter: Callable[[Blade], Blade]
    part: str = ""


def _root_mass(blade: Blade) -> Blade:
    mass = blade.mass.copy()
    mass[0] *= 10.0
    return replace(blade, mass=mass)


def _shifted(blade: Blade) -> Blade:
    """Sections about an axis that lies a hundredth of the length behind theirs."""
    place = pose(np.eye(3), np.array([0.0, 0.01 * blade.length, 0.0]))
    return replace(blade, mass=transformed(blade.mass, np.broadcast_to(place, (len(blade.mass), 4, 4))))


def _shear_and_torsion(blade: Blade) -> Blade:
    """Rows of BeamDyn's order (shear, shear, axial; bending, bending, torsion) taken as those of core."""
    order = [1, 2, 0, 4, 5, 3]
    return replace(blade, mass=blade.mass[:, order][:, :, order], stiffness=blade.stiffness[:, order][:, :, order])


READER = (
    ReaderFault("reader: columns exchanged", "flapwise and edgewise stiffness are exchanged", errors.exchanged_bending),
    ReaderFault("reader: unit", "flapwise stiffness is taken in kN m²", errors.scaled_strain(1e-3, BEND_Y)),
    ReaderFault("reader: mass multiplier", "a multiplier of the mass, of 1.05, is ignored", errors.scaled_mass(1 / 1.05)),
    ReaderFault("reader: stiffness multiplier", "a multiplier of the edgewise stiffness, of 1.05, is ignored",
                errors.scaled_strain(1 / 1.05, BEND_Z)),
    ReaderFault("reader: twist's sign", "the twist has the opposite sign", lambda b: replace(b, twist=-b.twist)),
    ReaderFault("reader: prebend's sign", "the prebend has the opposite sign", errors.mirrored_curve(-1.0, 1.0)),
    ReaderFault("reader: offsets", "mass centres are given about another axis", _shifted),
    ReaderFault("reader: precone's sign", "the precone has the opposite sign", lambda b: replace(b, precone=-b.precone),
                "precone"),
    ReaderFault("reader: hub radius", "the hub radius is dropped", lambda b: replace(b, hub_radius=0.0),
                "hub radius"),
    ReaderFault("reader: root mass", "the mass of the root station is ten times too large", _root_mass),
    ReaderFault("reader: order", "shear and torsion are in the order of BeamDyn", _shear_and_torsion),
    ReaderFault("reader: station", "the twist is that of the station before",
                lambda b: replace(b, twist=np.concatenate([b.twist[:1], b.twist[:-1]]))),
)  # fmt: skip
"""Mistakes of readers and of sampling."""


def reading(subject: BladeSubject) -> list[Control]:
    """Run the mistakes of readers on the blade's file: the second reading must differ; empty for a blade without a file."""
    file = subject.variant.file
    if file is None:
        return []
    right, _ = properties.of_reading(subject.name, file, file.blade)
    out = []
    for fault in READER:
        control = Control(fault.name, "reader", fault.what, "", subject.name, max(subject.points), ())
        if absent := [row.reason for row in right if row.verdict == "not run"]:
            out.append(replace(control, needs=absent[0]))
            continue
        try:
            wrong = fault.alter(file.blade)
        except ValueError as error:
            out.append(replace(control, detected_by=(f"{subject.name}, refused: {error}",)))
            continue
        if _equal(wrong, file.blade):
            out.append(replace(control, without_effect="changes no property of this blade"))
            continue
        if fault.part and fault.part not in {row.part for row in right}:
            out.append(replace(control, needs=f"a file that states the {fault.part}"))
            continue
        rows, _ = properties.of_reading(subject.name, replace(file, blade=wrong), wrong)
        known = {row.part for row in right if row.verdict == "fail"}
        found = [row for row in rows if row.verdict == "fail" and row.part not in known]
        out.append(
            replace(control, detected_by=tuple(f"{subject.name}, second reading, {row.part}: fail" for row in found))
        )
    return out


def _equal(a: Blade, b: Blade) -> bool:
    return all(np.array_equal(value, vars(b)[name]) for name, value in vars(a).items())
