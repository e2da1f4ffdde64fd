"""Faults of extrapolation and uncertainty on the blade that is verified: detected by core's refined frequencies."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.cases.faults import own_uncertainty as own
from southwell.cases.input import library
from southwell.cases.judge import convergence
from southwell.cases.plan.blade import BladeSubject, blades


def subject(name: str, omega: float) -> BladeSubject:
    chosen, *_ = [b for b in blades(library.load(name.partition("/")[0])) if b.name == name]
    return BladeSubject(chosen.case, replace(chosen.variant, speeds=np.array([omega])))


def test_faults_are_detected_by_modes_outside_their_uncertainty() -> None:
    result = {c.control: c for c in own.run(subject("park-cantilever", 10.0))}
    assert list(result) == [fault.name for fault in own.FAULTS]
    assert not [c for c in result.values() if c.missed or c.without_effect or c.needs]
    off = result["extrapolation: limit off"]
    assert off.change == pytest.approx(0.002, abs=1e-5)
    assert off.detected_by[0] == "park-cantilever, mode 1 from 8, 16 and 32 elements, 10 rad/s: fail"


def test_a_wrong_limit_within_its_uncertainty_is_without_effect() -> None:
    result = own.run(subject("tip-mass-in-plane/coned", 8.0))[0]
    assert result.without_effect.startswith("moves frequencies by at most 0.00")
    assert result.without_effect.endswith(", within their uncertainty")


def test_a_blade_that_coarse_meshes_do_not_solve_is_reported() -> None:
    assert {c.needs for c in own.run(subject("rotating-cable", 20.0))} == {own.NO_MESH}


def test_an_uncertainty_that_is_wrong_already_detects_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """The faults are judged by the modes that the right program covers."""
    monkeypatch.setattr(convergence, "from_refinement", own._altered(own._off)(convergence.from_refinement))
    assert [c.missed for c in own.run(subject("park-cantilever", 10.0)) if c.control == "extrapolation: limit off"] == [
        True
    ]
