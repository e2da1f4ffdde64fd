"""A mechanism as a case: solved at several rotor speeds by every code that accepts mechanisms, compared with core."""

from dataclasses import dataclass

import numpy as np
from msgspec import UNSET
from numpy.typing import NDArray

from ...core import multibody as mb
from ...core.mechanism.description import at_rate
from ...references.theories import blade_formulae
from ..input.errors import CaseError, nearest
from ..input.mechanisms import Described
from ..input.schema import rad_s
from ..judge.results import Setting

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Turning:
    """The mechanism of a case and its speeds; the counterpart of a blade's variant.

    Attributes:
        name: name of the case.
        described: mechanism as read.
        speeds: (k,) rad/s, ascending.
        count: number of modes to compare.
    """

    name: str
    described: Described
    speeds: Array
    count: int

    def at(self, omega: float) -> mb.Mechanism:
        """The mechanism with its rotor at ``omega`` (rad/s)."""
        return at_rate(self.described.mechanism, self.described.text.rotor, omega)


@dataclass(frozen=True)
class MechanismCase:
    """A mechanism's file with everything a case needs; ``variants`` contains the one mechanism."""

    described: Described
    target: float
    variants: tuple[Turning]

    @property
    def name(self) -> str:
        """As typed on the command line."""
        return self.described.text.name


def case(described: Described) -> MechanismCase:
    """The case of a mechanism that specifies its speeds and the target of the comparison.

    Raises:
        CaseError: if it does not specify them.
    """
    text, path = described.text, described.path
    if text.speeds is None or text.compare is None:
        missing = "speeds" if text.speeds is None else "compare"
        raise CaseError(f"{path}: {missing}: missing: a mechanism needs [speeds] and [compare] to be a case; add it")
    if (text.compare.groups == 0) != bool(text.compare.lacking):
        raise CaseError(
            f"{path}: compare.groups: give groups = 0 and compare.lacking, the reason, together, or neither"
        )
    try:
        at_rate(described.mechanism, text.rotor, 0.0)
    except mb.MechanismError as error:
        raise CaseError(f"{path}: rotor: {error}") from error
    if text.closed_form and text.closed_form.formula not in blade_formulae.FORMULAE:
        advice = nearest(text.closed_form.formula, blade_formulae.FORMULAE)
        raise CaseError(f"{path}: closed_form.formula: {text.closed_form.formula!r}: no such formula: {advice}")
    variant = Turning(text.name, described, rad_s(text.speeds, path), text.compare.modes)
    return MechanismCase(described, text.compare.target, (variant,))


def setting(case: MechanismCase) -> Setting:
    """Description of the case in a report."""
    (variant,), text = case.variants, case.described.text
    rpm = text.speeds is not None and text.speeds.rpm is not UNSET
    speeds = variant.speeds * (30 / np.pi if rpm else 1.0)
    cut = variant.described.solve(1).linear.tree.weld_names
    facts = {
        "bodies": f"{len(text.bodies)}",
        "joints": f"{len(text.joints)}",
        "joints that close loops": ", ".join(cut) or "none",
        "speeds": ", ".join(f"{v:.6g}" for v in speeds) + (" rpm" if rpm else " rad/s"),
        "modes compared": f"the lowest {variant.count}, and their damping ratios",
        "target": f"{case.target:g}",
    }
    compare = text.compare
    return Setting(
        case=case.name,
        title=text.title,
        description=" ".join(text.description.split()),
        source=text.source,
        unit="rpm" if rpm else "rad_s",
        facts=facts,
        groups=compare.groups if compare else 0,
        lacking=compare.lacking if compare else "",
        target=case.target,
    )
