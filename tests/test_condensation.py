"""From solids to the compressed model: ties, static condensation, segments, and the chain they make.

Sources of truth: St Venant's bars, Timoshenko's exact frequencies, closed forms of the discretisation, and the whole solid.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as ss
from matplotlib.collections import PolyCollection

from southwell.core import linearize as lz
from southwell.core import sections, segments, ties
from southwell.core import spatial as sp
from southwell.core.chain_mechanism import mechanism
from southwell.core.compressed import chain_from_segments, chain_modes
from southwell.core.condensation import condense, segment
from southwell.core.condensation import segments_in_place as in_place
from southwell.core.mechanism import inertia
from southwell.core.segments import between, segment_from_matrix
from southwell.core.solve import modes
from southwell.core.ties import CondensationError, FiniteElements
from southwell.references import solid
from southwell.references.solid_mesh import blade
from southwell.reports.condensation import stages
from southwell.reports.style import save
from southwell.tests.beams import PARK
from southwell.tests.solids import (
    HUB,
    LENGTH,
    ROOT,
    SIDE,
    SPAN,
    SPEED,
    SQUARE,
    STEEL,
    at,
    cuts,
    mac,
    segments_apart,
    segments_in_place,
    square_bar,
    square_beam,
    timoshenko,
    twisted,
    twisted_model,
    twisted_modes,
)

needs_skfem = pytest.mark.skipif(solid.version() is None, reason=f"not installed: {solid.HINT}")

Array = np.ndarray


# What a matrix says


def beam_segment(length: float, blade=PARK) -> tuple[Array, Array, Array]:
    """12×12 of a uniform beam, its 6×6 and the pose of b seen from a."""
    part = replace(blade, stations=np.array([0.0, length]), curve=np.zeros((0, 3)))
    rest = at(length)
    k = np.linalg.inv(sections.integrate(part, part.stations).flexibility[0])
    D = np.concatenate([-np.eye(6), sp.adjoint(rest)], axis=1)
    return D.T @ k @ D, k, rest


def test_the_textbook_beam_is_its_complex_stiffness() -> None:
    """Przemieniecki 1968, table 5.2: 12 E I/l³, −6 E I/l², 4 E I/l, 2 E I/l, E A/l, G J/l."""
    length, EA, EI, GJ = 0.5, 7e10 * 4e-4, 7e10 * 2e-7, 7e10 / 2.6 * 4e-7
    k12, k, rest = beam_segment(length)
    y = [1, 5, 7, 11]
    bending = EI / length**3 * np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]], float)
    unit = np.diag([1, length, 1, length])
    np.testing.assert_allclose(k12[np.ix_(y, y)], unit @ bending @ unit, rtol=1e-9)
    np.testing.assert_allclose([k12[0, 6], k12[3, 9]], [-EA / length, -GJ / length], rtol=1e-9)
    np.testing.assert_allclose(between(k12, rest, "beam"), k, rtol=1e-9, atol=1e-9 * np.abs(k).max())


def test_the_body_of_a_uniform_beam_rides_as_its_cubic_does() -> None:
    """Mean of w = v (3t² − 2t³) + θ l (t³ − t²): displacement v/2 − θ l/12, rotation 6 v/5 l − θ/10 (by least squares)."""
    length = 0.5
    k12, _, rest = beam_segment(length)
    ride = segment_from_matrix(k12, rest, np.eye(6)).ride
    b = sp.adjoint(sp.inverse(rest))  # ρ is seen at a's origin; the cubic's v and θ are at b
    ride = ride @ np.linalg.inv(b)
    centre = at(-0.5 * length)
    ride = sp.adjoint(centre) @ ride  # at the middle
    np.testing.assert_allclose(ride[np.ix_([1, 5], [1, 5])], [[0.5, -length / 12], [1.2 / length, -0.1]], rtol=1e-8)
    np.testing.assert_allclose(ride[np.ix_([0, 3], [0, 3])], 0.5 * np.eye(2), atol=1e-8)


def uniform_chain(n: int, omega: float = 0.0, count: int = 8) -> Array:
    length = PARK.length / n
    k12, _, rest = beam_segment(length)
    mass = 1.2 * length
    polar, cross = 1.2 * length * 1e-3, mass * (5e-4 + length**2 / 12)
    body = inertia(mass, [polar, cross, cross], [length / 2, 0, 0])
    chain = chain_from_segments([segment_from_matrix(k12, rest, body)] * n, at(PARK.hub_radius))
    return chain_modes(chain, omega, count).frequencies


def test_bending_converges_with_fourth_order() -> None:
    """From one rigid body a segment, to core's own converged beam; turning too, 20 segments leave 5e-6."""
    exact = modes(PARK, 0.0, 160, 4).frequencies
    errors = [np.abs(uniform_chain(n)[:4] / exact - 1) for n in (10, 20)]
    assert (np.log2(errors[0] / errors[1]) > 3.7).all()
    np.testing.assert_allclose(uniform_chain(20, 10.0)[:4], modes(PARK, 10.0, 160, 4).frequencies, rtol=1e-5)


