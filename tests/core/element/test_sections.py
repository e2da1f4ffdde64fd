"""Element stiffness from integrated flexibility, against textbook statics."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.element import sections
from southwell.core.element.discretize import discretize
from southwell.core.solve import modes
from southwell.core.space import spatial as sp

L, EA, GJ, EY, EZ, GA = 3.0, 5e8, 2e6, 4e6, 7e6, 9e7


def beam(shear: float) -> Blade:
    return uniform_blade("beam", L, 0.0, EA=EA, GJ=GJ, EI_y=EY, EI_z=EZ, mass=1.0, GA_y=shear, GA_z=shear)


def tip(blade: Blade, wrench: np.ndarray, elements: int = 1) -> np.ndarray:
    """Displacement and rotation (6,) of the tip under a wrench there, the root clamped; elements chained."""
    s = np.linspace(0.0, blade.length, elements + 1)
    seg = sections.integrate(blade, s)
    x = sections.frames(blade, s)
    at_tip = np.array([0, 0, 0, *np.cross(x[-1, :3, 3], wrench[:3])])  # moment about the ground's origin
    spatial = np.concatenate([wrench[:3], wrench[3:]]) + at_tip
    twist = np.zeros(6)
    for k in range(elements):
        lever = sp.adjoint(x[k])
        twist += lever @ seg.flexibility[k] @ lever.T @ spatial
    return np.concatenate([twist[:3] + np.cross(twist[3:], x[-1, :3, 3]), twist[3:]])


def test_the_root_is_coned_with_its_hub_radius_and_pitched() -> None:
    """Precone lifts the blade's axis and the hub radius along it towards +z; pitch turns y towards z, as twist does."""
    cone, pitch = 0.3, 0.4
    pose = sections.root(replace(beam(GA), hub_radius=2.0, precone=cone, pitch=pitch))
    axis, lifted = np.array([np.cos(cone), 0.0, np.sin(cone)]), np.array([-np.sin(cone), 0.0, np.cos(cone)])
    np.testing.assert_allclose(pose[:3, 3], 2.0 * axis, atol=1e-15)
    np.testing.assert_allclose(pose[:3, 0], axis, atol=1e-15)
    np.testing.assert_allclose(pose[:3, 1], np.cos(pitch) * np.array([0, 1, 0]) + np.sin(pitch) * lifted, atol=1e-15)


def test_an_element_has_the_twist_that_is_linear_between_stations() -> None:
    """Nodes at a quarter, a half and three quarters of a blade that is twisted by 0.8 rad."""
    mesh = discretize(replace(beam(GA), twist=np.array([0.0, 0.8])), 4)
    np.testing.assert_allclose(
        np.arctan2(mesh.nodes[:, 2, 1], mesh.nodes[:, 1, 1]), [0.0, 0.2, 0.4, 0.6, 0.8], atol=1e-12
    )


def test_a_tip_mass_is_in_the_axes_of_the_tip_section() -> None:
    """A plate across the z axis of a section that is twisted and pitched by 0.7 rad."""
    plate = np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 2.0])
    mesh = discretize(replace(beam(GA), twist=np.array([0.0, 0.5]), pitch=0.2, tip_mass=plate), 4)
    axes = mesh.nodes[-1, :3, :3]
    normal = np.array([0.0, -np.sin(0.7), np.cos(0.7)])
    np.testing.assert_allclose(axes @ mesh.lumps[-1, 3:, 3:] @ axes.T, np.eye(3) + np.outer(normal, normal), atol=1e-12)


@pytest.mark.parametrize("shear", [np.inf, GA], ids=["Euler-Bernoulli", "Timoshenko"])
@pytest.mark.parametrize("elements", [1, 3])
def test_uniform_cantilever_statics(shear: float, elements: int) -> None:
    b = beam(shear)
    slip = 0.0 if np.isinf(shear) else L / shear
    expected = {
        0: [L / EA, 0, 0, 0, 0, 0],
        1: [0, L**3 / 3 / EZ + slip, 0, 0, 0, L**2 / 2 / EZ],
        2: [0, 0, L**3 / 3 / EY + slip, 0, -(L**2) / 2 / EY, 0],
        3: [0, 0, 0, L / GJ, 0, 0],
        4: [0, 0, -(L**2) / 2 / EY, 0, L / EY, 0],
        5: [0, L**2 / 2 / EZ, 0, 0, 0, L / EZ],
    }
    for j, value in expected.items():
        np.testing.assert_allclose(tip(b, np.eye(6)[j], elements), value, rtol=1e-10, atol=1e-10 * max(np.abs(value)))


def test_bend_twist_coupling_statics() -> None:
    """A tip moment about y twists a coupled beam by the 2×2 compliance times the length."""
    k = section_stiffness(EA, GJ, EY, EZ)
    k[:, 3, 4] = k[:, 4, 3] = 0.3 * np.sqrt(GJ * EY)
    b = Blade("coupled", np.array([0.0, L]), np.repeat(k, 2, 0), np.repeat(section_mass(1.0), 2, 0), np.zeros(2))
    c = np.linalg.inv(k[0, 3:5, 3:5])
    np.testing.assert_allclose(tip(b, np.array([0, 0, 0, 0, 1.0, 0]))[3:5], c[:, 1] * L, rtol=1e-10)
    np.testing.assert_allclose(tip(b, np.array([0, 0, 1.0, 0, 0, 0]))[2], c[1, 1] * L**3 / 3, rtol=1e-10)


