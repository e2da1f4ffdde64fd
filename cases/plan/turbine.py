"""A turbine as a subject: solved at several rotor speeds by every code that accepts turbines, compared with core."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
from msgspec import UNSET
from scipy.integrate import trapezoid

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS
from ...core.turbine.turbine import Turbine
from ...references.protocol.description import Description
from ...references.protocol.process import Limits
from ...references.readers.turbine_mass import Weighed
from ..input import readers
from ..input.errors import CaseError
from ..input.readers.source import Mount, Source, TurbineReading
from ..input.turbine_cases import TurbineCase
from ..judge.cells import Head
from ..judge.results import PropertyCheck, Setting
from ..judge.verdict import unsigned
from ..solve import turbine_weights
from ..solve.properties import of_reading
from ..solve.reference import References
from ..solve.refinement import Refining
from ..solve.turbine import MOTION, references, refined_code
from ..solve.turbine_reading import read_again
from . import linearised
from .column import Column, unasked
from .settings import NOT_USED
from .subject import PropertyChecks, Subject
from .user_results import UserResults

MODES, TARGET = 8, 1e-3
"""Number of modes compared, from the lowest, and the largest relative difference."""


@dataclass(frozen=True)
class TurbineSubject(Subject):
    """A turbine with its speeds; see ``Subject``.

    Attributes:
        name: in the results.
        path: of its file.
        turbine: as every code is given it.
        points: rotor speeds, rad/s, ascending.
        rpm: whether reports give speeds in rpm and frequencies in Hz.
        source: its files, and what was read from them.
        title, description: of the report.
        modes: number of modes compared, from the lowest.
        target: largest relative difference.
        groups: number of independent groups that must confirm it.
        time_limit: of one solution by a foreign code, s.
        mount: what the user states besides the file.
    """

    name: str
    path: str
    turbine: Turbine
    points: tuple[float, ...]
    rpm: bool
    source: Source
    title: str = ""
    description: str = ""
    modes: int = MODES
    target: float = TARGET
    groups: int = 1
    time_limit: float = 300.0
    mount: Mount = field(default_factory=Mount)

    def __post_init__(self) -> None:
        if self.turbine.blades == 2:
            raise CaseError(
                f"{self.path}: two blades: none of the codes solves them on a tower; `southwell campbell` does, by Floquet's "
                "and Hill's methods, and --blade-only verifies one blade"
            )

    @property
    def deck(self) -> Path | None:
        """OpenFAST's primary file or HAWC2's htc, which there is a second reader of; None for other files."""
        return next((file for file in self.source.files if file.suffix.lower() in (".fst", ".htc")), None)

    @property
    def cells(self) -> int:
        """See ``Subject``."""
        return self.modes

    def setting(self) -> Setting:
        """See ``Subject``."""
        return Setting(
            case=self.name,
            title=self.title or f"The turbine {self.turbine.name}",
            description=self.description
            or f"The lowest {self.modes} modes of the whole turbine, each to be confirmed within {100 * self.target:g} %.",
            source="; ".join(self.source.about),
            unit="rpm" if self.rpm else "rad_s",
            facts=self._facts(),
            groups=self.groups,
            lacking="",
            target=self.target,
        )

    def _facts(self) -> dict[str, str]:
        turbine, drive = self.turbine, self.turbine.drivetrain
        speeds = np.array(self.points) * (30 / np.pi if self.rpm else 1.0)
        facts = {
            "tower": f"{turbine.tower.length:g} m, {_mass(turbine.tower):.6g} kg",
            "nacelle": f"{turbine.nacelle[0, 0]:.6g} kg",
            "hub": f"{turbine.hub[0, 0]:.6g} kg",
            "blades": f"{turbine.blades} of {turbine.blade.length:g} m, {_mass(turbine.blade):.6g} kg each",
            "yaw bearing": "locked" if np.isinf(turbine.yaw) else f"{turbine.yaw:.6g} N m/rad",
            "shaft": "rigid" if np.isinf(drive.stiffness) else f"{drive.stiffness:.6g} N m/rad",
            "generator": "free" if drive.free else "locked",
            "speeds": ", ".join(f"{v:.6g}" for v in speeds) + (" rpm" if self.rpm else " rad/s"),
            "modes compared": f"the lowest {self.modes}, seen from the ground",
            "target": unsigned(self.target),
        }
        if self.source.unused:
            facts[NOT_USED] = "; ".join(str(u).removeprefix("not used: ") for u in self.source.unused)
        return facts

    def columns(
        self, codes: Sequence[Description], limits: Limits, user_results: Sequence[UserResults]
    ) -> list[Column]:
        """A column for each code that solves turbines, and for linearisations; other codes have none, unless they are alone."""
        takers = [code for code in codes if code.turbines or (code.failure and len(codes) == 1)]
        linearised_columns = linearised.columns(
            self.name, self.path, self.turbine.blade.pitch, self.target, (MOTION,), user_results
        )
        return [*(self._column(code, limits) for code in takers or codes), *linearised_columns]

    def _column(self, code: Description, limits: Limits) -> Column:
        head = Head(self.name, code.name, code.version or "", "code", self.target, code.shares, (MOTION,))
        if column := unasked(head, code, "" if code.turbines else "the code does not take turbines"):
            return column
        refining = Refining(code.levels, code.order, code.finest or code.levels[-1])
        work = partial(refined_code, head, code.asked, self.turbine, refining, limits)
        return Column(code.name, ALL_EFFECTS, head, work, code.independence)

    def references(self, columns: Sequence[Column]) -> Callable[[], References]:
        """See ``Subject``."""
        return partial(references, self.turbine, self.points, self.modes)

    def property_checks(self, codes: Sequence[Description], limits: Limits) -> PropertyChecks:
        """See ``Subject``; a second reading of OpenFAST's or HAWC2's files."""
        if self.deck is None:
            return PropertyChecks()
        rows, weighed = self.second_reading(self.deck)
        if weighed is None:
            return PropertyChecks(rows)
        rows += turbine_weights.of_solver(self.name, self.turbine, weighed)
        return PropertyChecks(rows, turbine_weights.weighings(self.name, self.turbine, weighed, codes, limits))

    def second_reading(self, deck: Path) -> tuple[list[PropertyCheck], Weighed | None]:
        """The rows of a second reading of the turbine's files, and what the turbine weighs by it; None if they are not read."""
        blade = readers.reading(deck, self.mount)
        file = readers.BladeFile(deck, blade.blade, blade.source, self.mount)
        of_blade, stations = of_reading(self.name, file, blade.blade)
        rows = [*read_again(self.name, self.turbine, deck, self.mount), *of_blade]
        return rows, turbine_weights.expected(deck, blade.blade, stations)


def of_case(case: TurbineCase) -> TurbineSubject:
    """The subject of a turbine's case."""
    text, compare = case.text, case.text.compare
    return TurbineSubject(
        text.name,
        case.path,
        case.reading.turbine,
        case.speeds,
        text.speeds.rpm is not UNSET,
        case.reading.source,
        title=text.title,
        description=" ".join(text.description.split()),
        modes=compare.modes,
        target=compare.target,
        groups=compare.groups,
        time_limit=compare.time_limit,
    )


def subject(path: Path, reading: TurbineReading, points: Sequence[float], rpm: bool, mount: Mount) -> TurbineSubject:
    """A turbine that is given only by its file, at these speeds, rad/s."""
    name = re.sub(r"[^a-z0-9.-]+", "-", path.stem.lower()).strip("-.") or "turbine"
    return TurbineSubject(name, str(path), reading.turbine, tuple(points), rpm, reading.source, mount=mount)


def _mass(beam: Blade) -> float:
    """Mass of a beam and the body at its tip, kg."""
    return float(trapezoid(beam.mass[:, 0, 0], beam.stations) + beam.tip_mass[0, 0])
