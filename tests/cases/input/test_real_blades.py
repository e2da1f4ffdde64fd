"""The real blades that come with the cases: what is published of them, and what a table can say besides."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import trapezoid

from southwell.cases.input import library
from southwell.cases.input.blades import STEP, offset, stepped
from southwell.core.blade import Blade, BladeError, section_mass
from southwell.core.effects import Effects
from southwell.core.solve import modes
from southwell.core.space import spatial as sp


def blade(name: str) -> Blade:
    case, _, _ = name.partition("/")
    return next(v.blade for v in library.load(case).variants if v.name == name)


def moments(b: Blade) -> list[float]:
    """Mass, and first and second moment about the root."""
    s = np.linspace(0.0, b.length, 200_001)
    mass = np.interp(s, b.stations, b.mass[:, 0, 0])
    return [float(trapezoid(mass * s**k, s)) for k in range(3)]


def test_the_nrel_blade_has_its_published_mass_and_moments() -> None:
    """17,740 kg, 363,231 kg m, 11,776,047 kg m² (TP-500-38060, table 2-2), by a sum over stations: 1 % from the integral."""
    np.testing.assert_allclose(moments(blade("nrel-5mw")), [17740.0, 363231.0, 11776047.0], rtol=0.01)


def test_bmodes_printed_frequencies_belong_to_its_sampling() -> None:
    """Its own blade within 0.7 %, the blade of the table 1.5 to 4.5 % higher: the sampling, not the elements, makes that."""
    printed = np.array([1.7517, 1.9444, 4.1912, 6.3492, 8.2913])
    own, table = (
        modes(blade(f"windpact-1.5/{name}"), 2 * np.pi, 100, 5, effects=Effects(coriolis=False)).frequencies
        / (2 * np.pi)
        for name in ("bmodes", "offset")
    )
    np.testing.assert_allclose(own, printed, rtol=7e-3)
    assert ((table / own - 1) > 0.014).all()
    assert ((table / own - 1) < 0.045).all()


def test_an_offset_mass_is_a_mass_ahead() -> None:
    """A point mass at y = a: turning about x lifts it, turning about z moves it along −x."""
    (mass,) = offset(section_mass(2.0), np.array([0.3]))
    momentum = mass @ [0, 0, 0, 1.0, 0, 1.0]
    np.testing.assert_allclose(momentum[:3], [-0.6, 0.0, 0.6])
    np.testing.assert_allclose(np.diagonal(mass)[3:], [0.18, 0.0, 0.18])


def test_pieces_are_as_their_middles_are() -> None:
    base = blade("windpact-1.5/offset")
    b = stepped(base, np.array([0.0, 0.5, 1.0]))
    assert len(b.stations) == 4
    assert np.diff(b.stations)[1] == pytest.approx(STEP * base.length)
    for k, at in ((0, 0.25), (1, 0.25), (2, 0.75), (3, 0.75)):
        expected = np.interp(at * base.length, base.stations, base.stiffness[:, 4, 4])
        assert b.stiffness[k, 4, 4] == pytest.approx(expected)


@pytest.mark.parametrize("ends", [[0.0, 0.5], [0.1, 1.0], [0.0, 0.6, 0.5, 1.0]])
def test_pieces_must_cover_the_blade(ends) -> None:
    with pytest.raises(BladeError, match="pieces"):
        stepped(blade("windpact-1.5/offset"), np.array(ends))


def test_offsets_couple_and_centring_uncouples() -> None:
    coupled, centred = blade("windpact-1.5/offset"), blade("windpact-1.5/centred")
    shift = sp.adjoint(sp.pose(np.eye(3), np.array([0.0, 0.22, 0.0])))
    moved = replace(coupled, mass=np.swapaxes(shift, -1, -2) @ coupled.mass @ shift)
    np.testing.assert_allclose(moved.mass[-1], centred.mass[-1], atol=1e-12)
