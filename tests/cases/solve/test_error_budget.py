"""Where differences come from: each share is what theory says it is, and what the paper's and other codes' numbers show."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import trapezoid

from southwell.cases.input import library
from southwell.cases.judge.results import BudgetEntry, Run
from southwell.cases.plan.blade import blades
from southwell.cases.solve import error_budget
from southwell.cases.store import results_file
from southwell.core.blade import uniform_blade
from southwell.core.effects import Effects
from southwell.core.element.discretize import Mass
from southwell.core.element.measures import Measure
from southwell.core.solve import mesh_modes
from southwell.references import published
from southwell.references.theories import exact_beam, yoo_shin
from southwell.reports.shared.units import RAD_S
from southwell.reports.verification import error_budget as reported

from ...support import matrix_runs
from ...support.straight_blades import Y, family, park

CASE = "park-cantilever"


@cache
def changes() -> dict[tuple[str, str], float | None]:
    case = library.load(CASE)
    return {(s.part, s.mode): s.change for s in error_budget.solve(case, case.variants[0])}


def share(part: str, mode: str) -> float:
    (change,) = (v for (p, m), v in changes().items() if p.startswith(part) and m == mode)
    assert change is not None
    return change


def edgewise(code: object, omega: float = 10.0) -> np.ndarray:
    return family(code.solve(park(), omega, 24, 10), Y)  # type: ignore[attr-defined]


def test_no_stretch_no_rotary_inertia_is_what_the_closed_forms_say() -> None:
    """Yoo and Shin's model lacks the steady stretch and rotary inertia; Euler–Bernoulli without stretch: 11.71325 rad/s."""
    exact, expected = edgewise(exact_beam.CODE), edgewise(yoo_shin.CODE)
    for k in range(3):
        both = share("no prestretch", f"edgewise {k + 1}") + share("no rotary", f"edgewise {k + 1}")
        assert both == pytest.approx(expected[k] / exact[k] - 1.0, abs=2e-6)
    assert share("no stretch", "edgewise 1") == pytest.approx(11.71325 / 11.71131 - 1.0, abs=2e-6)


def test_shear_and_rotary_inertia_at_rest_are_rayleighs_corrections() -> None:
    """Rayleigh, Theory of Sound (1877), §186, and Timoshenko (1921): to first order, with a cantilever's shape w, the relative
    change is −½ (I/A) ∫w₁²/∫w² by rotary inertia and −½ (EI/κGA) ∫w₃²/∫w₂² by shear; indices: derivatives.
    """
    case = library.load(CASE)
    at_rest = replace(case.variants[0], speeds=np.array([0.0]))
    rows = {(s.part, s.mode): s.change for s in error_budget.solve(case, at_rest)}
    x, gyration = np.linspace(0.0, 1.0, 4001), 2e-7 / 4e-4 / 6.0**2
    for k, beta in enumerate((1.875104069, 4.694091133, 7.854757438), 1):
        sigma = (np.cosh(beta) + np.cos(beta)) / (np.sinh(beta) + np.sin(beta))
        c, s, ch, sh = np.cos(beta * x), np.sin(beta * x), np.cosh(beta * x), np.sinh(beta * x)
        shapes = (
            ch - c - sigma * (sh - s),
            sh + s - sigma * (ch - c),
            ch + c - sigma * (sh + s),
            sh - s - sigma * (ch + c),
        )
        w, w1, w2, w3 = (beta ** (2 * n) * trapezoid(d**2, x) for n, d in enumerate(shapes))
        assert rows["no rotary inertia", f"flapwise {k}"] == pytest.approx(0.5 * gyration * w1 / w, rel=2e-2)
        shear = -0.5 * gyration * (2 * 1.3 / (5 / 6)) * w3 / w2
        assert rows["with shear (κ = 5/6, ν = 0.3)", f"flapwise {k}"] == pytest.approx(shear, rel=2e-2)


def test_lumping_and_its_frame_make_up_the_papers_error() -> None:
    """Point masses on beams linear in the parent's frame, 50 elements: 189.6735 rad/s, of 189.92222 without rotary inertia."""
    both = share("lumped mass", "edgewise 3") + share("parent's frame", "edgewise 3")
    assert both == pytest.approx(189.6735 / 189.92222 - 1.0, abs=5e-6)
    assert both == pytest.approx(share("both", "edgewise 3"), abs=2e-6)
    fractions = [share("lumped mass", f"edgewise {k}") / share("both", f"edgewise {k}") for k in (1, 2, 3)]
    np.testing.assert_allclose(fractions, [0.33, 0.70, 0.80], atol=0.005)  # as docs/theory.md says


