"""What an adapter must pass before its answers are worth comparing: for those who write one, and for every one of ours.

In a third party's own tests, with pytest::

    @pytest.mark.parametrize("check", CHECKS, ids=str)
    def test_conforms(check):
        outcome = judge(CODE, check)
        if outcome.verdict == "not applicable":
            pytest.skip(outcome.reason)
        assert outcome.verdict == "pass", outcome.reason

On the command line: ``southwell conform NAME``. Every check either holds the code to a closed form, a printed number or a
symmetry (``conformance_checks``), or, for what a code may drop without a word, asks whether its answer is nearer to
core's with it than without.
"""

from dataclasses import dataclass
from functools import partial
from typing import Literal

from ...references.protocol.interface import Code
from . import checks as checks
from .blades import PROPERTIES
from .checks import Ask, BrokenError, NotForItError


@dataclass(frozen=True)
class Check:
    """One law.

    Attributes:
        name: a few words.
        law: what must be true.
        ask: raises ``BrokenError`` or ``NotForItError``, or returns if the code keeps the law.
        runs: whether it needs the code installed.
    """

    name: str
    law: str
    ask: Ask
    runs: bool = True

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True)
class Outcome:
    """What came of a check; a reason for all but ``pass``."""

    check: Check
    verdict: Literal["pass", "fail", "not applicable", "not run"]
    reason: str = ""


def judge(code: Code, check: Check) -> Outcome:
    """Ask one thing of a code. Whatever it raises, unless it declines the blade with a reason, is a failure."""
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
        "name, title, shares, effects, levels, order, digits, and a version or a hint",
        checks.declares,
        runs=False,
    ),
    Check("refusals", "what unsupported declines, in one line, solve refuses too", checks.refuses),
    Check("cantilever at rest", "Euler and Bernoulli's frequencies, in pairs", checks.at_rest),
    Check("turning beam", "Wright's printed flapwise number along z; along y less by Ω²", checks.turning),
    Check("counts", "as many modes as asked for or fewer, ascending, the same whatever the number", checks.counts),
    Check("repeats itself", "the same call, the same answer", checks.repeats),
    Check("shapes", "stations and columns, the root at rest, the first shape in closed form", checks.shapes),
    Check("order", "refinement converges as fast as declared", checks.order),
    Check("units", "no constant in it belongs to one system of units, to the digits it declares", checks.units),
    Check("quarter pitch", "swaps the planes", checks.quarter_pitch),
    Check("pitch's sense", "from y towards z", checks.pitch_sense),
    Check("twist's sense", "twisted throughout is pitched", checks.twist_sense),
    Check("torsion", "a soft shaft's first frequency, in the fourth column", checks.torsion),
    Check("tip mass at rest", "weighs: closed form", checks.tip_mass_weighs),
    Check("tip mass turning", "pulls: Bir's printed number", checks.tip_mass_pulls),
    Check("coupled planes", "refused, or the frequencies of the principal planes", checks.coupled_planes),
    Check("kink", "a corner of the curve: refused, or the closed form of two beams at right angles", checks.corner),
    Check("hinged root", "refused, or a straight line at Ω", checks.hinged_root),
    Check("shear", "refused, or Timoshenko's frequency in closed form", checks.shear),
    Check("effects", "effects declared are kept, and no others", checks.effects),
    *(Check(f"keeps {p.name}", "refused, or not dropped", partial(checks.keeps, p)) for p in PROPERTIES),
)
"""Every check, in the order in which failures are best read."""
