"""Points of a test rig or of another program over the lines of ``southwell campbell``."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from southwell.cases.plan import user_results
from southwell.cases.plan.user_results import Defaults, UserResults
from southwell.reports.campbell import points
from southwell.reports.shared.units import RPM


def read(tmp_path: Path, name: str, text: str) -> UserResults:
    path = tmp_path / f"{name}.csv"
    path.write_text(text)
    return user_results.read(name, path, Defaults(data=0.01))


@pytest.fixture
def files(tmp_path: Path) -> list[UserResults]:
    rows = "0, 1.5, flapwise 1, mine\n10, 2.0, flapwise 1, mine\n30, 4.0, flapwise 1, mine\n0, 9.0, flapwise 1, other\n"
    return [
        read(tmp_path, name, f"speed [rpm], {kind} [Hz], mode, blade\n{rows}")
        for name, kind in (("rig", "measured"), ("code", "frequency"))
    ]


def test_measured_points_have_bars_and_both_have_a_legend(files: list[UserResults]) -> None:
    axes = Figure().add_subplot()
    points.draw(axes, files, "mine", RPM)
    rig, code = axes.containers
    line, _, (bars,) = rig.lines  # type: ignore[union-attr]
    assert [float(x) for x in line.get_xdata()] == pytest.approx([0.0, 10.0, 30.0])
    assert [float(y) for y in line.get_ydata()] == pytest.approx([1.5, 2.0, 4.0])
    assert [float(y) for _, y in bars.get_segments()[1]] == pytest.approx(
        [1.96, 2.04]
    )  # two standard uncertainties of 1 %
    assert rig.has_yerr  # type: ignore[union-attr]
    assert not code.has_yerr  # type: ignore[union-attr]
    assert [h.get_label() for h in points.legend(files, "mine")] == ["rig, measured, ± 2 u_D", "code"]
    assert not points.legend(files, "absent")


def test_points_outside_the_diagram_are_counted(files: list[UserResults]) -> None:
    request = SimpleNamespace(speeds=(0.0, 20 * np.pi / 30))
    diagram: Any = SimpleNamespace(blade=SimpleNamespace(name="mine"), request=request)
    assert points.outside(files, diagram, top=100.0) == "2 of 6 added points outside"
    assert points.outside(files, diagram, top=1.9 * 2 * np.pi) == "4 of 6 added points outside"
    assert points.outside([], diagram, top=1.0) == ""
