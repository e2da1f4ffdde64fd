"""Mass, mass centre and inertia of the turbine that each code assembles, against those of the second reading of its files."""

from collections.abc import Sequence
from functools import partial
from importlib.metadata import version
from pathlib import Path

import numpy as np

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS
from ...core.element.mesh import Mesh
from ...core.space import spatial as sp
from ...core.space.inertia import transformed
from ...core.spectrum.mesh_solver import balance
from ...core.turbine import component
from ...core.turbine import rotor as equations
from ...core.turbine.machine import machine
from ...core.turbine.turbine import Turbine
from ...references.protocol.description import Description
from ...references.protocol.fingerprint import Fingerprint, of_turbine
from ...references.protocol.process import Limits
from ...references.protocol.worker import fingerprints
from ...references.readers import Stations, hawc2_turbine, turbine_mass
from ...references.readers.quadrature import Mounted
from ...references.readers.stations import NotReadError
from ...references.readers.turbine_mass import Weighed
from ..judge.results import PropertyCheck
from .properties import CORE, Weighing, unweighed

TARGET = 1e-5
"""Largest difference: rigid bodies and integrals of sections are the same in every discretisation."""


def expected(path: Path, blade: Blade, stations: Stations) -> Weighed | None:
    """What the second reading of the files weighs; None if they are not read."""
    mounted = Mounted(stations, blade.hub_radius, blade.precone, blade.pitch, blade.kinks)
    try:
        module = hawc2_turbine if path.suffix.lower() == ".htc" else turbine_mass
        return module.weigh(path, mounted, blade.tip_mass)
    except NotReadError:
        return None


def of_core(turbine: Turbine) -> Fingerprint:
    """The turbine that core assembles: its tower's mesh, which carries nacelle and rotor, and its rotor at rest."""
    full_machine = machine(turbine)
    state = balance(full_machine.blade_mesh, 0.0, np.zeros(3), ALL_EFFECTS)
    blade = component.reduced_component(full_machine.blade_mesh, state, full_machine.resolution.blade_modes)
    rotor = equations.rotor(full_machine.turbine, blade, 0.0, 0.0)[0]
    return of_turbine(_body(full_machine.tower_mesh), float(rotor[-1, -1]), full_machine.resolution.blade_elements)


def _body(mesh: Mesh) -> np.ndarray:
    points = mesh.beams.points
    at = mesh.nodes[mesh.parent[points.element]] @ sp.exp(points.zeta0)
    out = transformed(points.mass, at).sum(axis=0) + transformed(mesh.lumps, mesh.nodes).sum(axis=0)
    return np.asarray(out, float)


def rows(case: str, code: str, release: str, model: Fingerprint, weighed: Weighed) -> list[PropertyCheck]:
    """The rows of one model; first moments are compared relative to mass times height."""
    moments = weighed.total
    moment = moments.mass * weighed.height
    inertia = moments.inertia
    own = model.inertia or (0.0, 0.0, 0.0)
    compared = [
        ("mass", "kg", model.mass, moments.mass, moments.mass),
        *(
            (f"first moment of mass {name}", "kg m", model.first_moments[k], float(moments.first[k]), moment)
            for k, name in enumerate(("up", "to starboard", "downwind"))
        ),
        ("rotor's inertia about the shaft", "kg m²", model.rotor_inertia, weighed.rotor, weighed.rotor),
        *(
            (f"inertia about the base, {name}", "kg m²", own[k], float(inertia[k]), float(inertia[k]))
            for k, name in enumerate(("yaw", "pitch", "roll"))
        ),
    ]
    out = []
    for name, unit, value, reference, size in compared:
        difference = (value - reference) / size
        fails = abs(difference) > TARGET
        reason = f"{name}: {value:.6g} {unit} in the code's model, {reference:.6g} {unit} by the second reading"
        out.append(
            PropertyCheck(
                *(case, code, release, "fingerprint", name, TARGET),
                *(("fail", reason) if fails else ("pass", "")),
                *(value, reference, unit, difference),
            )
        )
    return out


def weighings(
    case: str, turbine: Turbine, weighed: Weighed, codes: Sequence[Description], limits: Limits
) -> list[Weighing]:
    """The tasks of all codes that take turbines."""
    ready = (code for code in codes if code.turbines and not code.failure and code.version)
    return [Weighing(code.name, partial(_weighed, case, turbine, weighed, code, limits)) for code in ready]


def _weighed(case: str, turbine: Turbine, weighed: Weighed, code: Description, limits: Limits) -> list[PropertyCheck]:
    """The rows of the turbine that a code assembles; ``limits`` are those of the code."""
    release = code.version or ""
    (model,) = fingerprints(code.asked, turbine, code.levels[:1], limits, release)
    if isinstance(model, Fingerprint) and model.inertia is not None:
        return rows(case, code.name, release, model, weighed)
    return [unweighed(case, code.name, release, model, TARGET)]


def of_solver(case: str, turbine: Turbine, weighed: Weighed) -> list[PropertyCheck]:
    """The rows of the turbine that core assembles."""
    return rows(case, CORE, version("southwell"), of_core(turbine), weighed)
