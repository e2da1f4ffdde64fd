"""Description of a case in a report: its texts, and the properties of each blade that every code was given."""

from typing import get_args

import numpy as np
from msgspec import UNSET
from scipy.integrate import trapezoid

from ...core.blade import Blade, clamped, straight
from ..input.schema import Case, Variant
from ..judge.pairing import MOTIONS
from ..judge.results import Setting, Unit
from ..judge.verdict import unsigned
from .mechanism_case import MechanismCase, setting

NOT_USED = "in its files, not used"
"""The fact that lists data in a blade's files that the blade does not use."""


def settings(case: Case | MechanismCase) -> tuple[Setting, ...]:
    """One setting for each blade of the case, or for its mechanism."""
    if isinstance(case, MechanismCase):
        return (setting(case),)
    return tuple(_setting(case, variant) for variant in case.variants)


def _setting(case: Case, variant: Variant) -> Setting:
    text = case.text
    (unit,) = (u for u in get_args(Unit) if getattr(text.speeds, u) is not UNSET)
    speeds = variant.speeds * (30 / np.pi if unit == "rpm" else 1.0)
    facts = _dimensionless(variant.blade) if unit == "gamma" else _dimensional(variant.blade)
    facts["speeds"] = ", ".join(f"{v:.6g}" for v in speeds) + {"rad_s": " rad/s", "rpm": " rpm", "gamma": " (γ)"}[unit]
    some = len(text.compare.motions) < len(MOTIONS)
    moving = f" that move mostly {' or '.join(text.compare.motions)}" if some else ""
    facts["modes compared"] = f"the lowest {text.compare.modes}{moving}"
    facts["target"] = unsigned(text.compare.target)
    if text.discretisation:
        d = text.discretisation
        what = f"{d.elements} elements, {d.mass} mass, {d.stiffness} stiffness".replace("_", "-")
        facts["source's discretisation"] = what
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
    facts = {
        "length": f"{blade.length:g} m",
        "hub radius": f"{blade.hub_radius:g} m",
        "mass": f"{mass + blade.tip_mass[0, 0]:.6g} kg",
        "stations": f"{len(blade.stations)}",
    }
    if blade.twist.any():
        facts["twist"] = f"{np.degrees(blade.twist[0]):g}° at the root, {np.degrees(blade.twist[-1]):g}° at the tip"
    if blade.precone:
        facts["precone"] = f"{np.degrees(blade.precone):g}° (positive downwind)"
    if blade.pitch:
        facts["pitch"] = f"{np.degrees(blade.pitch):g}° (positive with the leading edge downwind)"
    if not straight(blade):
        _, sweep, prebend = blade.curve[-1]
        facts["tip off the axis"] = f"{prebend:.4g} m downwind, {sweep:.4g} m to the leading edge"
    if blade.tip_mass.any():
        facts["tip mass"] = f"{blade.tip_mass[0, 0]:g} kg"
    if not clamped(blade):
        facts["root"] = "on hinges or springs"
    if not blade.mass[:, 3:, 3:].any():
        facts["rotary inertia"] = "none"
    return facts


def _dimensionless(blade: Blade) -> dict[str, str]:
    axial, bending = blade.stiffness[0, 0, 0], blade.stiffness[0, 5, 5]
    return {"slenderness": f"{np.sqrt(axial / bending):g}", "hub ratio": f"{blade.hub_radius:g}"}
