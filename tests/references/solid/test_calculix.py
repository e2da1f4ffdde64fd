"""CalculiX against exact beams, scikit-fem's solid, and the compressed model."""

import numpy as np
import pytest

from southwell.core.condense import exported, ties
from southwell.core.condense.compressed import mesh_from_segments
from southwell.core.condense.condensation import condense, segment
from southwell.core.condense.matrix_files import read_matrix, stored
from southwell.core.condense.segments import between
from southwell.core.effects import Effects
from southwell.core.solve import chain_modes, mesh_modes
from southwell.references.protocol.interface import CodeError
from southwell.references.solid import calculix, hexahedra
from southwell.references.solid.mesh import clamped_section, straight_bricks
from southwell.tests.support.solid_sections import clamped_free_to_contract, section_weights
from southwell.tests.support.solids import (
    HUB,
    LENGTH,
    ROOT,
    SIDE,
    SPEED,
    SQUARE,
    STEEL,
    at,
    mac,
    segments_in_place,
    square_bar,
    square_beam,
    timoshenko,
    twisted,
    twisted_modes,
)

pytestmark = pytest.mark.skipif(calculix.version() is None, reason=f"not installed: {calculix.HINT}")
needs_skfem = pytest.mark.skipif(hexahedra.version() is None, reason=f"not installed: {hexahedra.HINT}")


def test_square_cantilever() -> None:
    """Timoshenko's frequencies at zero speed; core's beam at 10 rad/s, without Coriolis forces."""
    bricks = square_bar(LENGTH, 60, start=HUB)
    at_rest = calculix.modes(bricks, SQUARE, 0.0, 6, clamped_free_to_contract(HUB))
    np.testing.assert_allclose(at_rest.frequencies, np.repeat(timoshenko(3), 2), rtol=2e-4)
    turning = calculix.modes(bricks, SQUARE, 10.0, 6, clamped_free_to_contract(HUB))
    beam = mesh_modes(square_beam(), 10.0, 80, 6, effects=calculix.EFFECTS)
    np.testing.assert_allclose(turning.frequencies, beam.frequencies, rtol=2e-4)
    assert (mac(turning, beam).diagonal() > 0.999).all()


@pytest.mark.slow
@needs_skfem
@pytest.mark.parametrize("omega", [0.0, SPEED])
def test_twisted_blade_three_ways(omega: float) -> None:
    """CalculiX against scikit-fem on one mesh (20 and 27 nodes per element), and the compressed model against both.

    The five lowest modes, the fifth is torsion. Without Coriolis forces, which CalculiX leaves out: 9e-5 of a
    frequency.
    """
    expected = calculix.modes(twisted(), STEEL, omega, 6, clamped_section(ROOT))
    actual = twisted_modes(omega, coriolis=False)
    np.testing.assert_allclose(expected.frequencies[:5], actual.frequencies[:5], rtol=1e-3)
    assert (mac(expected, actual).diagonal()[:5] > 0.99).all()
    chain = mesh_from_segments(segments_in_place(), at(ROOT))
    compressed = chain_modes(chain, omega, 6, effects=Effects(coriolis=False))
    np.testing.assert_allclose(compressed.frequencies[:5], expected.frequencies[:5], rtol=2.5e-3)
    assert (mac(expected, compressed).diagonal()[:5] > 0.99).all()


def tie(model: ties.FiniteElements, x: float, weights: np.ndarray) -> ties.Tie:
    nodes = np.flatnonzero(np.abs(model.points[:, 0] - x) < 1e-9)
    return ties.average(model, nodes, at(x), f"{x:g} m", np.kron(weights, np.eye(3)))


def test_segment_from_calculixs_matrices() -> None:
    """Its stored stiffness and mass, condensed by core: E A, E I to rounding, and the cantilever of 20 segments.

    ``*SUBSTRUCTURE GENERATE`` fixes the nodes that are not retained (``tests/references/defects``) and is not used.
    With uniform weights on its 8-node faces the segment would stretch by more than 10 % more.
    """
    length = LENGTH / 20
    bricks = square_bar(length, 4)
    places, nodes = calculix.numbered(bricks)
    steps = ["*STEP", "*FREQUENCY,SOLVER=MATRIXSTORAGE", "1", "*END STEP"]
    with calculix.run([*calculix.deck(places, nodes, SQUARE), *steps]) as folder:
        stiffness, mass = (stored(folder / f"blade.{kind}") for kind in ("sti", "mas"))
    model = exported.model(stiffness, dict(enumerate(nodes, 1)), mass, "calculix")
    weights = [section_weights(bricks, layer) for layer in (0, 4)]
    piece = segment(model, *(tie(model, x, w) for x, w in zip((0.0, length), weights, strict=True)))
    EA, EI = SQUARE.young * SIDE**2, SQUARE.young * SIDE**4 / 12
    f = np.linalg.inv(piece.stiffness)
    np.testing.assert_allclose(np.diagonal(f)[[0, 4, 5]], length / np.array([EA, EI, EI]), rtol=1e-8)
    frequencies = chain_modes(mesh_from_segments([piece] * 20, at(HUB)), 0.0, 6).frequencies
    np.testing.assert_allclose(frequencies, np.repeat(timoshenko(3), 2), rtol=2e-4)
    even = segment(model, *(tie(model, x, np.eye(len(weights[0]))) for x in (0.0, length)))
    assert np.linalg.inv(even.stiffness)[0, 0] > 1.1 * length / EA


