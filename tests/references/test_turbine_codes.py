"""Turbines of other codes against core's: frequencies extrapolated from two refinements, and shapes at the common stations."""

from dataclasses import replace

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.core.blade import AXIAL, TORSION, Blade
from southwell.core.turbine.machine import machine
from southwell.core.turbine.stations import weights
from southwell.core.turbine.tower import Support
from southwell.core.turbine.turbine import Drivetrain, Turbine
from southwell.core.turbine.turbine_modes import TurbineModes, turbine_modes
from southwell.references.exudyn.turbine import CODE as EXUDYN
from southwell.references.joint_chains.pinocchio_turbine import CODE as PINOCCHIO
from southwell.references.protocol.turbines import TurbineAdapter
from southwell.tests.support.turbines import small

OMEGA, COUNT = 4.0, 8

CODES = (EXUDYN, PINOCCHIO)


def floater() -> Support:
    """A base that moves in five directions, coupled in two."""
    K = np.diag([np.inf, 2e6, 3e6, 5e7, 8e7, 6e7])
    K[1, 5] = K[5, 1] = -4e6
    return Support(K, mass=mb.inertia(2000.0, (1e4, 3e4, 2e4), (-2.0, 0.3, 0.2)))


TURBINES = {
    "rigid shaft": small(),
    "locked generator": small(4e5, Drivetrain(2e6, 0.3, 20.0, False)),
    "free generator": small(4e5, Drivetrain(2e6, 0.3, 20.0, True)),
    "on a floater": replace(small(4e5), support=floater()),
}


def macs(turbine: Turbine, core: TurbineModes, shapes: np.ndarray) -> np.ndarray:
    """(m, m) of core's modes and others."""
    weight = np.concatenate([np.diagonal(w) for w in weights(turbine)])
    x, y = (s.reshape(len(s), -1) * np.sqrt(weight) for s in (core.motions, shapes))
    return np.abs(x.conj() @ y.T) ** 2 / np.outer((np.abs(x) ** 2).sum(1), (np.abs(y) ** 2).sum(1))


def bending_only(beam: Blade) -> Blade:
    """Rigid in stretch, shear and torsion: a third of the joints."""
    stiffness = beam.stiffness.copy()
    rigid = [AXIAL, TORSION]
    stiffness[:, rigid, rigid] = np.inf
    return replace(beam, stiffness=stiffness)


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("rigid shaft", EXUDYN),
        ("locked generator", PINOCCHIO),
        *(("on a floater", code) for code in CODES),
        *(("free generator", code) for code in CODES),
    ],
)
def test_two_refinements_extrapolate_to_the_solvers_frequencies(name: str, code: TurbineAdapter) -> None:
    turbine = replace(
        TURBINES[name], tower=bending_only(small().tower), blade=bending_only(small().blade), gravity=30.0
    )
    core = turbine_modes(machine(turbine), OMEGA, COUNT)
    coarse, fine = (np.abs(code.turbine_modes(turbine, OMEGA, n, COUNT).values) for n in (6, 9))
    limit = fine + (fine - coarse) / (1.5**2 - 1.0)
    np.testing.assert_allclose(limit, core.frequencies, rtol=1e-3)


@pytest.mark.parametrize("code", CODES, ids=lambda code: code.name)
def test_shapes_are_those_of_the_solver(code: TurbineAdapter) -> None:
    turbine = TURBINES["locked generator"]
    core = turbine_modes(machine(turbine), OMEGA, 6)
    answer = code.turbine_modes(turbine, OMEGA, 6, 6)
    mac = macs(turbine, core, answer.shapes)
    assert np.diagonal(mac).min() > 0.999
    assert (mac - np.diag(np.diagonal(mac))).max() < 0.5
