"""SHARPy's geometrically exact beam against core: an independent answer, also for coupled, curved, sheared and rotated
sections."""

import base64
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from southwell.cases.conformance.blades import PROPERTIES
from southwell.core import solve
from southwell.core.blade import Blade, uniform_blade, without_rotary_inertia
from southwell.core.sampling import mass_at, stiffness_at
from southwell.references.isolated.sharpy import CODE, _shapes, _unpacked, request
from southwell.references.protocol.interface import CodeError
from southwell.tests.support.beams import PARK, TIP_MASS, curved, tapered, yoo_shin

Array = NDArray[Any]

needs_sharpy = pytest.mark.skipif(CODE.version() is None, reason=f"not installed: {CODE.hint}")

ARCS = {p.name: p.blade for p in PROPERTIES if p.name in ("sweep", "prebend")}


def core(blade: Blade, omega: float, count: int = 5) -> Array:
    return solve.mesh_modes(blade, omega, 80, count).frequencies


@pytest.mark.slow
@needs_sharpy
@pytest.mark.parametrize(
    ("blade", "omega", "rtol"),
    [
        (PARK, 10.0, 3e-5),
        (without_rotary_inertia(PARK), 10.0, 3e-5),
        (yoo_shin(0.1), 50.0, 1e-4),
        (replace(PARK, precone=0.3), 10.0, 3e-5),
        (ARCS["sweep"], 10.0, 3e-5),
        (ARCS["prebend"], 10.0, 3e-5),
    ],
    ids=["cantilever", "thin", "Coriolis", "coned", "swept", "prebent"],
)
def test_uniform_blades(blade: Blade, omega: float, rtol: float) -> None:
    np.testing.assert_allclose(CODE.solve(blade, omega, 24, 5).frequencies, core(blade, omega), rtol=rtol)


@pytest.mark.slow
@needs_sharpy
@pytest.mark.parametrize(
    ("blade", "omega"),
    [
        (tapered(), 3.0),
        (replace(tapered(), pitch=0.4), 3.0),
        (curved(), 0.0),
        (curved(), 1.5),
        (replace(curved(), tip_mass=TIP_MASS), 1.5),
    ],
    ids=["tapered, twisted", "pitched", "curved at rest", "curved, coupled, sheared, coned", "with offset tip mass"],
)
def test_varying_blades_extrapolate_to_core(blade: Blade, omega: float) -> None:
    """Second order, from 25 and 50 elements."""
    coarse, fine = (CODE.solve(blade, omega, n, 5).frequencies for n in (24, 48))
    np.testing.assert_allclose(fine + (fine - coarse) / 3, core(blade, omega), rtol=1e-4)


@pytest.mark.slow
@needs_sharpy
@pytest.mark.parametrize(
    ("blade", "omega", "levels", "order"), [(PARK, 10.0, (6, 12, 24), 4), (tapered(), 3.0, (20, 40, 80), 2)]
)
def test_order(blade: Blade, omega: float, levels: tuple[int, int, int], order: int) -> None:
    """Fourth for uniform blades, second where sections vary; of the modes that have not converged to rounding."""
    f = np.array([CODE.solve(blade, omega, n, 5).frequencies for n in levels])[:, 2:]
    np.testing.assert_allclose(np.log2((f[0] - f[1]) / (f[1] - f[2])), order, atol=0.15)


@needs_sharpy
def test_shapes_agree_with_core() -> None:
    """For the curved, pitched blade: displacements and rotation, up to phase."""
    actual, expected = (
        m.reshape(5, -1)
        for m in (CODE.solve(curved(), 1.5, 48, 5).shapes, solve.mesh_modes(curved(), 1.5, 60, 5).shapes)
    )
    norms = np.linalg.norm(actual, axis=1) * np.linalg.norm(expected, axis=1)
    np.testing.assert_allclose(np.abs(np.sum(actual.conj() * expected, axis=1)) / norms, 1, atol=1e-4)


