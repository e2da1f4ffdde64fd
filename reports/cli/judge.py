"""``southwell judge``: linearisations of other programs, judged."""

from pathlib import Path
from typing import Annotated

import msgspec
from cyclopts import Parameter

from ...cases.linearisation import machine
from ...cases.linearisation.judged import YES
from ...cases.linearisation.judgement import judge
from ..linearisation import text
from ..shared.console import output
from ..shared.statuses import FAILED, PASSED


def command(
    files: Annotated[tuple[Path, ...], Parameter(negative=())],
    /,
    *,
    fst: Path | None = None,
    all: bool = False,
    json: bool = False,
) -> int:
    """Judge linearisations of OpenFAST: find their defects and name their modes.

    Prints the verdict (Yes, No or Open), the findings with their remedies, and the modes in the fixed frame. Status 1 unless
    the verdict is Yes.

    Parameters
    ----------
    files
        Files `case.*.lin`, also compressed (.gz): those with the same stem are the azimuths of one operating point. Tables of
        modes: .csv, HAWCStab2's .cmb.
    fst
        Primary file (.fst) of the turbine: list the modes of the deck in vacuo beside those of the linearisations.
    all
        List all modes, also those of aerodynamics and waves.
    json
        Print JSON: verdict, findings, and the modes of every operating point.
    """
    turbine = machine.read(fst) if fst else None
    judgement = judge(files)
    decks = [machine.beside(judged, turbine) for judged in judgement.sets] if turbine else []
    if json:
        print(msgspec.json.format(msgspec.json.encode(text.plain(judgement, decks))).decode())
    else:
        console = output()
        for line in (text.verdict(judgement), *text.findings(judgement)):
            console.print(line, markup=False, soft_wrap=not console.is_terminal)
        for table in (*text.modes(judgement, console.width, all), *text.decks(judgement, decks, console.width)):
            console.print(table)
    return PASSED if judgement.verdict == YES else FAILED
