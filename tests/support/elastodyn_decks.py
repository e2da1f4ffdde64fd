"""A small deck with ElastoDyn's assumed mode shapes, and linearisations that its equations give."""

from dataclasses import replace
from pathlib import Path

from southwell.cases.linearisation.lin_file import parsed
from southwell.cases.linearisation.machine import fields, models
from southwell.cases.linearisation.machine.deck import Deck
from southwell.cases.linearisation.machine.models import Models
from southwell.cases.linearisation.sets import AzimuthSet, azimuth_set

from .linearised_defects import healthy
from .linearised_machines import Lin, Machine, without
from .turbine_decks import deck

SHAPES = {"BldFl1Sh": (0.2, 1.1, -0.3), "BldFl2Sh": (-2.8, 3.2, 0.6), "BldEdgSh": (0.7, 0.5, -0.2)}
TOWER_SHAPES = {"TwFAM1Sh": (0.9, 0.2, -0.1), "TwSSM1Sh": (1.1, 0.1, -0.2)}

OMEGA = 2.5


def shaped(folder: Path, nodes: int = 12, pitch: float = 2.0) -> Path:
    """Write the deck of ``turbine_decks`` with assumed shapes; return its primary file."""
    path = deck(folder, free=True)
    for name, shapes in (("blade.dat", SHAPES), ("tower.dat", TOWER_SHAPES)):
        file = folder / name
        lines = [line for line in file.read_text().splitlines() if "Sh(" not in line]
        for shape, values in shapes.items():
            lines += [f"{value} {shape}({k})" for k, value in enumerate((*values, 0.0, 0.0), 2)]
        file.write_text(
            "\n".join([*lines, "0.5 BldFlDmp(1)", "0.6 BldFlDmp(2)", "0.7 BldEdDmp(1)", "1 TwrSSDmp(1)"]) + "\n"
        )
    main = folder / "main.dat"
    main.write_text(main.read_text() + f"{nodes} BldNodes\n{nodes} TwrNodes\n{pitch} BlPitch(1)\n")
    return path


def linearised(deck_: Deck, azimuths: int = 4, omega: float = OMEGA, words: tuple[str, ...] = ()) -> AzimuthSet:
    """A set whose A follows from the deck, with gravity, at its operating point, printed with ten digits.

    States whose descriptions have one of ``words`` are locked.
    """
    return _set(files(deck_, azimuths, omega, words))


def files(deck_: Deck, azimuths: int = 4, omega: float = OMEGA, words: tuple[str, ...] = ()) -> list[Lin]:
    """The files of ``linearised``."""
    lins = [small(without(lin, *words)) for lin in healthy(Machine(omega=omega), azimuths)]
    each = _set(lins)
    deck_models = Models(deck_, each, models.degrees(deck_, each), fields.points(deck_))
    structure = deck_models.structure()
    A = [structure.state_matrix(part, each) for part in models.matrices(structure, each, True, True)]
    return [replace(lin, A=a, decimals=9) for lin, a in zip(lins, A, strict=True)]


def small(lin: Lin) -> Lin:
    """The file with blades that bend less."""
    scales = [0.05 if "blade" in row.text else 1.0 for row in lin.rows]
    rows = [replace(row, value=row.value * x, slope=row.slope * x) for row, x in zip(lin.rows, scales, strict=True)]
    return replace(lin, rows=tuple(rows))


def _set(lins: list[Lin]) -> AzimuthSet:
    return azimuth_set("case", [parsed(Path(f"case.{k + 1}.lin"), lin.text()) for k, lin in enumerate(lins)])
