"""The second reading of a blade's file, and the mass and inertia of the codes' models, as rows of a run."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain
from math import isfinite

from ...core.blade import Blade
from ...references.protocol.description import Description
from ...references.protocol.fingerprint import Fingerprint
from ...references.protocol.process import Failure, Limits
from ...references.protocol.worker import fingerprints
from ...references.readers import Stations
from ..input.readers import BladeFile
from ..judge.results import PropertyCheck
from ..reading import comparison
from ..reading import weights as weighing
from ..reading.second import read_again

CORE = "southwell"

SHARED = "discretisation shared with Southwell's own solver"


def of_reading(case: str, file: BladeFile | None, blade: Blade) -> tuple[list[PropertyCheck], Stations]:
    """The rows of a second reading, and the stations by which models are weighed.

    Those are of the second reader if both readings agree, else as the description of the blade has them: a model that
    differs then has another cause. Without a file there are no rows.
    """
    if file is None:
        return [], weighing.stations_of(blade)
    second = read_again(file.blade, file.path, file.source, file.mount)
    reader, _, version = second.reader.rpartition(" ")
    if second.stations is None:
        missing = PropertyCheck(case, "second reader", "", "reading", "", comparison.TARGET, "not run", second.missing)
        return [missing], weighing.stations_of(blade)
    rows = [
        PropertyCheck(
            *(case, reader, version, "reading", p.name, comparison.TARGET),
            *(("pass", "") if p.agrees else ("fail", p.where(second.reader))),
            *(_finite(p.first), _finite(p.second), p.unit, _finite(p.difference)),
        )
        for p in second.properties
    ]
    rows += [
        PropertyCheck(case, reader, version, "reading", "schema", comparison.TARGET, "inconclusive", violation)
        for violation in second.stations.violations
    ]
    agrees = not second.contradictions
    return rows, weighing.resolved(file.blade, second.stations) if agrees else weighing.stations_of(blade)


def of_core(case: str, blade: Blade, stations: Stations, version: str) -> list[PropertyCheck]:
    """The rows of the model that core assembles."""
    models: list[Fingerprint] = []
    for elements in weighing.MESHES:
        models = [*models[-1:], weighing.of_core(blade, elements)]
        if weighing.enough(blade, stations, models, rotary=True):
            break
    return _rows(case, CORE, version, weighing.weights(blade, stations, models))


@dataclass(frozen=True)
class Weighing:
    """The task that compares the model of one code with what it is given.

    Attributes:
        code: name of the code.
        rows: one for each property, or one with the reason why there are none.
        storable: never stored for other runs here; ``references.protocol.worker`` keeps what the code answers.
    """

    code: str
    rows: Callable[[], list[PropertyCheck]]
    storable: bool = False

    def __call__(self) -> list[PropertyCheck]:
        """The rows."""
        return self.rows()


def _weighed(case: str, blade: Blade, stations: Stations, code: Description, limits: Limits) -> list[PropertyCheck]:
    """The rows of a code's model of a blade; ``limits`` are those of each model."""
    version, models = code.version or "", list[Fingerprint]()
    # nearly every code needs two meshes and few need more; each question starts a process
    questions = (code.levels[:2], code.levels[2:])
    for model in chain.from_iterable(fingerprints(code.asked, blade, q, limits, version) for q in questions):
        if not isinstance(model, Fingerprint) and len(models) == 2:
            break  # a finer mesh is not within the limits: the verdict is that of these two
        if not isinstance(model, Fingerprint):
            return [unweighed(case, code.name, version, model, weighing.TARGET)]
        models = [*models[-1:], model]
        if weighing.enough(blade, stations, models, code.effects.rotary_inertia):
            break
    weights = weighing.weights(blade, stations, models, code.effects.rotary_inertia)
    return _rows(case, code.name, version, weights, SHARED if code.shares == "discretisation" else "")


def unweighed(case: str, code: str, version: str, model: Fingerprint | Failure | None, target: float) -> PropertyCheck:
    """The row of a code that reports no model to weigh, with the reason."""
    failed = isinstance(model, Failure) and model.kind != "unsupported"
    kind = "not run" if failed else "not applicable"
    reason = model.reason if isinstance(model, Failure) else "the code reports no mass"
    return PropertyCheck(case, code, version, "fingerprint", "", target, kind, reason)


def weighings(
    case: str, blade: Blade, stations: Stations, codes: Sequence[Description], limits: Limits
) -> list[Weighing]:
    """The tasks for all codes that take the blade."""
    ready = (c for c in codes if c.blades and not c.failure and c.version and not (c.refused and c.refused[0]))
    return [Weighing(code.name, partial(_weighed, case, blade, stations, code, limits)) for code in ready]


def _rows(
    case: str, code: str, version: str, weights: Sequence[weighing.Weight], note: str = ""
) -> list[PropertyCheck]:
    return [
        PropertyCheck(
            *(case, code, version, "fingerprint", w.name, weighing.TARGET),
            *(w.verdict, note if w.verdict == "pass" else w.line),
            *(w.model, w.stations, w.unit, w.difference),
        )
        for w in weights
    ]


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None
