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

    The command prints the verdict (Yes, No or Open), the findings with their remedies, and the modes in the fixed frame. The
    status is 1 unless the verdict is Yes.

    Parameters
    ----------
    files
        Files `case.*.lin`, also compressed (.gz); files with the same stem are the azimuths of one operating point. Or tables
        of modes: .csv, or HAWCStab2's .cmb with the .amp of the same stem, which names the modes.
    fst
        Primary file (.fst) of the turbine. The modes are paired with those of Southwell's turbine by shape, and each difference
        is split into the deck's mode shapes and nodes, gravity, deflection, aerodynamics, and the rest with its causes.
    all
        List all modes, including those of aerodynamics and waves.
    json
        Print JSON: verdict, findings, and the modes of every operating point.
    """
    machine = deck.read(fst) if fst else None
    judgement = judge(files)
    compared = [compare(judged_set, machine) for judged_set in judgement.sets] if machine else []
    if json:
        print(msgspec.json.format(msgspec.json.encode(text.plain(judgement, compared))).decode())
    else:
        console = output()
        for line in (text.verdict(judgement), *text.findings(judgement)):
            console.print(line, markup=False, soft_wrap=True)
        for part in (*text.modes(judgement, console.width, all), *text.decks(judgement, compared, console.width)):
            console.print(part, markup=False, soft_wrap=isinstance(part, str))
    return PASSED if judgement.verdict == YES else FAILED