def test_torsion_is_that_of_masses_in_the_middle() -> None:
    """A shaft of n segments whose discs move as the mean of their ends: ω = (2/l) √(GJ/I_x) tan(β l/2), β = (k − ½)π/L."""
    n = 20
    length = PARK.length / n
    k12, _, rest = beam_segment(length)
    body = inertia(1.2 * length, [1e2 * length, 60.0, 60.0], [length / 2, 0, 0])
    found = chain_modes(chain_from_segments([segment_from_matrix(k12, rest, body)] * n, np.eye(4)), 0.0, 20).frequencies
    beta = (np.arange(1, 4) - 0.5) * np.pi / PARK.length
    exact = 2 / length * np.sqrt(7e10 / 2.6 * 4e-7 / 1e2) * np.tan(beta * length / 2)
    nearest = np.abs(found[:, None] / exact - 1).min(0)
    assert nearest.max() < 1e-6


# Ties


def freedoms_of_a_section(seed: int = 3, count: int = 7) -> FiniteElements:
    """Nodes scattered on a plane, each with three displacements and three rotations; springs to nowhere."""
    rng = np.random.default_rng(seed)
    points = np.column_stack([np.full(count, 0.4), rng.normal(size=(count, 2))])
    n = 6 * count
    every = FiniteElements(
        "section", np.repeat(points, 6, axis=0), np.tile(np.arange(6), count), ss.csr_array(ss.eye_array(n)), np.ones(n)
    )
    return every


def somewhere() -> Array:
    return sp.exp(np.array([[0.4, 0.2, -0.3, 0.3, -0.5, 0.7]]))[0]


@pytest.mark.parametrize("kind", ["rigid", "average"])
def test_a_tie_follows_its_frame_and_balances_its_wrench(kind: ties.Kind) -> None:
    """Moved as a rigid body the section's mean is the frame's twist; forces of a unit wrench have that wrench."""
    model = freedoms_of_a_section()
    every = np.arange(len(model.directions))
    make = ties.rigid if kind == "rigid" else ties.average
    tie = make(model, every, somewhere(), "section")
    np.testing.assert_allclose(tie.mean @ tie.motion, np.eye(6), atol=1e-12)
    assert (model.directions[tie.freedoms] < 3).all() == (kind == "average")


def test_rigid_motion_is_the_frames_own_screw() -> None:
    """Turning the frame by a finite small twist moves points as ``motion`` says, to second order."""
    model, frame = freedoms_of_a_section(), somewhere()
    twist = 1e-5 * np.array([1.0, -2.0, 0.5, 0.3, 0.8, -1.1])
    moved = frame @ sp.exp(twist[None])[0] @ sp.inverse(frame)
    points = model.points[::6]
    displaced = points @ moved[:3, :3].T + moved[:3, 3] - points
    linear = (ties.motion(model.points, model.directions, frame) @ twist).reshape(-1, 2, 3)
    np.testing.assert_allclose(linear[:, 0], displaced, atol=1e-8)
    np.testing.assert_allclose(linear[:, 1], np.tile(frame[:3, :3] @ twist[3:], (len(points), 1)), atol=1e-15)


