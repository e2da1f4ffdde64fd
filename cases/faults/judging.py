"""Faults in pairing, uncertainty, verdicts and readers."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from ..input import blades
from ..judge import convergence, pairing, refined, same, verdict
from ..judge.convergence import Compared, RefinedMode
from ..judge.pairing import Pair
from ..judge.spectrum import Spectrum
from ..judge.uncertainty import Estimate
from ..solve import published_tables, reference
from .alterations import returned
from .seeding import Fault, Seam, Trial
from .trials import FAST, PARK

OPENFAST = Trial("nrel-5mw", (0.0,), ())
BMODES = Trial("windpact-1.5/bmodes", (6.283185307179586,), ())


def by_number(original: Any) -> Any:
    """Modes are paired by their number."""

    def faulty(reference: Spectrum, answer: Spectrum, indices: Sequence[int], min_mac: float = 0.8) -> list[Pair]:
        return [Pair(i if i < len(answer.values) else None, 1.0) for i, _ in enumerate(indices)]

    return faulty


def next_one(original: Any) -> Any:
    """The partner of a mode is the one after it, in the answers of codes only: core would be wrong in the same way."""

    def faulty(answers: Sequence[Spectrum], compared: Compared, *args: Any) -> list[RefinedMode]:
        last = len(compared.spectrum.values) - 1
        return original(answers, replace(compared, indices=tuple(min(i + 1, last) for i in compared.indices)), *args)

    return faulty


def anything_goes(original: Any) -> Any:
    """Any MAC is accepted."""

    def faulty(core: Spectrum, answer: Spectrum, indices: Sequence[int], min_mac: float = 0.0) -> list[Pair]:
        return original(core, answer, indices, 0.0)

    return faulty


def inferred(original: Any) -> Any:
    """Unsupported motions of a code are inferred from its answer."""
    return lambda reference, i, motions: "no mode of this code moves so"


def _sure(uncertainty: float | None) -> Any:
    return returned(lambda estimate: replace(estimate, uncertainty=uncertainty))


def _extrapolated(original: Any) -> Any:
    def faulty(estimate: Estimate, widening: float) -> Estimate:
        return original(replace(estimate, value=estimate.value * (1.002 if estimate.order else 1.0)), widening)

    return faulty


def _passes(original: Any) -> Any:
    return lambda difference, uncertainty, target: ("pass", "")


def _signed(original: Any) -> Any:
    return lambda difference, uncertainty, target: original(max(difference, 0.0), uncertainty, target)


def _loose(original: Any) -> Any:
    return lambda difference, uncertainty, target: original(difference, uncertainty, 100.0 * target)


def _half(original: Any) -> Any:
    return lambda difference, uncertainty, target: original(difference - 0.002, uncertainty, target)


def _excuses(original: Any) -> Any:
    def faulty(difference: float, uncertainty: float | None, target: float) -> Any:
        verdict, reason = original(difference, uncertainty, target)
        return ("known difference", "discretisation") if verdict == "fail" else (verdict, reason)

    return faulty


def _read(alter: Callable[[dict[str, Any]], dict[str, Any]]) -> tuple[Seam, ...]:
    """The columns of a table of sections are altered."""
    return ((blades, "read_table", returned(alter)),)


def _exchanged(columns: dict[str, Any]) -> dict[str, Any]:
    return {**columns, "EI_flap [N m^2]": columns["EI_edge [N m^2]"], "EI_edge [N m^2]": columns["EI_flap [N m^2]"]}


def _backwards(columns: dict[str, Any]) -> dict[str, Any]:
    return {name: column if name == "fraction [-]" else column[::-1] for name, column in columns.items()}


def _digits(original: Any) -> Any:
    return lambda text, unit=1.0: original(text[:-1] + ("0" if text[-1] != "0" else "9"), unit)


def _numbers(original: Any) -> Any:
    return lambda text, unit=1.0: original(text, unit * 1.05)


def judge(make: Any) -> tuple[Seam, ...]:
    """The judge is replaced wherever it is called."""
    return (refined, "judge", make), (same, "judge", make), (verdict, "judge", make)


FAULTS = (
    Fault("paired by number", "pairing", "modes are paired by their number", "other families' frequencies",
          ((convergence, "pair", by_number),), FAST),
    Fault("paired with the next", "pairing", "an index one too high", "next mode's frequency",
          ((refined, "follow", next_one),), PARK),
    Fault("norms not squared", "pairing", "a norm is twice too large", "MAC a sixteenth; no partner",
          ((pairing, "_norm", lambda original: lambda a, momenta: 4.0 * original(a, momenta)),), PARK),
    Fault("any likeness", "pairing", "any MAC is accepted", "a wrong mode is compared",
             ((convergence, "pair", anything_goes), (refined, "pair", anything_goes)), blinds="twist reversed in the adapter"),
    Fault("motions inferred", "pairing", "a mode without a partner is not applicable", "no answer counts",
             ((refined, "_missing_motion", inferred),), blinds="lost column"),
    Fault("never sure", "uncertainty", "the uncertainty is always unknown", "all cells",
          ((convergence, "from_refinement", _sure(None)),), PARK),
    Fault("unsure by one percent", "uncertainty", "the uncertainty is always 1 %", "all cells",
          ((convergence, "from_refinement", _sure(0.01)),), PARK),
    Fault("limit off", "uncertainty", "limits are 0.2 % too large for codes with an order", "limits of the solver +0.2 %",
          ((convergence, "widened", _extrapolated),), PARK),
    Fault("every number passes", "verdict", "every verdict is pass", "all cells", judge(_passes),
             blinds="no hub radius"),
    Fault("target in percent", "verdict", "the target is a hundred times as large", "0.1 % becomes 10 %",
             judge(_loose), blinds="density"),
    Fault("sign of the difference", "verdict", "only frequencies above the solver's are judged", "negative differences pass",
             judge(_signed), blinds="softening's sign"),
    Fault("all is known", "verdict", "every failure is a known difference", "all failures",
             judge(_excuses), blinds="no Coriolis"),
    Fault("judged with a bias", "verdict", "differences are 0.2 % too small", "−0.2 %", judge(_half), PARK),
    Fault("model ignored", "verdict", "a code without effects is compared with all of them", "Coriolis at γ = 10",
          ((reference, "relevant_effects", lambda original: lambda *_: reference.ALL_EFFECTS),),
          replace(FAST, codes=("assumed-modes",))),
    Fault("printed digit", "reader", "the last digit of a printed number is misread", "0.1 to 0.5 %",
          ((published_tables, "from_print", _digits),), Trial("park-cantilever", (10.0,), ())),
    Fault("printed unit", "reader", "the unit of a table is wrong by 5 %", "+5 %",
          ((published_tables, "from_print", _numbers),), Trial("wright-flapwise", (12.0,), ())),
    Fault("table: axes exchanged", "reader", "EI_flap is read as EI_edge", "flapwise +50 %",
          _read(_exchanged), OPENFAST),
    Fault("table: stiffness unit", "reader", "EI_flap in kN m²", "flapwise −97 %",
          _read(lambda c: {**c, "EI_flap [N m^2]": 1e-3 * c["EI_flap [N m^2]"]}), BMODES),
    Fault("table: mass", "reader", "mass per length 3 % too large", "−1.5 % at rest",
          _read(lambda c: {**c, "mass [kg/m]": 1.06 * c["mass [kg/m]"]}), OPENFAST),
    Fault("table: tip first", "reader", "rows are read from the tip to the root", "factors",
          _read(_backwards), OPENFAST),
)  # fmt: skip
