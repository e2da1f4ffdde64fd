"""Lines of a turbine of two blades, whose modes move at ω + hΩ."""

import numpy as np
import pytest

from southwell.cases.campbell.machine import ModeLine, continued

OMEGA = np.array([1.0, 2.0, 3.0])


def line(frequencies: list[float], names: tuple[str, ...]) -> ModeLine:
    return ModeLine("tower", np.array(frequencies), names, np.ones(3), 0.0, (0, 0, 0))


@pytest.mark.parametrize("frequency", [3.1 + 2.0, 3.1 - 2.0, 2 * 2.0 - 3.1, 3.1])
def test_a_line_keeps_its_frame_where_another_motion_is_larger(frequency: float) -> None:
    """A mode at 3.1 rad/s moves at 5.1 and 1.1, and at 0.9 = |3.1 − 4|, too, at Ω = 2 rad/s."""
    frequencies = continued(line([3.0, frequency, 3.2], ("tower", "differential", "tower")), OMEGA)
    np.testing.assert_allclose(frequencies, [3.0, 3.1, 3.2], rtol=1e-12)


def test_a_line_with_one_name_is_as_solved() -> None:
    """Frequencies that jump under one name are not hidden."""
    np.testing.assert_array_equal(continued(line([3.0, 5.1, 3.2], ("tower",) * 3), OMEGA), [3.0, 5.1, 3.2])
