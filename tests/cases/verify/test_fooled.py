"""What once fooled the judge: each wrong answer ends in *fail* or *inconclusive*, or counts for nothing."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec import structs

from southwell.cases.faults import seeding
from southwell.cases.faults.table import BY_NAME
from southwell.cases.input import library
from southwell.cases.judge.reference import Reference
from southwell.cases.judge.results import Cell, Run
from southwell.cases.judge.same import rounding
from southwell.cases.judge.spectrum import of_blade, of_blades
from southwell.cases.judge.verdict import bracketed, discretised, judge
from southwell.cases.judge.witnesses import groups, witnesses
from southwell.cases.plan.blade import blades
from southwell.cases.solve import core_solver
from southwell.cases.solve.copies import copied
from southwell.cases.solve.reference import references
from southwell.core.effects import ALL_EFFECTS
from southwell.core.element.discretize import Mass
from southwell.core.element.measures import Measure
from southwell.core.modes import Modes
from southwell.core.solve import mesh_modes
from southwell.references import published
from southwell.references.protocol.process import Failure
from southwell.reports.shared import summary
from southwell.reports.verification import evidence, terminal
from southwell.reports.verification import report as matrix_report
from southwell.reports.verification.case_tables import comparison

from ...support import matrix_runs, samples

PARK = "park-cantilever"


FOOLING = (
    *("LOST", "EXTRA", "DAMPED", "WIDE", "WIDE_ONCE", "BRACKET", "GHOSTS"),
    *("WANDERING", "BACKWARDS", "ZERO", "DEAF", "CRUDE", "SCATTERS", "FRAGILE", "COPY"),
)


@cache
def run() -> Run:
    """All codes made to fool the judge, on one case at one speed."""
    case = library.load(PARK)
    single_speed = replace(case, variants=(replace(case.variants[0], speeds=np.array([10.0])),))
    with ThreadPoolExecutor(1) as executor:
        return matrix_runs.solve(
            blades(single_speed), [f"southwell.tests.support.fooling:{c}" for c in FOOLING], executor, parts=False
        )


def of(code: str) -> list[Cell]:
    return [c for c in run().cells if c.code == code]


def status(code: str) -> int:
    """The exit status of a run of this code alone."""
    return summary.status(Run(tuple(of(code))))


@pytest.mark.slow
def test_a_printed_number_is_not_excused_by_a_discretisation_that_leads_elsewhere() -> None:
    """Core without geometric stiffness at 10 rad/s: with 50 elements it gives the printed number as long as those are right;
    their refinements lead to 11.7 rad/s, and not to the 3.4 that is core's then."""
    fault = BY_NAME["no geometric stiffness"]
    original = core_solver.mesh_sweep

    def converged_only(*args, mass: Mass = "consistent", stiffness: Measure = "corotational", **kwargs) -> list[Modes]:
        with seeding.seeded(fault.seams if mass == "consistent" else ()):
            return list(original(*args, mass=mass, stiffness=stiffness, **kwargs))

    trial = seeding.Trial(PARK, (10.0,), ())
    with seeding.seeded(((core_solver, "mesh_sweep", lambda _: converged_only),)):
        failures = [c for c in seeding.cells(trial) if c.code == "park2010/present"]
    assert failures
    assert {c.verdict for c in failures} == {"fail"}
    assert max(abs(c.difference or 0.0) for c in failures) > 2.0
    expected = [c for c in seeding.cells(trial) if c.verdict == "known difference" and c.role == "table"]
    assert len(expected) == 1
    assert "its limit under refinement is" in expected[0].reason


@pytest.mark.slow
def test_a_column_lost_by_the_adapter_is_a_failure() -> None:
    result = {c.family: c for c in of("lost")}
    assert result["flapwise"].verdict == "fail"
    assert result["flapwise"].reason.startswith("no partner")
    assert result["edgewise"].verdict == "inconclusive"  # modes without a shape match no mode of core
    assert status("lost") == 1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("code", "reason"), [("extra", "do not match any mode of Southwell's own solver"), ("damped", "damping ratio 0.03")]
)
def test_a_spurious_or_damped_mode_makes_an_answer_inconclusive(code: str, reason: str) -> None:
    """Before, core's modes had partners among the others, and all of them passed."""
    cells = of(code)
    assert {c.verdict for c in cells} == {"inconclusive"}
    assert all(reason in c.reason for c in cells)
    assert status(code) == 1


@pytest.mark.slow
@pytest.mark.parametrize("code", ["wide", "wide-once"])
def test_a_large_declared_uncertainty_is_inconclusive(code: str) -> None:
    assert {c.verdict for c in of(code)} == {"inconclusive"}


