"""``southwell judge``: linearisations of other programs, judged."""

from pathlib import Path
from typing import Annotated

import msgspec
from cyclopts import Parameter

from ...cases.linearisation.judged import YES
from ...cases.linearisation.judgement import judge
from ...cases.linearisation.machine import deck
from ...cases.linearisation.machine.split import compare
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
        modes: .csv, HAWCStab2's .cmb; its .amp with the same stem names the modes.
    fst
        Primary file (.fst) of the turbine: pair the modes with those of Southwell's turbine by shape, and split each difference
        into the deck's mode shapes and nodes, gravity, deflection, aerodynamics, and the rest with its causes.
    all
        List all modes, also those of aerodynamics and waves.
    json
        Print JSON: verdict, findings, and the modes of every operating point.
    """
    machine = deck.read(fst) if fst else None
    judgement = judge(files)
    compared = [compare(judged, machine) for judged in judgement.sets] if machine else []
    if json:
        print(msgspec.json.format(msgspec.json.encode(text.plain(judgement, compared))).decode())
    else:
        console = output()
        for line in (text.verdict(judgement), *text.findings(judgement)):
            console.print(line, markup=False, soft_wrap=True)
        for part in (*text.modes(judgement, console.width, all), *text.decks(judgement, compared, console.width)):
            console.print(part, markup=False, soft_wrap=isinstance(part, str))
    return PASSED if judgement.verdict == YES else FAILED
