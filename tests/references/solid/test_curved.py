"""The curved solid: its geometry and mass against core's frames and the mesh, its sections against closed forms."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from southwell.cases import data
from southwell.cases.input import library
from southwell.cases.judge.pairing import mac, weights
from southwell.core import solve
from southwell.core.blade import AXIAL, BEND_Y, BEND_Z, TORSION, Blade
from southwell.core.element.sections import frames
from southwell.core.modes import STATIONS
from southwell.core.space import spatial as sp
from southwell.references.protocol.interface import CodeError
from southwell.references.solid import calculix, calculix_blade, hexahedra, identified
from southwell.references.solid.curved import STUB, CurvedSolid, inside, layer, with_root_forces
from southwell.references.solid.known import ACROSS, CURVED, GLASS, recognised
from southwell.references.solid.materials import Material, Orthotropic
from southwell.references.solid.scikit_fem_blade import CODE, modes

from ...support import curved_solid

pytestmark = pytest.mark.skipif(hexahedra.version() is None, reason=f"not installed: {hexahedra.HINT}")

SHEAR = 2.1e11 / 2.6

STEEL = Orthotropic((2.1e11, 2.1e11, 2.1e11), (0.3, 0.3, 0.3), (SHEAR, SHEAR, SHEAR), 7850.0)

SIDE = 0.05

BAR = CurvedSolid(
    "bar", 2.0, 0.1, 0.0, 0.0, (0.0, 0.0), (SIDE, SIDE), (SIDE, SIDE), (1.0, 1.0), behind=0.7, below=0.5, material=STEEL
)
"""A straight square bar; its reference line lies a fifth of the side towards +y from its axis."""


def case() -> Blade:
    return library.load("curved-solid").variants[0].blade


def test_an_orthotropic_material_with_isotropic_constants_is_isotropic() -> None:
    expected = Material(2.1e11, 0.3, 7850.0).moduli
    np.testing.assert_allclose(replace(STEEL, angle=0.7).moduli, expected, atol=1e-12 * expected.max())


def test_compliance_of_turned_fibres() -> None:
    """1/E_x = c⁴/E1 + s⁴/E2 + c²s² (1/G12 − 2 ν12/E1), η_xy,x as of R. M. Jones, Mechanics of Composite Materials (1975)."""
    pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    C = np.array([[GLASS.moduli[i, j, k, m] for k, m in pairs] for i, j in pairs])
    S = np.linalg.inv(C)
    (E1, E2, _), nu, G, angle = GLASS.young, GLASS.poisson[0], GLASS.shear[0], GLASS.angle
    c, s = np.cos(angle), np.sin(angle)
    assert S[0, 0] == pytest.approx(c**4 / E1 + s**4 / E2 + c**2 * s**2 * (1 / G - 2 * nu / E1), rel=1e-12)
    first = 2 / E1 + 2 * nu / E1 - 1 / G
    second = 2 / E2 + 2 * nu / E1 - 1 / G
    assert S[0, 3] == pytest.approx(first * s * c**3 - second * s**3 * c, rel=1e-12)


def test_frames_are_those_of_core() -> None:
    """The axis of the case at its stations, and between them where core has a spline."""
    for s, allowed in ((case().stations, 1e-7), (np.linspace(0.1, 2.9, 23), 1e-6)):
        np.testing.assert_allclose(frames(case(), s)[:, :3, 3] - [0.3, 0, 0], CURVED.curve(s), atol=allowed)
        np.testing.assert_allclose(frames(case(), s)[:, :3, :3], CURVED.axes(s), atol=10 * allowed)


def test_section_masses_add_up_to_the_mass_of_the_mesh() -> None:
    """Mass and its first and second moments about the hub: Gauss points along the curve against scikit-fem's matrix."""
    t, w = np.polynomial.legendre.leggauss(12)
    s, w = 0.5 * CURVED.length * (1 + t), 0.5 * CURVED.length * w
    back = sp.adjoint(sp.inverse(sp.pose(CURVED.axes(s), CURVED.position(s))))
    total = np.einsum("s,sji,sjk,skl->il", w, back, identified.mass(CURVED, s), back)
    body = hexahedra.solid(CURVED.bricks(np.linspace(0, CURVED.length, 81), ACROSS), GLASS)
    m = hexahedra.mass(body)
    x = body.nodes
    zero = np.zeros(len(x))
    R = np.stack(
        [
            np.stack([np.ones(len(x)), zero, zero, zero, x[:, 2], -x[:, 1]], axis=1),
            np.stack([zero, np.ones(len(x)), zero, -x[:, 2], zero, x[:, 0]], axis=1),
            np.stack([zero, zero, np.ones(len(x)), x[:, 1], -x[:, 0], zero], axis=1),
        ]
    )
    meshed = np.einsum("inj,ink->jk", R, np.stack([m @ part for part in R]))
    size = np.sqrt(np.diag(meshed))
    np.testing.assert_allclose(total / np.outer(size, size), meshed / np.outer(size, size), atol=2e-5)


