"""What the tests of both Exudyn codes share: beams, closed forms, and how an answer is refined."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from southwell.core.blade import Blade, section_mass, uniform_blade
from southwell.references.exudyn.ancf import CODE as ANCF
from southwell.references.exudyn.tree import CODE as TREE

needs_exudyn = pytest.mark.skipif(TREE.version() is None, reason=f"not installed: {TREE.hint}")
both = pytest.mark.parametrize("code", [ANCF, TREE], ids=lambda code: code.name)

E, RHO, A, I = 7e10, 3000.0, 4e-4, 2e-7
PARK = uniform_blade(
    "park", 6.0, 0.3, EA=E * A, GJ=E / 2.6 * 2 * I, EI_y=E * I, EI_z=E * I, mass=RHO * A, I_y=RHO * I, I_z=RHO * I
)
NO_ROTARY = replace(PARK, mass=np.repeat(section_mass(RHO * A), 2, axis=0))

# Edgewise and flapwise, modes 1 to 3, at 10 rad/s, rad/s. FULL: two independent spectral solutions of the extensible
# beam with rotary inertia. INEXTENSIBLE: the exact Euler-Bernoulli beam without stretch or rotary inertia. STRETCHED: an
# ANCF cable's converged values, so a check of the tree by other theory, and of the cable's adapter only.
FULL = np.array([[11.710953, 70.419355, 189.81994], [15.400199, 71.126584, 190.083784]])
INEXTENSIBLE = np.array([[11.71325, 70.44004, 189.93315], [15.40131, 71.14632, 190.19622]])
STRETCHED = np.array([[11.71131, 70.43535, 189.92222], [15.40088, 71.14306, 190.18649]])


def unit(hub: float = 0.0, **changes: float) -> Blade:
    """Length, mass per length and bending stiffness 1; slenderness 70 and no rotary inertia unless changed."""
    return uniform_blade(
        "unit", 1.0, hub, **{"EA": 4900.0, "GJ": 1.0, "EI_y": 1.0, "EI_z": 1.0, "mass": 1.0, **changes}
    )


def roots(count: int) -> np.ndarray:
    """βL of the cantilever: cosh βL cos βL = −1."""
    return np.array([brentq(lambda x: np.cos(x) + 1 / np.cosh(x), k * np.pi, (k + 1) * np.pi) for k in range(count)])


def cantilever(x: np.ndarray, beta: float) -> np.ndarray:
    """The cantilever's mode shape at fractions ``x``."""
    ratio = (np.cosh(beta) + np.cos(beta)) / (np.sinh(beta) + np.sin(beta))
    return np.cosh(beta * x) - np.cos(beta * x) - ratio * (np.sinh(beta * x) - np.sin(beta * x))


def families(modes, count: int) -> np.ndarray:
    """(2, count) edgewise and flapwise frequencies, told apart by which way the blade moves."""
    along_y, along_z = np.linalg.norm(modes.shapes[:, :, 1], axis=1), np.linalg.norm(modes.shapes[:, :, 2], axis=1)
    lateral = np.maximum(along_y, along_z) > np.linalg.norm(modes.shapes[:, :, 0], axis=1)
    return np.array(
        [
            modes.frequencies[lateral & (along_y > along_z)][:count],
            modes.frequencies[lateral & (along_z > along_y)][:count],
        ]
    )


def observed_order(values: list[np.ndarray]) -> np.ndarray:
    """Of three refinements, each twice the one before."""
    return np.log2((values[0] - values[1]) / (values[1] - values[2]))


def extrapolated(code, solve) -> tuple[np.ndarray, np.ndarray]:
    """Richardson's value from the two finest of three refinements, from the code's coarsest, and the observed order."""
    values = [solve(factor * code.levels[0]) for factor in (1, 2, 4)]
    return values[2] + (values[2] - values[1]) / (2.0**code.order - 1), observed_order(values)
