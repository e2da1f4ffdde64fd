"""The Sandia rotor's model holds what its sources say, before anything is compared with it."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from southwell.cases.validation import sandia34
from southwell.cases.validation.sandia34 import Variation
from southwell.core import multibody as mb

from ...support import frames


@pytest.mark.parametrize("name", ["root", "transition", "centre"])
def test_the_blades_sections_are_of_one_material(name: str) -> None:
    """E/ρ of stretch and of bending about either axis is aluminium's: the mass centre is the tension centre."""
    s = sandia34.data()["sections"][name]
    axial = s["stiffness"][0] / s["mass"]
    bending = np.array(s["stiffness"][4:]) / s["inertia"][1:]
    np.testing.assert_allclose(axial, 69e9 / 2700, rtol=2e-3)
    np.testing.assert_allclose(bending, axial, rtol=2e-2)


@pytest.mark.parametrize("name", ["root", "transition", "centre"])
def test_stretch_without_bending_moment_needs_no_couple_at_the_mass_centre(name: str) -> None:
    """The tension line, along which a force only stretches, passes through the mass centre."""
    K, M = sandia34.section(name, Variation())
    tension = -K[0, 5] / K[0, 0]
    mass = -M[0, 5] / M[0, 0]
    assert tension == pytest.approx(mass, rel=1e-12)
    assert abs(tension) < 0.05


def test_members_meet_and_are_divided_as_the_source_says() -> None:
    members = {m.name: m for m in sandia34.members(Variation())}
    assert {m.name: len(m.sections) for m in members.values()} == {
        "tower": 22,
        "right": 22,
        "left": 22,
        **{f"{where} {side} strut": 3 for where in ("low", "high") for side in ("right", "left")},
    }
    for side in ("right", "left"):
        blade = members[side]
        assert [a for a, b in pairwise(blade.sections) if a != b] == ["root", "transition", "centre", "transition"]
        np.testing.assert_allclose(blade.nodes[[0, -1]], members["tower"].nodes[[0, -1]], atol=1e-12)
        for where in ("low", "high"):
            end = members[f"{where} {side} strut"].nodes[-1]
            assert np.linalg.norm(blade.nodes - end, axis=1).min() < 1e-12
    np.testing.assert_array_equal(members["left"].nodes, members["right"].nodes * [-1, 1, 1])


def by_direct_stiffness(halvings: int, count: int) -> np.ndarray:
    """Lowest frequencies at rest without gravity, every straight element halved so often, mass lumped at the nodes."""
    numbers: dict[tuple[float, ...], int] = {}

    def number(place: np.ndarray) -> int:
        return numbers.setdefault(tuple(np.round(place, 9) + 0.0), len(numbers))

    elements = []
    for m in sandia34.members(Variation()):
        for start, end, name in zip(m.nodes[:-1], m.nodes[1:], m.sections, strict=True):
            for a, b in pairwise(np.linspace(start, end, 2**halvings + 1)):
                KM = frames.element(a, b, m.second, *sandia34.section(name, Variation()))
                elements.append((number(a), number(b), *KM))
    base, top = number(np.zeros(3)), number(np.array([0.0, 0.0, sandia34.data()["height"]]))
    return frames.frequencies(elements, {base: [0, 1, 2, 3, 4, 5], top: [0, 1, 2, 3, 4]}, count)


@pytest.mark.slow
def test_at_rest_it_is_the_frame_of_the_direct_stiffness_method() -> None:
    """The frame's lumped mass makes an error of second order in the elements' length: extrapolated from two divisions."""
    coarse, fine = by_direct_stiffness(0, 8), by_direct_stiffness(1, 8)
    at_rest = replace(sandia34.mechanism(0.0), gravity=(0.0, 0.0, 0.0))
    np.testing.assert_allclose(mb.solve(at_rest, count=8).frequencies, fine + (fine - coarse) / 3.0, rtol=5e-4)
