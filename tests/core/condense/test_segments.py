"""Segments, ties and chains without a solid: textbook beams, closed forms, and invalid input."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as ss

from southwell.core.condense import ties
from southwell.core.condense.compressed import mesh_from_segments, segment_modes
from southwell.core.condense.joined import joined
from southwell.core.condense.segments import Segment, between, segment_from_matrix
from southwell.core.condense.ties import CondensationError, FiniteElements
from southwell.core.element import sections
from southwell.core.mechanism.description import inertia
from southwell.core.solve import LargeStrainError, chain_modes, mesh_modes, modes
from southwell.core.space import spatial as sp
from southwell.tests.support.beams import PARK
from southwell.tests.support.solids import at

Array = np.ndarray


# Stiffness


def beam_segment(length: float, blade=PARK) -> tuple[Array, Array, Array]:
    """12×12 of a uniform beam, its 6×6 and the pose of b in a's frame."""
    part = replace(blade, stations=np.array([0.0, length]), curve=np.zeros((0, 3)))
    undeformed = at(length)
    k = np.linalg.inv(sections.integrate(part, part.stations).flexibility[0])
    D = np.concatenate([-np.eye(6), sp.adjoint(undeformed)], axis=1)
    return D.T @ k @ D, k, undeformed


def test_complex_stiffness_of_the_textbook_beam() -> None:
    """Przemieniecki 1968, table 5.2: 12 E I/l³, −6 E I/l², 4 E I/l, 2 E I/l, E A/l, G J/l."""
    length, EA, EI, GJ = 0.5, 7e10 * 4e-4, 7e10 * 2e-7, 7e10 / 2.6 * 4e-7
    k12, k, undeformed = beam_segment(length)
    y = [1, 5, 7, 11]
    bending = EI / length**3 * np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]], float)
    unit = np.diag([1, length, 1, length])
    np.testing.assert_allclose(k12[np.ix_(y, y)], unit @ bending @ unit, rtol=1e-9)
    np.testing.assert_allclose([k12[0, 6], k12[3, 9]], [-EA / length, -GJ / length], rtol=1e-9)
    np.testing.assert_allclose(between(k12, undeformed, "beam"), k, rtol=1e-9, atol=1e-9 * np.abs(k).max())


def test_the_body_of_a_uniform_beam_follows_its_cubic() -> None:
    """Mean of w = v (3t² − 2t³) + θ l (t³ − t²): displacement v/2 − θ l/12, rotation 6 v/5 l − θ/10 (by least squares)."""
    length = 0.5
    k12, _, undeformed = beam_segment(length)
    body_twist = segment_from_matrix(k12, undeformed, np.eye(6)).body_twist
    b = sp.adjoint(sp.inverse(undeformed))  # ρ is at a's origin; the cubic's v and θ are at b
    body_twist = body_twist @ np.linalg.inv(b)
    centre = at(-0.5 * length)
    body_twist = sp.adjoint(centre) @ body_twist  # at the middle
    np.testing.assert_allclose(
        body_twist[np.ix_([1, 5], [1, 5])], [[0.5, -length / 12], [1.2 / length, -0.1]], rtol=1e-8
    )
    np.testing.assert_allclose(body_twist[np.ix_([0, 3], [0, 3])], 0.5 * np.eye(2), atol=1e-8)


def uniform_segments(n: int) -> list[Segment]:
    length = PARK.length / n
    k12, _, undeformed = beam_segment(length)
    mass = 1.2 * length
    polar, cross = 1.2 * length * 1e-3, mass * (5e-4 + length**2 / 12)
    body = inertia(mass, [polar, cross, cross], [length / 2, 0, 0])
    return [segment_from_matrix(k12, undeformed, body)] * n


def uniform_chain(n: int, omega: float = 0.0, count: int = 8) -> Array:
    return chain_modes(mesh_from_segments(uniform_segments(n), at(PARK.hub_radius)), omega, count).frequencies


def test_two_joined_segments_are_one_of_twice_the_length() -> None:
    """``body_twist`` differs by the rotary inertia of the sections, which ``segment_from_matrix`` neglects."""
    for result, expected in zip(joined(uniform_segments(20)), uniform_segments(10), strict=True):
        for field, within in (("undeformed", 1e-12), ("stiffness", 1e-12), ("inertia", 1e-12), ("body_twist", 5e-3)):
            expected_value = getattr(expected, field)
            np.testing.assert_allclose(
                getattr(result, field), expected_value, atol=within * np.abs(expected_value).max()
            )
    assert len(joined(uniform_segments(7))) == 4