# Solid segments


def tied(model: FiniteElements, kind: ties.Kind, *places: float) -> list[ties.Tie]:
    return [ties.section(model, at(x), f"{x:g} m", kind) for x in places]


@needs_skfem
def test_average_ties_give_st_venants_tension_and_bending_at_any_length() -> None:
    """EA and EI to rounding for a piece as short as it is wide; shear within 3 % of Cowper's coefficient."""
    for length, layers in ((SIDE, 2), (4 * SIDE, 8)):
        model = solid.finite_elements(square_bar(length, layers), SQUARE)
        f = np.linalg.inv(segment(model, *tied(model, "average", 0.0, length)).stiffness)
        EA, EI = SQUARE.young * SIDE**2, SQUARE.young * SIDE**4 / 12
        np.testing.assert_allclose(np.diagonal(f)[[0, 4, 5]], length / np.array([EA, EI, EI]), rtol=1e-8)
        beam = square_beam()
        slip = f[1, 1] - length**3 / 3 / EI
        assert slip == pytest.approx(length / beam.stiffness[0, 1, 1], rel=0.05)


@needs_skfem
def test_the_body_has_the_segments_mass_centre_and_inertia() -> None:
    a, b, length = SIDE, SIDE, 0.3
    mass = SQUARE.density * a * b * length
    moments = mass / 12 * np.array([a * a + b * b, length**2 + a * a, length**2 + b * b])
    model = solid.finite_elements(square_bar(length, 2), SQUARE)
    found = segment(model, *tied(model, "average", 0.0, length)).inertia
    exact = inertia(mass, moments, [length / 2, 0, 0])
    np.testing.assert_allclose(found, exact, atol=1e-12 * mass)


CHORD, THICK, LAYER = 0.08, 0.02, 0.01


def st_venant() -> float:
    """G J of the rectangle: J = c t³/3 (1 − 192 t/(π⁵ c) Σ tanh(nπc/2t)/n⁵), n odd (Timoshenko and Goodier, art. 109)."""
    n = np.arange(1, 60, 2)
    series = np.sum(np.tanh(n * np.pi * CHORD / (2 * THICK)) / n**5.0)
    return SQUARE.lame[1] * CHORD * THICK**3 / 3 * (1 - 192 / np.pi**5 * THICK / CHORD * series)


def torsion(length: float, how: str) -> float:
    """G J that a piece of the rectangular bar shows, relative to St Venant's; in place: between neighbours of one chord."""
    layers = round(length / LAYER)
    margin = round(CHORD / LAYER) if how == "in place" else 0
    x = np.linspace(-margin * LAYER, (layers + margin) * LAYER, layers + 2 * margin + 1)
    bricks = blade(x, CHORD, THICK, across=(6, 2))
    model = solid.finite_elements(bricks, SQUARE)
    if how == "in place":
        ends = tied(model, "average", x[0], 0.0, length, x[-1])
        bounds = np.array([0, margin, margin + layers, 2 * margin + layers])
        piece = in_place(model, ends, solid.lumped_by_part(bricks, SQUARE, bounds))[1]
    else:
        piece = segment(model, *tied(model, "rigid" if how == "rigid" else "average", 0.0, length))
    return length / np.linalg.inv(piece.stiffness)[3, 3] / st_venant()


