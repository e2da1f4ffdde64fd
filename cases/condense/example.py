"""Worked example of FE condensation: solids as 20 complex stiffness elements and rigid bodies, against references.

A tapered, twisted blade of steel against the modes of the complete solid, by scikit-fem and by CalculiX; the paper's
cantilever as a solid against Timoshenko's exact frequencies; and the effect of rigid ties on torsion.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from ...core.condense.compressed import chain_from_segments, chain_modes
from ...core.condense.segments import Segment
from ...core.effects import ALL_EFFECTS, Effects
from ...core.modes import Modes
from ...core.regular_files import read_bytes
from ...references.protocol.interface import CodeError
from ...references.solid import calculix, hexahedra, timoshenko
from ...references.solid.mesh import Bricks, clamped
from ..input import atomic
from ..input.errors import CaseError
from . import solid_blades as solids
from .condensed import names

MODES = 5
SPEEDS = (0.0, solids.SPEED)
KINDS = ("rigid", "average", None)
"""How a segment is tied; ``None``: cut in place from the whole."""

TARGET, EXACT_TARGET = 5e-3, 1e-3
"""Largest difference of the condensed blade from the whole solid, and of the cantilever from the exact beam; relative."""

LENGTHS = (1, 2)
"""Of the flat bar, in chords."""

PLANE = 3
"""Frequencies of the cantilever in each plane."""


@dataclass(frozen=True)
class Speed:
    """The blade at one speed, rad/s; the whole solid and 20 elements.

    Attributes:
        omega: rotor speed.
        names: of the condensed model's modes.
        whole: by scikit-fem.
        condensed: in place.
        apart: by ``rigid`` and ``average``, each segment condensed alone.
        calculix: the whole solid without Coriolis forces; empty if not run.
        without: the condensed model without them.
    """

    omega: float
    names: tuple[str, ...]
    whole: tuple[float, ...]
    condensed: tuple[float, ...]
    apart: dict[str, tuple[float, ...]]
    calculix: tuple[float, ...]
    without: tuple[float, ...]


@dataclass(frozen=True)
class Example:
    """Everything computed in one run.

    Attributes:
        freedoms: of the whole solid.
        hexahedra: likewise.
        segments: number of segments.
        speeds: the blade.
        exact: the cantilever in one plane, Timoshenko, rad/s.
        cantilever: ``rigid`` and ``average`` → both planes, rad/s.
        torsion: ``rigid``, ``average`` and ``in place`` → G J of a flat bar over St Venant's at each of ``lengths``.
        lengths: of the piece of the bar, in chords.
        versions: versions of the codes, or why one was not run.
    """

    freedoms: int
    hexahedra: int
    segments: int
    speeds: tuple[Speed, ...]
    exact: tuple[float, ...]
    cantilever: dict[str, tuple[float, ...]]
    torsion: dict[str, tuple[float, ...]]
    lengths: tuple[int, ...]
    versions: dict[str, str]


@dataclass(frozen=True)
class Drawn:
    """The data of the figure."""

    bricks: Bricks
    segments: list[Segment]
    cuts: NDArray[np.intp]
    root: NDArray[np.float64]


def example(
    say: Callable[[str], None],
    *,
    layers: int = solids.LAYERS,
    across: tuple[int, int] = solids.ACROSS,
    segments: int = 20,
) -> tuple[Example, Drawn]:
    """Condense and compare; ``say`` is called with progress messages.

    Raises:
        CaseError: without scikit-fem there are no solids.
    """
    if hexahedra.version() is None:
        raise CaseError(f"--example: scikit-fem is not installed, and the solids need it; {hexahedra.HINT}")
    versions = {"scikit-fem": hexahedra.version() or ""}
    bricks = solids.twisted(layers, across)
    say("the blade's segments in place")
    model = hexahedra.finite_elements(bricks, solids.STEEL, "twisted blade")
    pieces = {"in place": solids.segments_in_place(model, bricks, segments)}
    for kind in ("rigid", "average"):
        say(f"each segment alone, {kind} ties")
        pieces[kind] = solids.segments_apart(kind, bricks, segments)
    found = tuple(_at_speed(say, bricks, pieces, omega, versions) for omega in SPEEDS)
    say("the cantilever")
    exact = timoshenko.cantilever(PLANE, solids.SQUARE, solids.SIDE, solids.LENGTH)
    bar = {kind: [solids.cantilever_segment(kind, segments)] * segments for kind in ("rigid", "average")}
    torsion = {}
    for kind in KINDS:
        say(f"torsion of a flat bar, {kind or 'in place'}")
        torsion[kind or "in place"] = tuple(solids.torsion(n * solids.CHORD, kind) for n in LENGTHS)
    printed = Example(
        freedoms=len(model.directions),
        hexahedra=int(np.prod(bricks.counts)),
        segments=segments,
        speeds=found,
        exact=_plain(exact),
        cantilever={kind: _plain(_chain(s, solids.HUB, 0.0, 2 * PLANE).frequencies) for kind, s in bar.items()},
        torsion=torsion,
        lengths=LENGTHS,
        versions=versions,
    )
    return printed, Drawn(bricks, pieces["in place"], solids.cuts(bricks, segments), solids.at(solids.ROOT))


def within(found: Example) -> bool:
    """Whether every difference is within its target: of the blade from the whole solid, of the cantilever from the beam."""
    return max(largest(s) for s in found.speeds) <= TARGET and cantilever(found, "average") <= EXACT_TARGET


def largest(s: Speed) -> float:
    """Largest relative difference of the condensed blade from the whole solid by either code."""
    off = differences(s.condensed, s.whole)
    return float(np.abs(np.append(off, differences(s.without, s.calculix) if s.calculix else [])).max())


def cantilever(found: Example, kind: str) -> float:
    """Largest relative difference of the cantilever with such ties from the exact beam."""
    return float(np.abs(differences(found.cantilever[kind], np.repeat(found.exact, 2))).max())


def differences(values: Sequence[float], of: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
    """Relative."""
    return np.asarray(values) / np.asarray(of) - 1.0


def write(path: Path, found: Example) -> None:
    """Write the results as JSON."""
    atomic.write(path, msgspec.json.format(msgspec.json.encode(found)) + b"\n")


def read(path: Path) -> Example:
    """Read a file written by ``write``.

    Raises:
        msgspec.DecodeError: if the format is invalid.
    """
    return msgspec.json.decode(read_bytes(path), type=Example)


def _at_speed(
    say: Callable[[str], None], bricks: Bricks, pieces: dict[str, list[Segment]], omega: float, versions: dict[str, str]
) -> Speed:
    say(f"whole solid at {omega:g} rad/s by scikit-fem")
    clamp = clamped(solids.ROOT)
    whole = hexahedra.modes(bricks, solids.STEEL, omega, MODES + 1, clamp)
    say(f"whole solid at {omega:g} rad/s by CalculiX")
    try:
        theirs = calculix.modes(bricks, solids.STEEL, omega, MODES + 1, clamp).frequencies
        versions["CalculiX"] = calculix.version() or ""
    except CodeError as error:
        theirs = np.zeros(0)
        versions["CalculiX"] = f"not run: {error}"
    chains = {how: _chain(s, solids.ROOT, omega, MODES + 1) for how, s in pieces.items()}
    ours = chains.pop("in place")
    return Speed(
        omega=omega,
        names=names(pieces["in place"], ours)[:MODES],
        whole=_plain(whole.frequencies[:MODES]),
        condensed=_plain(ours.frequencies[:MODES]),
        apart={how: _plain(m.frequencies[:MODES]) for how, m in chains.items()},
        calculix=_plain(theirs[:MODES]),
        without=_plain(_chain(pieces["in place"], solids.ROOT, omega, MODES + 1, calculix.EFFECTS).frequencies[:MODES]),
    )


def _chain(segments: list[Segment], root: float, omega: float, count: int, model: Effects = ALL_EFFECTS) -> Modes:
    return chain_modes(chain_from_segments(segments, solids.at(root)), omega, count, effects=model)


def _plain(values: np.ndarray) -> tuple[float, ...]:
    return tuple(values.tolist())
