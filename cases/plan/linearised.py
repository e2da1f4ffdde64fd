"""Linearisations of OpenFAST as results of a program: ``--add NAME=case.*.lin``, for a turbine's primary file."""

import re
from collections.abc import Collection, Sequence
from functools import lru_cache, partial
from pathlib import Path

from ...core.effects import ALL_EFFECTS
from ..input.errors import CaseError
from ..judge.cells import Head
from ..linearisation.judged import JudgedSet
from ..linearisation.judgement import judge
from ..linearisation.machine.cells import rows
from .column import Column
from .user_results import UserResults

_FILES = re.compile(r".*\.lin(\.gz)?", re.IGNORECASE)


def matches(path: str) -> bool:
    """Whether the file or files that are named are linearisations."""
    return bool(_FILES.fullmatch(path))


def read(name: str, pattern: str) -> UserResults:
    """The judged linearisations of a file, or of all that a pattern with ``*`` matches.

    Raises:
        CaseError: there are none, or one cannot be used.
    """
    return UserResults(name, pattern, (), linearised=_judged(pattern))


@lru_cache(maxsize=8)
def _judged(pattern: str) -> tuple[JudgedSet, ...]:
    path = Path(pattern)
    paths = sorted(path.parent.glob(path.name)) if "*" in path.name or "?" in path.name else [path]
    if not paths:
        raise CaseError(f"{pattern}: no such files: correct the path")
    return judge(paths).sets


def speeds(arguments: Sequence[str]) -> tuple[float, ...]:
    """Rotor speeds of the linearisations among results ``NAME=FILE``, rad/s, ascending.

    Raises:
        CaseError: as ``read``.
    """
    files = [text.partition("=")[2] for text in arguments]
    return tuple(
        sorted({judged_set.azimuth_set.omega for file in files if matches(file) for judged_set in _judged(file)})
    )


def columns(
    case: str, fst: str, pitch: float, target: float, motions: tuple[str, ...], user_results: Sequence[UserResults]
) -> list[Column]:
    """A column of a turbine for each of the results that are linearisations."""
    out = []
    for results in user_results:
        if results.linearised:
            files = sum(len(judged_set.azimuth_set.files) for judged_set in results.linearised)
            version = f"from {Path(results.path).name}, {files} file{'' if files == 1 else 's'}"
            head = Head(case, results.name, version, "code", target, "nothing", motions)
            work = partial(rows, head, fst, pitch, results.linearised)
            out.append(Column(results.name, ALL_EFFECTS, head, work, due="somewhere", bundled=False))
    return out


def check(user_results: Sequence[UserResults], turbines: Collection[str]) -> None:
    """Check that linearisations are given for one turbine.

    Raises:
        CaseError: there is none, or several.
    """
    for results in user_results:
        if results.linearised and len(turbines) != 1:
            raise CaseError(
                f"--add {results.name}={results.path}: linearisations are compared with a turbine, and the run has "
                f"{len(turbines) or 'none'}: give its primary file (.fst), as in southwell verify turbine.fst"
            )
