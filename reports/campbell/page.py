"""Writes the output of ``southwell campbell``: figures as SVG and PNG, tables as CSV, and a page with all of them."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...cases.campbell.diagram import Campbell
from ...cases.input import atomic
from ...cases.input.errors import CaseError
from ...cases.plan.user_results import UserResults
from ...cases.writers.elastodyn_shapes import as_it_is, polynomials
from ..shared.sheets import Sheet, markdown
from ..shared.style import save
from ..shared.units import Units
from . import cover, csv_tables, encounters, shapes, span, tables
from . import figure as figures
from .confirmation import TITLE as CONFIRMATION
from .cover import UNKNOWN, InputOrigin

PAGE = "campbell.md"

NOT_VERIFIED = f"## {CONFIRMATION}\n\nNone: no other code was run (`--verify`).\n"


def write(
    diagram: Campbell,
    folder: Path,
    units: Units,
    command: str,
    origin: InputOrigin = UNKNOWN,
    extra: Sequence[Sheet] = (),
    user_results: Sequence[UserResults] = (),
) -> tuple[Path, ...]:
    """Write figures (SVG and PNG), CSV tables, and a Markdown page with all of them; return the paths.

    Args:
        diagram: the Campbell diagram.
        folder: output folder.
        units: units of the figures and tables.
        command: the command that reproduces the page.
        origin: origin of the blade.
        extra: further tables.
        user_results: results that are drawn as points over the lines.

    Raises:
        OSError: if a file cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    name, k = diagram.blade.name, shapes_at(diagram)
    figure_of = {
        "campbell": figures.draw(diagram, units, f"{name}: natural frequencies versus rotor speed", user_results),
        "shapes": shapes.draw(diagram, k, units, f"{name}: mode shapes"),
        "span": span.draw(diagram.blade),
    }
    close = encounters.draw(diagram, units, f"{name}: modes that come close")
    if close:
        figure_of["encounters"] = close
    paths = [path for stem, figure in figure_of.items() for path in save(figure, folder / stem)]
    paths += [*csv_tables.write(diagram, folder), shapes.write_csv(diagram, k, folder)]
    page = folder / PAGE
    atomic.write(page, _page(diagram, k, units, command, origin, extra))
    return (page, *paths)


def shapes_at(diagram: Campbell) -> int:
    """The index of the speed at which shapes are shown.

    It is the requested speed nearest to the upper end of the operating range, or otherwise to the highest speed.
    """
    request, omega = diagram.request, diagram.tracks.omega
    target = request.operating[1] if request.operating else omega[-1]
    requested = np.flatnonzero(diagram.tracks.requested)
    return int(requested[np.abs(omega[requested] - target).argmin()])


def _page(diagram: Campbell, k: int, units: Units, command: str, origin: InputOrigin, extra: Sequence[Sheet]) -> str:
    omega = float(diagram.tracks.omega[k])
    parts = [
        f"# Campbell diagram of {diagram.blade.name}\n",
        f"{tables.verdict(diagram, units)}\n",
        *[f"{line}.\n" for line in tables.notes(diagram, units)],
        cover.cover(origin),
        "![Natural frequencies versus rotor speed](campbell.svg)\n",
        *[markdown(sheet) for sheet in (*tables.sheets(diagram, units), *extra)],
        *([] if any(sheet.title == CONFIRMATION for sheet in extra) else [NOT_VERIFIED]),
        *(["![Modes that come close](encounters.svg)\n"] if diagram.encounters else []),
        f"## Mode shapes, {units.at(omega)}\n\n![Mode shapes](shapes.svg)\n",
        _elastodyn(diagram, k, units),
        cover.properties(diagram.blade),
        cover.unused(origin),
        f"## Reproduce\n\n```\n{command}\n```\n",
    ]
    return "\n".join(parts)


def _elastodyn(diagram: Campbell, k: int, units: Units) -> str:
    omega = float(diagram.tracks.omega[k])
    try:
        fitted = polynomials(diagram.blade, omega, diagram.request.elements)
    except CaseError as error:
        return f"## ElastoDyn mode shapes\n\nNone: {error}.\n"
    blade_shapes = as_it_is(diagram.blade, diagram.tracks.solved[k])
    return markdown(shapes.coefficients(fitted, blade_shapes, units, omega))
