"""The interactive diagram: what a line says when pointed at, and shapes that move as the solver's."""

from pathlib import Path

import numpy as np
import pytest

import southwell
from southwell.reports.campbell import interactive
from southwell.reports.campbell.shapes import scaled
from southwell.reports.notebook.results import CampbellResult
from southwell.reports.shared.units import RPM

from ...support import browsers

pytest.importorskip("plotly")


@pytest.fixture(scope="module")
def result() -> CampbellResult:
    blade = southwell.read("park-cantilever")
    return southwell.campbell(blade, rpm="0:60:30", modes=2, operating=(30, 60), elements=10)


def test_a_point_tells_mode_frequency_uncertainty_and_confirming_codes(result: CampbellResult) -> None:
    figure = interactive.lines(result.diagram, RPM, {0: "exudyn-beam, scikit-fem"})
    first, second, *rays = figure.data
    text = first.text[-1]
    assert text.startswith(f"{result.diagram.labels[0]}<br>60 rpm: ")
    assert "relative<br>confirmed by: exudyn-beam, scikit-fem" in text
    assert "confirmed by: not verified" in second.text[0]
    np.testing.assert_allclose(first.y, result.to_frame().iloc[:, 0], rtol=1e-12)
    assert [ray.name for ray in rays] == [f"{n}P" for n in range(1, 7)]
    np.testing.assert_allclose(rays[1].y, 2 * rays[1].x / 60)


def test_a_plot_is_interactive_where_plotly_is_installed(result: CampbellResult) -> None:
    assert type(result.plot()).__name__ == "Figure"
    assert result.plot(interactive=False).get_xlabel() == "rotor speed, rpm"


def test_a_frame_is_the_mode_at_its_phase(result: CampbellResult) -> None:
    """After a quarter of the period the motion is the imaginary part with the opposite sign."""
    diagram, k = result.diagram, 1
    figure = interactive.shapes(diagram, k, RPM)
    _, motion = scaled(diagram, k, arm=diagram.blade.length / 10)
    quarter = figure.frames[interactive.PHASES // 4].data[0]
    size = interactive.AMPLITUDE * diagram.blade.length
    middle = np.stack([np.mean(getattr(quarter, axis), axis=1) for axis in "xyz"], axis=1)
    rest = np.outer(np.linspace(0.0, diagram.blade.length, 21), [1.0, 0.0, 0.0])
    np.testing.assert_allclose(middle, rest - size * motion[0, :, :3].imag, atol=2e-4)


@pytest.mark.slow
@browsers.needed
def test_the_page_is_drawn_without_a_network(result: CampbellResult, tmp_path: Path) -> None:
    path = interactive.write(result.diagram, tmp_path, RPM, 1)
    with browsers.browser() as running:
        page, fetched = browsers.page(running), []
        page.on("request", lambda r: fetched.append(r.url) if r.url.startswith("http") else None)
        page.goto(path.as_uri())
        page.wait_for_selector(".scatterlayer .trace")
        assert page.locator(".scatterlayer .trace").count() == 2 + 6
        assert fetched == []
