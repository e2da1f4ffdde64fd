"""scikit-fem, imported when it is used, and its assembly of bilinear forms."""

from collections.abc import Callable
from typing import Any


def skfem() -> Any:
    """Import scikit-fem; adapters must be importable where it is not installed."""
    import skfem

    return skfem


def bilinear(form: Callable[..., Any], trial: Any, test: Any = None, **attributes: Any) -> Any:
    """The sparse matrix (rows of ``test``, columns of ``trial``) that scikit-fem assembles of ``form(*u, *v, w)``.

    Args:
        form: linear in the fields u of the trial basis and v of the test basis; w has these attributes.
        trial: basis of the columns.
        test: basis of the rows at the same points; the trial basis if there is none.
        attributes: of w: values at the points, (…, elements, points), or constants.
    """
    return skfem().BilinearForm(form).assemble(trial, trial if test is None else test, **attributes)
