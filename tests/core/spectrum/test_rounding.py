"""A mechanism's uncertainty covers its error against closed forms: small for most, large for defective eigenvalues."""

import json
from itertools import pairwise

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.core.mechanism.description import MechanismError
from southwell.core.spectrum import eigen, rounding
from southwell.reports.cli.app import main
from southwell.tests.support.closed_forms import linkages, pendulums

pytestmark = pytest.mark.numerical


def rank_one(x: float) -> mb.Mechanism:
    """Two slides; the second is ``x`` times as stiff and as heavy as the first, which carries it."""
    return mb.Mechanism(
        (mb.Body("a", mb.inertia(2.0)), mb.Body("b", mb.inertia(2.0 * x))),
        (mb.Joint("p", "prismatic", "ground", "a"), mb.Joint("q", "prismatic", "a", "b")),
        coordinate_springs=(mb.CoordinateSpring("p.z", 3.0), mb.CoordinateSpring("q.z", 3.0 * x)),
    )


def exact(x: float) -> np.ndarray:
    """ω² (k = m = 3/2 …): roots of x s² − x (2 + x) (3/2) s + x (3/2)² for the relative motions of the slides."""
    b = 1.5 * (2.0 + x)
    root = 1.5 * np.sqrt(x * (4.0 + x))  # √(b² − 4 (3/2)²) without cancellation
    return np.sqrt([2.0 * 1.5**2 / (b + root), 0.5 * (b + root)])


@pytest.mark.parametrize("x", [1.0, 1e3, 1e6, 1e-6])
def test_masses_of_different_magnitude(x: float) -> None:
    solution = mb.solve(rank_one(x))
    error = np.abs(solution.frequencies / exact(x) - 1.0)
    assert (error <= solution.uncertainty + 4e-16).all()
    assert solution.uncertainty.max() < 1e-6


@pytest.mark.parametrize(
    ("mechanism", "guess", "values"),
    [
        (pendulums.turntable(2.0), {}, pendulums.turntable_values(2.0)),
        (pendulums.turntable(6.0), {}, pendulums.turntable_values(6.0)),
        (pendulums.pendulum(2.0, True), {}, pendulums.pendulum_values(2.0)),
        (
            linkages.slider_crank(3.0),
            {"guide.z": linkages.CRANK + linkages.CONNECTING},
            linkages.slider_crank_values(3.0),
        ),
    ],
    ids=["turntable", "unstable", "pendulum", "slider-crank"],
)
def test_the_uncertainty_covers_the_error(mechanism: mb.Mechanism, guess: dict[str, float], values: np.ndarray) -> None:
    solution = mb.solve(mechanism, guess)
    assert (solution.uncertainty < 1e-11).all()
    for value in values[np.isfinite(values)]:
        k = int(np.abs(solution.values - value).argmin())
        assert abs(solution.values[k] - value) <= (solution.uncertainty[k] + 1e-15) * abs(value)


def test_a_free_body_in_a_turning_frame_has_defective_eigenvalues() -> None:
    """A floating ring: its drift has the frequency Ω four times, two of them defective, accurate to 1e-8 only."""
    omega = 1.5
    solution = mb.solve(linkages.ring(omega, 4))
    near = np.abs(solution.frequencies - omega) < 1e-3
    assert near.sum() == 4
    assert (np.abs(solution.values[near] - 1j * omega) <= solution.uncertainty[near] * omega).all()
    assert 1e-9 < solution.uncertainty[near].max() < 1e-4
    assert (solution.uncertainty[~near][2:6] < 1e-9).all()


def test_the_residual_of_the_eigensolver_is_included(monkeypatch: pytest.MonkeyPatch) -> None:
    """For eigenvalues that are off by 1e-5 the uncertainty is larger than that."""
    linear = mb.solve(pendulums.double_pendulum(2.0)).linear
    good = eigen.gyroscopic(linear.M, 0.5 * (linear.C - linear.C.T), 0.5 * (linear.K + linear.K.T))
    off = eigen.Eigen(good.frequencies * (1.0 + 1e-5), good.vectors)
    assert (rounding.rounding(linear, good) < 1e-12).all()
    assert (rounding.rounding(linear, off) > 1e-5).all()


