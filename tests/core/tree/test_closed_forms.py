"""Core against rotating mechanisms whose eigenvalues have a closed form: critical speeds, linkages, a spinning ring."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ...support.closed_forms import linkages
from ...support.closed_forms.forms import FORMS, ClosedForm, differences, oscillating

TURNTABLE = next(form for form in FORMS if form.name == "turntable")
RING = next(form for form in FORMS if form.name == "ring")


@pytest.mark.parametrize("form", FORMS, ids=lambda form: form.name)
def test_core_has_the_eigenvalues_of_the_closed_form(form: ClosedForm) -> None:
    exact = np.array([form.exact(omega) for omega in form.speeds.tolist()])
    relative = np.array([differences(form, omega) for omega in form.speeds.tolist()])
    assert np.isfinite(exact).any(axis=0).all()
    np.testing.assert_array_equal(np.isfinite(relative), np.isfinite(exact))
    assert np.nanmax(relative) < form.target


def test_the_turntable_is_unstable_between_its_critical_speeds_only() -> None:
    """The natural frequencies at rest are √(50/2) = 5 and √(98/2) = 7 rad/s."""
    for omega, stable in ((4.99, True), (5.01, False), (6.99, False), (7.01, True)):
        slower, faster = TURNTABLE.exact(omega)
        assert (slower.real == 0) == stable
        assert faster.real == 0
        assert (max(v.real for v in TURNTABLE.solve(omega)) < 1e-9) == stable


def test_a_closed_form_without_the_coriolis_force_differs() -> None:
    """Without 4 Ω² ω² the turntable's roots are √(k/m − Ω²)."""
    without = replace(TURNTABLE, exact=lambda omega: 1j * np.sqrt(np.array([25.0, 49.0]) - omega**2))
    assert differences(without, 3.0).max() > 0.1


@pytest.mark.slow
def test_the_difference_of_the_ring_is_discretisation_error() -> None:
    """It is of fourth order: twice the elements divide it by 16, here by ten at least."""
    coarse, fine = (
        differences(replace(RING, solve=lambda omega, n=n: oscillating(linkages.ring(omega, n))), 1.0).max()
        for n in (10, 20)
    )
    assert coarse / fine > 10


def test_the_documentation_has_a_section_for_each_closed_form() -> None:
    page = (Path(__file__).parents[3] / "docs" / "closed-forms.md").read_text(encoding="utf-8")
    assert re.findall("^## (.*)$", page, re.M) == [form.title for form in FORMS]
    targets = [float(row) for row in re.findall(r"\| (\S+) \|$", page, re.M)]
    assert targets == [form.target for form in FORMS]