@needs_skfem
def test_rigid_ties_restrain_warping_and_average_ties_give_way() -> None:
    """4:1 rectangle. One chord long: rigid + 62 %, average − 16 %; in place it is St Venant's.

    What an end costs hardly depends on the length: ends lose (rigid) or add (average) the same piece of bar at one chord and
    at two. Rigid ends take less than the 2 √(E C_w/GJ) of Vlasov's theory, C_w = c³t³/144, in which sections do not shear.
    """
    found = {how: np.array([torsion(k * CHORD, how) for k in (1, 2)]) for how in ("rigid", "average", "in place")}
    np.testing.assert_allclose(found["in place"], 1.0, atol=5e-3)
    assert (found["rigid"] > 1.2).all()
    assert (found["average"] < 0.95).all()
    lost = {how: np.array([1, 2]) * (1 - 1 / values) for how, values in found.items()}
    vlasov = 2 * np.sqrt(SQUARE.young * CHORD**3 * THICK**3 / 144 / st_venant()) / CHORD
    assert 0.7 * vlasov < lost["rigid"][1] < vlasov
    for how in ("rigid", "average"):
        assert lost[how][0] == pytest.approx(lost[how][1], rel=0.1)


# The paper's cantilever as a solid


def cantilever(kind: ties.Kind) -> segments.Segment:
    length = LENGTH / 20
    model = solid.finite_elements(square_bar(length, 4), SQUARE)
    return segment(model, *tied(model, kind, 0.0, length))


@needs_skfem
def test_condensed_cantilever_against_timoshenko() -> None:
    """20 segments, three frequencies in each plane: exact characteristic equation at rest, core's beam at 10 rad/s."""
    chain = chain_from_segments([cantilever("average")] * 20, at(HUB))
    at_rest = chain_modes(chain, 0.0, 6)
    np.testing.assert_allclose(at_rest.frequencies, np.repeat(timoshenko(3), 2), rtol=2e-4)
    turning, beam = chain_modes(chain, 10.0, 6), modes(square_beam(), 10.0, 80, 6)
    np.testing.assert_allclose(turning.frequencies, beam.frequencies, rtol=2e-4)
    assert (mac(turning, beam).diagonal() > 0.9999).all()


@needs_skfem
def test_rigid_ties_miss_the_target_on_the_cantilever() -> None:
    """They stop Poisson's contraction at each of the 21 sections: a per cent too stiff, ten times the target."""
    found = chain_modes(chain_from_segments([cantilever("rigid")] * 20, at(HUB)), 0.0, 6).frequencies
    assert (found / np.repeat(timoshenko(3), 2) - 1 > 0.01).all()


@needs_skfem
def test_an_exported_segment_needs_only_its_matrix_and_its_body() -> None:
    """The 12×12 and the inertia alone, as from another code: the body rides as a uniform beam's, all but the same."""
    whole = cantilever("average")
    D = np.concatenate([-np.eye(6), sp.adjoint(whole.rest)], axis=1)
    alone = segment_from_matrix(D.T @ whole.stiffness @ D, whole.rest, whole.inertia)
    np.testing.assert_allclose(alone.stiffness, whole.stiffness, rtol=1e-9, atol=1e-9 * np.abs(whole.stiffness).max())
    found, expected = (chain_modes(chain_from_segments([s] * 20, at(HUB)), 10.0, 6).frequencies for s in (alone, whole))
    np.testing.assert_allclose(found, expected, rtol=1e-5)


# The tapered, twisted blade


@needs_skfem
@pytest.mark.parametrize("omega", [0.0, SPEED])
def test_condensed_blade_against_the_whole_solid(omega: float) -> None:
    """20 segments in place, five lowest frequencies (the fifth is torsion) within 0.5 %, mode by mode."""
    found = chain_modes(chain_from_segments(segments_in_place(), at(ROOT)), omega, 6)
    whole = twisted_modes(omega)
    np.testing.assert_allclose(found.frequencies[:5], whole.frequencies[:5], rtol=2e-3)
    assert (mac(found, whole).diagonal()[:5] > 0.999).all()


