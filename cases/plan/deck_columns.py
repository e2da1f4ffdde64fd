"""Columns that share nothing with core, not even the file's reader: codes that are given the deck of a user's blade."""

from collections.abc import Sequence
from functools import partial
from hashlib import sha256

from ...references.protocol.description import Description
from ...references.protocol.interface import Deck
from ...references.protocol.process import Limits
from ...references.pybmodes import deck as pybmodes
from ..input.readers import BladeFile
from ..input.schema import Variant
from ..judge.cells import Head
from ..solve.deck import deck_code
from ..solve.reference import relevant_effects
from ..solve.refinement import Refining
from .column import Column, declined

PATH = f"{pybmodes.__name__}:CODE"


def columns(variant: Variant, codes: Sequence[Description], limits: Limits, target: float) -> list[Column]:
    """A column of pyBModes, if it is among the codes, is installed, and reads the format of the blade's file."""
    file, code = variant.file, pybmodes.CODE
    description = next((c for c in codes if c.name == "pybmodes" and c.version and not c.failure), None)
    if file is None or description is None or file.source.format not in pybmodes.FORMATS:
        return []
    blade = variant.blade
    motions = code.motions_in(file.source.format)
    head = Head(variant.name, code.name, description.version or "", "code", target, "nothing", motions)
    effects = relevant_effects(code.effects, blade)
    if reason := code.unsupported(blade):
        return [declined(head, effects, reason)]
    refining = Refining(code.levels, code.order, code.finest or 8 * code.levels[-1])
    work = partial(deck_code, head, PATH, deck(file), blade, effects, refining, limits)
    return [Column(code.name, effects, head, work, code.independence)]


def deck(file: BladeFile) -> Deck:
    """The files of a blade, with what the user states besides them."""
    paths = list(dict.fromkeys(path.resolve() for path in (file.path, *file.source.files)))
    contents = sha256()
    for path in paths:
        contents.update(path.read_bytes())
    mount = file.mount
    return Deck(
        file.source.format,
        tuple(str(path) for path in paths),
        contents.hexdigest(),
        mount.length,
        mount.hub_radius,
        mount.multipliers,
    )
