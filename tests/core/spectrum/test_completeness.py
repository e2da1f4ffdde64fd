"""The count of frequencies by the inertia of K + iωC − ω²M, and the proof that none of the modes is missing."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from southwell.core import solve
from southwell.core.blade import uniform_blade
from southwell.core.effects import ALL_EFFECTS
from southwell.core.element.discretize import discretize
from southwell.core.modes import Modes
from southwell.core.spectrum import completeness, eigen, lanczos
from southwell.core.spectrum import mesh_solver as solution
from southwell.core.spectrum.completeness import MissedModesError
from southwell.core.tree import elimination
from southwell.core.tree.pencil import TreePencil
from southwell.tests.support.dense import dense

ROUND = uniform_blade("round", 10.0, 1.0, EA=1e9, GJ=1e6, EI_y=1e6, EI_z=1e6, mass=10.0)
FLAT = uniform_blade("flat", 10.0, 1.0, EA=1e9, GJ=1e6, EI_y=1e6, EI_z=4e6, mass=10.0, I_y=0.1, I_z=0.3)


def pencil(blade, omega: float, elements: int, **how: Any) -> TreePencil:
    return solution.balance(discretize(blade, elements, **how), omega, np.zeros(3), ALL_EFFECTS).pencil


@pytest.mark.parametrize("how", [{}, {"mass": "half_end", "stiffness": "body_fixed"}], ids=["consistent", "half_end"])
@pytest.mark.parametrize("elements", [1, 2, 7])
@pytest.mark.parametrize("omega", [0.0, 8.0])
def test_the_count_is_that_of_all_eigenvalues(omega: float, elements: int, how: dict[str, Any]) -> None:
    """Between each two frequencies of the dense solver, and against the signs of the dense matrix's eigenvalues."""
    p = pencil(FLAT, omega, elements, **how)
    M, C, K = (dense(p, matrix) for matrix in (p.M, p.C, p.K))
    f = eigen.gyroscopic(M, C, K).frequencies
    f = f[f < 1e5 * f[0]]
    shifts = np.append(0.5 * f[0], np.sqrt(f[1:] * f[:-1]))[np.append(True, f[1:] / f[:-1] > 1.001)]
    assert [completeness.below(p, s) for s in shifts] == [int((f < s).sum()) for s in shifts]
    signs = [int((np.linalg.eigvalsh(K + 1j * s * C - s**2 * M) < 0).sum()) for s in shifts[:6]]
    assert [completeness.below(p, s) for s in shifts[:6]] == signs


@pytest.mark.parametrize(("omega", "count"), [(0.0, 6), (8.0, 6), (0.0, 5)])
def test_missing_and_spurious_modes_are_reported(omega: float, count: int) -> None:
    p = pencil(ROUND, omega, 20)
    all_ = lanczos.lanczos(p, 10).frequencies
    f, beyond = all_[:count], all_[count:]
    completeness.check_complete(p, f, beyond)
    for k in range(count):
        if k < count - 1 or omega:  # at rest the last one's twin takes its place
            with pytest.raises(MissedModesError, match=r"found \d+ natural frequencies below .* there are \d+"):
                completeness.check_complete(p, np.delete(all_, k)[:count], np.delete(all_, k)[count:])
    with pytest.raises(MissedModesError):
        completeness.check_complete(p, np.sort(np.append(f, f[2] * 1.0001)), beyond)
    if count == 5:  # the last one's twin may be the same number to the last digit
        with pytest.raises(MissedModesError):
            completeness.check_complete(p, np.sort(np.append(f, f[2] * 1.0001)), np.append(f[-1], beyond[1:]))


@pytest.mark.parametrize("omega", [0.0, 8.0])
@pytest.mark.parametrize("count", range(1, 8))
def test_a_count_that_splits_a_double_mode_is_accepted(omega: float, count: int) -> None:
    frequencies = solve.mesh_modes(ROUND, omega, 20, count).frequencies
    np.testing.assert_allclose(frequencies, solve.mesh_modes(ROUND, omega, 20, 8).frequencies[:count], rtol=1e-9)


@pytest.mark.parametrize(
    "answer",
    [solve.modes, solve.mesh_modes, lambda blade, omega, *rest: next(solve.sweep(blade, [omega], *rest))],
    ids=["modes", "mesh_modes", "sweep"],
)
def test_no_answer_without_a_complete_count(answer: Callable[..., Modes], monkeypatch: pytest.MonkeyPatch) -> None:
    """With a projection that loses its third largest value, every entry point raises."""
    whole = lanczos.eigh

    def lossy(matrix, triangle):
        values, vectors = whole(matrix, triangle)
        kept = np.append(0, np.delete(np.arange(len(values)), -3))  # the first one twice: it is not used
        return values[kept], vectors[:, kept]

    monkeypatch.setattr(lanczos, "eigh", lossy)
    with pytest.raises(MissedModesError, match=r"found 4 natural frequencies .* there are 5"):
        answer(FLAT, 8.0, 40, 5)


def test_stiffness_lost_to_rounding_is_not_called_unstable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lanczos, "solve_error", lambda *_: 1e-2)
    with pytest.raises(
        lanczos.EigensolverError, match=r"stiffness of 40 elements is dominated by rounding error .*fewer elements"
    ):
        solve.mesh_modes(FLAT, 8.0, 40, 5)


def test_stiffness_that_may_be_either_is_called_both(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lanczos, "solve_error", lambda *_: 1e-2)
    indefinite = property(lambda p: elimination.factor(p.K, p.links)._replace(positive=False))
    monkeypatch.setattr(TreePencil, "factor", indefinite)
    with pytest.raises(
        lanczos.EigensolverError, match=r"the steady state is unstable; or it is dominated by rounding error"
    ):
        solve.mesh_modes(FLAT, 8.0, 40, 5)


def test_modes_too_close_to_be_told_apart_are_refused_with_their_frequency() -> None:
    """Without torsional stiffness torsion modes have the frequency of the propeller moment, Ω √((I_z − I_y)/(I_z + I_y))."""
    soft = uniform_blade("b", 10.0, 1.0, EA=1e8, GJ=1e-6, EI_y=1e5, EI_z=3e5, mass=5.0, I_y=0.01, I_z=0.02)
    with pytest.raises(lanczos.EigensolverError, match=r"between 5\.77\d+ and 5\.77\d+ rad/s.*check GJ and EI"):
        solve.modes(soft, 10.0, count=6)


def test_modes_below_those_that_cannot_be_told_apart_are_offered() -> None:
    """One mode, of 5.05 rad/s, is below the torsion modes of 5.77 rad/s: it can be had, and its number is stated."""
    soft = uniform_blade("b", 10.0, 0.0, EA=1e8, GJ=1e-6, EI_y=1e4, EI_z=1e4, mass=1.0, I_y=0.001, I_z=0.002)
    with pytest.raises(lanczos.EigensolverError, match=r"between 5\.77\d+ and .*, or request at most 1 mode$"):
        solve.modes(soft, 10.0, count=4)
    assert solve.modes(soft, 10.0, count=1).frequencies[0] < 5.77
