"""One thread for numerical libraries: the matrices of a blade are too small for several."""

from contextlib import AbstractContextManager
from functools import lru_cache

from threadpoolctl import ThreadpoolController


def one_thread() -> AbstractContextManager[object]:
    """Limit the linear algebra libraries loaded so far to one thread, while the context is entered."""
    return _controller().limit(limits=1)


@lru_cache(maxsize=1)
def _controller() -> ThreadpoolController:
    import scipy.linalg  # noqa: F401  (a library is limited only if it is loaded before)

    return ThreadpoolController()
