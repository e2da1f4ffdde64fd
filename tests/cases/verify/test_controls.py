"""Negative controls: each mistake is the one it is said to be, and is caught; a harness that is blind says so."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.judge import results
from southwell.cases.judge.results import Control, Run
from southwell.cases.verify import controls, matrix, mistakes
from southwell.core.blade import Blade
from southwell.core.effects import FULL
from southwell.core.modes import Modes
from southwell.references.theories import exact_beam
from southwell.reports.shared import summary
from southwell.reports.shared.units import RAD_S
from southwell.reports.verification import controls as told

from ...support.straight_blades import Y, Z, family, park

OMEGA = 10.0
AT_REST = 10.54925  # Euler–Bernoulli: 1.875104² √(EI / (ρ A L⁴))


def first(modes: Modes, column: int = Y) -> float:
    return float(family(modes, column)[0])


def made(solve: mistakes.Solve, omega: float = OMEGA, blade: Blade | None = None) -> Modes:
    return solve(blade or park(), omega, 15, 10, FULL)


def exact(blade: Blade, omega: float = OMEGA) -> Modes:
    return exact_beam.CODE.solve(blade, omega, 24, 10)


def test_without_geometric_stiffness_the_rotation_only_softens() -> None:
    """In the plane of rotation ω² = ω₀² − Ω²: 3.36 instead of 11.71; out of it ω₀ stays."""
    wrong = made(mistakes.no_geometric_stiffness)
    assert first(wrong) == pytest.approx(np.sqrt(AT_REST**2 - OMEGA**2), rel=1e-3)
    assert first(wrong, Z) == pytest.approx(AT_REST, rel=1e-3)


def test_softening_reversed_adds_twice_the_square_of_the_speed() -> None:
    """ω² = ω_flap² + Ω² in the plane of rotation, but for stretch and Coriolis; out of it nothing changes."""
    wrong, right = made(mistakes.softening_reversed), exact(park())
    assert first(wrong) == pytest.approx(np.sqrt(first(right, Z) ** 2 + OMEGA**2), rel=3e-4)
    assert first(wrong, Z) == pytest.approx(first(right, Z), rel=5e-5)


def test_a_frozen_frame_reads_chordwise_as_flapwise() -> None:
    wrong, right = made(mistakes.frozen_frame), exact(park())
    assert wrong.frequencies[:2] == pytest.approx([first(right, Z)] * 2, rel=5e-5)
    assert wrong.frequencies[0] / first(right) - 1.0 == pytest.approx(0.315, abs=1e-3)


def test_softening_is_that_of_points() -> None:
    """For lumped masses −Ω² m along x and y, nothing along z, nothing between nodes."""
    from southwell.core.chain import pencil
    from southwell.core.element.discretize import discretize

    blade = park()
    body = discretize(blade, 4, "half_end")
    own = mistakes.spin_softening(body, pencil.rest(body), OMEGA)
    mass = np.diagonal(body.lumps, axis1=1, axis2=2)[1:, 0]
    expected = -(OMEGA**2) * mass[:, None] * [1.0, 1.0, 0.0]
    np.testing.assert_allclose(np.diagonal(own.diagonal, axis1=1, axis2=2)[:, :3], expected, rtol=1e-12, atol=1e-12)
    assert not own.upper.any()


def test_a_shifted_axis_without_couplings_is_a_stiffer_beam() -> None:
    """EI_z + EA e² with e a quarter of √(EI_z/EA): frequencies times √(1 + 1/16); flapwise as before."""
    wrong, right = made(mistakes.shifted_axis, 0.0), exact(park(), 0.0)
    stiff = max(wrong.frequencies[:2])
    assert stiff / right.frequencies[0] == pytest.approx(np.sqrt(1 + mistakes.OFFSET**2), rel=1e-4)
    assert min(wrong.frequencies[:2]) == pytest.approx(right.frequencies[0], rel=1e-4)


def test_a_whole_end_mass_is_half_an_elements_mass_too_much() -> None:
    blade = park()
    extra = 0.5 * blade.mass[0, 0, 0] * blade.length / 15
    heavier = replace(blade, tip_mass=np.diag([extra] * 3 + [0.0] * 3))
    ratio = first(made(mistakes.whole_end_mass)) / first(made(mistakes.lumped))
    assert ratio == pytest.approx(first(exact(heavier)) / first(exact(blade)), abs=2e-3)
    assert ratio < 0.95


def test_without_hub_radius_and_coriolis() -> None:
    blade = park()
    assert first(made(mistakes.no_hub)) == pytest.approx(first(exact(replace(blade, hub_radius=0.0))), rel=1e-6)
    without = made(mistakes.no_coriolis)
    assert 1e-4 < first(without) / first(exact(blade)) - 1.0 < 1.3e-4  # Yoo–Shin coupled and uncoupled: 0.012 %


@cache
def run(
    *codes: str, case: str = "park-cantilever", blade: str = "park-cantilever", speeds: tuple = (0.0, OMEGA)
) -> Run:
    read = library.load(case)
    (variant,) = (v for v in read.variants if v.name == blade)
    one = replace(read, variants=(replace(variant, speeds=np.array(speeds)),))
    with ThreadPoolExecutor(1) as executor:
        return matrix.run([one], codes or ["exact-beam"], executor)


def status(run: Run) -> dict[str, str]:
    return {o.mistake.name: o.status for o in controls.outcomes(run.controls)}


def test_the_papers_case_catches_all_but_coriolis() -> None:
    found = status(run())
    assert found.pop("no Coriolis") == "needs a case"
    assert set(found.values()) == {"caught"}
    assert len(found) == len(mistakes.MISTAKES) - 1
    assert summary.status(run()) == 0
    assert "changes no frequency of park-cantilever by more than 0.012 %, and none of the 3" in told.sentence(run())
    assert any("needs case yoo-shin-chordwise/delta-0" in row["outcome"] for row in told.overview(run()))


def test_the_slender_one_catches_coriolis() -> None:
    one = run(case="yoo-shin-chordwise", blade="yoo-shin-chordwise/delta-0", speeds=(0.0, 10.0))
    assert status(one)["no Coriolis"] == "caught"
    assert status(one)["no hub radius"] == "needs a case"  # it has none
    (row,) = (r for r in one.controls if (r.control, r.omega) == ("no Coriolis", 10.0))
    assert set(row.caught) >= {"exact-beam", "yoo_shin1998/coupled"}
    assert row.change is not None


def test_a_coarse_mode_is_found_among_the_converged() -> None:
    """Fifteen point masses are 2 % off in the second mode; still it is the one that half a mass too much is seen in."""
    one = run(case="tip-mass", blade="tip-mass", speeds=(12.0,))
    (row,) = (r for r in one.controls if r.control == "whole end mass")
    assert row.mode == "flapwise 2"
    assert set(row.caught) == {"exact-beam", "bir2010/analytical"}


def test_a_code_on_cores_own_discretisation_is_no_witness() -> None:
    one = run("pinocchio")
    if any(c.verdict == "not run" for c in one.cells):
        pytest.skip("pip install 'southwell[codes]'")
    caught = {code for row in one.controls for code in row.caught}
    assert caught == {"park2010/present", "park2010/ref-3"}  # the printed tables, at the one speed they have


def test_a_blind_judge_is_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    cells = run().cells
    case = library.load("park-cantilever")
    wrongs = controls.solve(replace(case.variants[0], speeds=np.array([0.0, OMEGA])), case.text.compare)
    monkeypatch.setattr(controls, "judge", lambda *_: ("pass", ""))
    rows = controls.judged("park-cantilever", wrongs, cells)
    blind = replace(run(), controls=tuple(rows))
    assert {o.status for o in controls.outcomes(rows)} == {"missed", "needs a case"}
    assert summary.status(blind) == 1
    assert "is not noticed: no geometric stiffness" in told.headline(blind)


def test_a_control_made_harmless_is_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever repairs a mistake by accident is told: it is not caught any more in the case it must be seen in."""
    harmless = tuple(replace(m, wrong=m.right) if m.name == "no hub radius" else m for m in mistakes.MISTAKES)
    monkeypatch.setattr(controls, "MISTAKES", harmless)
    case = library.load("park-cantilever")
    wrongs = controls.solve(replace(case.variants[0], speeds=np.array([0.0, OMEGA])), case.text.compare)
    found = replace(run(), controls=tuple(controls.judged("park-cantilever", wrongs, run().cells)))
    assert status(found)["no hub radius"] == "missed"
    assert {s for name, s in status(found).items() if name != "no hub radius"} == {"caught", "needs a case"}
    assert summary.status(found) == 1
    assert "is not noticed: no hub radius" in told.headline(found)


