"""A mechanism as a subject: solved at several rotor speeds by every code that accepts mechanisms, compared with core."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version

import numpy as np
from msgspec import UNSET

from ...core import multibody as mb
from ...core.effects import ALL_EFFECTS
from ...core.mechanism.description import at_rate
from ...references.protocol.description import Description
from ...references.protocol.interface import Independence
from ...references.protocol.process import Limits
from ...references.theories import blade_formulae
from ..input.errors import CaseError, located, nearest
from ..input.mechanism_schema import Compare
from ..input.mechanisms import Described
from ..input.schema import rad_s
from ..judge.cells import Head
from ..judge.results import Setting
from ..solve.mechanism import QUANTITIES, answers_at, compared, formula, references
from ..solve.reference import References
from .column import Column, unasked
from .subject import Subject
from .user_results import UserResults


@dataclass(frozen=True)
class MechanismSubject(Subject):
    """A mechanism with its speeds; see ``Subject``.

    Attributes:
        described: the mechanism as read.
        compare: how closely codes must agree with core.
        points: rotor speeds, rad/s, ascending.
    """

    described: Described
    compare: Compare
    points: tuple[float, ...]

    @property
    def name(self) -> str:
        """See ``Subject``."""
        return self.described.text.name

    @property
    def path(self) -> str:
        """See ``Subject``."""
        return self.described.path

    @property
    def cells(self) -> int:
        """See ``Subject``."""
        return self.compare.modes * len(QUANTITIES)

    @property
    def time_limit(self) -> float:
        """See ``Subject``."""
        return self.compare.time_limit

    def setting(self) -> Setting:
        """See ``Subject``."""
        text, compare = self.described.text, self.compare
        rpm = text.speeds is not None and text.speeds.rpm is not UNSET
        speeds = np.array(self.points) * (30 / np.pi if rpm else 1.0)
        cut = self.described.solve(1).linear.tree.weld_names
        facts = {
            "bodies": f"{len(text.bodies)}",
            "joints": f"{len(text.joints)}",
            "joints that close loops": ", ".join(cut) or "none",
            "speeds": ", ".join(f"{v:.6g}" for v in speeds) + (" rpm" if rpm else " rad/s"),
            "modes compared": f"the lowest {compare.modes}, and their damping ratios",
            "target": f"{compare.target:g}",
        }
        return Setting(
            case=self.name,
            title=text.title,
            description=" ".join(text.description.split()),
            source=text.source,
            unit="rpm" if rpm else "rad_s",
            facts=facts,
            groups=compare.groups,
            lacking=compare.lacking,
            target=compare.target,
        )

    def columns(
        self, codes: Sequence[Description], limits: Limits, user_results: Sequence[UserResults]
    ) -> list[Column]:
        """Results of other programs are for blades and add no column."""
        return _columns(self.described, self.compare, codes, limits)

    def references(self, columns: Sequence[Column]) -> Callable[[], References]:
        """See ``Subject``."""
        return partial(references, self.described, self.points, self.compare.modes)


def subject(described: Described) -> MechanismSubject:
    """The subject of a mechanism's file that specifies its speeds and the target of the comparison.

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
    with located(f"{path}: rotor: ", mb.MechanismError):
        at_rate(described.mechanism, text.rotor, 0.0)
    if text.closed_form and text.closed_form.formula not in blade_formulae.FORMULAE:
        advice = nearest(text.closed_form.formula, blade_formulae.FORMULAE)
        raise CaseError(f"{path}: closed_form.formula: {text.closed_form.formula!r}: no such formula: {advice}")
    return MechanismSubject(described, text.compare, tuple(rad_s(text.speeds, path).tolist()))


_BY_HAND = Independence(
    engine="closed form",
    theory="second-order Lagrangian by hand",
    rotation="second-order Lagrangian by hand",
    sections="the case's closed_form.parameters",
    eigensolver="the adapters' own, with damping",
)


def _columns(described: Described, compare: Compare, codes: Sequence[Description], limits: Limits) -> list[Column]:
    """A column for each code and for the closed form; ``limits`` apply to each solution by a foreign code.

    Codes that accept only blades have no column, unless there are no other codes.
    """
    name, target = described.text.name, compare.target
    out = []
    for code in [code for code in codes if code.mechanisms] or codes:
        head = Head(name, code.name, code.version or "", "same discretisation", target, code.shares)
        refusal = "" if code.mechanisms else "the code takes blades, not mechanisms"
        work = partial(compared, head, described, partial(answers_at, code.asked, head.version, limits))
        column = unasked(head, code, refusal) or Column(code.name, ALL_EFFECTS, head, work)
        out.append(replace(column, origin=code.independence))
    if form := described.text.closed_form:
        head = Head(name, "closed form", f"southwell {version('southwell')}", "same discretisation", target, "nothing")
        work = partial(compared, head, described, partial(formula, form))
        out.append(Column(head.code, ALL_EFFECTS, head, work, _BY_HAND))
    return out
