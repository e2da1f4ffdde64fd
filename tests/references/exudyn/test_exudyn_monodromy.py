"""Exudyn integrates a rotor with an unequal blade over one revolution: Floquet's multipliers, independent of core's."""

import numpy as np

from southwell.core.rotor.comparison import compared
from southwell.core.rotor.floquet import distance
from southwell.core.rotor.orbit import linearize
from southwell.references.exudyn.monodromy import multipliers
from southwell.tests.support.rotors import coleman_feingold

OMEGA = 1.6
INERTIA = 3 * 500.0 * 30.0**2


def test_coleman_and_feingold_with_one_stiffer_blade() -> None:
    machine = coleman_feingold(OMEGA, stiffer=1.05)
    by_time = multipliers(machine, "shaft.rz", "rotor", INERTIA)
    strip = np.sort(np.abs(np.angle(by_time)) * OMEGA / (2 * np.pi) ** 2)[::2]
    np.testing.assert_allclose(strip, [0.03740962, 0.04310606, 0.05847881, 0.06171777, 0.09916926], atol=6e-9)
    np.testing.assert_allclose(np.abs(by_time), 1.0, atol=1e-6)
    both = compared(linearize(machine, "shaft.rz")[0])
    for exponents in (both.floquet, both.hill):
        assert distance(exponents.multipliers, by_time).max() < 1e-6
