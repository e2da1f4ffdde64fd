"""Mistakes of readers and of sampling on the blade that is verified: the second reading of its file must differ."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...core.blade import BEND_Y, BEND_Z, Blade
from ...core.space.inertia import transformed
from ...core.space.spatial import pose
from ..diagnosis import blade_errors as errors
from ..input.readers import BladeFile
from ..judge.results import Control
from ..plan.blade import BladeSubject
from ..solve import properties


@dataclass(frozen=True)
class ReaderFault:
    """A mistake of a reader: the blade that it returns instead of the right one.

    Attributes:
        name: short name.
        description: one sentence.
        alter: from the right blade to the wrong one.
        part: the property that a second reading must state to detect it; empty if every second reading does.
    """

    name: str
    description: str
    alter: Callable[[Blade], Blade]
    part: str = ""


def _root_mass(blade: Blade) -> Blade:
    mass = blade.mass.copy()
    mass[0] *= 10.0
    return replace(blade, mass=mass)


def _shifted(blade: Blade) -> Blade:
    """Sections about an axis that lies a hundredth of the length behind theirs."""
    shift = pose(np.eye(3), np.array([0.0, 0.01 * blade.length, 0.0]))
    return replace(blade, mass=transformed(blade.mass, np.broadcast_to(shift, (len(blade.mass), 4, 4))))


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


def run(subject: BladeSubject) -> list[Control]:
    """Run the mistakes of readers on the blade's file; empty for a blade without a file."""
    file = subject.variant.file
    return [] if file is None else of_file(subject.name, max(subject.points), file)


def of_file(case: str, omega: float, file: BladeFile) -> list[Control]:
    """Run the mistakes of readers on a blade's file: the second reading must differ."""
    correct_rows, _ = properties.of_reading(case, file, file.blade)
    out = []
    for fault in READER:
        control = Control(fault.name, "reader", fault.description, "", case, omega, ())
        if reasons := [row.reason for row in correct_rows if row.verdict == "not run"]:
            out.append(replace(control, needs=reasons[0]))
            continue
        try:
            faulty_blade = fault.alter(file.blade)
        except ValueError as error:
            out.append(replace(control, detected_by=(f"{case}, refused: {error}",)))
            continue
        if _equal(faulty_blade, file.blade):
            out.append(replace(control, without_effect="changes no property of this blade"))
            continue
        if fault.part and fault.part not in {row.part for row in correct_rows}:
            out.append(replace(control, needs=f"a file that states the {fault.part}"))
            continue
        rows, _ = properties.of_reading(case, replace(file, blade=faulty_blade), faulty_blade)
        failing = {row.part for row in correct_rows if row.verdict == "fail"}
        detections = [row for row in rows if row.verdict == "fail" and row.part not in failing]
        out.append(
            replace(control, detected_by=tuple(f"{case}, second reading, {row.part}: fail" for row in detections))
        )
    return out


def _equal(a: Blade, b: Blade) -> bool:
    return all(np.array_equal(value, vars(b)[name]) for name, value in vars(a).items())
