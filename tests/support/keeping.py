"""Keep the process that forks those of the codes through the tests of a module: starting one takes a second.

Otherwise each test has another one, as pytest puts the name of the test into the environment.
"""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from southwell.references.protocol import launch


@contextmanager
def kept() -> Iterator[None]:
    """Keep that process until the end of the block. It has the environment and the current folder of its first start."""
    surroundings = launch._surroundings()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(launch, "_kept", None)
        patch.setattr(launch, "_surroundings", lambda: surroundings)
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
