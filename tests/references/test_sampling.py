"""The sampling of the adapters is linear between stations, entry by entry; rigid strains stay rigid."""

import numpy as np

from southwell.core.blade import SHEAR_Y, Blade, section_mass, section_stiffness
from southwell.references import sampling

S = np.array([0.0, 1.0, 4.0])
BLADE = Blade(
    "linear",
    S,
    section_stiffness([8.0, 6.0, 2.0], [5.0, 4.0, 1.0], [7.0, 5.0, 4.0], [9.0, 8.0, 3.0]),
    section_mass([4.0, 3.0, 1.0], [0.2, 0.1, 0.3], [0.4, 0.5, 0.2]),
    np.array([0.3, 0.1, -0.2]),
)
AT = np.array([0.0, 0.25, 1.0, 2.5, 4.0])
"""With the weights of the three stations in ``WEIGHTS``, written down by hand."""
WEIGHTS = np.array([[1.0, 0.0, 0.0], [0.75, 0.25, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 0.5], [0.0, 0.0, 1.0]])


def test_twist_mass_and_stiffness_are_linear_between_stations() -> None:
    np.testing.assert_allclose(sampling.twist_at(BLADE, AT), WEIGHTS @ BLADE.twist, atol=1e-15)
    np.testing.assert_allclose(sampling.mass_at(BLADE, AT), np.einsum("ks,sij->kij", WEIGHTS, BLADE.mass), atol=1e-14)
    stiffness = sampling.stiffness_at(BLADE, AT)
    assert np.isinf(stiffness[:, SHEAR_Y, SHEAR_Y]).all()
    finite = np.where(np.isinf(BLADE.stiffness), 0.0, BLADE.stiffness)
    expected = np.einsum("ks,sij->kij", WEIGHTS, finite)
    np.testing.assert_allclose(np.where(np.isinf(stiffness), 0.0, stiffness), expected, atol=1e-14)


def test_engineering_properties_are_those_of_the_matrices() -> None:
    sections = sampling.sample(BLADE, AT)
    np.testing.assert_allclose(sections.EI_z, WEIGHTS @ [9.0, 8.0, 3.0], atol=1e-14)
    np.testing.assert_allclose(sections.EI_y, WEIGHTS @ [7.0, 5.0, 4.0], atol=1e-14)
    np.testing.assert_allclose(sections.I_y, WEIGHTS @ [0.2, 0.1, 0.3], atol=1e-14)
    np.testing.assert_allclose(sections.twist, WEIGHTS @ BLADE.twist, atol=1e-15)


def test_gauss_points_of_each_interval() -> None:
    """Two points at 1/√3 of half the interval from its middle, ascending, each with half its length as weight."""
    at, weight = sampling.points([0.0, 2.0, 3.0], 2)
    off = 1.0 / np.sqrt(3.0)
    np.testing.assert_allclose(at, [[1.0 - off, 1.0 + off], [2.5 - off / 2, 2.5 + off / 2]], atol=1e-15)
    np.testing.assert_allclose(weight, [[1.0, 1.0], [0.5, 0.5]], atol=1e-15)