def test_linear_taper_statics() -> None:
    """Tip load on EI falling linearly: w = ∫ (L−s)²/EI ds, in closed form with logarithms; converges as the elements do."""
    e0, e1 = 4e6, 1e6
    b = Blade(
        "taper",
        np.array([0.0, L]),
        section_stiffness(EA, GJ, [e0, e1], [EZ, EZ]),
        np.repeat(section_mass(1.0), 2, 0),
        np.zeros(2),
    )
    a = (e1 - e0) / L  # EI = e1 + a (s − L): with t = L − s, EI = e1 − a t
    exact = -(L**2) / (2 * a) - e1 * L / a**2 - e1**2 / a**3 * np.log(1 - a * L / e1)
    errors = [abs(tip(b, np.array([0, 0, 1.0, 0, 0, 0]), n)[2] / exact - 1) for n in (4, 8)]
    assert errors[1] < 1e-7
    assert np.log2(errors[0] / errors[1]) > 5.0  # three Gauss points: sixth order


def test_quarter_circle_in_plane() -> None:
    """A prebent quarter circle under an out-of-plane tip force: w = F R³ (π/4 /EI + (3π/4 − 2)/GJ) (Timoshenko 1930)."""
    radius, n = 2.0, 81
    angle = np.linspace(0.0, np.pi / 2, n)
    curve = np.stack([radius * np.sin(angle), radius * (1 - np.cos(angle)), np.zeros(n)], axis=1)
    b = Blade(
        "arc",
        radius * angle,
        np.repeat(section_stiffness(1e12, GJ, EY, EZ), n, 0),
        np.repeat(section_mass(1.0), n, 0),
        np.zeros(n),
        curve=curve,
    )
    exact = radius**3 * (np.pi / 4 / EY + (3 * np.pi / 4 - 2) / GJ)
    assert tip(b, np.array([0, 0, 1.0, 0, 0, 0]), 8)[2] == pytest.approx(exact, rel=2e-6)


@pytest.mark.parametrize(("length", "tolerance"), [(0.5 * L, 1e-6), (5e-5 * L, 1e-10)], ids=["long", "a step"])
def test_a_stiffness_that_changes_a_millionfold(length: float, tolerance: float) -> None:
    """A tip moment on EI growing linearly over a length h from the root: the tip turns by h ln(EI₁/EI₀)/(EI₁ − EI₀)."""
    stations, EI = np.array([0.0, length, L]), np.array([1.0, 1e6, 1e6])
    soft = Blade(
        "soft root", stations, section_stiffness(EA, GJ, EI, 3 * EI), np.repeat(section_mass(1.0), 3, 0), np.zeros(3)
    )
    exact = length * np.log(1e6) / (1e6 - 1.0) + (L - length) / 1e6
    np.testing.assert_allclose(tip(soft, np.array([0, 0, 0, 0, 1.0, 0]))[4], exact, rtol=tolerance)


def test_a_coupling_that_grows_until_the_section_is_almost_singular() -> None:
    """The diagonal is constant, so that only the matrix as a whole shows the change."""
    ends = np.zeros((2, 6, 6))
    ends[:] = section_stiffness(EA, GJ, EY, EZ)
    ends[1, 3, 4] = ends[1, 4, 3] = 0.9999 * np.sqrt(GJ * EY)
    coupled = Blade("coupled", np.array([0.0, L]), ends, np.repeat(section_mass(1.0), 2, 0), np.zeros(2))
    c = np.sqrt(GJ * EY) * 0.9999  # ∫ GJ/(GJ EY − c² t²) L dt
    exact = L * np.sqrt(GJ / EY) / c * np.arctanh(c / np.sqrt(GJ * EY))
    np.testing.assert_allclose(tip(coupled, np.array([0, 0, 0, 0, 1.0, 0]))[4], exact, rtol=1e-6)


@pytest.mark.parametrize("length", [0.1, 9.9e-5])
def test_stations_added_on_the_line_change_no_frequency_beyond_its_uncertainty(length: float) -> None:
    """A root as soft as a hinge (EI 0.1 N m² growing to 1e5 over a part of 10 m): the source of each station is the line."""

    def blade(stations: np.ndarray) -> Blade:
        EI = np.interp(stations, [0.0, 10 * length, 10.0], [0.1, 1e5, 1e5])
        mass = np.repeat(section_mass(10.0), len(stations), 0)
        return Blade("hinge", stations, section_stiffness(1e9, 1e5, EI, 3 * EI), mass, np.zeros(len(stations)))

    sparse = modes(blade(np.array([0.0, 10 * length, 10.0])), 0.0, count=4)
    added = 10 * length * (0.1 * 1e6 ** (np.arange(61) / 60) - 0.1) / (1e5 - 0.1)
    dense = modes(blade(np.append(added, 10.0)), 0.0, count=4)
    assert sparse.uncertainty.max() < 1e-6
    difference = np.abs(sparse.frequencies / dense.frequencies - 1.0)
    assert (difference <= sparse.uncertainty + dense.uncertainty).all()