@pytest.mark.parametrize("n", [6, 8, 20, 21])
def test_the_uncertainty_covers_the_error_due_to_the_number_of_segments(n: int) -> None:
    """Against core's refined beam; the uncertainty is less than a hundred times the error."""
    exact = modes(PARK, 10.0, count=4, accuracy=1e-9).frequencies
    result = segment_modes(uniform_segments(n), at(PARK.hub_radius), 10.0, 4)
    error = np.abs(result.frequencies / exact - 1.0)
    assert (error <= result.uncertainty).all()
    assert (result.uncertainty < 100.0 * error).all()
    assert 0 < result.strain < 0.01


def test_few_segments_have_infinite_uncertainty_and_large_strains_are_refused() -> None:
    assert np.isinf(segment_modes(uniform_segments(3), at(PARK.hub_radius), 0.0, 4).uncertainty).all()
    rubber = [replace(s, stiffness=s.stiffness * np.diag([3e-4, 1, 1, 1, 1, 1])) for s in uniform_segments(8)]
    with pytest.raises(LargeStrainError, match="allow large strains"):
        segment_modes(rubber, at(PARK.hub_radius), 10.0, 1)
    assert segment_modes(rubber, at(PARK.hub_radius), 10.0, 1, allow_large_strain=True).strain > 0.2


def test_bending_converges_with_fourth_order() -> None:
    """One rigid body per segment, against core's converged beam; also turning, where 20 segments leave 5e-6."""
    exact = mesh_modes(PARK, 0.0, 160, 4).frequencies
    errors = [np.abs(uniform_chain(n)[:4] / exact - 1) for n in (10, 20)]
    assert (np.log2(errors[0] / errors[1]) > 3.7).all()
    np.testing.assert_allclose(uniform_chain(20, 10.0)[:4], mesh_modes(PARK, 10.0, 160, 4).frequencies, rtol=1e-5)


def test_torsion_is_that_of_masses_in_the_middle() -> None:
    """A shaft of n segments whose discs move as the mean of their ends: ω = (2/l) √(GJ/I_x) tan(β l/2), β = (k − ½)π/L."""
    n = 20
    length = PARK.length / n
    k12, _, undeformed = beam_segment(length)
    body = inertia(1.2 * length, [1e2 * length, 60.0, 60.0], [length / 2, 0, 0])
    frequencies = chain_modes(
        mesh_from_segments([segment_from_matrix(k12, undeformed, body)] * n, np.eye(4)), 0.0, 20
    ).frequencies
    beta = (np.arange(1, 4) - 0.5) * np.pi / PARK.length
    exact = 2 / length * np.sqrt(7e10 / 2.6 * 4e-7 / 1e2) * np.tan(beta * length / 2)
    nearest = np.abs(frequencies[:, None] / exact - 1).min(0)
    assert nearest.max() < 1e-6


# Ties


def freedoms_of_a_section(seed: int = 3, count: int = 7) -> FiniteElements:
    """Nodes scattered on a plane, each with three displacements and three rotations, on springs to the ground."""
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
    """For a rigid motion, the section's mean is the frame's twist; the forces of a unit wrench have that wrench."""
    model = freedoms_of_a_section()
    every = np.arange(len(model.directions))
    make = ties.rigid if kind == "rigid" else ties.average
    tie = make(model, every, somewhere(), "section")
    np.testing.assert_allclose(tie.mean @ tie.motion, np.eye(6), atol=1e-12)
    assert (model.directions[tie.freedoms] < 3).all() == (kind == "average")


