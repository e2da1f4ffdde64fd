"""Keep the process that forks those of the codes, as a worker of ``verify`` does: starting one takes a second."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from southwell.references.protocol import launch


@contextmanager
def kept() -> Iterator[None]:
    """Keep that process until the end of the block. It has the environment and the current folder of its first start."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(launch, "_keeping", True)
        patch.setattr(launch, "_kept", None)
        try:
            yield
        finally:
            if launch._kept:
                launch._kept.close()


@pytest.fixture(scope="module")
def keeping() -> Iterator[None]:
    """``kept`` for the tests of a module, none of which may change the environment."""
    with kept():
        yield
