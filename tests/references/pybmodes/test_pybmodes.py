"""pyBModes against core without the same effects, closed forms and printed tables; and the effects it leaves out."""

import os
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from southwell.cases.input.library import load
from southwell.core import solve
from southwell.core.blade import Blade, uniform_blade, without_rotary_inertia
from southwell.core.effects import Effects
from southwell.references.protocol.interface import CodeError
from southwell.references.pybmodes import beam as pybmodes_beam
from southwell.references.pybmodes.beam import CODE
from southwell.references.pybmodes.input_file import write
from southwell.tests.support.analytic import ROOTS
from southwell.tests.support.beams import PARK, curved, tapered, yoo_shin
from southwell.tests.support.straight_blades import kinked

pytestmark = pytest.mark.skipif(CODE.version() is None, reason=f"not installed: {CODE.hint}")

Array = NDArray[Any]
WINDPACT = {v.name: v.blade for v in load("park-blade").variants}["park-blade/windpact"]
TIP_MASS = np.diag([40.0, 40.0, 40.0, 9.0, 1.0, 8.0])


def frequencies(blade: Blade, omega: float, elements: int, count: int = 6) -> Array:
    return CODE.solve(blade, omega, elements, count).frequencies


def orders(blade: Blade, omega: float, levels: tuple[int, ...], count: int) -> Array:
    """Observed order of convergence of each mode over doubled levels."""
    f = [frequencies(blade, omega, n, count) for n in levels]
    return np.log2((f[0] - f[1]) / (f[1] - f[2]))


def core(blade: Blade, omega: float, count: int) -> Array:
    """Core without the same effects, with 160 elements of fourth order; accurate to 1e-7 or better."""
    return solve.mesh_modes(blade, omega, 160, count, effects=CODE.effects).frequencies


def shaft(I_y: float, I_z: float) -> Blade:
    """A beam with torsional frequencies (k − ½) π √(GJ / I_x) at zero speed, far below those of bending."""
    return uniform_blade("shaft", 1.0, 0.1, EA=1e4, GJ=1e-2, EI_y=1e2, EI_z=1e2, mass=1.0, I_y=I_y, I_z=I_z)


@pytest.mark.parametrize(
    ("blade", "omega", "count", "rtol"),
    [
        (PARK, 10.0, 6, 1e-6),
        (yoo_shin(0.1), 50.0, 2, 1e-5),  # core's third is axial
        (yoo_shin(5.0), 10.0, 4, 1e-5),
        (replace(PARK, pitch=0.5), 10.0, 6, 1e-6),
    ],
    ids=["cantilever", "slender 70, fast", "large hub", "pitched"],
)
def test_agrees_with_core_without_the_same_effects(blade: Blade, omega: float, count: int, rtol: float) -> None:
    np.testing.assert_allclose(frequencies(blade, omega, 80, count), core(blade, omega, count), rtol=rtol)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("blade", "omega"),
    [
        (tapered(), 3.0),
        (replace(tapered(), pitch=0.4), 3.0),
        (WINDPACT, 30 * np.pi / 30),
    ],
    ids=["tapered and twisted", "pitched", "windpact"],
)
def test_tapered_blades_extrapolate_to_core_without_the_same_effects(blade: Blade, omega: float) -> None:
    """Second order, from 160 and 320 elements."""
    coarse, fine = (frequencies(blade, omega, n, 4) for n in (160, 320))
    np.testing.assert_allclose(fine + (fine - coarse) / 3, core(blade, omega, 4), rtol=2e-5)


@pytest.mark.parametrize(
    ("blade", "omega", "levels", "order"),
    [
        (PARK, 10.0, (5, 10, 20), 4),
        (yoo_shin(0.1), 20.0, (20, 40, 80), 4),
        (tapered(), 3.0, (40, 80, 160), 2),
        (WINDPACT, np.pi, (80, 160, 320), 2),
    ],
    ids=["cantilever", "slender 70", "tapered and twisted", "windpact"],
)
def test_order(blade: Blade, omega: float, levels: tuple[int, ...], order: int) -> None:
    """Second for tapered blades, since elements have the properties at their middle; fourth for uniform ones."""
    assert CODE.order == 2
    np.testing.assert_allclose(orders(blade, omega, levels, 4), order, atol=0.12)


def test_shapes_are_those_of_core() -> None:
    """Displacements by pairing, and the signs of the axes from the modes of a pitched, twisted blade."""
    blade = replace(tapered(), pitch=0.4)
    actual = CODE.solve(blade, 3.0, 160, 4).shapes.reshape(4, -1)
    expected = solve.mesh_modes(blade, 3.0, 160, 4, effects=CODE.effects).shapes.reshape(4, -1)
    norms = np.linalg.norm(actual, axis=1) * np.linalg.norm(expected, axis=1)
    np.testing.assert_allclose(np.abs(np.sum(actual.conj() * expected, axis=1)) / norms, 1, atol=1e-5)