@needs_skfem
def test_segments_apart_err_to_either_side() -> None:
    """Segments shorter than their chord: rigid ties miss by per cents, most in torsion; average ties are a little soft."""
    whole = twisted_modes(0.0).frequencies[:5]
    rigid, average = (
        chain_modes(chain_from_segments(segments_apart(kind), at(ROOT)), 0.0, 8).frequencies
        for kind in ("rigid", "average")
    )
    assert (rigid[:4] / whole[:4] - 1 > 0.02).all()
    assert (average[:4] / whole[:4] - 1 < 0).all()
    assert (average[:4] / whole[:4] - 1 > -0.01).all()
    assert np.abs(average[:5] / whole - 1).max() > 0.05  # torsion


@needs_skfem
@pytest.mark.parametrize(
    ("omega", "shift", "turn", "within"),
    [(0.0, 0.02, 1.0, 1e-7), (SPEED, 0.02, 0.0, 1e-6), (SPEED, 0.0, 0.1, 1e-5)],
    ids=["at rest, anyhow", "turning, shifted", "turning, turned"],
)
def test_sections_frames_are_free_to_choose(omega: float, shift: float, turn: float, within: float) -> None:
    """Shifted by 20 mm and turned: the same frequencies. Turned much, the straight way from frame to frame is a screw's."""
    x = twisted().corners[cuts(), 0, 0, 0]
    rng = np.random.default_rng(5)
    places = [np.concatenate([[0.0], shift * rng.normal(size=2), turn * rng.normal(size=3)]) for _ in x]
    frames = [at(x[0]), *(at(v) @ sp.exp(p[None])[0] for v, p in zip(x[1:], places[1:], strict=True))]
    model = twisted_model()
    on = [np.flatnonzero(np.abs(model.points[:, 0] - v) < 1e-9) for v in x]
    ties_ = [(ties.average if k else ties.rigid)(model, on[k], f, f"{k}") for k, f in enumerate(frames)]
    masses = solid.lumped_by_part(twisted(), STEEL, cuts())
    found = chain_modes(chain_from_segments(in_place(model, ties_, masses), at(ROOT)), omega, 5).frequencies
    parallel = chain_modes(chain_from_segments(segments_in_place(), at(ROOT)), omega, 5).frequencies
    np.testing.assert_allclose(found, parallel, rtol=within)


@needs_skfem
def test_the_compressed_model_is_a_mechanism_like_any_other() -> None:
    chain = chain_from_segments(segments_in_place(), at(ROOT))
    dense = lz.modes(lz.linearize(mechanism(chain, SPEED)), 6).frequencies
    np.testing.assert_allclose(dense, chain_modes(chain, SPEED, 6).frequencies, rtol=1e-9)


@needs_skfem
def test_nothing_of_the_blades_mass_is_lost() -> None:
    bodies, where = segments_in_place(), at(ROOT)
    total = np.zeros((6, 6))
    for s in bodies:
        lever = sp.adjoint(sp.inverse(where))
        total += lever.T @ s.inertia @ lever
        where = where @ s.rest
    model = twisted_model()
    R = ties.motion(model.points, model.directions, np.eye(4))
    np.testing.assert_allclose(total, (R.T * model.mass) @ R, atol=1e-12 * total.max())
    assert where[0, 3] == pytest.approx(ROOT + SPAN)


# The picture