@pytest.mark.slow
def test_a_wide_bracket_is_an_estimate_and_no_comparison() -> None:
    cells = of("bracket")
    assert {c.verdict for c in cells} == {"estimate"}
    assert not summary.compared(cells)
    assert status("bracket") == 1
    assert evidence.answer(Run(tuple(cells))).startswith("Open: nothing was compared.")


@pytest.mark.slow
def test_a_wide_target_is_coarse_and_no_evidence() -> None:
    """40 % away from core with a target of 50 % once was a pass, and counted as a group."""
    case = library.load(PARK)
    compare = structs.replace(case.text.compare, target=0.5)
    wide = replace(
        case,
        text=structs.replace(case.text, compare=compare),
        variants=(replace(case.variants[0], speeds=np.array([10.0])),),
    )
    with ThreadPoolExecutor(1) as executor:
        result = matrix_runs.solve(blades(wide), ["southwell.tests.support.fooling:FAR"], executor, parts=False)
    cells = [c for c in result.cells if c.code == "far"]
    assert {c.verdict for c in cells} == {"coarse"}
    assert all(abs(c.difference or 0.0) > 0.3 for c in cells)
    (witness,) = [w for w in witnesses(result, PARK) if w.name == "far"]
    assert witness.standing == "coarse"
    assert not groups([witness])
    assert not summary.compared(cells)


@pytest.mark.slow
def test_a_code_that_ignores_elements_is_inconclusive() -> None:
    """The same digits on three meshes 0.09 % off once were a pass with an uncertainty of 2e-9."""
    cells = of("deaf")
    assert {c.verdict for c in cells} == {"inconclusive"}
    assert all("identical: not refined" in c.reason for c in cells)


def test_an_order_that_is_not_the_declared_one_is_stated_with_a_pass() -> None:
    cells = [c for c in of("crude") if c.verdict == "pass"]
    assert cells
    assert all("observed order 1.0" in c.reason and "instead of 4" in c.reason for c in cells)


def test_scatter_under_refinement_is_stated_with_a_pass() -> None:
    cells = [c for c in of("scatters") if c.verdict == "pass"]
    assert cells
    assert all("refinements scatter by" in c.reason and "instead of converging with order 4" in c.reason for c in cells)


def test_a_crash_of_a_finer_refinement_is_stated_with_a_pass() -> None:
    cells = [c for c in of("fragile") if c.verdict == "pass"]
    assert cells
    assert all("finer: " in c.reason and "SIGABRT" in c.reason for c in cells)


def test_a_copy_of_core_is_recognised_by_its_digits() -> None:
    """With invented origins it once was an independent group."""
    result = run()
    cells = of("copy")
    assert {c.shares for c in cells} == {"discretisation"}
    assert all("its discretisation, not independent" in c.reason for c in cells)
    (witness,) = [w for w in witnesses(result, PARK) if w.name == "copy"]
    assert witness.kind == "Southwell's model"


def test_a_copy_is_recognised_although_one_speed_is_converged() -> None:
    """At that speed equal digits prove nothing; at the others they do. One other digit anywhere is no copy."""
    case = library.load(PARK)
    blade, speeds = case.variants[0].blade, [5.0, 10.0]
    core = [r for r in references(blade, speeds, case.text.compare, ())[ALL_EFFECTS] if isinstance(r, Reference)]
    copies = [
        of_blade(mesh_modes(blade, omega, n, r.core.count)) for omega, n, r in zip(speeds, (960, 8), core, strict=True)
    ]
    assert copied(blade, ALL_EFFECTS, list(zip(speeds, core, copies, strict=True))) is not None
    assert copied(blade, ALL_EFFECTS, list(zip(speeds[:1], core[:1], copies[:1], strict=True))) is None
    other = [copies[0], replace(copies[1], values=copies[1].values * (1.0 + 1e-8))]
    assert copied(blade, ALL_EFFECTS, list(zip(speeds, core, other, strict=True))) is None


def test_a_large_known_difference_is_no_comparison() -> None:
    """A code without geometric stiffness is 71 % off, and declares it."""
    cell = samples.cell(verdict="known difference", difference=-1e-5, value=3.4, reference=3.4, full=11.7)
    assert abs(summary.size(cell) or 0.0) > 0.7
    assert summary.status(Run((cell,))) == 1
    assert summary.status(Run((replace(cell, full=3.42),))) == 0


@pytest.mark.slow
def test_a_mode_that_the_code_has_twice_is_no_agreement() -> None:
    """One at the right frequency, and one of nearly the same shape 30 % above it: which is its answer?"""
    cells = of("ghosts")
    assert {c.verdict for c in cells if "ambiguous" in c.reason} == {"inconclusive"}
    assert sum("ambiguous" in c.reason for c in cells) >= 4
    assert status("ghosts") == 1