@cache
def square() -> np.ndarray:
    return identified.stiffness(BAR, np.array([1.0]), (4, 4))[0]


@pytest.mark.slow
def test_sections_of_a_square_bar() -> None:
    """E A, E I about the offset line, G J = 0.140577 G a⁴ (St Venant) about the centroid; offset couplings E A y."""
    E, G, area, y = 2.1e11, SHEAR, SIDE**2, -0.2 * SIDE
    S = np.linalg.inv(square())
    assert 1 / S[TORSION, TORSION] == pytest.approx(0.140577 * G * SIDE**4, rel=2e-3)
    assert 1 / S[BEND_Z, BEND_Z] == pytest.approx(E * SIDE**4 / 12, rel=1e-3)
    K = square()
    assert K[AXIAL, AXIAL] == pytest.approx(E * area, rel=1e-3)
    assert K[BEND_Y, BEND_Y] == pytest.approx(E * SIDE**4 / 12, rel=1e-3)
    assert K[BEND_Z, BEND_Z] == pytest.approx(E * (SIDE**4 / 12 + area * y**2), rel=1e-3)
    assert K[AXIAL, BEND_Z] == pytest.approx(-E * area * y, rel=1e-3)
    assert K[2, TORSION] / K[2, 2] == pytest.approx(y, rel=1e-3)


@pytest.mark.slow
def test_sections_do_not_depend_on_length_or_loads_of_neighbouring_slices() -> None:
    """The remainder falls by more than ten per chord of neighbours; twice as many elements change less than 5e-4."""

    def off(a: np.ndarray, b: np.ndarray) -> float:
        size = np.sqrt(np.diag(b))
        return float(np.abs((a - b) / np.outer(size, size)).max())

    middle = np.array([0.5 * CURVED.length])
    longest, *shorter = (identified.stiffness(CURVED, middle, ACROSS, stub)[0] for stub in (8.0, STUB, 3.0, 2.0))
    remainder = [off(K, longest) for K in shorter]
    assert remainder[0] < 1e-4
    assert (np.divide(remainder[1:], remainder[:-1]) > 10).all()
    fine = identified.stiffness(CURVED, middle, ACROSS, STUB, 12)[0]
    assert off(shorter[0], fine) < 5e-4