def test_a_blade_that_a_mistake_leaves_singular_has_no_modes_to_tell_of() -> None:
    """A free lag hinge on the rotor's axis is not held by anything: its frequency is nought, or not a number."""
    lagging = replace(park(), hub_radius=0.6, root=np.array([np.inf] * 5 + [0.0]))
    variant = replace(library.load("park-cantilever").variants[0], blade=lagging, speeds=np.array([OMEGA]))
    wrongs = controls.solve(variant, library.load("park-cantilever").text.compare)
    assert next(w for w in wrongs if w.mistake == "no Coriolis").modes
    assert len(wrongs) == len(mistakes.MISTAKES)


def row(**changes: object) -> Control:
    fields = {"control": "no hub radius", "case": "park-cantilever", "omega": 10.0, "mode": "chordwise 1"}
    numbers = {"right": 10.0, "wrong": 11.0, "caught": (), "missed": ("x",)}
    return Control(**{**fields, **numbers, **changes})  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({}, "missed"),
        ({"caught": ("y",)}, "caught"),
        ({"missed": ()}, "needs a code"),
        ({"wrong": 10.0}, "missed"),  # a control that does nothing tests nothing
        ({"case": "my-beam"}, "needs a case"),
        ({"wrong": None, "right": None, "mode": "", "missed": ()}, "needs a code"),
    ],
)
def test_what_becomes_of_a_mistake(changes: dict, expected: str) -> None:
    found = {o.mistake.name: o.status for o in controls.outcomes([row(**changes)])}
    assert found["no hub radius"] == expected
    assert summary.status(replace(run(), controls=(row(**changes),))) == (expected == "missed")