@pytest.mark.slow
@pytest.mark.parametrize("code", ["wandering", "backwards"])
def test_refinements_with_equal_or_fewer_elements_are_a_failure(code: str) -> None:
    """Else the same number of elements is a division by zero, and a falling one an order of convergence."""
    (cell,) = of(code)
    assert (cell.verdict, cell.mode) == ("fail", 0)
    assert cell.reason.startswith("elements: ")
    assert cell.reason.endswith("not refined")


@pytest.mark.slow
def test_a_frequency_of_zero_is_a_failure() -> None:
    assert of("zero")[0].verdict == "fail"


def test_a_wider_target_of_a_table_is_bounded_and_shown() -> None:
    text = (Path(published.__file__).parent / "openfast.toml").read_text(encoding="utf-8")
    with pytest.raises(published.TableError, match=r"<= 0\.02"):
        published.parse(text.replace("target = 0.02", "target = 0.03"), "x.toml")
    wide = samples.cell(role="table", code="author/one", difference=1.4e-2, value=11.86, target=2e-2, shares="nothing")
    page = Run((wide,))
    assert "1.40 % (target 2.00 %)" in matrix_report.heat(page)
    assert "(target 2.00 %)" in comparison([wide], summary.units(page, "beam"))
    (table,) = terminal.matrix(page, 100)
    assert "1.4 of 2" in str(list(table.columns[1].cells))


def test_rounding_of_a_blade_that_cannot_stretch_is_measured() -> None:
    """Precone bends a blade that is rigid along its axis: core then scatters by 1e-9 and more, which the uncertainty says."""
    blade = library.load("nrel-5mw").variants[0].blade
    rigid = blade.stiffness.copy()
    rigid[:, 0, 0] = np.inf
    coned = replace(blade, stiffness=rigid, precone=np.radians(-2.5))
    (own_answer,), *scaled = (
        of_blades(core_solver.answers(b, [(0.3, 40, 6)], "half_end", "body_fixed"))
        for b in (coned, *(core_solver.rescaled(coned, factor) for factor in (3.0, 7.0, 0.3, 11.0)))
    )
    first, second, *others = (answer for (answer,) in scaled)
    noise = rounding(own_answer, [first, second])
    for other in others:
        assert not isinstance(other, Failure)
        assert not isinstance(own_answer, Failure)
        assert (np.abs(other.frequencies / own_answer.frequencies - 1.0) <= noise).all()
    assert noise.max() < 1e-6
    assert len(rounding(own_answer, [Failure("refused", "")])) == 0


sizes = st.floats(0.0, 1.0)
RANK = {"pass": 0, "coarse": 1, "known difference": 1, "estimate": 2, "inconclusive": 2, "fail": 2}
"""As evidence: what neither agrees nor is explained is none."""
FULL_RANK = {"pass": 0, "coarse": 0, "inconclusive": 1, "fail": 2}


@settings(derandomize=True)
@given(d=sizes, u=sizes, more=sizes, target=st.floats(1e-9, 1.0))
def test_a_larger_difference_never_improves_a_verdict(d: float, u: float, more: float, target: float) -> None:
    assert FULL_RANK[judge(d + more, u, target)[0]] >= FULL_RANK[judge(d, u, target)[0]]
    assert judge(-d, u, target)[0] == judge(d, u, target)[0]


@settings(derandomize=True)
@given(d=st.floats(-0.9, 1.0), u=sizes, more=sizes, target=st.floats(1e-9, 0.5))
def test_a_larger_uncertainty_never_makes_evidence(d: float, u: float, more: float, target: float) -> None:
    for verdict in (judge, bracketed):
        assert RANK[verdict(d, u + more, target)[0]] >= RANK[verdict(d, u, target)[0]]
    assert judge(d, None, target)[0] == "inconclusive"


@settings(derandomize=True)
@given(d=sizes, u=sizes, more=sizes, rest=sizes, limit=st.none() | sizes, target=st.floats(1e-9, 1.0))
def test_larger_differences_never_excuse_a_given_discretisation(d, u, more, rest, limit, target) -> None:
    first = discretised(d, u, target, rest, limit, "x")[0]
    for d2, u2, rest2, limit2 in (
        (d + more, u, rest, limit),
        (d, u + more, rest, limit),
        (d, u, rest + more, limit),
        (d, u, rest, None if limit is None else limit + more),
    ):
        assert RANK[discretised(d2, u2, target, rest2, limit2, "x")[0]] >= RANK[first]
