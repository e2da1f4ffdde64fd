"""pyBModes given the deck itself: its own reader, sampling, mesh, matrices and eigenvalues.

Nothing of Southwell lies between the file and these frequencies, so that a mistake in Southwell's reader, which every code
that is given a blade follows, is a difference here. pyBModes reads ElastoDyn's files and BModes' own. Of ElastoDyn's table it
takes the six columns of OpenFAST; stretch and torsion are nearly rigid (J. H. Seo, pyBModes 1.19.1,
``io._elastodyn.adapter``). The adapter sets the rotor speed and divides pyBModes's elements between the stations that it read.

The description of the blade is used only to decline a blade whose properties pyBModes's beam does not have, as in ``beam``.
Precone is not declined: pyBModes ignores it, and ``cases.solve.deck`` adds its effect to the uncertainty.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.blade import AXIAL, TORSION, Blade
from ...core.effects import Effects
from ...core.modes import Modes
from ..protocol.interface import BladeAdapter, CodeError, Deck, Independence, Motion, extra
from ..theories.grading import graded
from . import beam

Array = NDArray[np.float64]

FORMATS = ("ElastoDyn", "BModes")
"""Formats that pyBModes reads as Southwell does."""


class PyBModesDeck(BladeAdapter):
    """See the module; the deck is given to ``with_deck``."""

    name = "pybmodes-deck"
    title = "pyBModes, given the deck"
    independence = Independence("pyBModes", "BModes", "pyBModes", "pyBModes' own reader", "pyBModes")
    motions = beam.PyBModes.motions
    effects = Effects(prestretch=False, coriolis=False, rotary_inertia=False)
    levels = beam.PyBModes.levels
    order = 2
    finest = beam.PyBModes.finest
    hint = extra("codes")
    distribution = "pybmodes"

    @staticmethod
    def motions_in(format: str) -> tuple[Motion, ...]:
        """The motions in the shapes of a deck of this format."""
        return beam.PyBModes.motions if format == "BModes" else ("edgewise", "flapwise")

    def __init__(self, deck: Deck | None = None) -> None:
        self.deck = deck

    def with_deck(self, deck: Deck) -> BladeAdapter:
        """See ``interface.BladeAdapter``."""
        return PyBModesDeck(deck)

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if pyBModes's beam does not support a property of the blade; stretch and torsion may be rigid."""
        if blade.pitch:
            return f"pitch = {blade.pitch:g} rad: pyBModes does not use it"
        stiffness = blade.stiffness.copy()
        for strain in (AXIAL, TORSION):
            rigid = np.isinf(stiffness[:, strain, strain]).any()
            stiffness[:, strain, strain] = 1.0 if rigid else stiffness[:, strain, strain]
        return beam.CODE.unsupported(replace(blade, stiffness=stiffness, precone=0.0))

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes of bending; see ``interface.BladeAdapter``. ``blade`` is not used.

        Raises:
            CodeError: no deck, one that pyBModes does not read, or a stiffness that is not positive at this speed.
        """
        if self.deck is None:
            raise CodeError("no deck is given")
        model, table = _read(self.deck)
        ends = np.asarray(table.span_loc, float)
        bending = np.array([table.flp_stff, table.edge_stff], float)
        pieces = -(-elements // min(len(ends) - 1, beam.SECTIONS))
        model._bmi.rot_rpm = omega * 30.0 / np.pi
        limit = beam.FREEDOMS * pieces * (len(ends) - 1) // 2
        doubted = False
        with beam.reproducible():
            if beam.FREEDOMS * pieces * (len(ends) - 1) > beam.ITERATED:
                doubted = _doubled(model, ends, count)
            _divide(model, graded(ends, bending, pieces))
            radius = float(model._bmi.radius)
            size = (radius, radius - float(model._bmi.hub_rad))
            frequencies, shapes = beam.moving(model, size, count, doubted, limit)
        if self.deck.format == "ElastoDyn":
            shapes[:, :, 3] = 0.0  # torsion is nearly rigid: only rounding
        return Modes(omega, frequencies, shapes, pieces * (len(ends) - 1))


def _read(deck: Deck) -> tuple[Any, Any]:
    """pyBModes's model of the blade in a deck, and its table of sections.

    Raises:
        CodeError: no file of the deck is one that pyBModes reads.
    """
    from pybmodes.io.elastodyn_reader import ElastoDynMain, read_elastodyn_blade, read_elastodyn_main, to_pybmodes_blade
    from pybmodes.io.sec_props import read_sec_props
    from pybmodes.models import RotatingBlade

    paths = [Path(file) for file in deck.files]
    if deck.format == "BModes":
        model = RotatingBlade(paths[0])
        return model, read_sec_props(model._bmi.resolve_sec_props_path())
    mains = [path for path in paths if "TIPRAD" in path.read_text("latin-1").upper()]
    if mains:
        main = read_elastodyn_main(mains[0])
        blade = read_elastodyn_blade(mains[0].parent / main.bld_file[0])
    else:
        main = ElastoDynMain(header="", title="")
        blade = read_elastodyn_blade(paths[0])
    length = deck.length or main.tip_rad - main.hub_rad
    if not length > 0.0:
        raise CodeError("length: not in the files: the stations of ElastoDyn are fractions of it")
    main.hub_rad = main.hub_rad if deck.hub_radius is None else deck.hub_radius
    main.tip_rad = main.hub_rad + length
    if deck.multipliers:
        blade.adj_bl_ms, blade.adj_fl_st, blade.adj_ed_st = deck.multipliers
    model = RotatingBlade.__new__(RotatingBlade)
    model._bmi, model._sp = to_pybmodes_blade(main, blade)
    model.coeff_validation = None
    return model, model._sp


def _divide(model: Any, ends: Array) -> None:
    model._bmi.el_loc, model._bmi.n_elements = ends, len(ends) - 1


def _doubled(model: Any, ends: Array, count: int) -> bool:
    """Whether two of the lowest modes may have nearly the same frequency: by one element between two stations."""
    if beam.FREEDOMS * (len(ends) - 1) > beam.ITERATED:
        return True
    _divide(model, ends)
    f = model.run(count + beam.SPARE, check_model=False).frequencies
    return bool((np.diff(f) <= beam.NEAR * f[1:]).any())


CODE = PyBModesDeck()