@needs_sharpy
def test_no_steady_state_at_high_speed() -> None:
    with pytest.raises(CodeError, match=r"no (stable )?steady state"):
        CODE.solve(yoo_shin(0.1), 200.0, 12, 4)


def test_the_request() -> None:
    """Total mass and compliance are those of the blade; sections have their undeformed axes."""
    blade, ends = tapered(), np.linspace(0, 40.0, 5)
    payload = request(blade, 3.0, np.column_stack([ends[:-1], ends[1:]]))
    s = (np.arange(20000) + 0.5) * 40.0 / 20000
    np.testing.assert_allclose(
        10 * np.array(payload["mass"]).sum(0)[0, 0], mass_at(blade, s)[:, 0, 0].sum() * 40 / 20000, rtol=2e-3
    )
    here = np.linalg.inv(request(blade, 3.0, np.array([[10.0, 10.0 + 1e-6]]))["stiffness"][0])  # twisted by 9° there
    turned = Rotation.from_rotvec([np.radians(9.0), 0, 0]).as_matrix()
    soft = turned @ np.diag(1 / np.diagonal(stiffness_at(blade, 10.0)[0]))[3:, 3:] @ turned.T
    np.testing.assert_allclose(here[3:, 3:], soft, rtol=1e-6, atol=1e-6 * soft.max())
    assert soft[1, 2] > 0.05 * soft[1, 1]
    assert not np.array(payload["rotations"]).any()


def test_mass_and_compliance_are_scaled_from_arc_to_chord() -> None:
    """A quarter of a circle by one element: chord 2 √2 / π of the arc; mass and compliance are those of the arc."""
    s = np.linspace(0, np.pi / 2, 9)
    quarter = replace(
        PARK,
        stations=s,
        curve=np.stack([np.sin(s), 1 - np.cos(s), 0 * s], axis=1),
        stiffness=np.repeat(PARK.stiffness[:1], 9, axis=0),
        mass=np.repeat(PARK.mass[:1], 9, axis=0),
        twist=np.zeros(9),
    )
    payload = request(quarter, 0.0, np.array([[0.0, np.pi / 2]]))
    nodes = np.array(payload["nodes"])
    chord = np.linalg.norm(nodes[2] - nodes[0])
    assert chord * np.array(payload["mass"])[0, 0, 0] == pytest.approx(1.2 * np.pi / 2, rel=1e-9)


def test_rotation_about_x_from_a_change_of_the_rotation_vector() -> None:
    """J(ψ) δψ against the finite rotation, far from the identity."""
    psi, change = np.array([0.9, -0.4, 0.7]), np.array([0.3, 0.5, -0.2])
    h = 1e-6
    turned = (Rotation.from_rotvec(psi + h * change) * Rotation.from_rotvec(psi).inv()).as_rotvec() / h
    q = np.concatenate([np.zeros(3), psi] * 3)
    vector = np.concatenate([np.zeros(3), change] * 3)[:, None].astype(complex)
    shape = _shapes(np.linspace(0, 1, 4), q, vector)[0]
    assert shape[-1, 3].real == pytest.approx(turned[0], rel=1e-5)
    assert not shape[0].any()


def test_numbers_are_transferred_exactly() -> None:
    values = np.random.default_rng(1).standard_normal(7)
    np.testing.assert_array_equal(_unpacked(base64.b64encode(values.tobytes()).decode()), values)


@pytest.mark.parametrize(
    ("blade", "reason"),
    [
        (replace(PARK, root=np.array([np.inf] * 5 + [0.0])), "the root is not clamped"),
        (uniform_blade("rigid", 1, 0, EA=1, GJ=np.inf, EI_y=1, EI_z=1, mass=1), "infinite stiffness of strain 3"),
    ],
)
def test_an_unsupported_blade_is_declined_with_a_reason(blade: Blade, reason: str) -> None:
    assert (CODE.unsupported(blade) or "").startswith(reason)
    with pytest.raises(CodeError, match=reason):
        CODE.solve(blade, 0.0, 5, 4)
