"""Element boundaries of a blade: at its kinks, and closer together where its bending stiffness changes."""

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade
from ..sampling import sample
from .spectral import intervals

Array = NDArray[np.float64]


def element_ends(blade: Blade, elements: int, limit: int) -> Array:
    """Arc lengths (n+1,) of the ends of at least ``elements`` elements.

    Every interval between kinks is divided into the same number of elements, so that properties are smooth within each
    element and the order of convergence is preserved. A blade with more than ``limit`` intervals has proportionally more
    elements, so that refinements stay distinct. Within an interval the larger of the two ratios of bending stiffness is
    divided evenly between the elements, so that the curvature (moment over stiffness) is resolved.
    """
    ends = intervals(blade)
    at = sample(blade, ends)
    return graded(ends, np.array([at.EI_y, at.EI_z]), -(-elements // min(len(ends) - 1, limit)))


def graded(ends: Array, bending: Array, pieces: int) -> Array:
    """Ends of ``pieces`` elements in each interval between ``ends`` (k+1,) with the bending stiffness ``bending`` (2, k+1)."""
    change = np.diff(np.log(bending))
    change = np.take_along_axis(change, np.abs(change).argmax(0)[None], 0).T
    equal = np.arange(pieces) / pieces
    uneven = np.abs(change) > 1e-6
    share = np.where(uneven, np.expm1(equal * change) / np.expm1(np.where(uneven, change, 1.0)), equal)
    return np.append((ends[:-1, None] + np.diff(ends)[:, None] * share).ravel(), ends[-1])