def test_the_command_prints_the_rounding(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match=r"^0$"):
        main(["mechanism", "pitch-link"])
    assert "± rounding" in capsys.readouterr().out
    with pytest.raises(SystemExit, match=r"^0$"):
        main(["mechanism", "pitch-link", "--json"])
    assert all(0 < mode["relative_uncertainty"] < 1e-10 for mode in json.loads(capsys.readouterr().out)["modes"])


# -------------------------------------------------------------------------------------------------------------- massless


def beams(count: int, damping: float = 0.0, rate: float = 0.0) -> mb.Mechanism:
    """Massless beams end to end on a hub, a body at the tip, and a slide with a damper on that."""
    names = ["hub", *(f"b{i}" for i in range(count))]
    tip = mb.inertia(2.0, [0.1, 0.2, 0.25], [0.3, 0.1, 0.0])
    return mb.Mechanism(
        (*(mb.Body(n) for n in names[:-1]), mb.Body(names[-1], tip), mb.Body("slide", mb.inertia(1.0))),
        (
            mb.Joint("spin", "revolute", "ground", "hub"),
            *(mb.Joint(f"j{b}", "elastic", a, b, mb.at(1.0)) for a, b in pairwise(names)),
            mb.Joint("s", "prismatic", names[-1], "slide"),
        ),
        (mb.Motion("spin.rz", rate=rate),),
        coordinate_springs=(mb.CoordinateSpring("s.z", 1e3, damping),),
        beams=tuple(
            mb.Beam(a, b, mb.straight_beam(1.0, EA=1e8, GJ=2e4, EI_y=1e4, EI_z=3e4)) for a, b in pairwise(names)
        ),
    )


@pytest.mark.parametrize(("count", "rate"), [(2, 3.0), (3, 0.0), (3, 3.0), (5, 3.0)])
def test_massless_bodies_on_elastic_joints_have_no_modes(count: int, rate: float) -> None:
    """Six modes of the tip and one of the slide, with nearly the same frequencies with and without the damper."""
    damped, free = mb.solve(beams(count, 0.5, rate)), mb.solve(beams(count, 0.0, rate))
    assert len(damped.values) == len(free.values) == 7
    np.testing.assert_allclose(damped.frequencies, free.frequencies, rtol=1e-4)
    assert (damped.uncertainty < 1e-8).all()


def test_a_massless_body_with_a_damper_decays() -> None:
    """Between springs k₁ and k₂ without mass: (k₁ + k₂ + λ c) a = k₂ b, m λ² b = k₂ (a − b)."""
    m, k1, k2, c = 2.0, 3.0, 5.0, 0.1
    solution = mb.solve(
        mb.Mechanism(
            (mb.Body("a"), mb.Body("b", mb.inertia(m))),
            (mb.Joint("p", "prismatic", "ground", "a"), mb.Joint("q", "prismatic", "a", "b")),
            coordinate_springs=(mb.CoordinateSpring("p.z", k1, c), mb.CoordinateSpring("q.z", k2)),
        )
    )
    roots = np.roots([m * c, m * (k1 + k2), c * k2, k1 * k2])
    expected = sorted(roots[roots.imag >= -1e-12], key=abs)
    np.testing.assert_allclose(solution.values, expected, rtol=1e-12)


def test_a_free_body_without_mass_is_refused() -> None:
    m = mb.Mechanism(
        (mb.Body("a", mb.inertia(1.0)), mb.Body("b")),
        (mb.Joint("p", "prismatic", "ground", "a"), mb.Joint("q", "prismatic", "a", "b")),
        coordinate_springs=(mb.CoordinateSpring("p.z", 3.0),),
    )
    with pytest.raises(MechanismError, match=r"coordinate 'q.z': it has no mass, stiffness or damping"):
        mb.solve(m)