def test_the_three_stages_in_one_picture(tmp_path: Path) -> None:
    """Faces of the mesh, 5 sections, 4 boxes and 4 springs; a box's outline is the segment's own, and bytes do not vary."""
    mass, side, length = 3.0, 0.2, 0.5
    body = inertia(
        mass, mass / 12 * np.array([2 * side**2, side**2 + length**2, side**2 + length**2]), [length / 2, 0, 0]
    )
    k12, _, rest = beam_segment(length)
    pieces = [segment_from_matrix(k12, rest, body)] * 4
    bricks = blade(np.linspace(1.0, 3.0, 9), side, side, across=(3, 2))
    figure = stages(bricks, 2 * np.arange(5), pieces, at(1.0), 999)
    mesh, cut, compressed = (
        [np.array([p.vertices for p in c.get_paths()]) for c in a.collections if isinstance(c, PolyCollection)]
        for a in figure.axes
    )
    assert [len(faces) for faces in mesh] == [2 * (8 * 3 + 8 * 2 + 3 * 2)]
    assert [faces.shape[1] for faces in cut] == [11] * 5  # 10 corners round, closed
    assert [len(faces) for faces in compressed] == [6] * 4
    apart = [np.ptp([faces[..., 0].mean() for faces in drawn]) for drawn in (cut, compressed)]
    assert apart[1] == pytest.approx(3 / 4 * apart[0], rel=1e-9)
    edges = np.diff(compressed[0], axis=1).reshape(-1, 2)
    for corner in (3, 8):  # along y and z from the first
        assert np.abs(edges - (cut[0][0, corner] - cut[0][0, 0])).sum(axis=1).min() < 1e-9
    assert {t.get_text() for t in figure.texts} == {
        "Finite element model: 48 hexahedra, 999 freedoms",
        "5 sections, each tied to a frame",
        "Compressed model: 4 rigid bodies, 4 complex stiffness elements, 24 freedoms",
    }
    for name in ("one.svg", "two.svg"):
        save(stages(bricks, 2 * np.arange(5), pieces, at(1.0), 999), tmp_path / name)
    assert (tmp_path / "one.svg").read_bytes() == (tmp_path / "two.svg").read_bytes()


# Bad input


def bad(change) -> tuple[Array, Array]:
    k, _, rest = beam_segment(0.5)
    return change(k.copy()), rest


def put(k: Array, entry: tuple[int, int], value: float) -> Array:
    k[entry] = value
    return k


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda k: k[:11, :11], r"shape \(11, 11\), expected \(12, 12\)"),
        (lambda k: put(k, (3, 4), np.nan), r"not finite at index \[3, 4\]"),
        (lambda k: put(k, (1, 5), 1.1 * k[1, 5]), "from symmetric: one triangle only"),
        (lambda k: np.triu(k), "from symmetric"),
        (lambda k: -k, "diagonal .* not positive semi-definite"),
        (
            lambda k: put(put(k, (1, 7), 2 * k[1, 7]), (7, 1), 2 * k[7, 1]),
            "not positive semi-definite .lowest eigenvalue",
        ),
        (lambda k: k + np.diag([1e-3 * k[0, 0]] + [0.0] * 11), "translation along x as a rigid body is resisted"),
        (
            lambda k: k + np.diag([0.0] * 9 + [0.1 * k[9, 9]] + [0.0] * 2),
            "rotation about x as a rigid body is resisted",
        ),
    ],
    ids=["size", "nan", "asymmetric", "one triangle", "sign", "indefinite", "grounded", "grounded in rotation"],
)
def test_a_matrix_that_is_no_segments_is_refused(change, match: str) -> None:
    with pytest.raises(CondensationError, match=f"stiffness of 'root to 1 m': .*{match}"):
        between(*bad(change), "root to 1 m")


def test_a_matrix_of_another_place_is_refused() -> None:
    """In millimetres where metres were meant: rotations no longer fit translations."""
    k, _, rest = beam_segment(0.5)
    wrong = rest.copy()
    wrong[0, 3] *= 1e3
    with pytest.raises(CondensationError, match=r"as a rigid body is resisted .*units"):
        between(k, wrong, "segment")


def test_a_mechanism_between_sections_is_refused() -> None:
    """No torsional stiffness but its trace elsewhere: seven motions without force."""
    _, k, rest = beam_segment(0.5)
    weak = k + 0.0
    weak[3, 3] = k[4, 4]
    weak[3, 4] = weak[4, 3] = k[4, 4]
    D = np.concatenate([-np.eye(6), sp.adjoint(rest)], axis=1)
    for k6, match in (
        (weak, "not positive|more than six"),
        (np.diag([1.0, 1, 1, 0, 1, 1]), "nothing resists the rotation about x"),
    ):
        with pytest.raises(CondensationError, match=match):
            between(D.T @ k6 @ D, rest, "segment")