@pytest.mark.parametrize("elements", [3, 7, 20])
def test_shapes_between_nodes_use_the_shape_functions(elements: int) -> None:
    """For any number of elements the first shape is the clamped-free one (Rayleigh 1877); slopes are in metres too."""
    root = ROOTS[0]
    x = root * np.linspace(0, 1, 21)
    ratio = (np.cosh(root) + np.cos(root)) / (np.sinh(root) + np.sin(root))
    exact = np.cosh(x) - np.cos(x) - ratio * (np.sinh(x) - np.sin(x))
    unlike = uniform_blade("plank", 6.0, 0.3, EA=1e8, GJ=1e5, EI_y=1e4, EI_z=1e6, mass=1.2, I_y=1e-3, I_z=1e-3)
    shape = CODE.solve(unlike, 0.0, elements, 1).shapes[0]
    np.testing.assert_allclose(shape[:, 2] / shape[-1, 2], exact / exact[-1], atol=1e-3)
    assert np.abs(np.delete(shape, 2, axis=1)).max() < 1e-9 * np.abs(shape[-1, 2])


def test_torsion_has_polar_inertia_and_spin_softens() -> None:
    """Closed form: ω² = ((k − ½) π)² GJ / I_x + Ω² (I_z − I_y) / I_x; rotation about x, to the tip."""
    blade, omega = shaft(1e-4, 9e-4), 5.0
    solution = CODE.solve(blade, omega, 40, 2)
    exact = np.sqrt((np.array([0.5, 1.5]) * np.pi) ** 2 * 1e-2 / 1e-3 + omega**2 * 0.8)
    np.testing.assert_allclose(solution.frequencies, exact, rtol=1e-6)
    x = np.linspace(0, 1, 21)
    shape = solution.shapes[0, :, 3] / solution.shapes[0, -1, 3]
    np.testing.assert_allclose(shape, np.sin(np.pi / 2 * x), atol=1e-6)


def test_a_blade_without_polar_inertia_has_bending_modes_only() -> None:
    """pyBModes solves this eigenproblem with a singular mass matrix from below; all available modes are returned."""
    solution = CODE.solve(without_rotary_inertia(PARK), 10.0, 4, 99)
    assert len(solution.frequencies) > 10
    assert not np.abs(solution.shapes[:, :, 3]).max() > 1e-9 * np.abs(solution.shapes).max()


def test_axial_modes_are_left_out() -> None:
    """The axial mode of this beam at zero speed is at π/2 · 70 = 110 rad/s; pyBModes computes it but returns no shape."""
    rotor_modes = frequencies(yoo_shin(0.0), 0.0, 40, 8)
    assert np.abs(rotor_modes / (35 * np.pi) - 1).min() > 0.05
    rest = np.square(ROOTS[:4])
    np.testing.assert_allclose(rotor_modes, np.repeat(rest, 2), rtol=1e-5)


@pytest.mark.parametrize(
    ("blade", "reason"),
    [
        (curved(), "couple"),
        (replace(PARK, curve=np.array([[0, 0, 0], [6 * np.cos(0.1), 6 * np.sin(0.1), 0]])), "sweep"),
        (replace(PARK, precone=0.1), "precone = 0.1"),
        (replace(PARK, root=np.array([np.inf] * 5 + [0.0])), "not clamped"),
        (replace(PARK, tip_mass=TIP_MASS), "tip_mass"),
        (uniform_blade("s", 1, 0, EA=1, GJ=1, EI_y=1, EI_z=1, mass=1, GA_y=1.0), "shear"),
        (uniform_blade("s", 1, 0, EA=1, GJ=np.inf, EI_y=1, EI_z=1, mass=1), "GJ is infinite"),
        (
            replace(PARK, mass=np.repeat(np.diag([1.0, 1.0, 1.00005, 0, 0, 0])[None], 2, axis=0)),
            "differs with direction",
        ),
    ],
    ids=["coupled", "swept", "coned", "hinged", "tip mass", "shear", "rigid", "added mass"],
)
def test_an_unsupported_blade_is_declined_with_a_reason(blade: Blade, reason: str) -> None:
    assert reason in (CODE.unsupported(blade) or "")
    with pytest.raises(CodeError, match=reason):
        CODE.solve(blade, 1.0, 5, 2)


@pytest.mark.slow
def test_pybmodes_is_wrong_for_mass_centres_off_the_axis(monkeypatch: pytest.MonkeyPatch) -> None:
    """Core agrees with the expected value of the reproducer, an independent method; pyBModes is off by 1.5 %.

    Both are without Coriolis terms, for a beam with its mass 0.05 m off the axis, at 60 rpm. Only in pyBModes the
    second flap mode does not depend on the stiffness of the other plane.
    """
    monkeypatch.syspath_prepend(Path(__file__).parents[1] / "defects")  # as for a script
    from ..defects import pybmodes_mass_centre as they

    blade = uniform_blade(
        "off",
        they.RADIUS,
        0.0,
        EA=they.EA,
        GJ=they.GJ,
        EI_y=they.EI,
        EI_z=4 * they.EI,
        mass=they.MASS,
    )
    e, m = they.OFFSET, they.MASS
    mass = np.diag([m, m, m, they.FLAP + they.EDGE + m * e**2, they.FLAP, they.EDGE + m * e**2])
    mass[0, 5] = mass[5, 0] = -m * e
    mass[2, 3] = mass[3, 2] = m * e
    blade = replace(blade, mass=np.repeat(mass[None], 2, axis=0))
    assert "mass centres off the axis" in (CODE.unsupported(blade) or "")
    actual = solve.mesh_modes(blade, 2 * np.pi, 80, 5, effects=Effects(coriolis=False)).frequencies
    np.testing.assert_allclose(they.Exact(2 * np.pi, 4 * they.EI).frequencies()[:5], actual, rtol=1e-4)


