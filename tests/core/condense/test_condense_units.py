"""Condensation does not depend on the units of mass, length and time: predicates, refusals and frequencies."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as ss
from hypothesis import given, settings
from hypothesis import strategies as st

from southwell.core.blade import uniform_blade
from southwell.core.condense import ties
from southwell.core.condense.compressed import mesh_from_segments
from southwell.core.condense.condensation import segment, segments_in_place
from southwell.core.condense.ties import CondensationError, FiniteElements
from southwell.core.element.discretize import discretize
from southwell.core.solve import chain_modes
from southwell.core.space import spatial as sp

from ...support.solids import at

Array = np.ndarray

ELEMENTS = 8
unit = st.floats(-3.0, 3.0).map(lambda power: 10.0**power)


def beam_model(kg: float = 1.0, m: float = 1.0, s: float = 1.0) -> FiniteElements:
    """A beam of 1 m with six freedoms at each node, for units of mass, length and time that are 1/kg, 1/m, 1/s of SI's."""
    blade = uniform_blade("beam", 1.0, 0.0, EA=1e6, GJ=80.0, EI_y=100.0, EI_z=300.0, mass=2.0, I_y=1e-4, I_z=3e-4)
    mesh = discretize(blade, ELEMENTS, "half_end", "body_fixed")
    n = ELEMENTS + 1
    K = np.zeros((6 * n, 6 * n))
    for k, x in enumerate(mesh.between):
        to_child = sp.adjoint(sp.inverse(x))
        rho = np.hstack([-to_child, np.eye(6)])  # of the element's ends, in the axes of its end b
        K[6 * k : 6 * k + 12, 6 * k : 6 * k + 12] += rho.T @ mesh.beams.stiffness[k] @ rho
    turning = np.tile(np.repeat([0, 1], 3), n)
    power = turning[:, None] + turning
    lumped = np.diagonal(mesh.lumps, axis1=1, axis2=2).ravel()
    return FiniteElements(
        "beam",
        m * np.repeat(mesh.nodes[:, :3, 3], 6, axis=0),
        np.tile(np.arange(6), n),
        ss.csr_array(kg / s**2 * float(m) ** power * K),
        kg * m ** (2.0 * turning) * lumped,
    )


def with_a_loose_part(model: FiniteElements, direction: int) -> FiniteElements:
    """The model with two further freedoms in the middle that hold only each other, apart from rounding."""
    stiffness = model.stiffness[[6 * (ELEMENTS // 2) + direction]].max()
    pair = stiffness * np.array([[1.0 + 4e-16, -1.0], [-1.0, 1.0]])
    middle = np.repeat(model.points[[6 * (ELEMENTS // 2)]], 2, axis=0)
    return FiniteElements(
        "beam",
        np.vstack([model.points, middle]),
        np.append(model.directions, [direction, direction]),
        ss.csr_array(ss.block_diag([model.stiffness, pair])),
        np.append(model.mass, [0.0, 0.0]),
    )


def refusal(model: FiniteElements, m: float) -> str:
    """The error, without numbers, of a condensation between the ends of the beam; empty if there is none."""
    ends = [ties.rigid(model, np.arange(6) + 6 * k, at(m * x), f"{x:g}") for k, x in ((0, 0.0), (ELEMENTS, 1.0))]
    try:
        segment(model, *ends)
    except CondensationError as error:
        return "".join(c for c in str(error) if c not in "0123456789.+-e")
    return ""


@settings(max_examples=15, deadline=None)
@given(kg=unit, m=unit, s=unit)
def test_frequencies_of_a_condensed_beam_do_not_depend_on_units(kg: float, m: float, s: float) -> None:
    frequencies = []
    for kilogram, metre, second in ((1.0, 1.0, 1.0), (kg, m, s)):
        model = beam_model(kilogram, metre, second)
        cuts = [ties.section(model, at(metre * x), "cut") for x in np.linspace(0.0, 1.0, ELEMENTS + 1)]
        parts = segments_in_place(model, cuts, np.tile(model.mass / ELEMENTS, (ELEMENTS, 1)))
        turning = chain_modes(mesh_from_segments(parts, at(0.0)), 5.0 / second, 6)
        frequencies.append(second * turning.frequencies)
    np.testing.assert_allclose(frequencies[1], frequencies[0], rtol=1e-9)


@settings(max_examples=30, deadline=None)
@given(kg=unit, m=unit, s=unit, direction=st.integers(0, 5), change=st.sampled_from(["none", "loose", "held", "bare"]))
def test_refusals_of_a_condensed_beam_do_not_depend_on_units(
    kg: float, m: float, s: float, direction: int, change: str
) -> None:
    """A loose part, a support that was left in the model, or no mass."""
    refusals = []
    for kilogram, metre, second in ((1.0, 1.0, 1.0), (kg, m, s)):
        model = beam_model(kilogram, metre, second)
        if change == "loose":
            model = with_a_loose_part(model, direction)
        elif change == "held":
            diagonal = np.zeros(len(model.mass))
            diagonal[6 * (ELEMENTS // 2) + direction] = 1e-2 * model.stiffness.diagonal()[direction]
            model = replace(model, stiffness=model.stiffness + ss.diags_array(diagonal))
        elif change == "bare":
            model = replace(model, mass=np.where(model.directions == direction, 0.0, model.mass))
        refusals.append(refusal(model, metre))
    assert refusals[0] == refusals[1]
    if change != "bare":
        assert bool(refusals[0]) == (change != "none"), refusals[0]


@pytest.mark.parametrize("metre", [1e-3, 1.0, 1e6])
def test_a_node_away_from_its_frame_ties_it_in_any_unit(metre: float) -> None:
    model = beam_model(m=metre)
    tie = ties.average(model, np.arange(6), at(2.0 * metre), "root")
    np.testing.assert_allclose(tie.mean @ tie.motion, np.eye(6), atol=1e-12 * max(metre, 1.0 / metre))
