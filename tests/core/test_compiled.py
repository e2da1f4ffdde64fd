"""The compiled kernels: the versions for different processors agree, and arrays of a wrong kind are errors, not crashes."""

import importlib.resources
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.core import solve
from southwell.core.blade import uniform_blade
from southwell.core.compiled import baseline, kernels  # type: ignore[attr-defined]
from southwell.core.element.discretize import discretize
from southwell.core.steady import blade_state
from southwell.core.tree import pencil

BLADE = uniform_blade("blade", 10.0, 1.0, EA=1e9, GJ=1e6, EI_y=1e6, EI_z=4e6, mass=10.0, I_y=0.1, I_z=0.3)

FREQUENCIES = """
from southwell.core import solve
from southwell.core.blade import uniform_blade
from southwell.core.compiled import kernels
blade = uniform_blade("blade", 10.0, 1.0, EA=1e9, GJ=1e6, EI_y=1e6, EI_z=4e6, mass=10.0, I_y=0.1, I_z=0.3)
print(kernels.__name__, *map(repr, solve.mesh_modes(blade, 8.0, 40, 8).frequencies.tolist()))
"""


@pytest.mark.numerical
def test_a_processor_without_avx2_has_the_same_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOUTHWELL_BASELINE", "1")
    run = subprocess.run([sys.executable, "-c", FREQUENCIES], capture_output=True, text=True, check=True)
    name, *result = run.stdout.split()
    assert name == "southwell.core.compiled.baseline"
    np.testing.assert_allclose(np.array(result, float), solve.mesh_modes(BLADE, 8.0, 40, 8).frequencies, rtol=1e-11)


def test_the_version_is_that_for_this_processor(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SOUTHWELL_BASELINE", raising=False)
    run = subprocess.run([sys.executable, "-c", FREQUENCIES], capture_output=True, text=True, check=True)
    expected = "avx2" if baseline.processor_has_avx2() else "baseline"
    assert run.stdout.split()[0] == f"southwell.core.compiled.{expected}"


def test_every_function_has_its_signature_and_every_signature_its_function() -> None:
    stub = importlib.resources.files("southwell.core.compiled").joinpath("kernels.pyi").read_text(encoding="utf-8")
    stated = {line.split("(")[0].split(":")[0].split()[1] for line in stub.splitlines() if line[:4] in ("def ", "clas")}
    assert stated == {name for name in dir(kernels) if not name.startswith("_")}


BODY = discretize(BLADE, 4)
P = pencil.linearize(BODY, pencil.undeformed(BODY), 8.0, np.zeros(3))
F, L = P.factor, P.links.arrays
SHORT = kernels.Links(BODY.parent[:-1], P.links.to_child[:-1].copy(), np.zeros((0, 6, 6)))
VECTOR = np.zeros((1, len(P.residual)))

WRONG = [
    (lambda: kernels.product(P.K, 1.0, L, VECTOR.astype(int)), TypeError, "float64"),  # type: ignore[arg-type]
    (lambda: kernels.product(P.K, 1.0, L, VECTOR.repeat(2, axis=1)[:, ::2]), TypeError, "C-contiguous"),
    (lambda: kernels.product(P.K, 1.0, L, VECTOR[:, :-1].copy()), ValueError, "length"),
    (lambda: kernels.product(P.K[:, :9, :9].copy(), 1.0, L, VECTOR), ValueError, r"12, 12\) or \(n, 18, 18"),
    (lambda: kernels.product(P.K, 1.0, SHORT, VECTOR), ValueError, "another number of links"),
    (lambda: kernels.negative_pivots(P.K, P.C[:-1], P.M, L, 1.0), ValueError, "numbers"),
    (lambda: kernels.solve(F.flexibility, F.transfer[:-1], F.reaction, L, VECTOR), ValueError, "numbers"),
    (lambda: kernels.displaced(BODY.parent, BODY.between[:-1].copy(), np.zeros((4, 12))), ValueError, "numbers"),
    (lambda: kernels.Links(np.array([0, 2]), np.zeros((2, 6, 6)), np.zeros((0, 6, 6))), ValueError, "before its child"),
    (lambda: kernels.exp(np.zeros(5)), ValueError, "numbers"),
    (lambda: kernels.exp(np.array(1.0)), ValueError, "dimensions"),
]


@pytest.mark.parametrize(("call", "error", "message"), WRONG)
def test_an_array_of_a_wrong_kind_is_an_error(call, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        call()


def test_results_are_not_written_to_arrays_that_are_read_only() -> None:
    fixed = VECTOR.copy()
    fixed.flags.writeable = False
    with pytest.raises(ValueError, match=r"writ|read-only"):
        kernels.solve(F.flexibility, F.transfer, F.reaction, L, fixed)


def test_a_block_has_at_most_eight_vectors() -> None:
    a = kernels.Operator(P.M, P.C, P.K, L, F.flexibility, F.transfer, F.reaction, *np.zeros((2, 0, 6, 6)))
    basis, projected = np.zeros((20, 2 * VECTOR.size)), np.zeros((20, 20))
    for w, size in ((np.ones((9, 2 * VECTOR.size)), 0), (np.ones((1, 2 * VECTOR.size)), 21)):
        with pytest.raises(ValueError, match="at most eight vectors"):
            a.extend(w, basis, projected, size, 0, 10)
    with pytest.raises(ValueError, match="projection room"):
        a.extend(np.ones((1, 2 * VECTOR.size)), basis, np.zeros((10, 10)), 0, 0, 10)


def test_empty_batches() -> None:
    assert kernels.exp(np.zeros((0, 6))).shape == (0, 4, 4)
    assert blade_state.coordinates(BODY, pencil.undeformed(BODY)).shape == (4, 12)


def test_points_that_are_not_sorted_by_element_are_refused() -> None:
    points = BODY.beams.points
    with pytest.raises(ValueError, match="not sorted by element"):
        _ = replace(BODY.beams, points=replace(points, element=points.element[::-1])).arrays


def test_a_module_that_is_older_than_its_sources_is_not_loaded() -> None:
    program = """
import pathlib
read = pathlib.Path.read_bytes
pathlib.Path.read_bytes = lambda path: read(path) + (b"// changed" if path.name == "rigid.hpp" else b"")
import southwell.core.compiled
"""
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert run.returncode == 1
    assert "ImportError: southwell's compiled kernels are not those of their sources: run make" in run.stderr


def test_a_checkout_in_the_current_folder_that_hides_the_package_is_named(tmp_path: Path) -> None:
    """A checkout without compiled modules; Python finds it in the folder in which it is started."""
    source = Path(kernels.__file__).parents[2]
    checkout = tmp_path / "southwell"
    shutil.copytree(source / "core", checkout / "core", ignore=shutil.ignore_patterns("*.so", "*.pyd", "__pycache__"))
    for name in ("__init__.py", "pyproject.toml"):
        shutil.copy(source / name, checkout)
    load = [sys.executable, "-c", "import southwell.core.compiled"]
    run = subprocess.run(load, capture_output=True, text=True, cwd=tmp_path)
    assert run.returncode == 1
    last = run.stderr.strip().splitlines()[-1]
    assert f"{checkout} is imported, a checkout, because {tmp_path} is the current folder on sys.path" in last
    assert f"start Python in another folder, or build the checkout: pip install --editable {checkout}" in last
