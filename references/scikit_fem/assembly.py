"""scikit-fem, imported when it is used, and its assembly of bilinear forms."""

from collections.abc import Callable
from typing import Any


def skfem() -> Any:
    """The package; adapters are imported where it is not installed."""
    import skfem

    return skfem


def bilinear(form: Callable[..., Any], trial: Any, test: Any = None, **given: Any) -> Any:
    """The sparse matrix (rows of ``test``, columns of ``trial``) that scikit-fem assembles of ``form(*u, *v, w)``.

    Args:
        form: linear in the fields u of the trial basis and v of the test basis; w has the attributes ``given``.
        trial: basis of the columns.
        test: basis of the rows at the same points; the trial basis if not given.
        given: values at the points, (…, elements, points), or constants.
    """
    return skfem().BilinearForm(form).assemble(trial, trial if test is None else test, **given)
