"""One call of a form for all pairs of shape functions gives the matrices of scikit-fem's own assembly."""

from typing import Any

import numpy as np
import pytest

from southwell.references.scikit_fem import forms, reissner_forms
from southwell.references.scikit_fem.assembly import bilinear

skfem = pytest.importorskip("skfem")

MESH = skfem.MeshLine(np.array([0.0, 0.3, 1.1, 1.2]))
COEFFICIENTS = [
    "EA",
    "GJ",
    "EI_yy",
    "EI_zz",
    "EI_yz",
    "tension",
    "torque",
    "g_s",
    "mass",
    "J_xx",
    "J_yy",
    "J_zz",
    "J_yz",
]


def difference(form: Any, trial: Any, test: Any = None, **given: Any) -> float:
    """The largest difference of an entry, relative to the largest entry."""
    mine = bilinear(form, trial, test, **given).toarray()
    expected = skfem.BilinearForm(form).assemble(trial, test, **given).toarray()
    return float(np.abs(mine - expected).max() / np.abs(expected).max())


@pytest.mark.parametrize("form", [forms.elastic, forms.inertia, forms.gyroscopic, forms.centrifugal])
@pytest.mark.parametrize("at", ["line", "tip"])
def test_forms_of_four_fields(form: Any, at: str) -> None:
    line, hermite = skfem.ElementLineP2, skfem.ElementLineHermite
    basis = skfem.Basis(MESH, skfem.ElementComposite(line(), hermite(), hermite(), line()), intorder=9)
    if at == "tip":
        basis = basis.boundary(np.array([MESH.nvertices - 1]))
    rng, shape = np.random.default_rng(1), basis.dx.shape
    given = {name: rng.normal(size=shape) for name in COEFFICIENTS}
    assert difference(form, basis, g=1.0 + rng.uniform(size=shape), **given) < 1e-13


@pytest.mark.parametrize(
    ("form", "rows", "columns"),
    [
        (reissner_forms.quadratic, 6, 6),
        (reissner_forms.quadratic_local, 12, 12),
        (reissner_forms.mixed, 6, 12),
    ],
)
def test_forms_of_vectors(form: Any, rows: int, columns: int) -> None:
    basis = skfem.Basis(MESH, skfem.ElementVector(skfem.ElementLineP2(), 6), intorder=3)
    forces = basis.with_element(skfem.ElementVector(skfem.ElementLineP1DG(), 6))
    on = np.random.default_rng(2).normal(size=(rows, columns, *basis.dx.shape))
    assert difference(form, basis, forces if rows != columns else None, on=on) < 1e-13
