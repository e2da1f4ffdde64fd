"""The results of a run: one row per cell, and what else a report needs. ``cases.store.results_file`` writes and reads them."""

from dataclasses import dataclass, field
from typing import Literal

Verdict = Literal[
    "pass", "coarse", "fail", "inconclusive", "known difference", "estimate", "measured", "not applicable", "not run"
]
Unit = Literal["rad_s", "rpm", "gamma"]

Key = tuple[str, str, float, int, str, str]
"""What identifies a cell in another run: case, code, rotor speed (rad/s), mode, quantity, and where."""


@dataclass(frozen=True)
class Cell:
    """One code's answer for one quantity of one mode at one point, against the reference.

    A cell without an answer (not run, not applicable) has ``mode`` 0 and no numbers. ``difference`` is relative to the scale of
    the quantity, see ``quantities``: for a frequency it is ``value/reference − 1``. ``uncertainty`` is that of the difference:
    discretisation of both sides, and half a unit of the last digit for a printed table. Values are in SI units.

    Attributes:
        case: name of the case; if it has several blades, followed by a slash and the blade's name.
        omega: rotor speed, rad/s.
        mode: number of the mode within the reference's modes at this speed, from 1.
        family: edgewise, flapwise, torsion, axial, mixed; of a mechanism's mode, the joint that moves most.
        code: short name of the code.
        version: version of the code.
        role: ``code`` (refined until converged), ``discretisation`` (the paper's own discretisation, its own column),
            ``same discretisation`` (target 1e-8), ``table`` (printed numbers), ``measured`` (not a code: see
            ``measured``).
        value: the code's best answer (extrapolated where refinement allows): rad/s for a frequency.
        reference: core's converged answer with the same physical effects.
        difference: relative.
        uncertainty: relative.
        target: relative; upper limit of |difference| + uncertainty.
        verdict: see ``cases.judge.verdict``.
        reason: reason for any verdict other than a plain pass; names and quantifies the cause of a known difference.
        full: core's converged frequency with all effects, rad/s (equals ``reference`` unless the code lacks effects); None for
            other quantities.
        shares: what the code shares with core: ``nothing``, ``mechanical model``, ``discretisation``, ``undeclared``,
            ``everything`` (core with its other method); empty for core itself.
        elements: number of elements of the finest refinement used.
        order: observed order of convergence, if available.
        mac: mass-weighted MAC of the pairing.
        ordinal: number of the mode within its family, counted over all of core's modes at this speed, from 1; 0 without a
            mode.
        quantity: what is compared, one of ``quantities.QUANTITIES``.
        where: what determines the point besides the rotor speed, with its unit, such as ``azimuth 30°``; empty if nothing does.
    """

    case: str
    omega: float
    mode: int
    family: str
    code: str
    version: str
    role: str
    value: float | None
    reference: float | None
    difference: float | None
    uncertainty: float | None
    target: float
    verdict: Verdict
    reason: str = ""
    full: float | None = None
    elements: int | None = None
    order: float | None = None
    mac: float | None = None
    shares: str = ""
    ordinal: int = 0
    quantity: str = "frequency"
    where: str = ""

    @property
    def key(self) -> Key:
        """What identifies the cell in another run."""
        return self.case, self.code, self.omega, self.mode, self.quantity, self.where

    @property
    def name(self) -> str:
        """Name of the mode, such as ``flapwise 2``, with its quantity and point, see ``described``; empty without a mode."""
        return described(f"{self.family} {self.ordinal}", self.quantity, self.where) if self.mode else ""


def described(mode: str, quantity: str, where: str) -> str:
    """A mode in words: with its quantity if that is no frequency, and with what determines the point besides the speed."""
    return ", ".join(part for part in (mode, quantity if quantity != "frequency" else "", where) if part)


@dataclass(frozen=True)
class Level:
    """One frequency at one refinement, paired with ``mode`` of the reference; for convergence figures."""

    case: str
    omega: float
    mode: int
    code: str
    elements: int
    frequency: float


@dataclass(frozen=True)
class Control:
    """Result of one seeded fault, run through the whole pipeline; see ``cases.faults``.

    Attributes:
        control: name of the fault.
        area: the faulty component: core, an adapter, pairing, …
        what: what a program with this fault does.
        size: size of its effect, in words.
        case: the trial's blade, as in ``Cell``; empty for faults in history and gate.
        omega: the trial's highest rotor speed, rad/s.
        detected_by: cells (or lines of the gate) that are bad with the fault and not without it; empty if not detected.
        change: largest difference among those cells, relative.
        needs: required codes that are not installed; if any, the trial was not run.
        without_effect: why the fault cannot be detected on this blade; empty if it can.
    """

    control: str
    area: str
    what: str
    size: str
    case: str
    omega: float
    detected_by: tuple[str, ...]
    change: float | None = None
    needs: str = ""
    without_effect: str = ""

    @property
    def missed(self) -> bool:
        """Whether the control was run, has an effect, and is not detected."""
        return not (self.detected_by or self.needs or self.without_effect)


