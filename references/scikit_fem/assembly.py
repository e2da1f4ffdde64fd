"""Assembly of bilinear forms with one call of the form for all pairs of shape functions.

scikit-fem's ``BilinearForm`` calls the form for each pair. On the few elements of a beam with six fields, these up to 324
calls take most of the time of a solution; the matrix is the same to rounding.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

Array = NDArray[np.float64]

TRIAL, TEST = -3, -4
"""Where an axis of length one is inserted, before (elements, points), so that the two kinds of shape functions pair."""


def bilinear(form: Callable[..., Any], trial: Any, test: Any = None, **given: Any) -> csr_array:
    """The matrix (rows, columns) of a form ``form(*u, *v, w)``, linear in the trial functions u and the test functions v.

    Args:
        form: of scikit-fem's fields, any number for u and for v, and of w with the attributes ``given``.
        trial: basis of u, whose degrees of freedom are the columns.
        test: basis of v at the same points, whose degrees of freedom are the rows; that of u if not given.
        given: values at the points, (…, elements, points), or constants.
    """
    test = trial if test is None else test
    values = form(*_functions(trial, TRIAL), *_functions(test, TEST), SimpleNamespace(**given))
    local = np.einsum("...eq,eq->...e", values, trial.dx)  # (columns of an element, its rows, elements)
    columns, rows = np.broadcast_arrays(trial.element_dofs[:, None], test.element_dofs[None])
    out = csr_array((local.ravel(), (rows.ravel(), columns.ravel())), shape=(test.N, trial.N))
    out.eliminate_zeros()
    return out


@lru_cache(maxsize=16)  # a blade's bases, which serve at every speed
def _functions(basis: Any, axis: int) -> list[Any]:
    """For each field of a basis, all its shape functions at once, with axes (…, functions, elements, points) and ``axis``."""
    from skfem.element import DiscreteField

    def together(arrays: Sequence[Array]) -> Array:
        return np.expand_dims(np.stack(arrays, axis=-3), axis)

    def field(parts: Sequence[Any]) -> Any:
        known = {name: getattr(parts[0], name) for name in ("grad", "hess")}
        slopes = {name: together([getattr(p, name) for p in parts]) for name, a in known.items() if a is not None}
        return DiscreteField(together([np.asarray(p) for p in parts]), **slopes)

    return [field(parts) for parts in zip(*basis.basis, strict=True)]
