"""Mistakes of reading, on the blade or the turbine that is verified: the second reading of its file must differ."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

import numpy as np

from ...core.blade import BEND_Y, BEND_Z, Blade
from ...core.space.inertia import transformed
from ...core.space.spatial import pose
from ...core.turbine.turbine import Turbine
from ..diagnosis import blade_errors as errors
from ..input import readers
from ..input.readers import BladeFile
from ..judge.results import Control, PropertyCheck
from ..plan.blade import BladeSubject
from ..plan.turbine import TurbineSubject
from ..solve import properties
from ..solve.turbine_reading import read_again
from .turbines import other_tilt, plain_ratio, shaft_of, with_shaft


@dataclass(frozen=True)
class ReaderFault:
    """A mistake of a reader: the blade or the turbine that it returns instead of the right one.

    Attributes:
        name: short name.
        description: one sentence.
        alter: from what is right to what is wrong.
        part: the property that a second reading must state to detect it; empty if every second reading does.
    """

    name: str
    description: str
    alter: Callable[[Any], Any]
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


BLADE = (
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
"""Mistakes of reading a blade."""


def _other_side(turbine: Turbine) -> Turbine:
    """The nacelle's mass centre on the other side of the yaw axis."""
    mirror = np.diag([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
    return replace(turbine, nacelle=mirror @ turbine.nacelle @ mirror)


def _downwind(turbine: Turbine) -> Turbine:
    height, overhang, tilt = shaft_of(turbine)
    return with_shaft(turbine, height, -overhang, tilt)


TURBINE = (
    ReaderFault("reader: tilt's sign", "the tilt of the shaft has the other sign", other_tilt),
    ReaderFault("reader: overhang's sign", "the rotor is on the other side of the tower", _downwind),
    ReaderFault("reader: nacelle", "the nacelle's mass centre is on the other side of the yaw axis", _other_side),
    ReaderFault("reader: gear ratio", "the generator's inertia is multiplied by the ratio instead of its square", plain_ratio),
    ReaderFault("reader: tower", "fore-aft and side-to-side stiffness of the tower are exchanged",
                lambda t: replace(t, tower=errors.exchanged_bending(t.tower))),
)  # fmt: skip
"""Mistakes of reading a turbine."""


def run(subject: BladeSubject | TurbineSubject) -> list[Control]:
    """Run the mistakes of reading on the files of a blade or a turbine; empty for one without files that are read twice."""
    case, omega = subject.name, max(subject.points)
    if isinstance(subject, BladeSubject):
        return [] if subject.file is None else _of_blade(case, omega, subject.file)
    path, mount = subject.deck, subject.mount
    if path is None:
        return []
    blade = readers.reading(path, mount)
    of_turbine = _misread(case, omega, TURBINE, subject.turbine, lambda t: read_again(case, t, path, mount))
    return [*_of_blade(case, omega, BladeFile(path, blade.blade, blade.source, mount)), *of_turbine]


def _of_blade(case: str, omega: float, file: BladeFile) -> list[Control]:
    return _misread(
        case, omega, BLADE, file.blade, lambda blade: properties.of_reading(case, replace(file, blade=blade), blade)[0]
    )


def _misread(
    case: str,
    omega: float,
    faults: Sequence[ReaderFault],
    right: Blade | Turbine,
    rows: Callable[[Any], list[PropertyCheck]],
) -> list[Control]:
    """The results of faults; ``rows`` compares a blade or a turbine with the second reading of its file."""
    correct_rows = rows(right)
    failing = {row.part for row in correct_rows if row.verdict == "fail"}
    out = []
    for fault in faults:
        control = Control(fault.name, "reader", fault.description, "", case, omega, ())
        if reasons := [row.reason for row in correct_rows if row.verdict == "not run"]:
            out.append(replace(control, needs=reasons[0]))
            continue
        try:
            wrong = fault.alter(right)
        except ValueError as error:
            out.append(replace(control, detected_by=(f"{case}, refused: {error}",)))
            continue
        if _alike(wrong, right):
            out.append(replace(control, without_effect=f"changes no property of this {type(right).__name__.lower()}"))
            continue
        if fault.part and fault.part not in {row.part for row in correct_rows}:
            out.append(replace(control, needs=f"a file that states the {fault.part}"))
            continue
        parts = [row.part for row in rows(wrong) if row.verdict == "fail" and row.part not in failing]
        out.append(replace(control, detected_by=tuple(f"{case}, second reading, {part}: fail" for part in parts)))
    return out


def _alike(a: Any, b: Any) -> bool:
    """Whether two descriptions are equal but for rounding."""
    if is_dataclass(a):
        return all(_alike(getattr(a, field.name), getattr(b, field.name)) for field in fields(a))
    return np.allclose(a, b, rtol=1e-9, atol=1e-12) if isinstance(a, np.ndarray) else a == b
