"""Differences that people published: the known cause is named first, or the case is stated as open.

Figures are retyped from the sources that each test names.
"""

from dataclasses import replace

import numpy as np
import pytest

from southwell.cases.diagnosis.diagnose import Diagnosis, diagnose
from southwell.core.blade import TORSION, Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.solve import mesh_sweep

pytestmark = pytest.mark.slow

RPM = np.pi / 30

MBWIND = np.array([
    [0.0000000000, 13.307988, 713.8320, 1.811e10, 1.811e10],
    [0.0222227642, 13.307988, 806.2639, 1.910e10, 1.955e10],
    [0.0666666667, 13.307988, 637.1906, 1.123e10, 1.535e10],
    [0.1111105690, 13.307988, 429.7371, 5.815e09, 8.460e09],
    [0.1666666670, 13.307988, 447.1508, 4.654e09, 7.173e09],
    [0.2333333330, 11.479989, 369.6172, 2.542e09, 5.034e09],
    [0.3000000000, 10.161991, 354.8638, 2.022e09, 4.469e09],
    [0.3666666670, 9.0109932, 336.4634, 1.549e09, 3.953e09],
    [0.4333333330, 7.7949934, 307.5790, 1.051e09, 3.378e09],
    [0.5000000000, 6.5439916, 273.5535, 6.410e08, 2.685e09],
    [0.5666666670, 5.3609953, 246.5888, 3.782e08, 2.170e09],
    [0.6333333330, 4.1879966, 202.1234, 2.151e08, 1.486e09],
    [0.7000000000, 3.1249972, 168.5948, 1.180e08, 1.114e09],
    [0.7666666670, 2.3189980, 141.2285, 8.396e07, 7.559e08],
    [0.8333333330, 1.5259986, 107.9739, 5.498e07, 4.849e08],
    [0.8888894310, 0.86299934, 91.2366, 3.717e07, 3.758e08],
    [0.9333333330, 0.3699997, 71.17459, 2.545e07, 2.735e08],
    [0.9777772360, 0.10599989, 48.58169, 7.887e06, 8.728e07],
    [1.0000000000, 0.0, 10.83762, 1.700e05, 5.010e06],
])  # fmt: skip
"""Fraction, twist (degrees), mass (kg/m), EI_flap, EI_edge (N m²): ricklupton/mbwind b1a8f49, parked_blade_nrel.yaml."""


def mbwind() -> Blade:
    s, twist, mass, flap, edge = MBWIND.T
    stiffness = section_stiffness(np.full(19, 1e12), np.full(19, 1e13), flap, edge)
    return Blade("mbwind", 61.5 * s, stiffness, section_mass(mass), np.radians(twist), hub_radius=1.5)


def first_names(diagnosis: Diagnosis) -> list[str]:
    return [name for name, _ in diagnosis.causes[0].changes]


def test_mbwind_is_named_as_a_truncated_modal_basis() -> None:
    """The thesis code mbwind to 100 rpm, rad/s: flapwise 1, edgewise 1, flapwise 2, edgewise 2 (by frequency)."""
    speeds = np.array([0.0, 20.0, 50.0, 100.0]) * RPM
    frequencies = np.array([
        [4.289513, 6.814949, 12.417516, 25.307194], [5.124437, 6.965019, 13.438279, 25.701539],
        [7.562747, 8.078772, 17.963777, 27.695768], [9.467076, 13.710680, 28.873108, 34.045807],
    ])  # fmt: skip
    diagnosis = diagnose(mbwind(), speeds, frequencies)
    assert diagnosis.cause is not None
    assert first_names(diagnosis) == ["in the 4 lowest modes at rest"]