def test_rigid_motion_is_that_of_the_frame() -> None:
    """Turning the frame by a finite small twist moves points as ``motion`` says, to second order."""
    model, frame = freedoms_of_a_section(), somewhere()
    twist = 1e-5 * np.array([1.0, -2.0, 0.5, 0.3, 0.8, -1.1])
    moved = frame @ sp.exp(twist[None])[0] @ sp.inverse(frame)
    points = model.points[::6]
    displaced = points @ moved[:3, :3].T + moved[:3, 3] - points
    linear = (ties.motion(model.points, model.directions, frame) @ twist).reshape(-1, 2, 3)
    np.testing.assert_allclose(linear[:, 0], displaced, atol=1e-8)
    np.testing.assert_allclose(linear[:, 1], np.tile(frame[:3, :3] @ twist[3:], (len(points), 1)), atol=1e-15)


def bad(change) -> tuple[Array, Array]:
    k, _, undeformed = beam_segment(0.5)
    return change(k.copy()), undeformed


def put(k: Array, entry: tuple[int, int], value: float) -> Array:
    k[entry] = value
    return k


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda k: k[:11, :11], r"shape \(11, 11\), expected \(12, 12\)"),
        (lambda k: put(k, (3, 4), np.nan), r"not finite at index \[3, 4\]"),
        (lambda k: put(k, (1, 5), 1.1 * k[1, 5]), "not symmetric .*: supply both triangles"),
        (lambda k: np.triu(k), "not symmetric"),
        (lambda k: -k, "diagonal .* not positive semi-definite"),
        (
            lambda k: put(put(k, (1, 7), 2 * k[1, 7]), (7, 1), 2 * k[7, 1]),
            "not positive semi-definite .lowest eigenvalue",
        ),
        (lambda k: k + np.diag([1e-3 * k[0, 0]] + [0.0] * 11), "translation along x as a rigid body causes forces"),
        (
            lambda k: k + np.diag([0.0] * 9 + [0.1 * k[9, 9]] + [0.0] * 2),
            "rotation about x as a rigid body causes forces",
        ),
    ],
    ids=["size", "nan", "asymmetric", "one triangle", "sign", "indefinite", "grounded", "grounded in rotation"],
)
def test_a_matrix_that_is_not_a_segments_is_refused(change, match: str) -> None:
    with pytest.raises(CondensationError, match=f"stiffness of 'root to 1 m': .*{match}"):
        between(*bad(change), "root to 1 m")


def test_a_matrix_of_other_end_frames_is_refused() -> None:
    """In millimetres where metres were meant: rotations no longer fit translations."""
    k, _, undeformed = beam_segment(0.5)
    altered = undeformed.copy()
    altered[0, 3] *= 1e3
    with pytest.raises(CondensationError, match=r"as a rigid body causes forces .*units"):
        between(k, altered, "segment")


def test_a_mechanism_between_sections_is_refused() -> None:
    """Equal and opposite rotations about x and y cause no force; then, rotation about x alone."""
    undeformed = at(0.5)
    D = np.concatenate([-np.eye(6), sp.adjoint(undeformed)], axis=1)
    free = np.eye(6)
    free[3, 4] = free[4, 3] = 1.0
    with pytest.raises(CondensationError, match="'segment': more than six motions without force"):
        between(D.T @ free @ D, undeformed, "segment")
    with pytest.raises(CondensationError, match="no stiffness against rotation about x of frame a"):
        between(D.T @ np.diag([1.0, 1, 1, 0, 1, 1]) @ D, undeformed, "segment")


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
        (lambda: ties.average(lump(), np.arange(12), at(0.4), "two"), "6 freedoms do not determine the six motions"),
        (
            lambda: ties.average(lump(mass=np.zeros(42)), np.arange(42), at(0.4), "bare"),
            r"smallest weight .* \(lumped mass\)",
        ),
        (lambda: ties.average(lump(), np.arange(42), at(0.4), "edge", -np.ones(42)), "smallest weight -1"),
        (lambda: lump(stiffness=ss.csr_array(np.eye(41))), r"stiffness has shape \(41, 41\), expected \(42, 42\)"),
        (lambda: lump(points=np.zeros((42, 2))), r"points has shape \(42, 2\)"),
        (lambda: lump(stiffness=ss.csr_array(np.tri(42))), "not symmetric"),
        (lambda: lump(stiffness=ss.csr_array(np.full((42, 42), np.inf))), "not finite"),
        (lambda: mesh_from_segments([], np.eye(4)), "segments: none given"),
    ],
)
def test_bad_ties_and_models_are_refused(act, match: str) -> None:
    with pytest.raises(CondensationError, match=match):
        act()
