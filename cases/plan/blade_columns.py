"""The columns of a blade: one for each code, for the discretisation of the source, and for each printed table."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from importlib.metadata import version

from ...core.blade import Blade, straight
from ...core.effects import ALL_EFFECTS
from ...references.protocol.description import Description
from ...references.protocol.interface import CORE, Independence
from ...references.protocol.process import Limits
from ..input.schema import Case, Variant
from ..judge.cells import Head
from ..solve.published_tables import about, about_deck, rows
from ..solve.reference import relevant_effects
from ..solve.refinement import Refining
from ..solve.works import as_in_source, papers_equations, refined_code, same_code
from . import deck_columns
from .column import Column, declined, unasked

ROUNDING_TARGET = 1e-8
"""Target for two codes with the same discretisation."""

PAPER = "paper's equations, literally"
"""The column of ``core.park2010``, which checks the solver's algebra."""


def columns(case: Case, variant: Variant, codes: Sequence[Description], limits: Limits) -> list[Column]:
    """All columns of one blade; ``limits`` apply to each solution by a foreign code.

    ``refused`` of each code is its answer to this blade; a code that has not been asked yet is asked before it solves
    the blade. Codes that accept only mechanisms have no column, unless there are no other codes.
    """
    target, blade, source = case.text.compare.target, variant.blade, case.text.discretisation
    out = []
    if source:
        head = Head(variant.name, "southwell", version("southwell"), "discretisation", target)
        out.append(
            Column(
                "Southwell, as in the source",
                relevant_effects(source.effects, blade),
                head,
                partial(as_in_source, head, blade, source),
            )
        )
    head = Head(variant.name, PAPER, version("southwell"), "same discretisation", ROUNDING_TARGET, "everything")
    work = partial(papers_equations, head, blade)
    out.append(Column(PAPER, ALL_EFFECTS, head, work, due="highest speed"))
    for table in about(blade, case.text.compare.tables) + (about_deck(blade, variant.speeds) if variant.file else []):
        head = Head(variant.name, table.name, "", "table", target, "nothing")
        computed = source if source and table.name in source.tables else None
        work = partial(rows, head, table, blade, computed)
        theory = CORE if computed else table.series.theory or table.source
        origin = Independence(table.source, theory, theory, sections=table.source, eigensolver=table.source)
        out.append(
            Column(table.name, relevant_effects(table.series.effects, blade), head, work, origin, due="somewhere")
        )
    takers = [code for code in codes if code.blades]
    if not takers:
        heads = [Head(variant.name, code.name, code.version or "", "code", target) for code in codes]
        out += [declined(head, ALL_EFFECTS, "the code takes mechanisms, not blades") for head in heads]
    for code in takers:
        head = Head(variant.name, code.name, code.version or "", "code", target, code.shares, code.motions)
        out.append(replace(_code(head, code, blade, limits), origin=_origin(code, blade)))
    return out + deck_columns.columns(variant, codes, limits, target)


def _code(head: Head, code: Description, blade: Blade, limits: Limits) -> Column:
    if column := unasked(head, code, next(iter(code.refused), None) or ""):
        return column
    name, effects = code.asked, relevant_effects(code.effects, blade)
    if code.shares == "discretisation":
        head = replace(head, role="same discretisation", target=ROUNDING_TARGET)
        return Column(
            code.name,
            effects,
            head,
            partial(same_code, head, name, blade, code.levels[-1], code.effects, limits),
        )
    refining = Refining(code.levels, code.order, code.finest or 8 * code.levels[-1], bracket=code.bracket)
    return Column(code.name, effects, head, partial(refined_code, head, name, blade, effects, refining, limits))


def _origin(code: Description, blade: Blade) -> Independence | None:
    """The declared independence of a code; frames from core do not count if the section axes are those of the blade."""
    declared = code.independence
    plain = straight(blade) and not (blade.twist.any() or blade.precone or blade.pitch)
    return replace(declared, sections="blade") if declared and declared.theory != CORE and plain else declared