@pytest.mark.parametrize("stiffness", ["body_fixed", "corotational"])
def test_the_error_of_lumped_mass_falls_with_the_square_of_the_elements(stiffness: Measure) -> None:
    """Exact: Exudyn's ANCF cable, converged; geometrically nonlinear, without rotary inertia."""
    blade, exact = library.load(CASE).variants[0].blade, np.array([11.71131, 70.43535, 189.92222])

    def errors(elements: int, mass: Mass, measure: Measure) -> np.ndarray:
        effects = Effects(rotary_inertia=False)
        solved = mesh_modes(blade, 10.0, elements, 9, mass=mass, stiffness=measure, effects=effects)
        return family(solved, Y)[:3] / exact - 1.0

    coarse, fine = (errors(n, "half_end", stiffness) for n in (50, 100))
    np.testing.assert_allclose(np.log2(coarse / fine)[1:], 2.0, atol=0.05)
    np.testing.assert_allclose(errors(200, "consistent", "corotational"), 0.0, atol=2e-6)


def test_coriolis_is_nothing_out_of_the_plane() -> None:
    assert abs(share("no Coriolis", "flapwise 1")) < 1e-7
    assert share("no Coriolis", "edgewise 1") == pytest.approx(1.2e-4, abs=1e-5)  # Yoo–Shin, coupled or not: 0.012 %


def test_effects_that_a_blade_lacks_are_not_switched_off() -> None:
    """Shear is switched on where a blade is rigid in it, off where it is not; stretch where there is any."""
    case = library.load(CASE)
    variant = replace(case.variants[0], speeds=np.array([0.0]))

    def parts(**kwargs: float) -> set[str]:
        section = {"EA": np.inf, "GJ": 1.0, "EI_y": 1.0, "EI_z": 1.0, "mass": 1.0} | kwargs
        blade = uniform_blade("a", 1.0, 0.0, **section)
        return {s.part for s in error_budget.solve(case, replace(variant, blade=blade)) if s.cause == "model form"}

    always = {"no prestretch", "no Coriolis", "no rotary inertia"}
    assert parts() == always
    assert parts(EA=5e3) == always | {"no stretch", "with shear (κ = 5/6, ν = 0.3)"}
    assert parts(EA=5e3, GA_y=2e3, GA_z=2e3) == always | {"no stretch", "no shear"}


def test_the_speed_is_the_highest_that_is_printed() -> None:
    """The tables' speeds may be in rpm, their frequencies in Hz; a case without a table has its highest."""
    wind, paper = library.load("windpact-1.5"), library.load("park-blade")
    bmodes = replace(wind.variants[-1], speeds=np.array([0.0, 2 * np.pi, 7.0]))
    assert {s.omega for s in error_budget.solve(wind, bmodes)} == {2 * np.pi}
    assert {s.omega for s in error_budget.solve(paper, paper.variants[0])} == {paper.variants[0].speeds[-1]}


@cache
def run() -> Run:
    case = library.load(CASE)
    single_speed = replace(case, variants=(replace(case.variants[0], speeds=np.array([10.0])),))
    with ThreadPoolExecutor(1) as executor:
        return matrix_runs.solve(blades(single_speed), ["yoo-shin", "exact-beam"], executor)


@pytest.mark.slow
def test_rounding_is_that_of_the_printed_digits() -> None:
    """Half a unit of the last digit of 11.71, and what core's own extrapolation leaves open."""
    datum = published.load("park2010").series[0].data[0]
    (bound,) = (s for s in run().error_budget if s.part == "printed digits" and s.mode == "edgewise 1")
    assert bound.bound
    assert bound.cause == "rounding"
    assert bound.change == pytest.approx(datum.half_unit / datum.value, rel=1e-2)


@pytest.mark.slow
def test_a_bound_is_the_largest_of_the_codes_that_were_refined() -> None:
    rows = [s for s in run().error_budget if not s.bound]
    assert "codes, refined" not in {s.part for s in run().error_budget}  # series bracket their own answers
    cells = [replace(c, order=4.0, uncertainty=1e-5 * (1 + k)) for k, c in enumerate(run().cells) if c.mode == 1]
    (bound,) = (s for s in error_budget.uncertain(CASE, rows, cells) if s.part == "codes, refined")
    assert (bound.change, bound.mode, bound.bound) == (
        max(c.uncertainty or 0.0 for c in cells if c.role == "code"),
        "edgewise 1",
        True,
    )
    assert error_budget.uncertain(CASE, (), run().cells) == []


@pytest.mark.slow
def test_the_budget_is_read_as_written_and_shown(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    results_file.write(path, run())
    assert results_file.read(path) == run()
    rows = reported.rows(run(), CASE)
    assert [row["cause"] for row in rows] == sorted(
        (row["cause"] for row in rows), key=["discretisation", "model form", "rounding"].index
    )
    assert {"edgewise 1", "flapwise 3"} <= set(rows[0])
    (inertia,) = (row for row in rows if row["what"] == "no rotary inertia")
    assert inertia["edgewise 3"].startswith("+0.054")
    assert reported.heading(run(), CASE, RAD_S) == "10 rad/s"
    bare = BudgetEntry(CASE, 10.0, "edgewise 9", "model form", "x", None)
    assert reported.rows(replace(run(), error_budget=(bare,)), CASE)[0]["edgewise 9"] == "no such mode"
