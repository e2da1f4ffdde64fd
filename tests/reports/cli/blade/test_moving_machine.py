"""The interactive page of a turbine: what moves is the solver's motion."""

from pathlib import Path

import numpy as np
import pytest

from southwell.cases.campbell.machine import MachineDiagram, MachineRequest, machine_diagram
from southwell.core.rotor.multiblade import transformation
from southwell.reports.campbell import moving_machine
from southwell.reports.shared.units import RPM
from southwell.tests.support import browsers
from southwell.tests.support.turbines import small

pytest.importorskip("plotly")


@pytest.fixture(scope="module")
def diagram() -> MachineDiagram:
    return machine_diagram(small(), MachineRequest((0.0, 2.0), modes=6))


def complexes(pairs: list) -> np.ndarray:
    array = np.array(pairs)
    return array[..., 0] + 1j * array[..., 1]


def test_what_is_drawn_is_the_motion_of_the_solver(diagram: MachineDiagram) -> None:
    data = moving_machine.moving(diagram, RPM)
    assert data["names"] == [line.name for line in diagram.lines]
    motion, speed = diagram.solved[1].parts, data["speeds"][1]
    np.testing.assert_allclose(speed["tower"], motion.tower, atol=6e-4)
    assert motion.tower[0].any() == 0
    assert motion.tower[-1, 0] == pytest.approx(20.0, rel=1e-3)
    for n, line in enumerate(diagram.lines):
        m, mode = line.places[1], speed["modes"][n]
        assert mode["omega"] == line.frequencies[1]
        drawn = np.concatenate([complexes(mode["tower"]).ravel(), complexes(mode["blades"])[:, -1].ravel()])
        exact = np.concatenate([motion.tower_motion[m].ravel(), motion.blades[m][:, -1].ravel()])
        largest = np.abs(exact).argmax()
        np.testing.assert_allclose(drawn, exact * (drawn[largest] / exact[largest]), atol=2e-5)


def test_hub_and_top_of_the_tower_move_as_one_body(diagram: MachineDiagram) -> None:
    """The nacelle is rigid: the component along it of the velocities of its ends is the same."""
    motion = diagram.solved[1].parts
    hub = motion.hub[:, :3] @ motion.shaft[:3, :3].T
    along = motion.shaft[:3, 3] - motion.tower[-1]
    np.testing.assert_allclose(hub @ along, motion.tower_motion[:, -1] @ along, atol=1e-9 * np.abs(hub).max())


def test_a_collective_mode_moves_the_blades_alike(diagram: MachineDiagram) -> None:
    for line in diagram.lines:
        if not line.names[1].endswith("collective"):
            continue
        blades = np.tensordot(transformation(0.4, 3), diagram.solved[1].parts.blades[line.places[1]][:, -1], 1)
        np.testing.assert_allclose(blades[:, 2], blades[0, 2], rtol=0.2)
        return
    pytest.fail("no collective mode")


@pytest.mark.slow
@browsers.needed
def test_the_page_moves_and_follows_a_click(diagram: MachineDiagram, tmp_path: Path) -> None:
    path = moving_machine.write(diagram, tmp_path, RPM)
    with browsers.browser() as running:
        page = browsers.page(running)
        page.goto(path.as_uri())
        page.wait_for_function("document.querySelectorAll('#mode option').length === 6")
        page.evaluate("play(false); select(1, 0)")
        assert diagram.lines[1].names[0] in page.inner_text("#caption")
        before = page.evaluate("positions().blades[0].at(-1)")
        page.evaluate("state.phase += 1")
        after = page.evaluate("positions().blades[0].at(-1)")
        assert np.abs(np.subtract(before, after)).max() > 0.1
