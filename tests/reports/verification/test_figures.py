"""Figures: the same bytes for the same numbers, lines through core's values, labels that do not lie on each other."""

import re
from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text
from numpy.typing import NDArray

from southwell.cases.judge.results import Level, Run
from southwell.reports.shared.style import COLOURS, INK, MARKERS, looks, save, spread
from southwell.reports.shared.units import GAMMA, RAD_S, RPM, Units
from southwell.reports.verification.convergence import convergence, ticks
from southwell.reports.verification.figures import campbell, differences

from ...support import samples


def drawn(figure: Figure | None) -> Figure:
    assert figure
    return figure


def points(line: Line2D) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """x and y of a line's points."""
    return np.asarray(line.get_xdata(), dtype=float), np.asarray(line.get_ydata(), dtype=float)


def all_figures(run: Run) -> list[Figure]:
    return [drawn(draw(run, "beam", RAD_S)) for draw in (campbell, differences, convergence)]


@pytest.mark.slow
def test_the_same_run_gives_the_same_bytes_without_a_date(tmp_path: Path) -> None:
    for k in range(2):
        for j, figure in enumerate(all_figures(samples.run())):
            save(figure, tmp_path / f"{k}-{j}.svg")
    for j in range(3):
        text = (tmp_path / f"0-{j}.svg").read_bytes()
        assert text == (tmp_path / f"1-{j}.svg").read_bytes()
        assert not re.search(rb"<dc:date|20\d\d-\d\d-\d\d", text)


def test_a_users_own_settings_of_matplotlib_change_nothing(tmp_path: Path) -> None:
    save(drawn(campbell(samples.run(), "beam", RAD_S)), tmp_path / "a.svg")
    with mpl.rc_context({"font.size": 30, "lines.linewidth": 9, "axes.facecolor": "black", "svg.hashsalt": "other"}):
        save(drawn(campbell(samples.run(), "beam", RAD_S)), tmp_path / "b.svg")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


@pytest.mark.parametrize("units", [RAD_S, RPM, GAMMA])
def test_campbell_lines_run_through_cores_values_and_markers_are_the_codes(units: Units) -> None:
    axes = drawn(campbell(samples.run(), "beam", units)).axes[0]
    lines = [line for line in axes.lines if line.get_color() == INK and len(points(line)[0]) > 2]
    assert len(lines) == len(samples.BEAM)
    for (_, rest, coefficient), line in zip(samples.BEAM, lines, strict=True):
        x, y = points(line)
        exact = [samples.frequency(rest, coefficient, v / units.speeds) * units.frequencies for v in x]
        np.testing.assert_allclose(
            y, exact, rtol=1e-9
        )  # Southwell's form is straight in the squares: exact between, too
    marks = {line.get_label(): line for line in axes.lines if line.get_linestyle() == "None"}
    assert set(marks) == set(samples.CODES)
    for code, line in marks.items():
        own = [c for c in samples.run().cells if c.code == code and c.case == "beam"]
        x, y = points(line)
        np.testing.assert_allclose(y, [(c.value or 0.0) * units.frequencies for c in own])
        np.testing.assert_allclose(x, [c.omega * units.speeds for c in own])


def test_rays_are_multiples_of_the_rotors_speed() -> None:
    figure = drawn(campbell(samples.run(), "beam", RPM))
    axes = figure.axes[0]
    named = sorted(int(t.get_text()[:-1]) for t in axes.texts if t.get_text().endswith("P"))
    rays = [points(line) for line in axes.lines if len(points(line)[0]) == 2 and points(line)[0][0] == 0]
    slopes = sorted(float(y[1] / x[1]) for x, y in rays)
    np.testing.assert_allclose(slopes, np.array(named) / 60.0)  # n per revolution: n rpm / 60 in Hz
    assert named[0] == 1


def test_convergence_shows_the_order_and_the_errors_of_the_rows() -> None:
    figure = drawn(convergence(samples.run(), "beam", RAD_S))
    assert [axes.get_title(loc="left") for axes in figure.axes if axes.get_visible()] == [
        "edgewise 1",
        "flapwise 1",
        "edgewise 2",
        "flapwise 2",
    ]
    panel = figure.axes[0]
    assert sorted(t.get_text() for t in panel.texts) == ["2.0", "2.0", "4.0"]
    slopes = []
    for line in panel.lines[1:]:
        n, error = points(line)
        slopes.append(-np.polyfit(np.log(n), np.log(error), 1)[0])
    np.testing.assert_allclose(sorted(slopes), [2.0, 2.0, 4.0], rtol=0.01)


@pytest.mark.parametrize(
    ("least", "most", "expected"),
    [
        (12, 60, [20, 30, 40, 50, 60]),
        (20, 160, [20, 50, 100]),
        (2, 160, [3, 10, 30, 100]),
        (5, 5, [5]),
    ],
)
def test_the_axis_of_elements_has_three_labels_or_more(least: int, most: int, expected: list[int]) -> None:
    assert ticks(least, most) == expected