def test_coinciding_frames_are_refused() -> None:
    k = np.block([[np.eye(6), -np.eye(6)], [-np.eye(6), np.eye(6)]])
    with pytest.raises(CondensationError, match="the end frames of 'joint' coincide"):
        segment_from_matrix(k, np.eye(4), np.eye(6), "joint")


def lump(**changes) -> FiniteElements:
    return replace(freedoms_of_a_section(), **changes)


@pytest.mark.parametrize(
    ("act", "match"),
    [
        (lambda: ties.rigid(lump(), np.zeros(0, int), np.eye(4), "tip"), "section 'tip': a tie with no nodes"),
        (lambda: ties.average(lump(), np.zeros(0, int), np.eye(4), "tip"), "section 'tip': a tie with no nodes"),
        (lambda: ties.section(lump(), at(0.5), "0.5 m"), "section '0.5 m': no nodes .* nearest are -0.1 m"),
        (lambda: ties.average(lump(), np.arange(12), at(0.4), "two"), "6 freedoms cannot tell six motions"),
        (
            lambda: ties.average(lump(mass=np.zeros(42)), np.arange(42), at(0.4), "bare"),
            "weights are the lumped masses",
        ),
        (lambda: ties.average(lump(), np.arange(42), at(0.4), "edge", -np.ones(42)), "weights reach down to -1"),
        (lambda: lump(stiffness=ss.csr_array(np.eye(41))), r"stiffness has shape \(41, 41\), expected \(42, 42\)"),
        (lambda: lump(points=np.zeros((42, 2))), r"points has shape \(42, 2\)"),
        (lambda: lump(stiffness=ss.csr_array(np.tri(42))), "from symmetric"),
        (lambda: lump(stiffness=ss.csr_array(np.full((42, 42), np.inf))), "not finite"),
        (lambda: chain_from_segments([], np.eye(4)), "segments: none given"),
    ],
)
def test_bad_ties_and_models_are_refused(act, match: str) -> None:
    with pytest.raises(CondensationError, match=match):
        act()


@needs_skfem
def test_models_that_cannot_be_condensed_are_refused() -> None:
    model = solid.finite_elements(square_bar(0.2, 2), SQUARE, "bar")
    a, b = tied(model, "rigid", 0.0, 0.2)
    n = len(model.directions)
    loose = ss.csr_array(ss.block_diag([model.stiffness, ss.csr_array((1, 1))]))
    more = FiniteElements(
        "bar",
        np.vstack([model.points, [[0.1, 0, 0]]]),
        np.append(model.directions, 0),
        loose,
        np.append(model.mass, 0.0),
    )
    with pytest.raises(CondensationError, match=f"bar: nothing holds some of its {n + 1} freedoms"):
        condense(more, tied(more, "rigid", 0.0, 0.2))
    with pytest.raises(CondensationError, match="section '0 m': shares nodes with another rigid tie"):
        condense(model, (a, a))
    with pytest.raises(CondensationError, match="bar: no mass"):
        segment(replace(model, mass=np.zeros(n)), a, b)
    middle = tied(model, "rigid", 0.0, 0.1, 0.2)
    with pytest.raises(CondensationError, match=r"section '0\.1 m': a rigid tie stops the warping"):
        in_place(model, middle, np.stack([model.mass, model.mass]))
    with pytest.raises(CondensationError, match=r"masses: shape \(1, \d+\), expected \(2, \d+\)"):
        in_place(model, tied(model, "average", 0.0, 0.1, 0.2), model.mass[None])
    supported = replace(model, stiffness=model.stiffness + ss.diags_array(1e6 * (model.points[:, 0] == 0.1)))
    with pytest.raises(CondensationError, match=r"'0 m to 0\.2 m': translation along . as a rigid body is resisted"):
        segment(supported, a, b)