@pytest.mark.slow
def test_the_file_has_the_sections_of_the_solid() -> None:
    """Root, middle and tip, as its command writes them; every matrix is full."""
    blade = case()
    some = np.array([0, 20, 40])
    result = identified.stiffness(CURVED, blade.stations[some], ACROSS)
    size = np.sqrt(np.diagonal(result, axis1=1, axis2=2))
    scale = size[:, :, None] * size[:, None]
    np.testing.assert_allclose(blade.stiffness[some] / scale, result / scale, atol=1e-7)
    np.testing.assert_allclose(blade.mass, identified.mass(CURVED, blade.stations), atol=1e-12)
    assert len(blade.stations) == curved_solid.STATIONS
    text = (Path(next(iter(data.__path__))) / "curved-solid.toml").read_text(encoding="utf-8")
    assert text.startswith(curved_solid.head(CURVED))
    assert (np.abs(result / scale) > 1e-3).all()
    assert (np.abs((result / scale)[:, TORSION, BEND_Y]) > 0.3).all()


def test_the_root_transmits_the_wrench_at_the_tip() -> None:
    """The tractions at the root have the resultants of unit forces and moments about the root."""
    force = inside(CURVED, 0.0, ACROSS).force
    position = CURVED.bricks(np.array([0.0, 0.01]), ACROSS)
    nodes = position.lattice()[0].reshape(-1, 3) - [CURVED.hub_radius, 0, 0]
    resultant = np.concatenate([force.sum(axis=1), np.cross(nodes.T[..., None], force, axis=0).sum(axis=1)])
    np.testing.assert_allclose(resultant, np.eye(6), atol=1e-7)


@pytest.mark.slow
def test_a_held_bar_has_timoshenkos_frequencies() -> None:
    """A square bar of Poisson's ratio 0.3, whose full clamp would be too stiff: core with the sections of ``square``."""
    frequencies = modes(BAR, 0.0, 20, 4).frequencies
    mass = identified.mass(BAR, np.array([0.0, 2.0]))
    beam = Blade("bar", np.array([0.0, 2.0]), np.repeat(square()[None], 2, axis=0), mass, np.zeros(2), hub_radius=0.1)
    np.testing.assert_allclose(frequencies, solve.mesh_modes(beam, 0.0, 60, 4).frequencies, rtol=3e-4)


# ------------------------------------------------------------------------------------------------------------ the adapter


@pytest.mark.slow
def test_the_case_is_recognised_by_its_axis_and_sections() -> None:
    blade = case()
    assert recognised(blade) == (CURVED, "")
    assert CODE.unsupported(replace(blade, name="other")) is None


def turned(blade: Blade, i: int, j: int) -> Blade:
    """The sign of a coupling of all sections changed."""
    stiffness = blade.stiffness.copy()
    stiffness[:, i, j] = stiffness[:, j, i] = -stiffness[:, j, i]
    return replace(blade, stiffness=stiffness)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda b: turned(b, TORSION, BEND_Y), r"stiffness: entry \(3, 4\).* differs by .* identified from the solid"),
        (lambda b: replace(b, stiffness=1.01 * b.stiffness), "stiffness: entry"),
        (lambda b: replace(b, mass=1.001 * b.mass), "mass: entry .* differs by 1.0e-03"),
        (lambda b: replace(b, curve=b.curve * [1, -1, 1]), "no solid with this axis is known"),
        (lambda b: replace(b, twist=-b.twist), "no solid with this axis is known"),
        (lambda b: replace(b, pitch=0.1), "pitch: this solid has none"),
        (lambda b: replace(b, tip_mass=np.eye(6)), "tip mass: this solid has none"),
    ],
    ids=["coupling", "stiffness", "mass", "sweep", "twist", "pitch", "tip mass"],
)
def test_a_blade_that_is_not_the_solids_beam_is_declined(change, reason: str) -> None:
    with pytest.raises(CodeError, match=reason):
        CODE.solve(change(case()), 0.0, 10, 2)


@cache
def whole(omega: float) -> np.ndarray:
    return modes(CURVED, omega, 40, 6).frequencies


@pytest.mark.slow
@pytest.mark.parametrize("omega", [0.0, 10.0])
def test_frequencies_of_beam_and_solid_agree(omega: float) -> None:
    """Six modes within 0.1 %: the difference that remains is that of beam theory."""
    np.testing.assert_allclose(solve.mesh_modes(case(), omega, 80, 6).frequencies, whole(omega), rtol=1e-3)


