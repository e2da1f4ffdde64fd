"""What a column solves: the answers of a code, or of core in another way, and their rows against core's references."""

from collections.abc import Sequence
from dataclasses import replace

from ...core.blade import Blade
from ...core.effects import Effects
from ...core.element.measures import Measure
from ...references.protocol.process import Failure, Limits
from ...references.protocol.worker import Run as CodeRun
from ...references.protocol.worker import answers
from ..input.schema import Discretisation
from ..judge.cells import Head, Rows, join, joined
from ..judge.convergence import Refinements
from ..judge.printed import source_discretisation_cells
from ..judge.reference import Reference
from ..judge.refined import refined
from ..judge.same import rounding, same_discretisation_cells
from ..judge.spectrum import Answer, of_blades
from . import core_solver, paper
from .copies import copied
from .refinement import Ask, Refining, solve

ELEMENTS = 20
"""Number of elements of the paper's equations, as of its blade: their dense matrices take the cube of it. Codes with core's
discretisation also have it if core is stable with it: refinement does not reduce rounding, which is compared."""

References = Sequence[tuple[float, Reference]]
"""Rotor speeds, rad/s, and core's references at these speeds."""


def refined_code(
    head: Head, name: str, blade: Blade, effects: Effects, refining: Refining, limits: Limits, core: References
) -> Rows:
    """Rows of a code, refined until it can be judged; a copy of core's discretisation is recognised."""

    def ask(runs: Sequence[CodeRun]) -> list[Answer]:
        return of_blades(answers(name, blade, runs, limits, head.version))

    solved = refinements(ask, refining, core)
    cells, levels = joined(refined(head, omega, r, s, refining.order, refining.bracket) for omega, r, s in solved)
    first = [(omega, r, s.answers[0]) for omega, r, s in solved if s.answers]
    if head.shares in ("nothing", "undeclared") and (copy := copied(blade, effects, first)):
        why = (
            f"equals the answers of Southwell's own solver with {copy[0]} elements to {copy[1]:.0e}: its discretisation, not "
            "independent"
        )
        cells = [replace(c, shares="discretisation", reason=join(why, c.reason)) for c in cells]
    return cells, levels


def as_in_source(head: Head, blade: Blade, source: Discretisation, core: References) -> Rows:
    """Rows of core with the discretisation of a source."""

    def ask(runs: Sequence[CodeRun]) -> list[Answer]:
        return of_blades(core_solver.answers(blade, runs, source.mass, source.stiffness, source.effects))

    refining = core_solver.as_given(source)
    solved = refinements(ask, refining, core)
    return joined(
        source_discretisation_cells(head, omega, r, s, refining.order, source.label) for omega, r, s in solved
    )


def same_code(
    head: Head, name: str, blade: Blade, finest: int, effects: Effects, limits: Limits, core: References
) -> Rows:
    """Rows of a code that is given core's discretisation, with as many elements as core and at the same speeds."""

    def ask(elements: int, scale: float = 1.0) -> list[Answer]:
        scaled = core_solver.rescaled(blade, scale)
        return of_blades(core_solver.answers(scaled, runs(elements), "half_end", "body_fixed", effects))

    def runs(elements: int) -> list[CodeRun]:
        return [(omega, elements, r.core.count) for omega, r in core]

    elements = min(ELEMENTS, finest)
    core_answers = ask(elements)
    if any(isinstance(answer, Failure) for answer in core_answers):
        elements = finest
        core_answers = ask(elements)
    scaled_answers = [ask(elements, scale) for scale in (3.0, 7.0)]
    spectra = of_blades(answers(name, blade, runs(elements), limits, head.version))
    noises = [rounding(a, rescaled) for a, *rescaled in zip(core_answers, *scaled_answers, strict=True)]
    rows = zip(core, spectra, core_answers, noises, strict=True)
    return joined(
        same_discretisation_cells(head, omega, r, a, b, rounding_of_core) for (omega, r), a, b, rounding_of_core in rows
    )


def papers_equations(head: Head, blade: Blade, core: References, elements: int = ELEMENTS) -> Rows:
    """Rows of the paper's equations, at the highest speed only: a difference at lower speeds also appears there.

    Where core is not stable with the paper's elements, which have no geometric stiffness, there are half as many again;
    where it is not stable with these either, elements are corotational.
    """
    if not core:
        return [], []
    omega, reference = max(core, key=lambda pair: pair[0])
    meshes: list[tuple[int, Measure]] = [
        (elements, "body_fixed"),
        (3 * elements // 2, "body_fixed"),
        (elements, "corotational"),
    ]
    for number, stiffness in meshes:
        run = (omega, number, reference.core.count)
        (core_answer,) = of_blades(core_solver.answers(blade, [run], "half_end", stiffness))
        if not isinstance(core_answer, Failure):
            break
    (literal,) = of_blades([paper.answer(blade, run, stiffness)])
    return same_discretisation_cells(head, omega, reference, literal, core_answer)


def refinements(ask: Ask, refining: Refining, core: References) -> list[tuple[float, Reference, Refinements]]:
    """Refinements of a solver at each of core's speeds, which are to converge for the modes that core has there."""
    compared = {omega: r.core for omega, r in core}
    count = max(r.core.count for _, r in core)
    solved = solve(ask, list(compared), refining, count, lambda omega, _: compared[omega])
    return [(omega, r, s) for (omega, r), s in zip(core, solved, strict=True)]
