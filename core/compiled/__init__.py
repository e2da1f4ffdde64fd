"""Loops over elements and nodes in C++: NumPy arrays come in and go out.

The formulae are in headers (``.hpp``) beside the modules that use them, the functions that Python calls in this folder. They
are compiled twice: for any processor, and for one with AVX2 and FMA. ``kernels`` is the module for this processor, with the
signatures in ``kernels.pyi``; with ``SOUTHWELL_BASELINE`` set, it is the one for any processor.
"""

import os
from typing import TYPE_CHECKING

from . import imported, sources

if TYPE_CHECKING:
    from . import kernels
else:
    try:
        from . import baseline as kernels
    except ImportError as error:
        raise ImportError(
            f"southwell's compiled kernels cannot be loaded ({error}): {imported.remedy('install the package again')}"
        ) from error
    if kernels.processor_has_avx2() and not os.environ.get("SOUTHWELL_BASELINE"):
        from . import avx2 as kernels
    if kernels.sources() != sources.digest():
        raise ImportError(
            "southwell's compiled kernels are not those of their sources: "
            + imported.remedy("run make, or pip install --editable .")
        )

__all__ = ["kernels"]
