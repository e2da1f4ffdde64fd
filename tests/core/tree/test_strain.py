"""The strain of a mechanism's beams: reported, refused where large, and only within the range of the strain measure."""

from dataclasses import replace

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.core.element import measures
from southwell.core.space import spatial as sp
from southwell.core.steady import equilibrium
from southwell.core.tree.spanning import compile_tree
from southwell.tests.support.closed_forms.linkages import ring

ARC = ring(0.0, 12).beams[0].beams
"""One element of a thin ring."""


def folded() -> np.ndarray:
    """The pose (4, 4) of an arc's end, pulled in along the arc by 1/G_xx: δ_x + G_xx δ_x² = 0."""
    delta = np.zeros(6)
    delta[0] = -1.0 / ARC.law.shortening[0, 0, 0]
    return sp.exp(ARC.law.eta[0] + delta)


def hanging(EA: float) -> mb.Mechanism:
    """10 kg on a massless beam, 2 m long, at 9.81 m/s²."""
    return mb.Mechanism(
        (mb.Body("mass", mb.inertia(10.0, 0.1)),),
        (mb.Joint("end", "elastic", "ground", "mass", mb.at(2.0)),),
        beams=(mb.Beam("ground", "mass", mb.straight_beam(2.0, EA=EA, GJ=1e3, EI_y=1e3, EI_z=1e3)),),
        gravity=(9.81, 0.0, 0.0),
    )


def test_a_folded_element_has_no_strain_and_is_out_of_range() -> None:
    x, none = folded()[None], np.zeros((1, 6))
    assert measures.relative_strain(ARC.law, x, none) == pytest.approx(0.0, abs=1e-12)
    assert measures.out_of_range(ARC.law, x).all()
    assert not measures.out_of_range(ARC.law, ARC.law.undeformed).any()
    assert not measures.out_of_range(replace(ARC.law, measure="body_fixed"), x).any()


@pytest.mark.slow
def test_a_guess_that_folds_a_beam_is_refused_and_the_state_named() -> None:
    """Before, the state found had frequencies several percent off."""
    tree = compile_tree(ring(0.0, 12))
    step = sp.log(sp.inverse(ARC.law.undeformed[0]) @ folded())
    guess = {f"j4.{name}": float(v) for name, v in zip(("x", "y", "z", "rx", "ry", "rz"), step, strict=True)}
    with pytest.raises(mb.MechanismError, match=r"without a guess, a steady state was found at j4.x = "):
        equilibrium.steady_state(tree, guess)


def test_a_beam_that_is_held_folded_is_refused() -> None:
    held = mb.Mechanism(
        (mb.Body("end", mb.inertia(1.0, 0.1)), mb.Body("other", mb.inertia(1.0, 0.1))),
        (mb.Joint("fixed", "fixed", "ground", "end", folded()), mb.Joint("pin", "revolute", "ground", "other")),
        coordinate_springs=(mb.CoordinateSpring("pin.rz", 1.0),),
        beams=(mb.Beam("ground", "end", ARC),),
    )
    with pytest.raises(
        mb.MechanismError, match=r"beam ground–end: .* beyond the range of its strain measure: divide it"
    ):
        mb.solve(held)


def test_the_strain_of_a_hanging_beam_is_mg_over_ea() -> None:
    solution = mb.solve(hanging(1e5))
    assert solution.strain == pytest.approx(98.1 / 1e5, rel=1e-9)


def test_large_strains_are_refused_unless_allowed() -> None:
    with pytest.raises(mb.MechanismError, match=r"beams: steady strain 39%: too large .* or allow large strains"):
        mb.solve(hanging(250.0))
    assert mb.solve(hanging(250.0), allow_large_strain=True).strain == pytest.approx(98.1 / 250.0, rel=1e-9)


def test_a_bushing_has_no_strain() -> None:
    soft = replace(
        hanging(1.0), beams=(mb.Beam("ground", "mass", mb.bushing(np.eye(4), np.diag([100.0] * 6)), at_a=mb.at(2.0)),)
    )
    assert mb.solve(soft).strain == 0.0
