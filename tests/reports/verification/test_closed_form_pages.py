"""Core against the closed forms that the documentation shows: what it shows is held, and a wrong core would be seen."""

from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.lines import Line2D

from southwell.cases.closed_forms import linkages
from southwell.cases.closed_forms.closed_forms import FORMS, ClosedForm, differences, oscillating
from southwell.cases.judge.results import Run
from southwell.cases.verify.pool import Serial
from southwell.reports.cli import verify
from southwell.reports.shared.style import INK
from southwell.reports.verification import closed_forms_figure, closed_forms_page
from southwell.reports.verification import report as matrix_report

from ..cli.test_cli import southwell

Found = tuple[ClosedForm, np.ndarray, np.ndarray]


@pytest.fixture(scope="module", params=FORMS, ids=lambda form: form.name)
def found(request: pytest.FixtureRequest) -> Found:
    form = replace(request.param, speeds=request.param.speeds[:: 5 if len(request.param.speeds) > 9 else 3])
    return form, *closed_forms_figure.solved(form)


def test_core_keeps_to_the_closed_form(found: Found) -> None:
    form, values, off = found
    assert np.nanmax(off) < form.target
    exact = np.array([form.exact(omega) for omega in form.speeds.tolist()])
    known = np.isfinite(exact)
    assert (np.isfinite(off) == known).all()
    assert known.any(axis=0).all()
    np.testing.assert_allclose(values[known], exact[known], atol=form.target * np.abs(exact[known]).max())


def test_the_figure_has_the_points_and_the_line(found: Found) -> None:
    form, values, off = found
    above, below = closed_forms_figure.figure(form, values, off).axes
    markers = [line for line in above.lines if line.get_linestyle() == "None"]
    assert len(markers) == len(form.branches)
    for k, line in enumerate(markers):
        there = np.isfinite(values[:, k])
        np.testing.assert_allclose(_xy(line)[0], form.speeds[there])
        np.testing.assert_allclose(_xy(line)[1], np.abs(values[there, k]), rtol=1e-6)
    assert [t.get_text() for t in above.texts][-len(form.branches) :] == list(form.branches)
    (target,) = [line for line in below.lines if line.get_color() == INK]
    assert _xy(target)[1].tolist() == [form.target] * 2


def _xy(line: Line2D) -> tuple[np.ndarray, np.ndarray]:
    return np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)


def test_the_turntable_grows_between_its_critical_speeds_only() -> None:
    table = FORMS[0]
    assert table.critical == pytest.approx((5.0, 7.0))
    for omega, stable in ((4.99, True), (5.01, False), (6.99, False), (7.01, True)):
        slower, faster = table.exact(omega)
        assert (slower.real == 0) == stable
        assert faster.real == 0
        assert max(v.real for v in table.solve(omega)) < 1e-9 or not stable


def test_a_solver_without_the_coriolis_force_would_be_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """The table's exact roots without 4 Ω² ω²: √(k/m − Ω²) each, far from what core gives."""
    table = FORMS[0]
    without = replace(table, exact=lambda omega: 1j * np.sqrt(np.array([25.0, 49.0]) - omega**2))
    assert differences(table, 3.0)[1].max() < 1e-12
    assert differences(without, 3.0)[1].max() > 0.1


@pytest.mark.slow
def test_the_rings_difference_is_discretisation() -> None:
    """Of fourth order: twice the elements, a difference 16 times as small (at least ten)."""
    ring = FORMS[-1]
    finer = [replace(ring, solve=lambda omega, n=n: oscillating(linkages.ring(omega, n))) for n in (10, 20)]
    coarse, fine = (differences(form, 1.0)[1].max() for form in finer)
    assert coarse / fine > 10


def test_the_page_has_every_figure_and_the_same_bytes_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    few = tuple(replace(form, speeds=form.speeds[::12]) for form in FORMS[:3])
    monkeypatch.setattr(closed_forms_page, "FORMS", few)
    made = closed_forms_page.pages()
    assert made == closed_forms_page.pages()
    text = made["closed-forms.md"]
    assert set(made) == {"closed-forms.md", *(f"closed-forms/{form.name}.svg" for form in few)}
    assert all(f"]({name})" in text for name in made if name.endswith(".svg"))
    assert all(form.formula in text for form in few)


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> tuple[ClosedForm, ...]:
    chosen = tuple(replace(form, speeds=form.speeds[::12]) for form in FORMS if form.name in ("turntable", "four-bar"))
    monkeypatch.setattr(closed_forms_page, "FORMS", chosen)
    return chosen


def test_the_command_writes_what_the_report_takes_up(
    few: tuple[ClosedForm, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert not closed_forms_page.beside(tmp_path)
    status, shown, _ = southwell(f"closed-forms --out {tmp_path}", capsys)
    assert status == 0
    assert shown.count("✔ pass") == len(few)
    report = matrix_report.write(Run(()), tmp_path).read_text(encoding="utf-8")
    assert "\n## Closed forms\n" in report
    assert "$$" not in report
    for form in few:
        assert f"\n### {form.title}\n" in report
        assert f"](closed-forms/{form.name}.svg)" in report
        assert (tmp_path / "closed-forms" / f"{form.name}.svg").exists()


def test_a_core_that_misses_a_closed_form_ends_with_status_1(
    few: tuple[ClosedForm, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    wrong = replace(few[0], exact=lambda omega: (1 + 1e-6) * few[0].exact(omega))
    monkeypatch.setattr(closed_forms_page, "FORMS", (wrong, few[1]))
    status, shown, _ = southwell(f"closed-forms --out {tmp_path}", capsys)
    assert status == 1
    assert "1.0e-06 | 1e-09 | ✘ fail" in shown


@pytest.mark.slow
@pytest.mark.parametrize(("error", "expected"), [(0.0, 0), (1e-6, 1)])
def test_verify_compares_closed_forms_too(
    few: tuple[ClosedForm, ...],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    error: float,
    expected: int,
) -> None:
    first = replace(few[0], exact=lambda omega: (1 + error) * few[0].exact(omega))
    monkeypatch.setattr(closed_forms_page, "FORMS", (first, few[1]))
    monkeypatch.setattr(verify, "executor", lambda *_: nullcontext(Serial()))
    run = "verify hodges-rutkowski --codes exact-beam --faults none --workers 1 --closed-forms"
    status, shown, _ = southwell(f"{run} --out {tmp_path}", capsys)
    assert status == expected
    assert shown.count("1e-09 | ✘ fail") == expected
    report = (tmp_path / "report.md").read_text(encoding="utf-8")
    assert "\n## Closed forms\n" in report
    assert "Command: `southwell verify hodges-rutkowski --codes exact-beam --closed-forms`" in report


def test_a_folder_that_is_a_file_is_refused(
    few: tuple[ClosedForm, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    status, _, err = southwell(f"closed-forms --out {tmp_path / 'file'}", capsys)
    assert (status, err.count("\n")) == (2, 1)
    assert "file: cannot be written" in err
