"""Conformance suite for adapters, those of this package and of third parties.

In a third party's own tests, with pytest::

    @pytest.mark.parametrize("check", CHECKS, ids=str)
    def test_conforms(check):
        outcome = judge(CODE, check)
        if outcome.verdict == "not applicable":
            pytest.skip(outcome.reason)
        assert outcome.verdict == "pass", outcome.reason

On the command line: ``southwell conform NAME``. A check compares the code with a closed form, a printed number or a
symmetry (``checks``), or, for a property that a code might silently drop, tests whether its answer is closer
to core's with the property than without (``dropped``).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal

from ...references.protocol.interface import Adapter
from . import checks, dropped
from . import mechanism_checks as mechanism
from .asking import BrokenError, NotForItError
from .blades import PROPERTIES


@dataclass(frozen=True)
class Check:
    """One conformance check.

    Attributes:
        name: short name.
        law: the requirement.
        ask: raises ``BrokenError`` or ``NotForItError``, or returns if the code meets the requirement.
        runs: whether it needs the code installed.
    """

    name: str
    law: str
    ask: Callable[[Any], None]
    runs: bool = True

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True)
class Outcome:
    """The result of a check, with a reason for all but ``pass``."""

    check: Check
    verdict: Literal["pass", "fail", "not applicable", "not run"]
    reason: str = ""


def judge(code: Adapter, check: Check) -> Outcome:
    """Run one check on a code. Any exception is a failure, unless the code declines the blade with a reason."""
    if check.runs and code.version() is None:
        return Outcome(check, "not run", f"not installed: {code.hint}")
    try:
        check.ask(code)
    except NotForItError as declined:
        return Outcome(check, "not applicable", str(declined))
    except BrokenError as broken:
        return Outcome(check, "fail", str(broken))
    except Exception as error:  # a foreign code may raise anything
        return Outcome(check, "fail", f"{type(error).__name__}: {' '.join(str(error).split())}")
    return Outcome(check, "pass")


CHECKS = (
    Check(
        "declarations",
        "name, title, independence, effects, levels, order, digits, and a version or a hint",
        checks.declares,
        runs=False,
    ),
    Check("refusals", "unsupported gives one line, and solve refuses the same blades", checks.refuses),
    Check("cantilever at rest", "Euler and Bernoulli's frequencies, in pairs", checks.at_rest),
    Check(
        "rotating beam",
        "Wright's printed flapwise frequency along z; along y, its square is smaller by Ω²",
        checks.turning,
    ),
    Check("counts", "at most the requested number of modes, ascending, independent of that number", checks.counts),
    Check("repeatable", "the same call gives the same answer", checks.repeats),
    Check("shapes", "stations and columns, the root at rest, the first shape in closed form", checks.shapes),
    Check("order", "refinement converges as fast as declared", checks.order),
    Check("units", "the answer does not depend on the system of units, to the declared digits", checks.units),
    Check("quarter pitch", "a pitch of 90° exchanges the planes", checks.quarter_pitch),
    Check("pitch's sense", "from y towards z", checks.pitch_sense),
    Check("twist's sense", "a constant twist equals a pitch", checks.twist_sense),
    Check("precone's sense", "shapes lean with the coned blade, from z towards −x", checks.precone_sense),
    Check(
        "Coriolis's sense",
        "in an edgewise mode, stretch a quarter period ahead of the motion along y, of the size of a closed form",
        checks.coriolis_sense,
    ),
    Check("torsion", "a soft shaft's first frequency, in the fourth column", checks.torsion),
    Check("tip mass at rest", "closed form", checks.tip_mass_weighs),
    Check("tip mass rotating", "its tension: Bir's printed frequency", checks.tip_mass_pulls),
    Check("tip mass's axes", "twist at the tip turns an offset tip mass as pitch does", checks.tip_mass_axes),
    Check("coupled planes", "refused, or the frequencies of the principal planes", checks.coupled_planes),
    Check("kink", "a corner of the curve: refused, or the closed form of two beams at right angles", checks.corner),
    Check("hinged root", "refused, or a straight line at Ω", checks.hinged_root),
    Check("shear", "refused, or Timoshenko's frequency in closed form", checks.shear),
    Check("effects", "exactly the declared effects are included", dropped.effects),
    *(Check(f"keeps {p.name}", "refused, or not dropped", partial(dropped.keeps, p)) for p in PROPERTIES),
)
"""All checks of a code for blades, in the order most useful for reading failures."""

FOR_MECHANISMS = (
    Check(
        "mechanism declarations",
        "name, title, independence, effects, and a version or a hint",
        mechanism.declares,
        runs=False,
    ),
    Check(
        "mechanism refusals",
        "unsupported_mechanism gives one line, and solve_mechanism refuses the same mechanisms",
        mechanism.refuses,
    ),
    Check("pendulum", "√(g/l), its steady state, and its coordinate by name", mechanism.hangs),
    Check("damped slide", "damping, preload and weight: closed form", mechanism.oscillates),
    Check("flap and lag hinge", "Johnson's frequencies of a rotating rod", mechanism.flaps),
    Check("gyroscope", "a spinning disc on two gimbals in closed form", mechanism.gyrates),
    Check("stretched spring", "the tension of a spring between two points adds lateral stiffness", mechanism.stretched),
    Check("branching tree", "two branches, with joints listed level by level", mechanism.branches),
    Check("parallelogram", "refused, or √(g/l) with three redundant equations", mechanism.closes),
    Check(
        "constraints' curvature",
        "refused, or the pendulum whose stiffness comes only from the reaction in a loop",
        mechanism.curves,
    ),
    Check(
        "joint from child to parent",
        "the coordinate changes sign, the eigenvalues do not change",
        mechanism.reversed_joint,
    ),
    Check("mechanism repeatable", "the same call gives the same answer", mechanism.repeats),
    Check("periodic equations", "refused", mechanism.periodic),
    Check("no steady state", "refused", mechanism.falls),
)
"""All checks of a code for mechanisms."""

EVERY = (*CHECKS, *FOR_MECHANISMS)
"""All checks; a worker receives their indices."""