def test_convergence_puts_a_code_with_fewer_effects_into_the_panel_of_the_modes_name() -> None:
    pairs = ((1, "edgewise", 5.0), (2, "axial", 9.0))
    cells = [samples.cell(mode=k, family=f, full=w, reference=w, code="all") for k, f, w in pairs]
    cells += [
        samples.cell(mode=k, family=f, full=9.0, reference=4.0, code="less") for k, f in ((1, "axial"), (2, "edgewise"))
    ]
    levels = [
        Level("beam", 10.0, c.mode, c.code, n, (c.reference or 0) * (1 + c.mode / n)) for c in cells for n in (10, 20)
    ]
    figure = drawn(convergence(Run(tuple(cells), tuple(levels)), "beam", RAD_S))
    first = figure.axes[0]
    assert first.get_title(loc="left") == "edgewise 1"
    np.testing.assert_allclose([points(line)[1][0] for line in first.lines[1:]], [0.1, 0.2])


def test_differences_draw_every_number_and_each_rows_target() -> None:
    axes = drawn(differences(samples.run(), "beam", RAD_S)).axes[0]
    count = sum(len(points(line)[0]) for line in axes.lines)
    assert count == sum(c.case == "beam" and c.difference is not None for c in samples.run().cells)
    assert "target 0.10 %" in {t.get_text() for t in axes.texts}
    assert [t.get_text() for t in axes.get_yticklabels()] == list(samples.CODES)
    assert {t.get_text() for t in axes.get_xticklabels(which="both")} >= {"10⁻⁴", "10⁻³"}
    assert not any("$" in t.get_text() for t in axes.get_xticklabels(which="both"))  # a formula is drawn slowly


@pytest.mark.parametrize("draw", [campbell, differences, convergence])
def test_nothing_to_draw_is_no_figure(draw: Callable[[Run, str, Units], Figure | None]) -> None:
    assert draw(Run((samples.empty("not run", "not installed"),)), "beam", RAD_S) is None
    assert draw(samples.run(), "no such case", RAD_S) is None


def labels(axes: Axes) -> list[Text]:
    """The texts that are drawn: annotations, the title, the numbers within an axis' limits."""
    ticks = []
    for axis in (axes.xaxis, axes.yaxis):
        low, high = sorted(axis.get_view_interval())
        ticks += [t.label1 for t in axis.get_major_ticks() if low <= t.get_loc() <= high and t.label1.get_visible()]
    return [t for t in (*axes.texts, axes.title, axes._left_title, *ticks) if t.get_text().strip()]  # type: ignore[attr-defined]


def test_labels_do_not_lie_on_each_other() -> None:
    for figure in all_figures(samples.run()):
        figure.draw_without_rendering()
        texts = [t for axes in figure.axes if axes.get_visible() for t in labels(axes)]
        assert len(texts) > 8
        boxes = [(t.get_text(), t.get_window_extent().padded(-1.5)) for t in texts]
        assert not [(a, b) for k, (a, p) in enumerate(boxes) for b, q in boxes[:k] if p.overlaps(q)]


def test_labels_are_not_cut_off() -> None:
    long = Run((samples.cell(code="paper's equations, literally", difference=1e-13, target=1e-8),))
    for figure in [*all_figures(samples.run()), drawn(differences(long, "beam", RAD_S))]:
        figure.draw_without_rendering()
        canvas = figure.bbox.padded(1.0)
        texts = [t for t in [*figure.texts, *(t for axes in figure.axes for t in labels(axes))] if t.get_text().strip()]
        boxes = [(t.get_text(), t.get_window_extent()) for t in texts]
        outside = [text for text, box in boxes if not (canvas.containsx(box.x0) and canvas.containsx(box.x1))]
        assert outside == []


def test_a_wide_target_is_told_clear_of_the_next_heading() -> None:
    """A table held to 2 % only, whose target lies at the right edge; a tiny one is not told in percent."""
    table = samples.cell(role="table", code="table", difference=0.014, target=0.02, value=11.86)
    wide = Run((table, samples.cell(code="twin", difference=1e-13, target=1e-8)))
    for run, phrase in ((wide, "target 2.00 %"), (Run((samples.cell(target=1e-8, difference=1e-13),)), "target 1e-08")):
        figure = drawn(differences(run, "beam", RAD_S))
        figure.draw_without_rendering()
        extents = {t.get_text(): t.get_window_extent() for t in labels(figure.axes[0])}
        assert extents[phrase].x1 + 10 < extents["largest"].x0


@given(st.lists(st.floats(-100, 100), max_size=8), st.floats(0.1, 30))
def test_spread_keeps_order_and_distance_and_moves_no_more_than_it_must(targets: list[float], gap: float) -> None:
    positions = spread(targets, gap)
    order = np.argsort(targets, kind="stable")
    placed = np.array(positions)[order] if positions else np.zeros(0)
    assert (np.diff(placed) >= gap * (1 - 1e-9)).all()
    if len(targets) < 2 or np.diff(np.sort(targets)).min() >= gap:
        assert positions == targets
    assert sum(positions) == pytest.approx(sum(targets), abs=1e-6)


def test_every_code_has_a_look_of_its_own() -> None:
    many = looks([f"code {k}" for k in range(20)])
    assert len({(look.colour, look.marker) for look in many.values()}) == 20
    assert len(set(COLOURS)) == len(COLOURS)
    assert len(set(MARKERS)) == len(MARKERS)
