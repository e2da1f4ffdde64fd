"""What a blade's page states besides its results: origin and date, properties along the span, conventions, unused inputs."""

import platform
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path

from ...cases.input.properties import sections
from ...cases.regression.history import this_machine
from ...core.blade import Blade
from ...core.regular_files import read_bytes
from ...references.protocol.sources import LIBRARIES
from ..shared import markdown
from .properties import COLUMNS, PROPERTIES, cell, facts, picked, rows


@dataclass(frozen=True)
class InputOrigin:
    """Where a blade comes from.

    Attributes:
        about: one fact per line.
        files: files that were read; none if it is a case of this package.
        unused: non-zero quantities of the files that the blade does not use, one line each.
    """

    about: Sequence[str] = ()
    files: Sequence[Path] = ()
    unused: Sequence[str] = ()


UNKNOWN = InputOrigin()


def cover(origin: InputOrigin) -> str:
    """The section on the input: origin, digests of the files, date and versions.

    Raises:
        OSError: if a file cannot be read.
    """
    items = [{"": "origin", "value": "<br>".join(map(markdown.plain, origin.about))}] if origin.about else []
    items += [
        {"": "file", "value": f"{markdown.plain(path.name)}, SHA-256 `{sha256(read_bytes(path)).hexdigest()}`"}
        for path in origin.files
    ]
    if origin.unused:
        count = len(origin.unused)
        listed = f"{count} non-zero {'quantity' if count == 1 else 'quantities'}, listed below"
        items.append({"": "not used", "value": listed})
    libraries = ", ".join(f"{name} {version(name)}" for name in LIBRARIES)
    items.append({"": "computed", "value": f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC"})
    program = f"southwell {version('southwell')}, Python {platform.python_version()}, {libraries}"
    items.append({"": "program", "value": f"{program}; {this_machine()}"})
    return f"## Input\n\n{markdown.table(items)}\n"


def properties(blade: Blade) -> str:
    """The sections on the blade's properties: facts with the conventions they follow, figure, and a table along the span."""
    conventions = [{"": name, "value": markdown.plain(text)} for name, text in facts(blade).items() if text]
    values = rows(blade, sections(blade))
    indices = picked(len(values))
    along = [{COLUMNS[k]: cell(k, float(row[k])) for k in range(PROPERTIES)} for row in values[indices]]
    note = "" if len(indices) == len(values) else f"\n{len(indices)} of {len(values)} stations.\n"
    return (
        f"## Blade and conventions\n\n{markdown.table(conventions)}\n\n## Properties along the span\n\n"
        f"![Properties along the span](span.svg)\n\n{markdown.table(along)}\n{note}"
    )


def unused(origin: InputOrigin) -> str:
    """The section on quantities of the files that are not used; nothing is stated of a blade of unknown origin."""
    if origin is UNKNOWN:
        return ""
    lines = (
        "\n".join(f"- {markdown.plain(line.removeprefix('not used: '))}" for line in origin.unused)
        or "All non-zero quantities are used."
    )
    return f"## Inputs not used\n\n{lines}\n"
