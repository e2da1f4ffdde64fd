"""Description of a case in a report: its texts, and the properties of each blade that every code was given."""

from typing import get_args

import numpy as np
from msgspec import UNSET
from scipy.integrate import trapezoid

from ...core.blade import Blade, clamped
from ...references.protocol.interface import MOTIONS
from ..input.blades import rigid_strains
from ..input.properties import farthest
from ..input.schema import Case, Variant
from ..judge.results import Setting, Unit
from ..judge.verdict import unsigned

NOT_USED = "in its files, not used"
"""The fact that lists data in a blade's files that the blade does not use."""


def settings(case: Case) -> tuple[Setting, ...]:
    """One setting for each blade of the case."""
    return tuple(setting(case, variant) for variant in case.variants)


def setting(case: Case, variant: Variant) -> Setting:
    """The setting of one blade."""
    text = case.text
    (unit,) = (u for u in get_args(Unit) if getattr(text.speeds, u) is not UNSET)
    speeds = variant.speeds * (30 / np.pi if unit == "rpm" else 1.0)
    of_blade = _dimensionless(variant.blade) if unit == "gamma" else _dimensional(variant.blade)
    facts = {label: value for label, value in of_blade.items() if value}
    facts["speeds"] = ", ".join(f"{v:.6g}" for v in speeds) + {"rad_s": " rad/s", "rpm": " rpm", "gamma": " (γ)"}[unit]
    is_selection = len(text.compare.motions) < len(MOTIONS)
    moving = f" that move mostly {' or '.join(text.compare.motions)}" if is_selection else ""
    facts["modes compared"] = f"the lowest {text.compare.modes}{moving}"
    facts["target"] = unsigned(text.compare.target)
    if text.discretisation:
        d = text.discretisation
        label = f"{d.elements} elements, {d.mass} mass, {d.stiffness} stiffness".replace("_", "-")
        facts["source's discretisation"] = label
    if variant.unused:
        facts[NOT_USED] = "; ".join(str(u).removeprefix("not used: ") for u in variant.unused)
    groups = text.compare.required(variant.name.partition("/")[2])
    return Setting(
        case=variant.name,
        title=text.title,
        description=" ".join(text.description.split()),
        source=text.source,
        unit=unit,
        facts=facts,
        groups=groups,
        lacking="" if groups else text.compare.lacking,
        target=text.compare.target,
    )


def _dimensional(blade: Blade) -> dict[str, str]:
    mass = trapezoid(blade.mass[:, 0, 0], blade.stations)
    first, last = np.degrees(blade.twist[[0, -1]])
    sweep, prebend = (farthest(blade.curve[:, k]) for k in (1, 2))
    return {
        "length": f"{blade.length:g} m",
        "hub radius": f"{blade.hub_radius:g} m",
        "mass": f"{mass + blade.tip_mass[0, 0]:.6g} kg",
        "stations": f"{len(blade.stations)}",
        "twist": f"{first:g}° at the root, {last:g}° at the tip" if blade.twist.any() else "",
        "prebend": f"{prebend:.4g} m (positive downwind)" if prebend else "",
        "sweep": f"{sweep:.4g} m (positive to the leading edge)" if sweep else "",
        **_mounting(blade, "kg"),
        "rotary inertia": "" if blade.mass[:, 3:, 3:].any() else "none",
        "not given, rigid": rigid_strains(blade),
    }


def _dimensionless(blade: Blade) -> dict[str, str]:
    axial, bending = blade.stiffness[0, 0, 0], blade.stiffness[0, 5, 5]
    return {
        "slenderness": f"{np.sqrt(axial / bending):g}",
        "hub ratio": f"{blade.hub_radius:g}",
        **_mounting(blade, "times the blade's mass"),
    }


def _mounting(blade: Blade, unit: str) -> dict[str, str]:
    """The angles at the hub, the tip mass and the root; empty where there is nothing to state. ``unit`` is that of mass."""
    cone, pitch = np.degrees([blade.precone, blade.pitch])
    return {
        "precone": f"{cone:g}° (positive downwind)" if cone else "",
        "pitch": f"{pitch:g}° (positive with the leading edge downwind)" if pitch else "",
        "tip mass": f"{blade.tip_mass[0, 0]:g} {unit}" if blade.tip_mass.any() else "",
        "root": "" if clamped(blade) else "on hinges or springs",
    }