def test_without_rows_there_is_nothing_to_say() -> None:
    assert controls.outcomes([]) == []
    bare = replace(run(), controls=())
    assert (told.headline(bare), told.overview(bare), told.sentence(bare)) == ("", [], "")


def test_a_change_is_told_apart_from_none_and_from_no_answer() -> None:
    def said(**changes: object) -> str:
        found = told.overview(replace(run(), controls=(row(**changes),)))
        return next(r["largest change"] for r in found if r["core made wrong"] == "no hub radius")

    assert said() == "+10.00 %: park-cantilever, chordwise 1, 10 rad/s"
    assert said(wrong=10.0) == "none"
    assert said(wrong=None, right=None, mode="") == "no steady state is left"


def test_rows_survive_the_disk(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    results.append(path, run().cells, run().levels, run())
    assert results.read(path) == run()


def test_the_figure_has_a_line_a_mistake_and_says_what_nobody_notices() -> None:
    figure = told.mistakes(run(speeds=(0.0, 5.0, OMEGA)), "park-cantilever", RAD_S)
    assert figure is not None
    (axes,) = figure.axes
    hollow = [line for line in axes.lines if line.get_markerfacecolor() == "white"]
    assert len(hollow) == 2  # Coriolis, at both speeds above rest
    assert told.mistakes(run(speeds=(0.0,)), "park-cantilever", RAD_S) is None