@dataclass(frozen=True)
class Diagnosed:
    """Why the frequencies of one column differ from core's; see ``cases.diagnosis``.

    Attributes:
        case: as in ``Cell``.
        code: as in ``Cell``.
        known: whether a cause is known.
        sentence: the diagnosis in one line.
        causes: the most probable causes, one line each.
        modes: difference at rest and slope with speed, one line for each mode.
    """

    case: str
    code: str
    known: bool
    sentence: str
    causes: tuple[str, ...] = ()
    modes: tuple[str, ...] = ()


@dataclass(frozen=True)
class BudgetEntry:
    """Effect of one cause on one of core's frequencies: one entry of the error budget.

    Attributes:
        case: as in ``Cell``.
        omega: rotor speed, rad/s.
        mode: name of the mode: ``flapwise 2``.
        cause: discretisation, model form, or rounding.
        part: the specific cause: ``lumped mass, 50 elements``.
        change: relative; None if no mode corresponds.
        bound: whether ``change`` is an upper bound of either sign.
    """

    case: str
    omega: float
    mode: str
    cause: str
    part: str
    change: float | None
    bound: bool = False


@dataclass(frozen=True)
class Origin:
    """Origin of the answers of one column for one blade; see ``references.protocol.interface.Independence``."""

    case: str
    code: str
    engine: str
    theory: str
    rotation: str
    sections: str
    eigensolver: str


@dataclass(frozen=True)
class Setting:
    """Description of a case's blade in a report, so that old results can be shown without the case's file.

    Attributes:
        case: as in ``Cell``.
        title: title, one line.
        description: purpose and assumptions of the case.
        source: source of the data.
        unit: unit of its speeds: ``rad_s``, ``rpm`` or ``gamma``.
        facts: name → value with unit, in words.
        groups: number of independent groups that must agree with core; 0 if the run requires none.
        lacking: why the case requires none.
        target: target of the case, relative; None if it has none.
    """

    case: str
    title: str
    description: str
    source: str
    unit: Unit
    facts: dict[str, str] = field(default_factory=dict)
    groups: int = 0
    lacking: str = ""
    target: float | None = None


@dataclass(frozen=True)
class PropertyCheck:
    """One property of a blade: in a second reading of its file, in the model of a code, or in another description of it.

    Attributes:
        case: as in ``Cell``.
        code: the second reader, or the code whose model it is.
        version: its version.
        quantity: ``reading``, ``fingerprint`` (of a code's model), or ``invariance`` (another description of the blade).
        part: the property: ``edgewise stiffness``, ``mass``, ``stations split``; empty if nothing is compared.
        target: relative.
        verdict: pass, fail, inconclusive (a fingerprint that refinement still changes), not run, or not applicable.
        reason: one line for any verdict other than a plain pass.
        value: in Southwell's reading, in the code's model, or the frequency of the mode that changes most; None if infinite.
        reference: in the second reading, by quadrature of its stations, or the frequency of the blade as given; None if
            infinite.
        unit: of both.
        difference: relative; None if it is infinite, or nothing is compared.
    """

    case: str
    code: str
    version: str
    quantity: Literal["reading", "fingerprint", "invariance"]
    part: str
    target: float
    verdict: Verdict
    reason: str = ""
    value: float | None = None
    reference: float | None = None
    unit: str = ""
    difference: float | None = None


@dataclass(frozen=True)
class Planned:
    """A planned column of one case.

    Attributes:
        case: as in ``Cell``.
        code: as in ``Cell``.
        speeds: number of speeds at which cells are required.
        cells: number of cells required at each speed, one for each quantity of each compared mode; a code without an answer has
            one cell, of mode 0, with the reason. Zero if only some modes are known, as in a printed table.
    """

    case: str
    code: str
    speeds: int
    cells: int


@dataclass(frozen=True)
class Run:
    """Results of a run: everything a report needs.

    Attributes:
        cells: all rows.
        levels: the answers of every refinement.
        versions: package or code → version.
        command: command line that reproduces the run.
        settings: description of each case's blade.
        controls: results of the seeded faults.
        error_budget: one entry per cause and mode.
        origins: origin of the answers of each column.
        diagnoses: why columns differ from core.
        plan: every planned column.
        property_checks: second readings, fingerprints of the codes' models, and invariances.
        unfinished: one sentence on what is missing; empty if the run is complete.
    """

    cells: tuple[Cell, ...]
    levels: tuple[Level, ...] = ()
    versions: dict[str, str] = field(default_factory=dict)
    command: str = ""
    settings: tuple[Setting, ...] = ()
    controls: tuple[Control, ...] = ()
    error_budget: tuple[BudgetEntry, ...] = ()
    origins: tuple[Origin, ...] = ()
    diagnoses: tuple[Diagnosed, ...] = ()
    plan: tuple[Planned, ...] = ()
    property_checks: tuple[PropertyCheck, ...] = ()
    unfinished: str = ""
