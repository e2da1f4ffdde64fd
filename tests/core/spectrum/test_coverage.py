"""How often the stated uncertainty covers the error of a frequency: random blades against a much finer mesh.

``python -m southwell.tests.core.spectrum.test_coverage 300`` is the study of docs/uncertainty.md.
"""

import sys
import warnings

import numpy as np
import pytest
from numpy.typing import NDArray

from southwell import uniform_blade
from southwell.core.solve import modes
from southwell.core.spectrum.accuracy import estimate
from southwell.core.spectrum.refinement import AccuracyWarning

from ...support.units import random_blade

Array = NDArray[np.float64]

COUNT = 10

# Shear-flexible and uniform. Frequencies, rad/s, by Chebyshev collocation of the intrinsic beam equations; a Legendre-Galerkin
# solution agrees to 1e-12.
UNIFORM = uniform_blade(
    "uniform",
    3.9638670176161095,
    0.0,
    EA=148979601.43720415,
    GJ=42950.550575068795,
    EI_y=97992.00801708206,
    EI_z=125350.85497327568,
    mass=12.850490620584106,
    I_y=0.008452468443785542,
    I_z=0.010812352634701124,
    GA_y=48704869.70062443,
    GA_z=34379908.02397019,
)
OMEGA = 11.93640483086907
EXACT = np.array(
    [
        *(22.685754908848928, 23.463837269900946, 125.72935051806921, 140.79994767365247, 343.65992714175894),
        *(387.67365470953024, 591.7160936008094, 665.3025551674775, 751.7314963261658, 1087.534305491101),
    ]
)


@pytest.mark.parametrize("accuracy", [1e-4, 1e-6, 1e-9])
def test_the_uncertainty_covers_the_error_of_a_uniform_blade(accuracy: float) -> None:
    solved = modes(UNIFORM, OMEGA, accuracy=accuracy)
    assert (np.abs(solved.frequencies / EXACT - 1.0) <= solved.uncertainty).all()


def test_a_difference_that_vanishes_by_chance_is_not_trusted() -> None:
    """f = 1 + h⁴ − a h⁶ on h = 1, 1/2, 1/4 with f₃ near f₂: the terms cancel, and the error of f₃ is not small."""
    a = (1 / 2**4 - 1 / 4**4) / (1 / 2**6 - 1 / 4**6)
    scale = 1e-3
    f = np.array([[1.0 + scale * (h**4 - 1.001 * a * h**6)] for h in (1.0, 0.5, 0.25)])
    result = estimate(f, 4)
    assert abs(result.values[0] - 1.0) <= result.of_values[0]


def outside(seed: int, accuracy: float, finest: float) -> list[float]:
    """Error, as a fraction of the uncertainty, of each frequency of a random blade that the finer solution can judge."""
    blade, omega = random_blade(np.random.default_rng(seed))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        coarse, fine = (
            modes(blade, omega, count=COUNT, accuracy=accuracy),
            modes(blade, omega, count=COUNT, accuracy=finest),
        )
    error = np.abs(coarse.frequencies / fine.frequencies - 1.0)
    judged = fine.uncertainty < 0.2 * coarse.uncertainty
    return list((np.maximum(error - fine.uncertainty, 0.0) / coarse.uncertainty)[judged])


@pytest.mark.nightly
def test_the_uncertainty_covers_the_errors_of_random_blades() -> None:
    ratios = np.array([ratio for seed in range(1000, 1020) for ratio in outside(seed, 1e-4, 1e-9)])
    assert len(ratios) > 150
    assert ratios.max() <= 1.0


if __name__ == "__main__":
    for accuracy, finest in ((1e-3, 1e-9), (1e-6, 1e-11)):
        ratios = np.array([r for seed in range(int(sys.argv[1])) for r in outside(seed, accuracy, finest)])
        print(f"accuracy {accuracy:g}: {(ratios > 1).sum()} of {len(ratios)} outside, by {ratios.max():.2f} at most")
