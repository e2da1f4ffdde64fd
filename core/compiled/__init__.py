"""Loops over elements and nodes in C++: NumPy arrays come in and go out.

The formulae are in headers (``.hpp``) beside the modules that use them, the functions that Python calls in this folder. They
are compiled twice: for any processor, and for one with AVX2 and FMA. ``loops`` is the module for this processor, with the
signatures in ``loops.pyi``; with ``SOUTHWELL_BASELINE`` set, it is the one for any processor.
"""

import os
from typing import TYPE_CHECKING

from . import sources

if TYPE_CHECKING:
    from . import loops
else:
    try:
        from . import baseline as loops
    except ImportError as error:
        raise ImportError(
            f"southwell's compiled loops cannot be loaded ({error}): install the package again"
        ) from error
    if loops.processor_has_avx2() and not os.environ.get("SOUTHWELL_BASELINE"):
        from . import avx2 as loops
    if loops.sources() != sources.digest():
        raise ImportError(
            "southwell's compiled loops are not those of their sources: run make, or pip install --editable ."
        )

__all__ = ["loops"]