def test_bladed_differs_at_rest_and_the_cause_is_open() -> None:
    """Bladed's numbers for the same blade, rad/s: EI or mass read differently, −0.7 % flapwise at rest."""
    speeds = np.array([1.0, 5.0, 10.0, 20.0]) * RPM
    frequencies = [[4.2606, 6.8065, 12.323, 25.265], [4.3144, 6.8150, 12.384, 25.288],
             [4.4771, 6.8413, 12.574, 25.359], [5.0606, 6.9459, 13.314, 25.643]]  # fmt: skip
    diagnosis = diagnose(mbwind(), speeds, frequencies)
    flap = diagnosis.modes[0]
    assert (flap.at_rest, flap.rest_reference) == pytest.approx((4.2584, 4.2892), abs=2e-4)
    assert (flap.slope, flap.slope_reference) == pytest.approx((1.755, 1.812), abs=2e-3)
    assert diagnosis.cause is None
    assert "at rest (−0.77 to −0.13 %: stiffness or mass) and a slope" in diagnosis.sentence


def test_a_shear_modulus_of_half_e_times_one_plus_nu_is_named() -> None:
    """OWENSFEA.jl 1f201a4, test/CantileverBeamRotatingModal.jl: strip swept by 45°, ``E/2(1+v)`` is (E/2)(1 + v)."""
    end = 0.25 + 0.25 / np.sqrt(2)
    stiffness = section_stiffness(2.1e8, 19824.21875, 7000.0, 43750.0, 6.730769e7, 6.730769e7)
    blade = Blade(
        "strip", np.array([0.0, 0.25, 0.5]), np.repeat(stiffness, 3, 0), np.repeat(section_mass(7.8, 2.6e-4, 1.625e-3), 3, 0),
        np.zeros(3), curve=np.array([[0, 0, 0], [0.25, 0, 0], [end, 0.25 - end, 0]]), kinks=(0.25,),
    )  # fmt: skip
    as_written = blade.stiffness.copy()
    as_written[:, TORSION, TORSION] = 32480.0
    speeds = [0.0, 3000 * RPM, 6000 * RPM]
    answers = mesh_sweep(replace(blade, stiffness=as_written), speeds, 32, 6)
    diagnosis = diagnose(blade, speeds, [modes.frequencies for modes in answers])
    assert first_names(diagnosis) == ["with E/2·(1 + ν) for G (ν = 0.28)"]
    assert diagnosis.cause is not None


def test_a_flap_frequency_that_falls_has_the_wrong_sign_of_a_term() -> None:
    """``batch_rotode.m`` (Bristol 2013): sign of T′w′; 10.636, 9.954, 7.631 Hz at 0, 16.5, 33 rad/s on a root spring."""
    x = np.linspace(0.0, 1.0, 41)
    flap = 191.697339 - 327.3956 * x + 167.7985 * x**2
    root = np.full(6, np.inf)
    root[4] = 1865.577
    stiffness = section_stiffness(np.full(41, 1e9), np.full(41, 1e6), flap, 1000 * flap)
    blade = Blade(
        "student",
        1.002401545 * x,
        stiffness,
        np.repeat(section_mass(0.2686152), 41, 0),
        np.zeros(41),
        0.025098455,
        root=root,
    )
    diagnosis = diagnose(blade, [0.0, 16.5, 33.0], 2 * np.pi * np.array([[10.636], [9.954], [7.631]]), ["flapwise 1"])
    assert diagnosis.cause is not None
    assert first_names(diagnosis) == ["with the sign of T′w′ reversed in the beam's equation"]
    assert (
        diagnosis.indication
        == "frequencies fall with speed where the solver's rise: geometric stiffness is missing or reversed"
    )


def test_the_slope_of_a_formula_for_low_speed_is_seen_and_open() -> None:
    """S = 1.193 + 1.571 R/L of uniform blades is the limit at low speed: here R = 0, to 400 rad/s."""
    blade = uniform_blade("uniform", 0.5, 0.0, EA=2e7, GJ=3080.0, EI_y=2e3, EI_z=2e5, mass=0.8, I_y=8e-5, I_z=8e-3)
    rest = next(mesh_sweep(blade, [0.0], 40, 1)).frequencies[0]
    speeds = [0.0, 106.0, 400.0]
    frequencies = [[np.sqrt(rest**2 + 1.193 * omega**2)] for omega in speeds]
    diagnosis = diagnose(blade, speeds, frequencies, ["flapwise 1"])
    assert diagnosis.largest < 2e-3
    assert "grows from rest with speed" in diagnosis.sentence
    assert diagnosis.cause is None