def test_no_steady_state_at_high_speed_is_reported() -> None:
    """A section thicker than wide is unstable in torsion: Ω² (I_y − I_z) above (π/2)² GJ / L²."""
    assert frequencies(shaft(9e-4, 1e-4), 5.0, 10, 1)[0] > 0
    with pytest.raises(CodeError, match="no stable steady state"):
        CODE.solve(shaft(9e-4, 1e-4), 6.0, 10, 1)


def test_unused_entries_of_the_input_file(tmp_path: Path) -> None:
    """pyBModes ignores precone, so such blades are declined, and pitch, so it is included in the twist."""
    blade = replace(tapered(), pitch=0.0)
    path = write(tmp_path, blade, 3.0, np.linspace(0, blade.length, 21), 4)
    text, answers = path.read_text(), []
    for line in ("0.0  precone", "0.0  bl_thp", "1.0  rpm_mult"):
        for value in ("0.0", "0.5") if "rpm" in line else ("0.0", "20.0"):
            path.write_text(text.replace(line, value + line[3:]))
            answers.append(pybmodes_beam._pybmodes().RotatingBlade(path).run(4, check_model=False).frequencies)
    plain, coned, _, pitched, at_rest, half = answers
    np.testing.assert_array_equal([coned, pitched], [plain, plain])
    assert (at_rest < half).all()  # an entry that is used changes the result
    assert (half < plain).all()


def test_no_files_are_left_behind(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    CODE.solve(PARK, 10.0, 5, 4)
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("doubted", [False, True])
def test_a_mode_that_the_iteration_misses_is_found(doubted: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first answer lacks one of a double pair."""
    monkeypatch.setattr(pybmodes_beam, "_moves", lambda _: True)
    monkeypatch.setattr(pybmodes_beam, "_at_stations", lambda shapes, *_: np.array(shapes))
    all_, requested_counts = np.array([1.0, 2.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]), []

    def run(count: int, **_: bool) -> SimpleNamespace:
        requested_counts.append(count)
        result = np.delete(all_, 1)[:count] if len(requested_counts) == 1 else all_[:count]
        return SimpleNamespace(
            frequencies=result * (1.0 + 1e-8 * len(requested_counts)), shapes=list(range(len(result)))
        )

    rotor = SimpleNamespace(run=run)
    frequencies, shapes = pybmodes_beam.moving(rotor, (1.0, 1.0), count=3, doubted=doubted, limit=10)
    assert requested_counts == ([5, 10] if doubted else [5])
    expected = [1.0, 2.0, 2.0] if doubted else [1.0, 2.0, 3.0]
    np.testing.assert_allclose(frequencies, 2 * np.pi * np.array(expected), rtol=1e-6)
    assert len(shapes) == 3


MANY = kinked(stations=61)
ROUND = uniform_blade("round", 1.0, 0.0, EA=1e6, GJ=1e3, EI_y=1.0, EI_z=1.0, mass=1.0)


@pytest.mark.parametrize(
    ("blade", "omega", "doubled"),
    [
        (ROUND, 0.0, True),
        (ROUND, 20.0, False),  # spin softening separates the pairs
        (WINDPACT, 0.0, False),
        (replace(ROUND, twist=np.array([0.0, 1.0])), 0.0, True),
        (
            replace(MANY, mass=MANY.mass * (1.0 + 0.1 * (np.arange(61) % 2))[:, None, None]),
            0.0,
            True,
        ),  # a coarse mesh would be too fine to be solved directly
    ],
)
def test_blades_with_double_frequencies_are_recognised(blade: Blade, omega: float, doubled: bool) -> None:
    assert pybmodes_beam._doubled(blade, omega, 6) == doubled


def test_both_modes_of_double_pairs_are_found() -> None:
    f = CODE.solve(ROUND, 0.0, 80, 6).frequencies
    np.testing.assert_allclose(f[::2], f[1::2], rtol=1e-9)
    np.testing.assert_allclose(f[::2], np.square(ROOTS[:3]), rtol=1e-6)


def test_iterated_answers_are_reproducible() -> None:
    """Above ``ITERATED`` freedoms the iteration begins at a random vector, unless it is given."""
    first, second = (CODE.solve(WINDPACT, 2.0, 80, 6) for _ in range(2))
    np.testing.assert_array_equal(first.frequencies, second.frequencies)
    np.testing.assert_array_equal(first.shapes, second.shapes)
