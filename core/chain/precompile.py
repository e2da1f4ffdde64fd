"""``python -m southwell.core.chain.precompile``: compile the eigensolver's loops, while another process compiles the others."""

import numpy as np

from .lanczos import lanczos
from .pencil import ChainPencil


def eigensolver() -> None:
    """Solve one element with a consistent mass; the compiled functions go to the cache."""
    size = 18  # (ξ_a, ρ, β)
    M, C, K = np.eye(size), np.zeros((size, size)), np.diag(np.arange(1.0, size + 1.0))
    lanczos(ChainPencil(np.zeros(size - 6), M[None], C[None], K[None], np.eye(6)[None], np.zeros((0, 0))), 1)


if __name__ == "__main__":
    eigensolver()