@pytest.mark.parametrize("layer", [0, 1])
def test_section_weights_integrate_a_tapered_twisted_section(layer: int) -> None:
    """Area and second moments of chord × thickness, rotated by the twist."""
    x, chord, thick, twist = np.array([0.0, 1.0]), np.array([0.4, 0.3]), np.array([0.2, 0.1]), np.array([0.5, 0.1])
    bricks = straight_bricks(x, chord, thick, twist, across=(2, 3))
    places, nodes = calculix.numbered(bricks)
    at_layer = np.unique(places[2 * layer])[1:]
    W = section_weights(bricks, layer)
    y, z = nodes[at_layer, 1:].T
    c, t = chord[layer], thick[layer]
    along = y * np.cos(twist[layer]) + z * np.sin(twist[layer])
    assert W.sum() == pytest.approx(c * t, rel=1e-12)
    assert along @ W @ along == pytest.approx(c**3 * t / 12, rel=1e-12)
    assert y @ W @ y + z @ W @ z == pytest.approx(c * t * (c**2 + t**2) / 12, rel=1e-12)


def test_the_substructure_of_calculix_is_rejected() -> None:
    """CalculiX 2.20 fixes the nodes that are not retained instead of eliminating them: no coupling, no rigid motions.

    If a later version is correct, this segment equals that of its stored matrices.
    """
    length = LENGTH / 20
    bricks = square_bar(length, 4)
    places, nodes = calculix.numbered(bricks)
    ends = np.unique(places[[0, -1]])[1:]
    lines = [*calculix.deck(places, nodes, SQUARE), "*NSET,NSET=ENDS", *(str(k + 1) for k in ends), "*STEP"]
    lines += ["*SUBSTRUCTURE GENERATE", "*RETAINED NODAL DOFS,SORTED=NO", "ENDS,1,3"]
    lines += ["*SUBSTRUCTURE MATRIX OUTPUT,STIFFNESS=YES,OUTPUT FILE=USER DEFINED,FILE NAME=blade", "*END STEP"]
    with calculix.run(lines) as folder:
        model = exported.model(read_matrix(folder / "blade.mtx"), {int(k) + 1: nodes[k] for k in ends})
    assert len(model.directions) == 3 * len(ends)
    tied = [tie(model, x, section_weights(bricks, layer)) for x, layer in ((0.0, 0), (length, 4))]
    k = condense(model, tied).stiffness
    if calculix.version() == "2.20":
        assert not model.stiffness[: len(ends) // 2, -len(ends) // 2 :].nnz
        with pytest.raises(ties.CondensationError, match=r"as a rigid body causes forces.*a support left in the model"):
            between(k, ties.relative_pose(*tied), "substructure")
    else:
        f = np.linalg.inv(between(k, ties.relative_pose(*tied), "substructure"))
        assert f[0, 0] == pytest.approx(length / (SQUARE.young * SIDE**2), rel=1e-6)


def test_errors_name_the_cause(monkeypatch: pytest.MonkeyPatch) -> None:
    bricks = twisted(2, (2, 2))
    with pytest.raises(CodeError, match=r"across: \(1, 1\) elements"):
        calculix.modes(square_bar(1.0, 20, across=1), SQUARE, 0.0, 2, clamped_section(0.0))
    with pytest.raises(CodeError, match="clamp: fixes 0 displacements"):
        calculix.modes(bricks, STEEL, 0.0, 2, clamped_section(0.0))
    inside_out = straight_bricks(np.linspace(0.0, 1.0, 3), 0.1, -0.1, across=(2, 2))
    with pytest.raises(CodeError, match=r"ccx ended with .*\*ERROR in e_c3d: nonpositive jacobian"):
        calculix.modes(inside_out, STEEL, 0.0, 2, clamped_section(0.0))
    with pytest.raises(CodeError, match=r"ccx (ended|found)"):
        calculix.modes(bricks, STEEL, 1e5, 2, clamped_section(ROOT))
    monkeypatch.setenv("PATH", "")
    assert calculix.version() is None
    with pytest.raises(CodeError, match="ccx is not on the PATH: apt-get install calculix-ccx"):
        calculix.modes(bricks, STEEL, 0.0, 2, clamped_section(ROOT))
