"""Frame3DD's frame against closed forms and core; its model of rotation; the contents of its requests."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from southwell.core import solve
from southwell.core.blade import Blade, uniform_blade
from southwell.references.isolated import frame3dd as frame3dd_frame
from southwell.references.isolated import frame3dd_worker
from southwell.references.isolated.frame3dd import CODE, SECTIONS, request
from southwell.references.protocol.interface import CodeError
from southwell.tests.support.beams import PARK, curved, tapered, yoo_shin

Array = NDArray[Any]

needs_frame3dd = pytest.mark.skipif(CODE.version() is None, reason=f"not installed: {CODE.hint}")

POINT = np.diag([7.2, 7.2, 7.2, 0.0, 0.0, 0.0])


def core(blade: Blade, omega: float, count: int = 5) -> Array:
    return solve.mesh_modes(blade, omega, 100, count, effects=CODE.effects).frequencies


@needs_frame3dd
def test_the_cantilever_at_zero_speed_is_the_closed_form() -> None:
    """βL = 1.8751, 4.6941, 7.8548 (Euler–Bernoulli), in both planes: fourth order, so to 1e-6 with 45 elements."""
    beta = np.repeat([1.8751040687, 4.6940911330, 7.8547574382], 2)
    exact = beta**2 * np.sqrt(14e3 / 1.2) / 36.0
    np.testing.assert_allclose(CODE.solve(PARK, 0.0, 45, 6).frequencies, exact, rtol=1e-6)


@needs_frame3dd
@pytest.mark.parametrize(
    ("blade", "omega"),
    [
        (PARK, 10.0),
        (yoo_shin(0.1), 30.0),
        (replace(PARK, tip_mass=POINT), 10.0),
        (tapered(), 3.0),
        (replace(tapered(), pitch=0.4), 3.0),
    ],
    ids=["cantilever", "fast", "tip mass", "tapered, twisted", "pitched"],
)
def test_two_refinements_extrapolate_to_the_solvers_frequencies(blade: Blade, omega: float) -> None:
    """Second order, from 40 and 60 elements; without spin softening the first would be 31 % higher."""
    coarse, fine = (CODE.solve(blade, omega, n, 4).frequencies for n in (40, 60))
    np.testing.assert_allclose(fine + (fine - coarse) * 0.8, core(blade, omega, 4), rtol=1.5e-4)


@needs_frame3dd
def test_order_where_sections_vary() -> None:
    f = np.array([CODE.solve(tapered(), 3.0, n, 4).frequencies for n in (20, 40, 80)])
    np.testing.assert_allclose(np.log2((f[0] - f[1]) / (f[1] - f[2])), 2.0, atol=0.3)


@needs_frame3dd
def test_shapes_agree_with_core() -> None:
    """For the pitched, twisted blade, up to sign; real because there is no Coriolis force."""
    blade = replace(tapered(), pitch=0.4)
    actual = CODE.solve(blade, 3.0, 60, 4).shapes[:, :, 1:3].real.reshape(4, -1)
    expected = solve.mesh_modes(blade, 3.0, 60, 4, effects=CODE.effects).shapes[:, :, 1:3].reshape(4, -1)
    norms = np.linalg.norm(actual, axis=1) * np.linalg.norm(expected, axis=1)
    np.testing.assert_allclose(np.abs(np.sum(actual * expected.conj(), axis=1)) / norms, 1, atol=1e-4)


def test_the_request() -> None:
    """The forces sum to ∫ m Ω² x, the springs to m Ω² L; stiffness is the harmonic mean."""
    payload: Any = request(replace(PARK, tip_mass=POINT), 10.0, np.linspace(0, 6, 21), 5)
    assert sum(payload["force"]) == pytest.approx(100 * (1.2 * 6 * 3.3 + 7.2 * 6.3), rel=1e-12)
    assert sum(payload["spring"]) == pytest.approx(100 * (7.2 + 7.2), rel=1e-12)
    assert payload["EI_y"] == pytest.approx([14e3] * 20)
    varying: Any = request(tapered(), 3.0, np.array([0.0, 4, 10, 20, 32, 40]), 5)
    # edge stiffness falls linearly from 6 to 3 GN m² between 4 and 10 m: the mean of its inverse is log 2 / 3
    assert varying["EI_z"][1] == pytest.approx(3e9 / np.log(2), rel=1e-5)
    assert varying["twist"][1] == pytest.approx(np.radians(11.0), rel=1e-9)


@pytest.mark.parametrize(
    ("blade", "reason"),
    [
        (replace(PARK, root=np.array([np.inf] * 5 + [0.0])), "the root is not clamped"),
        (replace(PARK, precone=0.1), "prebend, sweep or precone"),
        (replace(PARK, tip_mass=np.diag([1.0, 1, 1, 0.1, 0.1, 0.1])), "tip_mass: a body with inertia"),
        (curved(), "sections couple"),
        (uniform_blade("soft", 1, 0, EA=1, GJ=1, EI_y=1, EI_z=1, mass=1, GA_y=1.0, GA_z=1.0), "finite shear stiffness"),
        (uniform_blade("rigid", 1, 0, EA=1, GJ=np.inf, EI_y=1, EI_z=1, mass=1), "GJ is infinite"),
    ],
)
def test_an_unsupported_blade_is_declined_with_a_reason(blade: Blade, reason: str) -> None:
    assert (CODE.unsupported(blade) or "").startswith(reason)
    with pytest.raises(CodeError, match=reason.split(":")[0]):
        CODE.solve(blade, 0.0, 20, 4)


def test_too_many_intervals_are_declined() -> None:
    s = np.linspace(0, 6, SECTIONS + 3)
    kinked = replace(
        PARK,
        stations=s,
        curve=np.zeros((0, 3)),
        twist=0.1 * np.cos(s),
        stiffness=np.repeat(PARK.stiffness[:1], len(s), 0) * (1.0 + 0.1 * np.sin(9 * s))[:, None, None],
        mass=np.repeat(PARK.mass[:1], len(s), 0),
    )
    assert "12 intervals between stations" in (CODE.unsupported(kinked) or "")


def test_a_squared_frequency_below_that_of_the_speed_is_unstable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        frame3dd_frame, "ask", lambda *_: {"frequencies": [9.9], "shapes": np.zeros((1, 4, 21)).tolist()}
    )
    with pytest.raises(CodeError, match="no stable steady state; lower the speed"):
        CODE.solve(PARK, 10.0, 20, 1)


class Frame:
    """A frame that solves by Stodola's iteration only, or for some numbers of modes; the planes of its modes are given."""

    def __init__(self, planes: list[list[float]], subspace: set[int]) -> None:
        self.planes, self.subspace = np.array(planes), subspace

    def enableDynamics(self, count: int, method: int, *_: float) -> None:
        self.gives_up = method == frame3dd_worker.JACOBI and count not in self.subspace

    def run(self) -> tuple[SimpleNamespace]:
        if self.gives_up:
            raise RuntimeError("did not exit gracefully")
        y, z = (np.outer(column, np.arange(3.0)) for column in self.planes.T)
        return (SimpleNamespace(freq=[2.0, 1.0, 3.0], xdsp=0 * y, ydsp=y, zdsp=z, xrot=0 * y),)


def test_modes_in_one_plane_from_stodolas_iteration_are_rejected() -> None:
    """Three modes in one plane, pitched: rejected from Stodola's iteration; accepted in two planes or by subspace iteration."""
    first, second = [[1.0, 2.0]] * 3, [[1.0, 2.0], [2.0, 4.0], [2.0, -1.0]]
    with pytest.raises(RuntimeError, match="missed the modes of one plane"):
        frame3dd_worker.modes(Frame(first, set()), 3)
    for frame in (Frame(second, set()), Frame(first, {5})):
        assert frame3dd_worker.modes(frame, 3)["frequencies"] == pytest.approx([2 * np.pi, 4 * np.pi, 6 * np.pi])
    assert len(frame3dd_worker.modes(Frame(first, {3}), 2)["shapes"]) == 2
