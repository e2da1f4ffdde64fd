"""What is verified: a subject says where it is asked, how its answers are compared, and who answers.

A blade of a case, a mechanism and a turbine are subjects. The run knows no more of them than this page: it solves the
references of every subject, then its columns.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.blade import Blade
from ...references.protocol.description import Description
from ...references.protocol.process import Limits
from .. import data
from ..input.readers import BladeFile
from ..judge.results import BudgetEntry, PropertyCheck, Setting
from .column import Column
from .user_results import UserResults


@dataclass(frozen=True)
class PropertyChecks:
    """What is known of a subject's second reading, and the tasks that weigh the models of codes and describe it otherwise."""

    rows: Sequence[PropertyCheck] = ()
    tasks: Sequence[Callable[[], list[PropertyCheck]]] = ()


class Subject(ABC):
    """One subject of a run. What its methods return can be pickled, because it is executed in other processes.

    Attributes:
        name: in the results: that of the case, followed by a slash and the blade's if the case has several.
        path: of its file, for messages.
        points: where it is asked: rotor speeds, rad/s, ascending.
        cells: number of cells that a column must have at each point: one for each compared quantity of each compared mode.
        time_limit: of one solution by a foreign code, s, unless the request gives another.
        tables: names of the published tables with which it is compared.
        blade: the blade that codes are asked whether they accept; None if the subject is none.
        file: the file that its blade was read from; None if there is none, or if it was changed since.
    """

    name: str
    path: str
    points: tuple[float, ...]
    cells: int
    time_limit: float
    tables: tuple[str, ...] = ()
    blade: Blade | None = None
    file: BladeFile | None = None

    @property
    def users(self) -> bool:
        """Whether it does not come with the package."""
        return Path(data.__file__ or "").parent not in Path(self.path).parents

    @abstractmethod
    def setting(self) -> Setting:
        """Its description in a report."""

    @abstractmethod
    def columns(
        self, codes: Sequence[Description], limits: Limits, user_results: Sequence[UserResults]
    ) -> list[Column]:
        """Its columns.

        Args:
            codes: descriptions of all codes of the run; ``refused`` is the answer to this subject's blade.
            limits: of each solution by a foreign code.
            user_results: results of other programs and measurements.
        """

    @abstractmethod
    def references(self, columns: Sequence[Column]) -> Callable[[], dict[Any, list[Any]]]:
        """The task that solves core's references: effects → a reference, or a failure, at each point."""

    def property_checks(self, codes: Sequence[Description], limits: Limits) -> PropertyChecks:
        """The second reading of its file, and the tasks of all other checks of its properties; arguments as for ``columns``."""
        return PropertyChecks()

    def error_budget(self) -> Callable[[], list[BudgetEntry]] | None:
        """The task that splits core's error into its causes; None if there is none for this kind of subject."""
        return None


def asked_about(subjects: Collection[Subject]) -> list[Blade]:
    """The blades that codes are asked whether they accept, in the order of the subjects."""
    return [subject.blade for subject in subjects if subject.blade is not None]


def speeds_of_blades(subjects: Collection[Subject]) -> dict[str, tuple[float, ...]]:
    """Name of each blade → its rotor speeds, rad/s."""
    return {subject.name: subject.points for subject in subjects if subject.blade is not None}