@pytest.mark.slow
@pytest.mark.skipif(calculix.version() is None, reason=f"not installed: {calculix.HINT}")
@pytest.mark.parametrize("omega", [0.0, 10.0])
def test_calculix_finds_the_same_modes_of_the_whole_solid(omega: float) -> None:
    """One solid, two programs; CalculiX's material turns from layer to layer, and it has no Coriolis forces."""
    bricks, root = with_root_forces(CURVED, 20, ACROSS)
    sections = [
        (layer(bricks, 2 * k), position) for k, position in enumerate(CURVED.position(STATIONS * CURVED.length))
    ]
    actual = hexahedra.modes(bricks, CURVED.material, omega, 6, root, coriolis=False, sections=sections)
    expected = calculix_blade.CODE.solve(case(), omega, 20, 6)
    np.testing.assert_allclose(expected.frequencies, actual.frequencies, rtol=3e-4)
    assert (np.diag(mac(actual.shapes, expected.shapes, weights(case()))) > 0.999).all()


@pytest.mark.slow
def test_a_full_clamp_is_stiffer_than_a_beams() -> None:
    """Without warping and contraction at the root, every mode is higher by two to three times the target."""
    bricks = CURVED.bricks(np.linspace(0.0, CURVED.length, 41), ACROSS)
    places = CURVED.position(STATIONS * CURVED.length)
    sections = [(layer(bricks, 4 * k), position) for k, position in enumerate(places)]
    root = layer(bricks, 0)

    def clamp(nodes: np.ndarray) -> np.ndarray:
        return np.repeat(np.isin(np.arange(len(nodes)), root)[:, None], 3, axis=1)

    stiffer = hexahedra.modes(bricks, GLASS, 0.0, 6, clamp, sections=sections).frequencies / whole(0.0) - 1.0
    assert ((stiffer > 2e-3) & (stiffer < 3.2e-3)).all(), stiffer


@pytest.mark.slow
def test_frequencies_converge_with_the_fourth_power() -> None:
    f = np.array([modes(CURVED, 0.0, n, 6).frequencies for n in (10, 20, 40)])
    np.testing.assert_allclose(np.log2((f[0] - f[1]) / (f[1] - f[2])), CODE.order, atol=0.2)


@pytest.mark.slow
@pytest.mark.parametrize(
    "change",
    [
        lambda b: turned(b, TORSION, BEND_Y),
        lambda b: turned(b, AXIAL, BEND_Z),
        lambda b: replace(b, curve=b.curve * [1, -1, 1]),
        lambda b: replace(b, curve=b.curve * [1, 1, -1]),
        lambda b: replace(b, twist=-b.twist),
    ],
    ids=["bend–twist coupling", "extension–bending coupling", "sweep", "prebend", "twist"],
)
def test_a_wrong_sign_in_the_beam_is_detected_by_the_solid(change) -> None:
    off = solve.mesh_modes(change(case()), 10.0, 80, 6).frequencies / whole(10.0) - 1.0
    assert np.abs(off).max() > 5e-3, off


@pytest.mark.nightly
def test_the_difference_from_the_beam_falls_with_slenderness() -> None:
    """The sixth mode of half as slender a solid: the difference grows with the square of chord over length."""
    chord, thick = ((2.0 * a, 2.0 * b) for a, b in (CURVED.chord, CURVED.thickness))
    stout = replace(CURVED, chord=chord, thickness=thick)
    off = [
        modes(solid, 0.0, 40, 6).frequencies[5] / solve.mesh_modes(beam, 0.0, 60, 6).frequencies[5] - 1
        for solid, beam in ((CURVED, case()), (stout, curved_solid.beam(stout, 21)))
    ]
    assert 3.0 < off[1] / off[0] < 5.0, off
