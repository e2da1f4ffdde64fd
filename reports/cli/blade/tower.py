"""``southwell modes`` of a tower that stands alone."""

from pathlib import Path

import msgspec
import numpy as np

from ....cases.input.errors import NO_STATE, CaseError
from ....cases.input.machines import towers
from ....core.turbine.tower_modes import TowerModes, tower_modes
from ...shared import not_used
from ...shared.certain import certain, relative
from ...shared.console import output
from ...shared.sheets import Sheet, terminal
from ..errors import UsageError


def is_tower(name: str) -> bool:
    """Whether a name is the file of a tower without a rotor."""
    return towers.is_tower(Path(name))


def run(name: str, modes: int, json: bool, **given: bool) -> None:
    """Compute and print the natural frequencies of a tower.

    Args:
        name: the file.
        modes: number of modes, from the lowest.
        json: print JSON.
        given: options of blades by name, and whether each is given.

    Raises:
        CaseError: the file cannot be read, or the tower does not carry its weight.
        UsageError: an option applies to blades only.
    """
    for option, is_given in given.items():
        if is_given:
            raise UsageError(f"--{option.replace('_', '-')}: {name} is a tower, which does not rotate: leave it out")
    tower, source = towers.read(Path(name))
    try:
        solved = tower_modes(tower, modes)
    except NO_STATE as error:
        raise CaseError(f"{name}: {error}") from error
    if json:
        print(msgspec.json.format(msgspec.json.encode(_rows(tower.beam.name, solved))).decode())
        return
    console = output()
    console.print(terminal(_sheet(tower.beam.name, solved), console.width))
    for line in source.about:
        console.print(line, style="dim", markup=False)
    not_used.show(source.unused, console)


def _sheet(name: str, solved: TowerModes) -> Sheet:
    rows = [
        (label, certain(frequency, doubt), relative(doubt), f"{100 * part:.0f} %")
        for label, frequency, doubt, part in zip(
            solved.names,
            (solved.frequencies / (2 * np.pi)).tolist(),
            solved.uncertainty.tolist(),
            solved.confidence.tolist(),
            strict=True,
        )
    ]
    note = "The confidence is the part of the kinetic energy in the motion that names a mode, of a platform of the elastic."
    return Sheet(f"{name}: natural frequencies", ("mode", "Hz", "± relative", "confidence"), tuple(rows), note)


def _rows(name: str, solved: TowerModes) -> list[dict[str, object]]:
    return [
        {
            "tower": name,
            "mode": k + 1,
            "name": solved.names[k],
            "frequency_rad_s": float(solved.frequencies[k]),
            "frequency_hz": float(solved.frequencies[k] / (2 * np.pi)),
            "relative_uncertainty": float(solved.uncertainty[k]),
            "confidence": float(solved.confidence[k]),
        }
        for k in range(len(solved.names))
    ]
