"""The second reading of a blade's file, and the mass and inertia of the codes' models, as rows of a run."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
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
        row = PropertyCheck(
            case, "second reader", "", "reading", "", None, None, "", None, comparison.TARGET, "not run"
        )
        return [_because(row, second.missing)], weighing.stations_of(blade)
    rows = [
        PropertyCheck(
            *(
                case,
                reader,
                version,
                "reading",
                p.name,
                _finite(p.first),
                _finite(p.second),
                p.unit,
                _finite(p.difference),
            ),
            comparison.TARGET,
            "pass" if p.agrees else "fail",
            "" if p.agrees else p.where(second.reader),
        )
        for p in second.properties
    ]
    unsure = PropertyCheck(
        case, reader, version, "reading", "schema", None, None, "", None, comparison.TARGET, "inconclusive"
    )
    rows += [_because(unsure, violation) for violation in second.stations.violations]
    same = not second.contradictions
    return rows, weighing.resolved(file.blade, second.stations) if same else weighing.stations_of(blade)


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
    """The task that compares the model of one code with the stations.

    Attributes:
        case: name of the case.
        blade: the blade that the code is given.
        stations: what its model is compared with.
        description: of the code.
        limits: of each model.
        storable: never stored for other runs here; ``references.protocol.worker`` keeps what the code answers.
    """

    case: str
    blade: Blade
    stations: Stations
    description: Description
    limits: Limits
    storable: bool = False

    @property
    def code(self) -> str:
        """Name of the code."""
        return self.description.name

    def __call__(self) -> list[PropertyCheck]:
        """The rows: one for each property, or one with the reason why there are none."""
        code, version = self.description, self.description.version or ""
        models: list[Fingerprint] = []
        for elements in code.levels:
            (model,) = fingerprints(code.asked, self.blade, [elements], self.limits, version)
            if not isinstance(model, Fingerprint) and len(models) == 2:
                break  # a finer mesh is not within the limits: the verdict is that of these two
            if not isinstance(model, Fingerprint):
                return [unweighed(self.case, code.name, version, model, weighing.TARGET)]
            models = [*models[-1:], model]
            if weighing.enough(self.blade, self.stations, models, code.effects.rotary_inertia):
                break
        weights = weighing.weights(self.blade, self.stations, models, code.effects.rotary_inertia)
        return _rows(self.case, code.name, version, weights, SHARED if code.shares == "discretisation" else "")


def unweighed(case: str, code: str, version: str, model: Fingerprint | Failure | None, target: float) -> PropertyCheck:
    """The row of a code that reports no model to weigh, with the reason."""
    failed = isinstance(model, Failure) and model.kind != "unsupported"
    kind = "not run" if failed else "not applicable"
    row = PropertyCheck(case, code, version, "fingerprint", "", None, None, "", None, target, kind)
    return _because(row, model.reason if isinstance(model, Failure) else "the code reports no mass")


def weighings(
    case: str, blade: Blade, stations: Stations, codes: Sequence[Description], limits: Limits
) -> list[Weighing]:
    """The tasks for all codes that take the blade."""
    ready = (c for c in codes if c.blades and not c.failure and c.version and not (c.refused and c.refused[0]))
    return [Weighing(case, blade, stations, code, limits) for code in ready]


def _rows(
    case: str, code: str, version: str, weights: Sequence[weighing.Weight], note: str = ""
) -> list[PropertyCheck]:
    return [
        PropertyCheck(
            *(case, code, version, "fingerprint", w.name, w.model, w.stations, w.unit, w.difference, weighing.TARGET),
            w.verdict,
            note if w.verdict == "pass" else w.line,
        )
        for w in weights
    ]


def _because(row: PropertyCheck, reason: str) -> PropertyCheck:
    return replace(row, reason=reason)


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None
