"""A blade of a case as a subject."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version

from ...core.blade import Blade
from ...references.protocol.description import Description
from ...references.protocol.process import Limits
from ..input.readers import BladeFile
from ..input.schema import Case, Variant
from ..judge.results import BudgetEntry, PropertyCheck, Setting
from ..solve import error_budget, properties
from ..solve.invariances import Invariances
from ..solve.reference import References, references
from . import user_columns
from .blade_columns import columns
from .column import Column
from .settings import setting
from .subject import PropertyChecks, Subject
from .user_results import UserResults


@dataclass(frozen=True)
class BladeSubject(Subject):
    """One blade of a case; see ``Subject``."""

    case: Case
    variant: Variant

    @property
    def name(self) -> str:
        """See ``Subject``."""
        return self.variant.name

    @property
    def path(self) -> str:
        """See ``Subject``."""
        return self.case.path

    @property
    def points(self) -> tuple[float, ...]:
        """See ``Subject``."""
        return tuple(self.variant.speeds.tolist())

    @property
    def cells(self) -> int:
        """See ``Subject``."""
        return self.case.text.compare.modes

    @property
    def time_limit(self) -> float:
        """See ``Subject``."""
        return self.case.text.compare.time_limit

    @property
    def tables(self) -> tuple[str, ...]:
        """See ``Subject``."""
        return self.case.text.compare.tables

    @property
    def blade(self) -> Blade:
        """See ``Subject``."""
        return self.variant.blade

    @property
    def file(self) -> BladeFile | None:
        """See ``Subject``."""
        return self.variant.file

    def setting(self) -> Setting:
        """See ``Subject``."""
        return setting(self.case, self.variant)

    def columns(
        self, codes: Sequence[Description], limits: Limits, user_results: Sequence[UserResults]
    ) -> list[Column]:
        """See ``Subject``."""
        compare = self.case.text.compare
        return columns(self.case, self.variant, codes, limits) + user_columns.columns(
            self.variant, user_results, compare
        )

    def references(self, columns: Sequence[Column]) -> Callable[[], References]:
        """See ``Subject``."""
        effects = [column.effects for column in columns]
        return partial(references, self.variant.blade, list(self.points), self.case.text.compare, effects)

    def property_checks(self, codes: Sequence[Description], limits: Limits) -> PropertyChecks:
        """See ``Subject``."""
        rows, stations = properties.of_reading(self.name, self.variant.file, self.blade)
        rows += properties.of_core(self.name, self.blade, stations, version("southwell"))
        tasks: list[Callable[[], list[PropertyCheck]]] = []
        tasks += properties.weighings(self.name, self.blade, stations, codes, limits)
        if self.users:
            tasks.append(Invariances(self.name, self.blade, max(self.points), self.cells))
        return PropertyChecks(rows, tasks)

    def error_budget(self) -> Callable[[], list[BudgetEntry]] | None:
        """See ``Subject``."""
        return partial(error_budget.solve, self.case, self.variant)


def blades(*cases: Case) -> list[BladeSubject]:
    """The blades of cases, each a subject."""
    return [BladeSubject(case, variant) for case in cases for variant in case.variants]
