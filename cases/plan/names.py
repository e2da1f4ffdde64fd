"""Unique names of blades and columns: no two blades, and no two columns, of a run may have the same name."""

from collections.abc import Iterable, Sequence

from ...references.protocol.description import Description
from ...references.published import label, load
from ..input.errors import CaseError
from .blade_columns import PAPER
from .subject import Subject
from .user_results import UserResults

OURS = ("southwell", "source's discretisation", PAPER, "closed form", "printed tables")
"""Columns of this package that are not codes, as named in results and in tables."""


def unique(subjects: Sequence[Subject], codes: Sequence[Description], user_results: Sequence[UserResults]) -> None:
    """Check that every name is used only once.

    Args:
        codes: descriptions of the codes.

    Raises:
        CaseError: if a name is used twice; one line that identifies both uses.
    """
    _once("case", ((subject.name, subject.path) for subject in subjects), "leave one out, or rename it")
    tables = [name for subject in subjects for name in subject.tables]
    columns = [(name, "this package") for name in OURS]
    for table in dict.fromkeys(tables):
        columns += [
            (f"{label(table)}/{name}", f"table {table}") for name in dict.fromkeys(s.name for s in load(table).series)
        ]
    columns += [(code.name, f"--codes {code.asked}") for code in codes]
    columns += [(results.name, f"--add {results.path}") for results in user_results]
    _once("code", columns, "leave one out, or give it another name")


def _once(kind: str, sources: Iterable[tuple[str, str]], remedy: str) -> None:
    owners: dict[str, str] = {}
    for name, source in sources:
        if name in owners:
            raise CaseError(f"{kind}: {name!r} is given twice, by {owners[name]} and by {source}: {remedy}")
        owners[name] = source
