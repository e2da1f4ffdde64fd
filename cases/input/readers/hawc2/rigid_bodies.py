"""The bodies of an htc that a turbine takes as rigid, and how much lower the frequencies would be with their flexibility."""

import numpy as np

from .....core.space import spatial as sp
from .....core.turbine.machine import machine
from .....core.turbine.rigid_parts import MODES, RigidPart, lowering
from .....core.turbine.turbine import Turbine
from .....core.turbine.turbine_modes import turbine_modes
from .frames import Frames
from .parts import Parts
from .rigid import Line, moved

SHOWN = 1e-5
"""Smallest effect of a rigid part on a frequency that is stated as a number."""


def rigid_bodies(turbine: Turbine, split: Parts, lines: dict[str, Line], body_frames: Frames) -> tuple[str, ...]:
    """How much lower the frequencies would be if the bodies taken as rigid were as flexible as the htc has them."""
    rigid_parts: list[RigidPart] = []
    for k, name in enumerate(split.nacelle):
        move = sp.adjoint(body_frames.pose[name])
        carried = sum(
            (moved(lines[n].inertia(), body_frames.pose[n]) for n in split.nacelle[k + 1 :]), np.zeros((6, 6))
        )
        carried = carried + moved(lines[name].inertia(beyond_root=True), body_frames.pose[name])
        rigid_parts.append(RigidPart(name, "all", move @ lines[name].compliance() @ move.T, carried))
    into = sp.inverse(body_frames.hub)
    move = sp.adjoint(into @ body_frames.pose[split.shaft])
    rigid_parts.append(RigidPart(split.shaft, "rotor", move @ lines[split.shaft].compliance(torsion=False) @ move.T))
    common = [name for name in split.hubs[0] if all(name in hub for hub in split.hubs)]
    for name in split.hubs[0]:
        rotation = sp.pose(sp.rotation(2, np.array(0.0 if name in common else -body_frames.azimuths[0])), np.zeros(3))
        move = sp.adjoint(rotation @ into @ body_frames.pose[name])
        rigid_parts.append(
            RigidPart(name, "rotor" if name in common else "blade", move @ lines[name].compliance() @ move.T)
        )
    try:
        full_machine = machine(turbine)
        lower = lowering(full_machine, rigid_parts)
        names = turbine_modes(full_machine, 0.0, lower.shape[1]).names
    except ValueError as error:  # no steady state
        flexible = ", ".join(part.name for part in rigid_parts)
        return (f"taken as rigid, with all mass: {flexible}; the effect of their flexibility is unknown: {error}",)
    words = []
    for part, fractions in zip(rigid_parts, lower, strict=True):
        k = int(fractions.argmax())
        size = f"{100 * fractions[k]:.1g} % ({names[k]})" if fractions[k] > SHOWN else f"below {100 * SHOWN:g} %"
        words.append(f"{part.name}{' besides its torsion' if part.name == split.shaft else ''} {size}")
    return (
        f"taken as rigid, with all mass: {', '.join(words)}: the most by which the htc's flexibility would lower one of the "
        f"{MODES} lowest frequencies, to first order at rest",
    )
