"""``southwell.read``, ``.modes``, ``.root_loads``, ``.campbell`` and ``.verify``."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from math import radians
from pathlib import Path
from typing import Literal, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...cases.campbell import diagram
from ...cases.campbell.diagram import CampbellRequest
from ...cases.campbell.required import required_margin
from ...cases.input import files, library, readers
from ...cases.input.default_case import MODES, default_case
from ...cases.input.errors import CaseError
from ...cases.input.readers import Mount
from ...cases.input.schema import Case, speed_range
from ...cases.plan.request import Execution, Request
from ...cases.verify import pipeline
from ...core import solve
from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS, Effects
from ...core.element.discretize import Mass
from ...core.element.measures import Measure
from ...core.root_loads import RootLoads
from ...core.root_loads import root_loads as loads_at_root
from ...references.protocol.process import Limits
from ..shared.units import RAD_S, RPM, Units
from .results import CampbellResult, ModesResult, VerifyResult

Array = NDArray[np.float64]

Given = TypeVar("Given")

Speeds = str | ArrayLike
"""Rotor speeds: a number, a sequence, a range ``"first:last:step"``, or a list ``"0,5,10"``."""


def read(
    path: str | Path,
    *,
    main: str | Path | None = None,
    length: float | None = None,
    hub_radius: float | None = None,
    precone: float | None = None,
    pitch: float | None = None,
    pitch_convention: Literal["southwell", "openfast"] = "southwell",
    subset: tuple[int, int] | None = None,
    multipliers: tuple[float, float, float] | None = None,
    offsets: bool | None = None,
    root: str | Path | None = None,
    allow_outside: bool = False,
) -> Blade:
    """Read the blade in a file or of a case, which is named or is a TOML file with speeds.

    Args:
        path: ElastoDyn, BeamDyn, BModes, HAWC2, windIO, or Southwell's TOML or CSV; or a case, ``"nrel-5mw"`` or
            ``"park-blade/windpact"``.
        main: the main file that defines how the blade is mounted on the hub.
        length: from root to tip, m, if no file states it.
        hub_radius: from the hub's centre to the root along the coned axis, m; required if no file states it.
        precone: degrees, positive downwind.
        pitch: degrees; its sign is that of ``pitch_convention``.
        pitch_convention: ``southwell``: positive with the leading edge downwind; ``openfast``: upwind, as BlPitch.
        subset: set and subset of a HAWC2 structural file, ``(5, 1)``.
        multipliers: of mass, flap and edge stiffness, in place of an ElastoDyn table's AdjBlMs, AdjFlSt and AdjEdSt.
        offsets: whether the offset columns of a FAST 7 table are used; by default they are.
        root: folder that holds all files of the deck; a file may reference files anywhere in it.
        allow_outside: whether a file may reference files in any folder.

    Raises:
        CaseError: one line with file and line, value, likely cause and remedy.
    """
    mount = Mount(
        main=None if main is None else Path(main),
        length=length,
        hub_radius=hub_radius,
        precone=None if precone is None else radians(precone),
        pitch=None if pitch is None else radians(pitch if pitch_convention == "southwell" else -pitch),
        subset=subset,
        multipliers=multipliers,
        offsets=offsets,
    )
    with ExitStack() as allowed:
        allowed.enter_context(files.outside_allowed(allow_outside))
        if root is not None:
            allowed.enter_context(files.root_allowed(Path(root)))
        if library.is_blade_file(str(path)):
            return readers.reading(Path(path), mount).mounted(Path(path))
        if mount != Mount():
            raise CaseError(f"{path}: a case defines how its blade is mounted: leave out main, length and the like")
        case = library.select(str(path))
    if len(case.variants) > 1:
        raise CaseError(f"{path}: several blades: name one of {', '.join(v.name for v in case.variants)}")
    return next(iter(case.variants)).blade


def modes(
    blade: Blade,
    omega: float | None = None,
    *,
    rpm: float | None = None,
    modes: int = 10,
    elements: int | None = None,
    accuracy: float = 1e-6,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    effects: Effects = ALL_EFFECTS,
    gravity: Array = solve.NO_GRAVITY,
    load: Array | None = None,
    allow_large_strain: bool = False,
) -> ModesResult:
    """Compute the lowest modes of a blade at one rotor speed with Southwell's own solver, as ``southwell modes``.

    Args:
        blade: the blade.
        omega: rotor speed, rad/s.
        rpm: rotor speed in rpm, instead.
        modes: number of modes, from the lowest.
        elements: number of beam elements of equal length; by default as many as ``accuracy`` requires.
        accuracy: largest relative uncertainty of a frequency, if ``elements`` is not given.
        mass: ``consistent``, or ``half_end`` (lumped, Park et al. 2010).
        stiffness: ``corotational``, or ``body_fixed`` (Park et al. 2010).
        effects: physical effects included.
        gravity: (3,) m/s², in hub axes.
        load: (n, 3) steady force per length at the blade's stations, N/m, in hub axes.
        allow_large_strain: accept steady strains above 20 %.

    Raises:
        CaseError: no speed, or two.
        ValueError, SteadyStateError, UnstableError, EigensolverError: as ``core.solve.modes``.
    """
    given, units = _given(rpm, omega)
    result = solve.modes(
        blade,
        given / units.speeds,
        elements,
        modes,
        accuracy=accuracy,
        mass=mass,
        stiffness=stiffness,
        effects=effects,
        gravity=gravity,
        load=load,
        allow_large_strain=allow_large_strain,
    )
    return ModesResult(**vars(result), blade=blade, units=units)


def root_loads(
    blade: Blade,
    omega: float | None = None,
    *,
    rpm: float | None = None,
    accuracy: float = 1e-6,
    gravity: Array = solve.NO_GRAVITY,
    load: Array | None = None,
    allow_large_strain: bool = False,
) -> RootLoads:
    """Compute the steady force and moment of a blade on its hub at one rotor speed, as ``southwell show --steady``.

    Args:
        blade: the blade.
        omega: rotor speed, rad/s.
        rpm: rotor speed in rpm, instead.
        accuracy: largest relative uncertainty of the force and of the moment.
        gravity: (3,) m/s², in hub axes, at the azimuth of interest; its loads turn with the blade.
        load: (n, 3) steady force per length at the blade's stations, N/m, in hub axes.
        allow_large_strain: accept steady strains above 20 %.

    Raises:
        CaseError: no speed, or two.
        ValueError, SteadyStateError: as ``core.root_loads.root_loads``.
    """
    given, units = _given(rpm, omega)
    return loads_at_root(
        blade,
        given / units.speeds,
        accuracy=accuracy,
        gravity=gravity,
        load=load,
        allow_large_strain=allow_large_strain,
    )


def campbell(
    blade: Blade,
    *,
    rpm: Speeds | None = None,
    omega: Speeds | None = None,
    modes: int = 6,
    per_rev: Sequence[int] = (1, 2, 3, 4, 5, 6),
    operating: tuple[float, float] | None = None,
    margin: str | float = "10%",
    elements: int | None = None,
    accuracy: float = 1e-6,
    allow_large_strain: bool = False,
) -> CampbellResult:
    """Compute the Campbell diagram of a blade, as ``southwell campbell``: modes tracked over rotor speed, and their margins.

    Args:
        blade: the blade.
        rpm: rotor speeds in rpm; results are then in rpm and Hz.
        omega: rotor speeds in rad/s, instead; results are then in rad/s.
        modes: number of modes, from the lowest.
        per_rev: excitation orders n (nP).
        operating: lowest and highest operating speed, in the unit of the speeds.
        margin: required distance from nP over the operating range: relative to nP (``"10%"``, 0.1) or absolute (``"5Hz"``).
        elements: number of beam elements of equal length; by default at each speed as many as ``accuracy`` requires.
        accuracy: largest relative uncertainty of a frequency, if ``elements`` is not given.
        allow_large_strain: accept steady strains above 20 %.

    Raises:
        CaseError: no speeds or fewer than two, an operating range outside them, another margin, or no steady state at a speed.
    """
    speeds, units = _speeds(rpm, omega)
    request = CampbellRequest(
        speeds=tuple(speeds.tolist()),
        modes=modes,
        per_rev=tuple(per_rev),
        operating=None if operating is None else (operating[0] / units.speeds, operating[1] / units.speeds),
        margin=required_margin(margin),
        elements=elements,
        accuracy=accuracy,
        allow_large_strain=allow_large_strain,
    )
    return CampbellResult(diagram.campbell(blade, request, diagram.solver(blade, request, at=units.at)), units)


def verify(
    blade: Blade | str,
    *,
    rpm: Speeds | None = None,
    omega: Speeds | None = None,
    codes: Sequence[str] | None = None,
    modes: int = MODES,
    changes: Sequence[str] = (),
    add: Sequence[str] = (),
    faults: str = "none",
    witnesses: int | None = None,
    time_limit: float | None = None,
    memory_limit: float = Limits.memory / 2**30,
    workers: int = 2,
    out: str | Path | None = None,
    fresh: bool = False,
) -> VerifyResult:
    """Solve a blade with every code, and compare and judge the results mode by mode against Southwell's own solver.

    Args:
        blade: a blade, or the name or TOML file of a case, which defines its speeds.
        rpm: rotor speeds in rpm.
        omega: rotor speeds in rad/s, instead.
        codes: names (``southwell codes``); by default all. Codes that are not installed are reported as not run.
        modes: number of modes of a blade to compare, from the lowest.
        changes: changes of the blade's properties, ``"EI_flap=*1.1"``.
        add: results of other programs or measurements, ``"NAME=FILE.csv"``.
        faults: seeded faults: ``fast``, ``all``, ``none``, or names separated by commas. Each alters this package for seconds;
            do not use it in other threads meanwhile.
        witnesses: number of independent groups that must confirm the blade; by default as the case says, none with ``codes``.
        time_limit: seconds for one solution by another code.
        memory_limit: memory in GiB for one solution by another code.
        workers: number of codes that run at the same time.
        out: folder for results.jsonl, where a run that was stopped continues.
        fresh: compute every answer again instead of taking those of earlier runs from the store.

    A speed without a steady state has cells that fail with the reason.

    Raises:
        CaseError: no speeds for a blade, speeds for a case, or a bad option.
        UnknownCodeError: a code that is not known.
    """
    request = Request(
        subjects=(_case(blade, rpm, omega, modes),),
        codes=None if codes is None else tuple(codes),
        changes=tuple(changes),
        add=tuple(add),
        faults=faults,
        witnesses=witnesses,
        time_limit=time_limit,
        memory_limit=memory_limit,
        execution=Execution(workers, threads=True, out=None if out is None else Path(out), fresh=fresh),
    )
    return VerifyResult(pipeline.verify(request))


def _case(blade: Blade | str, rpm: Speeds | None, omega: Speeds | None, modes: int) -> Case | str:
    if isinstance(blade, Blade):
        speeds, units = _speeds(rpm, omega)
        return default_case(blade, speeds.tolist(), rpm=units is RPM, source="given in Python", modes=modes)
    if rpm is not None or omega is not None:
        raise CaseError(f"{blade}: a case has its own speeds: leave out rpm and omega, or give a blade")
    return blade


def _given(rpm: Given | None, omega: Given | None) -> tuple[Given, Units]:
    """The one of both that is given, and its unit."""
    if rpm is not None and omega is None:
        return rpm, RPM
    if omega is not None and rpm is None:
        return omega, RAD_S
    raise CaseError("speeds: give either rpm or omega, as in rpm='0:12:1'")


def _speeds(rpm: Speeds | None, omega: Speeds | None) -> tuple[Array, Units]:
    """Speeds (k,) in rad/s, ascending, and the unit in which they were given."""
    given, units = _given(rpm, omega)
    try:
        values = speed_range(given) if isinstance(given, str) else np.atleast_1d(np.asarray(given, dtype=float))
    except (ValueError, TypeError) as error:
        raise CaseError(f"{units.speed}: {error}") from error
    if values.ndim != 1 or not (np.isfinite(values).all() and (values >= 0).all() and (np.diff(values) > 0).all()):
        raise CaseError(f"{units.speed}: {given}: speeds are finite, not negative, and ascend: correct them")
    return values / units.speeds, units
